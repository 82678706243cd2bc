"""Load cases of a part, from the study's words to the solver's."""

from __future__ import annotations

from codesign.parts.load_case import CarriedMass, CaseSettings, FlownCase
from codesign.study.config import PartConfig, StudyConfig
from codesign.study.load_config import part_load
from codesign.units import MILLIMETER


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
