"""Load cases of a part, from the study's words to the solver's."""

from __future__ import annotations

from codesign import fem
from codesign.parts.load_case import CaseSettings, PartLoad, PressedFace, PushedFace
from codesign.study.config import LoadConfig, PartConfig, StudyConfig
from codesign.units import MEGA, MILLIMETER


def case_settings(part: PartConfig, config: StudyConfig) -> tuple[CaseSettings, ...]:
    """A part's load cases. Where one asks for a safety factor of its own, the others ask for the study's."""
    own = any(case.safety_factor_min is not None for case in part.load_cases)
    rest = config.constraints.safety_factor_min if own else None
    return tuple(
        CaseSettings(case.name, tuple(part_load(load) for load in case.loads), case.safety_factor_min or rest)
        for case in part.load_cases
    )


def part_load(load: LoadConfig) -> PartLoad:
    """One load in SI units; total forces on faces are the part's to interpret."""
    if load.pressing_n is not None:
        return PressedFace(load.face, load.pressing_n)
    if load.pressure_mpa is not None:
        return fem.Pressure(load.face, load.pressure_mpa * MEGA)
    if load.traction_mpa is not None:
        return fem.Traction(load.face, tuple(x * MEGA for x in load.traction_mpa))
    if load.acceleration_m_s2 is not None:
        return fem.Acceleration(load.acceleration_m_s2)
    force = load.force_n or (0.0, 0.0, 0.0)
    if load.point_mm is None and load.moment_n_m is None:
        return PushedFace(load.face, force)
    point = tuple(x * MILLIMETER for x in load.point_mm or (0.0, 0.0, 0.0))
    return fem.AffineTraction(load.face, force, point, load.moment_n_m or (0.0, 0.0, 0.0))
