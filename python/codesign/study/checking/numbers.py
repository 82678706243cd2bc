"""Names of objectives and limits: what is known of them before an evaluation."""

from __future__ import annotations

import difflib
from collections.abc import Iterator

from codesign.names import closest, nearest
from codesign.problem import numbers
from codesign.problem.numbers import Number, known_number, number_names
from codesign.problem.quantities import OF_A_PART, QUANTITIES, REDUCTIONS
from codesign.study.checking.problems import Problem, repeated
from codesign.study.config import LimitConfig, StudyConfig

MOST_OBJECTIVES = 6
MOST_NUMBERS = 8  # named instead of an unknown one
REDUCED_PARTS = ("sum(parts.", "min(parts.", "max(parts.")  # paths of numbers that every study has
SECTIONS = ("parts", "flight", "objective_families")


def number_problems(config: StudyConfig) -> Iterator[Problem]:
    """Objectives and limits that name no number, or one that this study cannot have."""
    names = config.objectives.names
    if not 1 <= len(names) <= MOST_OBJECTIVES:
        yield "objectives", f"{len(names)} objectives: there must be one to {MOST_OBJECTIVES}"
    if twice := repeated(names):
        yield "objectives", f"{twice!r} is named twice"
    for key, name in _asked(config):
        if reason := unknown_number(config, name) or _missing_number(config, name):
            yield key, reason
    for name, limit in config.constraints.limits.items():
        yield from _limit_problems(f"constraints.limits.{name}", limit)


def constant_numbers(config: StudyConfig) -> Iterator[Problem]:
    """Objectives and limits on numbers that are the same for every design, and so decide nothing."""
    for key, name in _asked(config):
        found = known_number(name)
        if found is not None and found.needs in numbers.ALWAYS_ZERO and not _has(config, found.needs):
            yield key, f"{name!r} is 0 for every design: {numbers.ALWAYS_ZERO[found.needs]}; it decides nothing"


def _asked(config: StudyConfig) -> Iterator[tuple[str, str]]:
    for key, listed in (
        ("objectives.minimize", config.objectives.minimize),
        ("objectives.maximize", config.objectives.maximize),
        ("constraints.limits", tuple(config.constraints.limits)),
    ):
        for name in listed:
            yield key, name


def _limit_problems(key: str, limit: LimitConfig) -> Iterator[Problem]:
    if limit.minimum is None and limit.maximum is None:
        yield key, "needs min, max or both"
    if limit.minimum is not None and limit.maximum is not None and limit.minimum > limit.maximum:
        yield key, f"min = {limit.minimum:g} is above max = {limit.maximum:g}"


def unknown_number(config: StudyConfig, name: str) -> str | None:
    """Why there can be no such number; None if there may be."""
    if ":" in name or name in QUANTITIES:
        return None
    function, bracket, rest = name.partition("(")
    if bracket and (function not in REDUCTIONS or not rest.endswith(")")):
        return f"{name!r}: expected {', '.join(f'{reduction}(…)' for reduction in REDUCTIONS)}"
    path = rest.removesuffix(")") if bracket else name
    first, _, rest = path.partition(".")
    if first not in SECTIONS or not rest:
        return f"no number {name!r}; {_nearest_numbers(config, name)}"
    if "*" in path.split(".") and not bracket:
        return f"{name!r}: a path with * needs min(…), max(…) or sum(…) around it"
    return _unknown_name(config, name, path) or _unknown_path(name, path)


def _unknown_name(config: StudyConfig, name: str, path: str) -> str | None:
    """Why a path names a part, load case or joint that is not there."""
    steps = path.split(".")
    parts = {part.name: part for part in config.parts}
    if steps[0] == "parts" and steps[1] != "*":
        if steps[1] not in parts:
            return f"{name!r}: no part {steps[1]!r}; {nearest(steps[1], parts)}"
        cases = [case.name for case in parts[steps[1]].load_cases]
        if len(steps) > 3 and steps[2] == "cases" and steps[3] not in (*cases, "*"):
            return f"{name!r}: no load case {steps[3]!r} of {steps[1]}; {nearest(steps[3], cases)}"
    if steps[:2] == ["flight", "joints"] and len(steps) > 2 and config.flight is not None:
        joints = [joint for group in config.flight.joint_groups for joint in group.joints]
        if steps[2] not in (*joints, "*"):
            return f"{name!r}: no joint {steps[2]!r} of flight.joint_groups; {nearest(steps[2], joints)}"
    return None


def _unknown_path(name: str, path: str) -> str | None:
    """Why a path leads to no number of an evaluation, with the nearest that does."""
    if known_number(path) is not None:
        return None
    steps = path.split(".")
    depth = (4 if "cases" in steps[2:3] else 2) if steps[0] == "parts" else 1
    prefix = {1: f"{steps[0]}.", 2: "parts.PART.", 4: "parts.PART.cases.CASE."}[depth]
    rest = [known.removeprefix(prefix) for known in number_names(prefix)]
    rest = [known for known in rest if not known.startswith("cases.")]
    wanted = ".".join(steps[depth:])
    found = closest(wanted, rest)
    hint = f"did you mean {'.'.join((*steps[:depth], found))!r}?" if found else f"there are {', '.join(rest)}"
    return f"no number {name!r}; {hint}"


def _missing_number(config: StudyConfig, name: str) -> str | None:
    """Why this study lacks a number that others have."""
    found: Number | None = None if ":" in name else known_number(name)
    if config.flight is None or found is None or found.needs not in numbers.MISSING or _has(config, found.needs):
        return None
    return f"{name!r} needs {numbers.MISSING[found.needs]}"


def _has(config: StudyConfig, need: str) -> bool:
    """Whether a study has what a number needs, to be there or to vary."""
    flight = config.flight
    if need == numbers.FLOWN_CASE:
        return any(part.flies for part in config.parts)
    if need == numbers.CLEARANCES:
        return config.interference is not None
    if flight is None:
        return False
    return {
        numbers.JOINTS: any(group.joints for group in flight.joint_groups),
        numbers.TANK: flight.tank is not None,
        numbers.FUEL: flight.fuel is not None,
        numbers.GROUND: bool(flight.ground.frames),
        numbers.SEEDS: len(flight.seeds) > 1,
    }[need]


def _nearest_numbers(config: StudyConfig, name: str) -> str:
    """Numbers that this study has, those first that are most like an unknown one."""
    own = {key for key, known in QUANTITIES.items() if known.path.startswith(REDUCED_PARTS)}
    flown = {key for key in QUANTITIES if key not in own and config.flight is not None}
    of_parts = {f"parts.{part.name}.{key}" for part in config.parts for key in OF_A_PART}
    like = difflib.SequenceMatcher(b=name)

    def likeness(known: str) -> tuple[float, str]:
        like.set_seq1(known)
        return -like.ratio(), known

    had = (known for known in own | flown | of_parts if _missing_number(config, known) is None)
    ranked = sorted(had, key=likeness)
    found = closest(name, ranked)
    meant = f"did you mean {found!r}? " if found else ""
    return f"{meant}nearest of those that this study has: {', '.join(ranked[:MOST_NUMBERS])}"
