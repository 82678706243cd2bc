"""Finds, reads and checks studies."""

from __future__ import annotations

import copy
import functools
import hashlib
import importlib
import re
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping
from itertools import chain
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any, TypeVar, cast

from codesign.errors import DesignError, StudyError, UrdfError
from codesign.names import nearest
from codesign.parts.part import Part
from codesign.problem.design_space import DesignSpace
from codesign.robot.description import RobotDescription
from codesign.robot.table import generated_urdf, written_urdf
from codesign.study.checking.flight import flight_problems, robot_problems
from codesign.study.checking.problems import Problem
from codesign.study.checking.references import reference_problems
from codesign.study.choices import design_space
from codesign.study.config import PartConfig, RawStudy, StudyConfig
from codesign.study.conversion import convert
from codesign.study.fingerprint import study_identity
from codesign.study.imports import PACKAGE
from codesign.study.parts import built_problems
from codesign.study.study import StudyData
from codesign.study.user_modules import import_beside, module_file

STUDIES = PACKAGE / "studies"
BARE_ROBOT = '<robot name="none"><link name="none"/></robot>'
MADE_FROM = re.compile(r"<!-- made from (\S+),")  # what the table's program writes at the head of a URDF
EXTENDS, WITHOUT = "extends", "without"  # keys of a study that states only what it does differently
AnyStudy = TypeVar("AnyStudy", bound=StudyData)


def shipped_studies() -> list[str]:
    """Names of the studies that come with the product."""
    return sorted(p.parent.name for p in STUDIES.glob("*/study.toml"))


def load(source: str | Path, kind: type[AnyStudy]) -> AnyStudy:
    """Loads and checks a study as an object of `kind`; kept until one of its files changes.

    Args:
        source: a shipped study's name, or the path of a study.toml or of its folder.
    Raises: StudyError with file, key, value and reason.
    """
    path = locate(source)
    make = cast("Callable[..., StudyData]", kind)
    return cast("AnyStudy", _load(str(source), path, make, _content(path, parse(path))))


@functools.lru_cache(maxsize=8)
def _load(source: str, path: Path, kind: Callable[..., StudyData], _content: str) -> StudyData:
    return study_from(parse(path), path, kind, source)


def study_from(raw: RawStudy, path: Path, kind: Callable[..., StudyData], source: str = "") -> StudyData:
    """A checked study of a parsed study.toml.

    Args:
        raw: the document; path: of its file, beside which robot and modules lie; kind: class of the study.
        source: what workers load it from; by default its path.
    Raises: StudyError with file, key, value and reason.
    """
    study = _unchecked(raw, path, kind, source)
    _refuse(path, design_problems(study))
    return study


def _unchecked(raw: RawStudy, path: Path, kind: Callable[..., StudyData], source: str) -> StudyData:
    """A study whose file is right in itself."""
    config = convert(raw, path)
    part_classes = {part.name: part_class(part, path) for part in config.parts}
    functions = {name: function_of(name, path) for name in own_functions(config)}
    _refuse(path, chain(reference_problems(config, part_classes), flight_problems(config)))
    robot = robot_of(config, path)
    modules = {cls.__module__ for cls in part_classes.values()} | {f.__module__ for f in functions.values()}
    return kind(
        source=source if source in shipped_studies() else str(path),
        path=path,
        raw=raw,
        config=config,
        space=design_space(config),
        part_classes=part_classes,
        functions=functions,
        base_robot=robot,
        identity=study_identity(raw, path, modules),
    )


def robot_of(config: StudyConfig, path: Path) -> RobotDescription:
    """The robot of a study, of a URDF or of the table it is made from; one bare link where it has none."""
    if config.robot is None:
        return RobotDescription.from_text(BARE_ROBOT)
    file = path.parent / config.robot.urdf
    try:
        if file.suffix == ".toml":
            return RobotDescription.from_text(generated_urdf(file), directory=file.resolve().parent)
        return RobotDescription.load(file)
    except UrdfError as error:
        raise StudyError(f"{path}: robot.urdf: {error}") from error


def parse(path: Path) -> RawStudy:
    """The document of a study, with what it takes over from the study it extends. Raises: StudyError."""
    return extended(_document(path), path, _extended_file, _document)


def _extended_file(name: str, path: Path) -> Path:
    """The file of the study that the one at path extends."""
    if name in shipped_studies():
        return STUDIES / name / "study.toml"
    file = (path.parent / name).resolve()
    file = file / "study.toml" if file.is_dir() else file
    if not file.is_file():
        raise StudyError(f"{path}: extends: {name!r}: no such study; shipped studies: {', '.join(shipped_studies())}")
    return file


def _document(path: Path) -> RawStudy:
    try:
        return tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except (OSError, UnicodeDecodeError) as error:
        raise StudyError(f"{path}: cannot be read: {error}") from error
    except tomllib.TOMLDecodeError as error:
        raise StudyError(f"{path}: not valid TOML: {error}") from error


def _content(path: Path, raw: RawStudy) -> str:
    """Digest of the files that a study is made of: its own, the robot, the modules beside it."""
    folder = path.parent
    robot = raw.get("robot")
    urdf = robot.get("urdf") if isinstance(robot, dict) else None
    files = [path, *sorted(folder.glob("*.py")), *sorted(folder.glob("*/*.py"))]
    files += [folder / urdf] if isinstance(urdf, str) else []
    digest = hashlib.sha256(repr(raw).encode())  # also what another file gave
    for file in files:
        digest.update(str(file).encode() + b"\0" + (file.read_bytes() if file.is_file() else b""))
    return digest.hexdigest()


def _refuse(path: Path, problems: Iterable[Problem]) -> None:
    for key, reason in problems:
        raise StudyError(f"{path}: {key}: {reason}")


def design_problems(study: StudyData) -> Iterator[Problem]:
    """What designs of the grid show: values that variables set, the baseline, the parts' options, faces and places."""
    space = study.space
    last, middle = [n - 1 for n in space.levels], [n // 2 for n in space.levels]
    designs = [space.from_indices(indices) for indices in (middle, [0] * len(middle), last)]
    try:
        designs = designs if study.baseline is None else [study.baseline, *designs]
    except DesignError as error:
        yield "baseline", str(error)
    yield from stale_robot(study)
    yield from robot_problems(study.config, study.base_robot)
    yield from built_problems(study.config, study.part_classes, study.base_robot, designs)
    second = [min(1, n) for n in last]
    for corner in ([0] * len(space.levels), second, last, *_other_choices(study.space)):
        configured = study.configured(space.from_indices(corner))
        yield from chain(reference_problems(configured, study.part_classes), flight_problems(configured))


def stale_robot(study: StudyData) -> Iterator[Problem]:
    """A URDF that is not that of the table beside it, which it says it is made from."""
    file = study.path.parent / study.config.robot.urdf if study.config.robot is not None else None
    if file is None or file.suffix == ".toml":
        return
    text = file.read_text(encoding="utf-8", errors="replace")
    made = MADE_FROM.search(text)
    table = file.with_name(made[1]) if made else file
    if made is None or not table.is_file():
        return
    try:
        if written_urdf(table) == text:
            return
        current = RobotDescription.from_text(generated_urdf(table)).to_text() == study.base_robot.to_text()
    except UrdfError as error:
        yield "robot.urdf", f"{file.name} is made from {table.name}, which is wrong: {error}"
        return
    if not current:
        yield "robot.urdf", f"{file.name} is not that of {table.name}: python -m codesign.robot.table {table} {file}"


def _other_choices(space: DesignSpace) -> Iterator[list[int]]:
    """Grid points beyond the corners that together have every named choice."""
    most = max((variable.levels for variable in space.variables if variable.named), default=0)
    for k in range(2, most - 1):
        yield [min(k, variable.levels - 1) if variable.named else 0 for variable in space.variables]


def locate(source: str | Path) -> Path:
    """The file of a study by name, path or folder. Raises: StudyError: there is none."""
    if str(source) in shipped_studies():
        return STUDIES / str(source) / "study.toml"
    path = Path(source).expanduser()
    if path.is_dir():
        path = path / "study.toml"
    if not path.is_file():
        raise StudyError(f"{source}: no such study file; shipped studies: {', '.join(shipped_studies())}")
    return path.resolve()


def own_functions(config: StudyConfig) -> list[str]:
    """Objectives and limits that are functions of the study: `module:function`."""
    return sorted(name for name in {*config.objectives.names, *config.constraints.limits} if ":" in name)


def function_of(name: str, path: Path) -> Callable[[Mapping[str, Any]], float]:
    """A study's own function, `module:function`. Raises: StudyError: it cannot be had."""
    module_name, _, function_name = name.partition(":")
    try:
        module = _load_module(module_name, path.parent)
    except (Exception, SystemExit) as error:  # whatever a user's module raises when it is imported
        raise StudyError(f"{path}: {name!r}: {type(error).__name__}: {error}") from error
    function = getattr(module, function_name, None)
    if not callable(function):
        functions = [key for key, value in vars(module).items() if isinstance(value, FunctionType)]
        raise StudyError(f"{path}: {name!r}: no such function; {nearest(function_name, functions)}")
    return cast("Callable[[Mapping[str, Any]], float]", function)


def part_class(part: PartConfig, path: Path) -> type[Part]:
    """The class that shapes a part. Raises: StudyError: it cannot be had."""
    module_name, colon, class_name = part.shape.partition(":")
    if not colon:
        raise StudyError(f"{path}: parts.{part.name}.shape = {part.shape!r}: expected module:Class")
    try:
        module = _load_module(module_name, path.parent)
    except (Exception, SystemExit) as error:  # whatever a user's module raises when it is imported
        raise StudyError(
            f"{path}: parts.{part.name}.shape = {part.shape!r}: {type(error).__name__}: {error}"
        ) from error
    classes = {name: value for name, value in vars(module).items() if isinstance(value, type)}
    shape = classes.get(class_name)
    if shape is None or not issubclass(shape, Part) or shape is Part:
        own = [name for name, value in classes.items() if issubclass(value, Part) and value is not Part]
        reason = "is not a subclass of codesign.parts.part.Part" if shape else f"is not in {module_name}"
        hint = nearest(class_name, own)
        raise StudyError(f"{path}: parts.{part.name}.shape = {part.shape!r}: {class_name!r} {reason}; {hint}")
    return shape


def _load_module(name: str, folder: Path) -> ModuleType:
    """A module beside the study file, else an importable one."""
    if module_file(folder, name.partition(".")[0]) is None:
        return importlib.import_module(name)
    if folder.is_relative_to(PACKAGE):
        return importlib.import_module(".".join(("codesign", *folder.relative_to(PACKAGE).parts, name)))
    return import_beside(folder, name)


def extended(
    raw: RawStudy, path: Path, find: Callable[[str, Path], Path], read: Callable[[Path], RawStudy]
) -> RawStudy:
    """A parsed study.toml with everything that it takes over from the study it extends.

    Tables are merged key by key. Lists of tables that all have a name are merged by it, entries of a new name come
    last. All other values replace those taken over; what `without` names is not taken over.

    Args:
        raw: as read from the file at path. find: the file that `extends` names. read: the document in a file.
    Raises: StudyError: the chain of studies ends where it began, or there is nothing to leave out.
    """
    chain = {path: raw}
    while isinstance(name := raw.get(EXTENDS), str):
        path = find(name, path)
        if path in chain:
            raise StudyError(f"{path}: {EXTENDS}: studies extend each other in a circle")
        chain[path] = raw = read(path)
    merged: RawStudy = {}
    for path, own in reversed(chain.items()):
        for place in own.get(WITHOUT, []) if merged else []:
            if not _leave_out(merged, place):
                raise StudyError(f"{path}: {WITHOUT}: {place!r}: the extended study has no such key")
        merged = _merged(merged, copy.deepcopy(own))
    return merged


def _merged(base: Any, own: Any) -> Any:
    if isinstance(base, dict) and isinstance(own, dict):
        return base | {key: _merged(base[key], value) if key in base else value for key, value in own.items()}
    if _named(base) and _named(own):
        merged = {entry["name"]: entry for entry in base}
        for entry in own:
            merged[entry["name"]] = _merged(merged.get(entry["name"], {}), entry)
        return list(merged.values())
    return own


def _named(value: Any) -> bool:
    """Whether a value is a list of tables with different names."""
    if not isinstance(value, list) or not value:
        return False
    names = [entry.get("name") if isinstance(entry, dict) else None for entry in value]
    return all(isinstance(name, str) for name in names) and len(set(names)) == len(names)


def _leave_out(document: RawStudy, place: str) -> bool:
    """Removes what a dotted path names; entries of lists by their name. False: nothing is there."""
    *folders, last = place.split(".")
    target: Any = document
    for folder in folders:
        if isinstance(target, list) and _named(target):
            target = {entry["name"]: entry for entry in target}
        target = target.get(folder) if isinstance(target, Mapping) else None
    if not isinstance(target, dict) or last not in target:
        return False
    del target[last]
    return True
