"""Load cases that can never decide: others load the part the same way and ask for more."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import permutations

import numpy as np

from codesign.study.checking.problems import Problem
from codesign.study.config import LoadCaseConfig, StudyConfig
from codesign.study.load_config import LoadConfig

VALUES = (
    "pressing_n", "force_n", "moment_n_m", "bearing_n", "pressure_mpa", "traction_mpa", "acceleration_m_s2",
)  # fmt: skip
SAME_RATIO = 1e-9  # relative


def idle_cases(config: StudyConfig) -> Iterator[Problem]:
    """Cases whose loads are a multiple of another's that with its safety factor asks for at least as much."""
    for part in config.parts:
        told: set[str] = set()
        for idle, other in permutations(part.cases, 2):
            if {idle.name, other.name} & told:
                continue
            ratio = _ratio(idle, other)
            mine, theirs = (case.safety_factor_min or config.constraints.safety_factor_min for case in (idle, other))
            if ratio is not None and ratio * theirs >= mine:
                told.add(idle.name)
                yield (
                    f"parts.{part.name}.cases[{idle.name}]",
                    f"decides nothing: {other.name!r} loads the part the same way, {ratio:.3g} times as much, and "
                    f"asks for a safety factor of {theirs:g} (here {mine:g})",
                )


def _ratio(case: LoadCaseConfig, other: LoadCaseConfig) -> float | None:
    """By what the loads of a case are to be multiplied to be those of another; None: they act otherwise."""
    if case.flown or other.flown or len(case.loads) != len(other.loads):
        return None
    if any(_place(mine) != _place(theirs) for mine, theirs in zip(case.loads, other.loads, strict=True)):
        return None
    mine, theirs = _numbers(case), _numbers(other)
    if mine.shape != theirs.shape:
        return None
    ratio = float(mine @ theirs / (mine @ mine))
    same = np.allclose(ratio * mine, theirs, rtol=0.0, atol=SAME_RATIO * np.abs(theirs).max())
    return ratio if ratio > 0.0 and same else None


def _place(load: LoadConfig) -> tuple[object, ...]:
    return load.face, load.interface, load.point_mm, tuple(name for name in VALUES if getattr(load, name) is not None)


def _numbers(case: LoadCaseConfig) -> np.ndarray:
    given = [getattr(load, name) for load in case.loads for name in VALUES]
    return np.concatenate([np.atleast_1d(value).astype(float) for value in given if value is not None])
