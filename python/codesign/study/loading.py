"""Finds, reads and checks studies."""

from __future__ import annotations

import functools
import hashlib
import importlib
import importlib.util
import sys
import tomllib
from collections.abc import Callable, Mapping
from pathlib import Path
from types import ModuleType
from typing import Any, TypeVar, cast

from codesign.errors import StudyError
from codesign.parts.part import Part
from codesign.problem.design_space import DesignSpace, Variable
from codesign.robot.description import RobotDescription
from codesign.study.checks import check_study
from codesign.study.config import PartConfig, StudyConfig
from codesign.study.conversion import convert
from codesign.study.fingerprint import PACKAGE, code_hash, study_hash
from codesign.study.study import StudyData

STUDIES = PACKAGE / "studies"
AnyStudy = TypeVar("AnyStudy", bound=StudyData)


def shipped_studies() -> list[str]:
    """Names of the studies that come with the product."""
    return sorted(p.parent.name for p in STUDIES.glob("*/study.toml"))


@functools.lru_cache(maxsize=8)
def load(source: str | Path, kind: type[AnyStudy]) -> AnyStudy:
    """Loads and checks a study as an object of `kind`.

    Args:
        source: a shipped study's name, or the path of a study.toml or of its folder.
    Raises: StudyError with file, key and reason.
    """
    path = _locate(source)
    try:
        raw = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError) as error:
        raise StudyError(f"{path}: cannot be read: {error}") from error
    except tomllib.TOMLDecodeError as error:
        raise StudyError(f"{path}: not valid TOML: {error}") from error
    config = convert(raw, path)
    part_classes = {part.name: _part_class(part, path) for part in config.parts}
    functions = {name: _function(name, path) for name in own_functions(config)}
    code = code_hash({cls.__module__ for cls in part_classes.values()} | {f.__module__ for f in functions.values()})
    check_study(config, part_classes, path)
    space = DesignSpace(tuple(Variable(n, v.minimum, v.maximum, v.step, v.unit) for n, v in config.variables.items()))
    study = kind(
        source=str(source if str(source) in shipped_studies() else path),
        path=path,
        raw=raw,
        config=config,
        space=space,
        part_classes=part_classes,
        functions=functions,
        base_robot=RobotDescription.load(path.parent / config.robot.urdf),
        hash=study_hash(raw, path, code),
        code_hash=code,
    )
    for corner in ([0] * len(space.variables), [levels - 1 for levels in space.levels]):
        study.configured(space.from_indices(corner))  # a number that a variable sets must exist and stay valid
    try:
        _ = study.baseline
    except ValueError as error:
        raise StudyError(f"{path}: baseline: {error}") from error
    return study


def _locate(source: str | Path) -> Path:
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


def _function(name: str, path: Path) -> Callable[[Mapping[str, Any]], float]:
    module_name, _, function_name = name.partition(":")
    try:
        function = getattr(_load_module(module_name, path.parent), function_name)
    except Exception as error:  # whatever a user's module raises when it is imported
        raise StudyError(f"{path}: {name!r}: {type(error).__name__}: {error}") from error
    if not callable(function):
        raise StudyError(f"{path}: {name!r}: not a function of an evaluation's document")
    return cast("Callable[[Mapping[str, Any]], float]", function)


def _part_class(part: PartConfig, path: Path) -> type[Part]:
    module_name, colon, class_name = part.shape.partition(":")
    if not colon:
        raise StudyError(f"{path}: parts.{part.name}.shape = {part.shape!r}: expected module:Class")
    try:
        module = _load_module(module_name, path.parent)
        shape = getattr(module, class_name)
    except Exception as error:  # whatever a user's module raises when it is imported
        raise StudyError(
            f"{path}: parts.{part.name}.shape = {part.shape!r}: {type(error).__name__}: {error}"
        ) from error
    if not (isinstance(shape, type) and issubclass(shape, Part)):
        raise StudyError(
            f"{path}: parts.{part.name}.shape = {part.shape!r}: not a subclass of codesign.parts.part.Part"
        )
    return shape


def _load_module(name: str, folder: Path) -> ModuleType:
    """A module beside the study file, else an importable one."""
    file = folder / f"{name}.py"
    if not file.is_file():
        return importlib.import_module(name)
    if folder.is_relative_to(PACKAGE):
        return importlib.import_module(".".join(("codesign", *folder.relative_to(PACKAGE).parts, name)))
    unique = f"codesign_study_{hashlib.sha256(str(file).encode()).hexdigest()[:12]}_{name}"
    if unique in sys.modules:
        return sys.modules[unique]
    spec = importlib.util.spec_from_file_location(unique, file)
    if spec is None or spec.loader is None:
        raise ImportError(f"{file} cannot be loaded")
    module = importlib.util.module_from_spec(spec)
    sys.modules[unique] = module
    try:
        spec.loader.exec_module(module)
    except BaseException:
        del sys.modules[unique]
        raise
    return module
