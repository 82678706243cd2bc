"""A study: checked configuration, design space, base robot and part classes; the entry to the whole chain."""

from __future__ import annotations

import functools
import hashlib
import importlib
import importlib.util
import json
import shutil
import sys
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

import msgspec

from codesign.config import (
    DECIDING_SECTIONS,
    MaterialConfig,
    PartConfig,
    RawStudy,
    StudyConfig,
    TrajectoryConfig,
    VariableConfig,
)
from codesign.design import Design, DesignSpace, Variable
from codesign.errors import StudyError
from codesign.geometry.part import Part, parameter_units
from codesign.urdf import RobotDescription

if TYPE_CHECKING:
    from codesign.analysis import Confirmation
    from codesign.cache import PartCache
    from codesign.evaluation import Evaluation

STUDIES = Path(__file__).parent / "studies"
PACKAGE = Path(__file__).parent
DECIDING_MODULES = (
    "analysis", "config", "fem_model", "flight_setup", "inertial", "interference", "pipeline", "robot", "study",
    "transforms", "units", "urdf",
)  # fmt: skip


@dataclass(frozen=True)
class Study:
    """Everything that defines a study. Immutable; `load_study` makes and checks it.

    source: the name or path it was loaded from (worker processes load it again from there).
    raw: the parsed TOML, on which design variables with `sets` act. hash: of all that decides a result. code_hash: of
    the engine and the parts' sources, which with a part's own values and settings decide that part's numbers.
    """

    source: str
    path: Path
    raw: RawStudy
    config: StudyConfig
    space: DesignSpace
    part_classes: dict[str, type[Part]]
    base_robot: RobotDescription
    hash: str
    code_hash: str

    @property
    def name(self) -> str:
        """Short name."""
        return self.config.name

    @property
    def title(self) -> str:
        """One line for people."""
        return self.config.title or self.config.name

    @property
    def description(self) -> str:
        """A paragraph for people."""
        return self.config.description

    @property
    def objectives(self) -> tuple[str, ...]:
        """Names of the minimised objectives."""
        return tuple(self.config.objectives.minimise)

    @property
    def optimizer(self) -> Any:
        """Defaults of the search."""
        return self.config.optimizer

    @property
    def execution(self) -> Any:
        """Workers and limits."""
        return self.config.execution

    @property
    def baseline(self) -> Design | None:
        """The design that reports compare with, if the study names one."""
        return self.space.design(self.config.baseline) if self.config.baseline else None

    @property
    def trajectories(self) -> tuple[str, ...]:
        """Names of the trajectories."""
        return tuple(self.config.trajectories)

    def configured(self, design: Mapping[str, float]) -> StudyConfig:
        """The configuration with the numbers that design variables set replaced."""
        setting = {n: v for n, v in self.config.variables.items() if v.sets}
        if not setting:
            return self.config
        raw = json.loads(json.dumps(self.raw))
        for name, variable in setting.items():
            for path in variable.sets:
                _replace_number(raw, path, design[name], self.path)
        return _convert(raw, self.path)

    def build_parts(self, theta: Mapping[str, float] | Sequence[float]) -> dict[str, Part]:
        """Parts of a design by name."""
        from codesign.pipeline import build_parts

        return build_parts(self, self.space.design(theta))

    def build_robot(self, theta: Mapping[str, float] | Sequence[float]) -> str:
        """URDF text of the robot with this design's parts."""
        from codesign.pipeline import build_robot

        return build_robot(self, self.space.design(theta)).to_text()

    def evaluate(
        self,
        theta: Mapping[str, float] | Sequence[float],
        trajectory: str | None = None,
        cache: PartCache | None = None,
    ) -> Evaluation:
        """One design through the whole chain; `trajectory`: a name of the study, default its own."""
        from codesign.pipeline import evaluate

        return evaluate(self, self.space.design(theta), trajectory=trajectory, cache=cache)

    def confirm(self, theta: Mapping[str, float] | Sequence[float]) -> dict[str, Confirmation]:
        """Parts of a design by name, as analysed and with full geometry on a fine mesh (some seconds a part)."""
        from codesign.pipeline import confirm_parts

        return confirm_parts(self, self.space.design(theta))


def shipped_studies() -> list[str]:
    """Names of the studies that come with the product."""
    return sorted(p.parent.name for p in STUDIES.glob("*/study.toml"))


@functools.lru_cache(maxsize=8)
def load_study(source: str | Path = "ironcub") -> Study:
    """Loads and checks a study.

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
    config = _convert(raw, path)
    part_classes = {part.name: _part_class(part, path) for part in config.parts}
    code = _code_hash(part_classes)
    _check(config, part_classes, path)
    space = DesignSpace(tuple(Variable(n, v.minimum, v.maximum, v.step, v.unit) for n, v in config.variables.items()))
    study = Study(
        source=str(source if str(source) in shipped_studies() else path),
        path=path,
        raw=raw,
        config=config,
        space=space,
        part_classes=part_classes,
        base_robot=RobotDescription.load(path.parent / config.robot.urdf),
        hash=_study_hash(raw, path, code),
        code_hash=code,
    )
    for corner in ([0] * len(space.variables), [levels - 1 for levels in space.levels]):
        study.configured(space.from_indices(corner))  # a number that a variable sets must exist and stay valid
    try:
        _ = study.baseline
    except ValueError as error:
        raise StudyError(f"{path}: baseline: {error}") from error
    return study


def new_study(folder: str | Path, template: str = "gimbal_quad") -> list[Path]:
    """Writes a commented, runnable study into a new folder and returns the files.

    Raises: StudyError if the folder holds files already.
    """
    folder = Path(folder)
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise StudyError(f"{folder}: exists and is not empty")
    folder.mkdir(parents=True, exist_ok=True)
    sources = sorted(p for p in (STUDIES / template).iterdir() if p.is_file() and p.name != "__init__.py")
    return [Path(shutil.copy(source, folder / source.name)) for source in sources]


def _locate(source: str | Path) -> Path:
    if str(source) in shipped_studies():
        return STUDIES / str(source) / "study.toml"
    path = Path(source).expanduser()
    if path.is_dir():
        path = path / "study.toml"
    if not path.is_file():
        raise StudyError(f"{source}: no such study file; shipped studies: {', '.join(shipped_studies())}")
    return path.resolve()


def _convert(raw: RawStudy, path: Path) -> StudyConfig:
    try:
        return msgspec.convert(raw, StudyConfig)
    except msgspec.ValidationError as error:
        reason, _, location = str(error).partition(" - at `$")
        key = _named_key(raw, location.rstrip("`").lstrip(".")) or "top level"
        raise StudyError(f"{path}: {key}: {reason}") from error


def _named_key(raw: RawStudy, location: str) -> str:
    """The location of a wrong value with the name of the table entry that msgspec writes as `[...]`."""
    table, placeholder, rest = location.partition("[...]")
    entry_type = {"variables": VariableConfig, "materials": MaterialConfig, "trajectories": TrajectoryConfig}.get(table)
    if not placeholder or entry_type is None:
        return location
    for name, entry in raw[table].items():
        try:
            msgspec.convert(entry, entry_type)
        except msgspec.ValidationError:
            return f"{table}.{name}{rest}"
    return location


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
            f"{path}: parts.{part.name}.shape = {part.shape!r}: not a subclass of codesign.geometry.part.Part"
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


def _check(config: StudyConfig, part_classes: Mapping[str, type[Part]], path: Path) -> None:
    """Cross-references and bounds that types cannot express; raises StudyError with file, key and reason."""

    def refuse(key: str, reason: str) -> None:
        raise StudyError(f"{path}: {key}: {reason}")

    if not config.variables:
        refuse("variables", "a study needs at least one design variable")
    for name, variable in config.variables.items():
        if variable.maximum <= variable.minimum:
            refuse(f"variables.{name}", f"max = {variable.maximum:g} must be above min = {variable.minimum:g}")
        steps = (variable.maximum - variable.minimum) / variable.step
        if abs(steps - round(steps)) > 1e-6:
            refuse(f"variables.{name}.step", f"{variable.step:g} does not divide max - min into whole steps")
    names = [part.name for part in config.parts]
    if len(set(names)) != len(names):
        refuse("parts", f"two parts have the name {next(n for n in names if names.count(n) > 1)!r}")
    for part in config.parts:
        key = f"parts.{part.name}"
        if part.material not in config.materials:
            refuse(f"{key}.material", f"{part.material!r} is not in [materials]: {', '.join(config.materials)}")
        units = parameter_units(part_classes[part.name])
        if set(part.parameters) != set(units):
            refuse(f"{key}.parameters", f"{part.shape} takes {', '.join(units)}; given {', '.join(part.parameters)}")
        for parameter, name in part.parameters.items():
            if name not in config.variables:
                refuse(f"{key}.parameters.{parameter}", f"no design variable {name!r}")
            if config.variables[name].unit != units[parameter]:
                refuse(f"variables.{name}.unit", f"{part.shape} expects {units[parameter]!r} for {parameter}")
    used = {name for part in config.parts for name in part.parameters.values()}
    for name, variable in config.variables.items():
        if name not in used and not variable.sets:
            refuse(f"variables.{name}", "no part takes it and it sets nothing")
    _check_flight(config, refuse)


def _check_flight(config: StudyConfig, refuse: Any) -> None:
    flight = config.flight
    for group in flight.joint_groups:
        for key in ("initial_rad", "ranges_deg"):
            if len(getattr(group, key)) != len(group.joints):
                refuse(f"flight.joint_groups[{group.name}].{key}", f"needs {len(group.joints)} entries, one a joint")
        for joint, (low, high) in zip(group.joints, group.ranges_deg, strict=True):
            if low >= high:
                refuse(f"flight.joint_groups[{group.name}].ranges_deg", f"{joint}: {low:g} must be below {high:g}")
    for pair in flight.jets.symmetric_pairs:
        for jet in pair:
            if jet not in flight.jets.frames:
                refuse("flight.jets.symmetric_pairs", f"no jet {jet!r}")
    for key, name in [("flight.trajectory", flight.trajectory)] + [
        ("validation.trajectories", name) for name in config.validation.trajectories
    ]:
        if name not in config.trajectories:
            refuse(key, f"no trajectory {name!r}; there are {', '.join(config.trajectories)}")
    for name, trajectory in config.trajectories.items():
        for window in trajectory.windows:
            if window.to_s <= window.from_s:
                refuse(f"trajectories.{name}.windows", f"to_s = {window.to_s:g} is not after {window.from_s:g}")
    if flight.jet_model == "turbine" and flight.turbine is None:
        refuse("flight.jet_model", "'turbine' needs [flight.turbine]")
    for objective in config.objectives.minimise:
        if objective not in ("momentum", "joint_velocity", "thrust"):
            refuse("objectives.minimise", f"no objective {objective!r}; there are momentum, joint_velocity, thrust")


def _replace_number(raw: RawStudy, dotted: str, value: float, path: Path) -> None:
    """Sets raw["a"]["b"] for "a.b"; list items by index. The place must exist and hold a number."""
    *parents, last = dotted.split(".")
    node: Any = raw
    try:
        for key in parents:
            node = node[int(key)] if isinstance(node, list) else node[key]
        index = int(last) if isinstance(node, list) else last
        old = node[index]
    except (KeyError, IndexError, ValueError, TypeError):
        raise StudyError(f"{path}: sets = {dotted!r}: no such number in the study") from None
    if isinstance(old, bool) or not isinstance(old, int | float):
        raise StudyError(f"{path}: sets = {dotted!r}: not a number")
    node[index] = value


def _study_hash(raw: RawStudy, path: Path, code: str) -> str:
    """Hash of everything that decides a result: deciding sections, robot, code."""
    digest = hashlib.sha256()
    digest.update(json.dumps({k: raw.get(k) for k in DECIDING_SECTIONS}, sort_keys=True).encode())
    digest.update((path.parent / raw["robot"]["urdf"]).read_bytes())
    digest.update(code.encode())
    return digest.hexdigest()[:16]


def _code_hash(part_classes: Mapping[str, type[Part]]) -> str:
    """Hash of the sources of the parts and of the engine."""
    digest = hashlib.sha256()
    for module in sorted({cls.__module__ for cls in part_classes.values()}):
        digest.update(Path(str(sys.modules[module].__file__)).read_bytes())
    digest.update(engine_hash().encode())
    return digest.hexdigest()[:16]


@functools.cache
def engine_hash() -> str:
    """Hash of the code that turns a design into numbers: compiled core, geometry, DECIDING_MODULES."""
    from codesign import _core

    files = [Path(str(_core.__file__)), *sorted((PACKAGE / "geometry").glob("*.py"))]
    files += [PACKAGE / f"{name}.py" for name in DECIDING_MODULES]
    digest = hashlib.sha256()
    for file in files:
        digest.update(file.name.encode() + file.read_bytes())
    return digest.hexdigest()[:16]
