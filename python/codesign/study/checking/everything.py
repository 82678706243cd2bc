"""Everything that is wrong with a study, at once."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import chain
from pathlib import Path

import msgspec

from codesign.errors import StudyError
from codesign.parts.materials import material_names
from codesign.parts.part import Part
from codesign.problem.identity import Identity
from codesign.robot.description import RobotDescription
from codesign.study import loading
from codesign.study.checking.flight import flight_problems
from codesign.study.checking.problems import Problem
from codesign.study.checking.references import reference_problems
from codesign.study.choices import design_space
from codesign.study.config import RawStudy, StudyConfig
from codesign.study.conversion import convert, readable
from codesign.study.study import StudyData

ROBOTS_NAME = re.compile(r"no (link|joint|moving joint)\b")
UNKNOWN_NAME = re.compile(r"('[^']*': )?no [\w: ]+ '")  # of a reason that stands whatever else is wrong


def find_problems(source: str | Path) -> list[str]:
    """Everything that is wrong with a study, a line each; empty if it can be loaded.

    What is refused is left out and the rest judged: of numbers by names and bounds, of robot and parts by the names of
    links, joints, interfaces and faces. A part whose parameters are wrong cannot be built, so its faces are unknown.
    """
    path = loading.locate(source)
    try:
        read = readable(loading.parse(path))
        found = [f"{path}: {problem}" for problem in read.problems]
        if read.raw is None:
            return found
        config = convert(read.raw, path)
    except StudyError as error:
        return [str(error)]
    part_classes, unloaded = _part_classes(config, path)
    found += unloaded
    lost = set(read.lost)
    if unloaded:  # variants of loads and supports are offered by the classes
        lost |= {part.name for part in config.parts if part.name not in part_classes} | {"variant"}
    config = msgspec.structs.replace(config, parts=[part for part in config.parts if part.name in part_classes])
    found += _own_functions(config, path)
    named = chain(reference_problems(config, part_classes), flight_problems(config))
    found += [_line(path, problem) for problem in named if not lost or _stands(problem, lost)]
    raw, judged = _with_known_materials(read.raw, config, path)
    return list(dict.fromkeys([*found, *_deeper_problems(raw, path, judged, part_classes, lost, not found)]))


def _with_known_materials(raw: RawStudy, config: StudyConfig, path: Path) -> tuple[RawStudy, StudyConfig]:
    """A study whose parts of an unknown material are of another one: faces do not depend on it."""
    unknown = {part.name for part in config.parts if part.material not in config.materials}
    if not unknown:
        return raw, config
    other = {"material": material_names()[0]}
    parts = [part | other if part.get("name") in unknown else part for part in raw["parts"]]
    known = {part.name for part in config.parts}
    made = convert({**raw, "parts": parts}, path)
    return {**raw, "parts": parts}, msgspec.structs.replace(made, parts=[p for p in made.parts if p.name in known])


def _deeper_problems(
    raw: RawStudy,
    path: Path,
    config: StudyConfig,
    part_classes: dict[str, type[Part]],
    lost: set[str],
    sound: bool,
) -> Iterator[str]:
    """What robot, parts and the grid's corners show. sound: nothing else is wrong, so everything told is a cause."""
    robot = RobotDescription.from_text(loading.BARE_ROBOT)
    no_robot = False
    try:
        robot = loading.robot_of(config, path)
    except StudyError as error:
        yield str(error)
        sound, no_robot = False, True
    try:
        space = design_space(config)
        study = StudyData("", path, raw, config, space, part_classes, {}, robot, Identity({}, {}))
        for problem in loading.design_problems(study):
            reason = problem[1]
            follows = "cannot be built" in reason or (no_robot and ROBOTS_NAME.search(reason))
            if sound or not (follows or (lost and not _stands(problem, lost))):
                yield _line(path, problem)
    except StudyError as error:
        yield str(error)
    except Exception:  # follows from what is told already
        if sound:
            raise


def _part_classes(config: StudyConfig, path: Path) -> tuple[dict[str, type[Part]], list[str]]:
    """Classes of the parts, and why there are none of some."""
    classes, problems = {}, []
    for part in config.parts:
        try:
            classes[part.name] = loading.part_class(part, path)
        except StudyError as error:
            problems.append(str(error))
    return classes, problems


def _own_functions(config: StudyConfig, path: Path) -> Iterator[str]:
    """Why functions of the study are not there."""
    for name in loading.own_functions(config):
        try:
            loading.function_of(name, path)
        except StudyError as error:
            yield str(error)


def _stands(problem: Problem, lost: set[str]) -> bool:
    """Whether a problem is one of its own, although other things are wrong: a name that nothing lost has."""
    return UNKNOWN_NAME.match(problem[1]) is not None and lost.isdisjoint(re.findall(r"\w+", problem[1]))


def _line(path: Path, problem: Problem) -> str:
    return f"{path}: {problem[0]}: {problem[1]}"
