"""Load cases of a part, from the study's words to the solver's."""

from __future__ import annotations

from codesign import fem
from codesign.parts.load_case import (
    CarriedMass,
    CaseSettings,
    FlownCase,
    InterfaceForce,
    PartLoad,
    PressedFace,
    PushedFace,
)
from codesign.study.config import LoadConfig, PartConfig, StudyConfig
from codesign.units import MEGA, MILLIMETER


def case_settings(part: PartConfig, config: StudyConfig) -> tuple[CaseSettings, ...]:
    """A part's load cases but for flown ones. Where one asks for its own safety factor, others ask for the study's."""
    rest = _otherwise(part, config)
    return tuple(
        CaseSettings(case.name, tuple(part_load(load) for load in case.loads), case.safety_factor_min or rest)
        for case in part.load_cases
        if not case.flown
    )


def flown_settings(part: PartConfig, config: StudyConfig) -> tuple[FlownCase, ...]:
    """A part's load cases whose loads the flight gives."""
    rest = _otherwise(part, config)
    return tuple(
        FlownCase(case.name, tuple(case.flown.items()), case.safety_factor_min or rest)
        for case in part.load_cases
        if case.flown
    )


def carried_masses(part: PartConfig) -> tuple[CarriedMass, ...]:
    """What faces of a part carry."""
    masses = []
    for mass in part.masses:
        x, y, z = (MILLIMETER * value for value in mass.point_mm)
        masses.append(CarriedMass(mass.face, mass.mass_kg, (x, y, z), mass.inertia_kg_m2, mass.interface))
    return tuple(masses)


def asked_of(part: PartConfig, config: StudyConfig) -> dict[str, float]:
    """Safety factor that each load case asks for, relative to the others': 1 where none asks for its own."""
    rest = _otherwise(part, config) or 1.0
    return {case.name: case.safety_factor_min or rest for case in part.load_cases}


def _otherwise(part: PartConfig, config: StudyConfig) -> float | None:
    own = any(case.safety_factor_min is not None for case in part.load_cases)
    return config.constraints.safety_factor_min if own else None


def part_load(load: LoadConfig) -> PartLoad:
    """One load in SI units; total forces on faces are the part's to interpret."""
    if load.pressing_n is not None:
        return PressedFace(load.face, load.pressing_n)
    if load.pressure_mpa is not None:
        return fem.Pressure(load.face, load.pressure_mpa * MEGA)
    if load.traction_mpa is not None:
        return fem.Traction(load.face, tuple(x * MEGA for x in load.traction_mpa))
    if load.bearing_n is not None:
        return fem.BearingLoad(load.face, load.bearing_n)
    if load.acceleration_m_s2 is not None:
        return fem.Acceleration(load.acceleration_m_s2)
    force = load.force_n or (0.0, 0.0, 0.0)
    x, y, z = (MILLIMETER * value for value in load.point_mm or (0.0, 0.0, 0.0))
    moment = load.moment_n_m or (0.0, 0.0, 0.0)
    if load.interface:
        return InterfaceForce(load.face, load.interface, force, (x, y, z), moment)
    if load.point_mm is None and load.moment_n_m is None:
        return PushedFace(load.face, force)
    return fem.AffineTraction(load.face, force, (x, y, z), moment)
