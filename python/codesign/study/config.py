"""A study as written in study.toml: strictly typed structs, units in the key names, unknown keys refused."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from msgspec import Meta, field

from codesign.errors import StudyError
from codesign.robot.assembly import PartPlacement
from codesign.robot.changes import RobotChange
from codesign.robot.clearance import InterferenceSettings
from codesign.study.flight_config import FlightConfig, TrajectoryConfig
from codesign.study.load_config import LoadConfig
from codesign.study.sections import ChoiceName, Name, NonNegative, Positive, Probability, Section, Seed, Vector3

ONLY_CASE = "load"  # name of the load case of a part that has one


class VariableConfig(Section, frozen=True, kw_only=True):
    """One design variable: an even grid (min, max, step), a list of numbers (values), or named choices.

    sets: places of the study (dotted paths; entries of a list by index or name) that take the variable's value.
    choices: names, or a table of names, each of which sets the same keys: numbers that parameters of parts take as
    `variable.key`, and places of the study by their dotted path.
    """

    minimum: float | None = field(name="min", default=None)
    maximum: float | None = field(name="max", default=None)
    step: Positive | None = None
    values: list[float] = []
    choices: list[ChoiceName] | dict[ChoiceName, dict[Name, float | bool | str]] = []
    unit: Literal["", "mm", "deg"] = ""
    label: str = ""
    sets: list[str] = []

    def __post_init__(self) -> None:
        grid = [self.minimum, self.maximum, self.step]
        if [any(n is not None for n in grid), bool(self.values), bool(self.choices)].count(True) != 1 or (
            None in grid and not self.values and not self.choices
        ):
            raise ValueError("a variable needs either min, max and step, or values, or choices")
        if isinstance(self.choices, dict) and self.sets:
            raise ValueError("choices of several numbers name in their own keys what they set, without sets")

    @property
    def listed(self) -> list[float | str]:
        """What a variable without an even grid takes: numbers, or names of choices."""
        return [*self.values, *self.choices]

    @property
    def chosen_keys(self) -> list[str]:
        """What every choice of several numbers sets."""
        return list(next(iter(self.choices.values()))) if isinstance(self.choices, dict) and self.choices else []


class MaterialConfig(Section, frozen=True, kw_only=True):
    """Isotropic linear elastic material.

    fatigue_strength_mpa: stress amplitude, fully reversed, that smooth specimens stand for fatigue_cycles; with the
    ultimate strength it gives the fatigue of flown loads.
    """

    young_modulus_gpa: Positive
    poisson_ratio: Annotated[float, Meta(gt=-1, lt=0.5)]
    yield_strength_mpa: Positive
    density_kg_m3: Positive
    ultimate_strength_mpa: Positive | None = None
    fatigue_strength_mpa: Positive | None = None
    fatigue_cycles: Positive | None = None


class MassOnFaceConfig(Section, frozen=True, kw_only=True):
    """A rigid body that a face of the part carries, an engine, say: accelerations pull at it, frequencies count it.

    Point and moments of inertia are in axes of the interface, if one is named; links that hang on it and have no mass
    of their own in the robot's file take these numbers.
    """

    face: Name
    mass_kg: Positive
    point_mm: Vector3
    interface: str = ""
    inertia_kg_m2: Vector3 = (0.0, 0.0, 0.0)


class LoadCaseConfig(Section, frozen=True, kw_only=True):
    """Loads that act together. safety_factor_min: what they ask for, where it is not what the study asks for.

    flown: instead of loads, those of the flight at every sample: interface of the part -> face that what hangs on it
    pushes on, by its thrust, weight and inertia; the part's own weight and inertia act too.
    """

    name: Name
    loads: list[LoadConfig] = []
    flown: dict[Name, Name] = {}
    safety_factor_min: Positive | None = None


class PartConfig(Section, frozen=True, kw_only=True):
    """One parametric part: the class that shapes it, the variables it takes, its material and its places in the robot.

    shape: `module:Class`; the module is a file beside study.toml or any importable module.
    parameters: the part's parameter -> design variable. supports: faces that are clamped, or `FACE: xz`, held in
    these directions only (a bolt's hole across, the face under its head along). options: further keyword arguments of
    the class, or parameters that are fixed. loads: of the only load case; or cases: any number of them, by name.
    material: a name of [materials], else one that `codesign materials` lists. density_kg_m3: of the part's mass,
    where it is not that of the material; reports say so.
    """

    name: Name
    shape: Name
    parameters: dict[str, str]
    material: Name
    density_kg_m3: Positive | None = None
    supports: list[Name]
    loads: list[LoadConfig] = []
    cases: list[LoadCaseConfig] = []
    masses: list[MassOnFaceConfig] = []
    placements: list[PartPlacement] = []
    options: dict[str, float | bool | str] = {}

    @property
    def load_cases(self) -> list[LoadCaseConfig]:
        """The load cases, be there one or more."""
        return self.cases or [LoadCaseConfig(name=ONLY_CASE, loads=self.loads)]

    @property
    def flies(self) -> bool:
        """Whether a load case takes its loads from the flight."""
        return any(case.flown for case in self.cases)


class RobotConfig(Section, frozen=True, kw_only=True):
    """The robot that the parts are built into; path relative to study.toml.

    visuals: package:// path of a URDF with the same links, whose meshes pictures show where its package is installed.
    changes: what design variables change on it before the parts are placed.
    """

    urdf: Name
    visuals: str = ""
    changes: list[RobotChange] = []


class FemConfig(Section, frozen=True, kw_only=True):
    """How part stress is computed; see `codesign.parts.load_case.StressSettings`.

    exclusion: where the peak stress is not read, "local" (in proportion to what is near) or "published" (a fixed
    distance); see docs/fem.md. exclusion_distance_mm: instead of the rule's own distances; published: 3.
    edge_length_mm: of the elements of parts that bring no size field; None: 0.35 of the mean wall thickness, more
    where that were over about 60 000 elements (thin tubes, where one element through the wall does).
    memory_limit_mib: for the matrices and factors of one part; what needs more is solved by iteration, or refused.
    """

    geometry: Literal["simplified", "full"] = "simplified"
    load: str = "uniform"
    support: str = "published"
    accuracy: Literal["optimization", "fine", "converged"] = "optimization"
    exclusion: Literal["local", "published"] = "local"
    exclusion_distance_mm: NonNegative | None = None
    edge_length_mm: Positive | None = None
    tolerance: Positive = 0.05
    memory_limit_mib: Annotated[int, Meta(ge=64, le=2**30)] = 1400


class ObjectivesConfig(Section, frozen=True, kw_only=True):
    """What is minimized and what is maximized: one to six numbers of an evaluation.

    family: how momentum, joint_velocity and thrust are computed. Besides them any name of
    `codesign.problem.quantities`, any path of the evaluation's document (`parts.strut.mass`, `flight.max_torque`,
    `sum(parts.*.work)`), or `module:function`, a function of the document in a module beside the study file.
    """

    family: Literal["rms", "script", "paper"] = "rms"
    minimize: tuple[str, ...] = ("momentum", "joint_velocity", "thrust")
    maximize: tuple[str, ...] = ()

    @property
    def keys(self) -> tuple[str, ...]:
        """Of the minimized numbers; what is maximized has a minus before its name."""
        return self.minimize + tuple(f"-{name}" for name in self.maximize)

    @property
    def names(self) -> tuple[str, ...]:
        """Of the numbers, without signs."""
        return self.minimize + self.maximize


class LimitConfig(Section, frozen=True, kw_only=True):
    """Bounds of a number of the evaluation, in its SI unit."""

    minimum: float | None = field(name="min", default=None)
    maximum: float | None = field(name="max", default=None)


class ConstraintsConfig(Section, frozen=True, kw_only=True):
    """What a design must satisfy. Clearances need the section [interference]; None: reported only.

    first_frequency_min_hz: of each part on its supports; None: not computed. buckling_factor_min: of each part, the
    multiple of its load at which it buckles; None: not computed. limits: bounds of any number of the evaluation by name
    or path, as in `ObjectivesConfig`: `"flight.max_torque" = { max = 50.0 }`.
    """

    safety_factor_min: Positive = 10.0
    body_clearance_min_mm: float | None = None
    plume_clearance_min_mm: float | None = None
    first_frequency_min_hz: Positive | None = None
    buckling_factor_min: Positive | None = None
    limits: dict[str, LimitConfig] = {}

    @property
    def part_minima(self) -> dict[str, float]:
        """What every part must reach: name of the number in its document -> lower limit."""
        limits = {
            "safety_factor": self.safety_factor_min,
            "first_frequency": self.first_frequency_min_hz,
            "buckling_factor": self.buckling_factor_min,
        }
        return {name: limit for name, limit in limits.items() if limit is not None}


class ValidationConfig(Section, frozen=True, kw_only=True):
    """Trajectories that chosen designs are flown on afterwards."""

    trajectories: list[str] = []


class TolerancesConfig(Section, frozen=True, kw_only=True):
    """How far what is made lies from what is drawn, for `codesign tolerances`; normal, cut off at three deviations.

    dimensions: class of ISO 2768-1, fine, medium or coarse, of lengths that are design variables. angle_deg: of angles
    that are. jet_angle_deg: of what hangs on interfaces, about two axes. young_modulus, yield_strength, density:
    relative standard deviations of the material.
    """

    dimensions: Literal["f", "m", "c"] = "m"
    angle_deg: NonNegative = 0.5
    jet_angle_deg: NonNegative = 0.5
    young_modulus: Annotated[float, Meta(ge=0, lt=0.3)] = 0.02
    yield_strength: Annotated[float, Meta(ge=0, lt=0.3)] = 0.04
    density: Annotated[float, Meta(ge=0, lt=0.3)] = 0.01


class OptimizerConfig(Section, frozen=True, kw_only=True):
    """Defaults of the search; the command line overrides them.

    evaluations: the budget; None: 200 for the surrogate search, population times generations for the others.
    """

    algorithm: Name = "nsga2"
    population: Annotated[int, Meta(ge=2, le=100_000)] = 25
    generations: Annotated[int, Meta(ge=1, le=1_000_000)] = 40
    evaluations: Annotated[int, Meta(ge=1, le=100_000_000)] | None = None
    crossover_probability: Probability = 0.9
    mutation_probability: Probability = 0.25
    seed: Seed = 1


class ExecutionConfig(Section, frozen=True, kw_only=True):
    """Worker processes and their limits.

    lazy: strength and clearances only of designs that can enter the front, `"strength"`: strength alone; None: true for
    the surrogate search.
    """

    workers: Annotated[int, Meta(ge=1, le=1000)] = 2
    time_limit_s: Annotated[float, Meta(gt=0, le=1e7)] = 120.0
    memory_limit_mib: Annotated[int, Meta(ge=64, le=2**30)] = 2048
    lazy: bool | Literal["strength"] | None = None


class StudyConfig(Section, frozen=True, kw_only=True):
    """The whole file. Without [flight] parts alone are judged; without [robot] they sit in none."""

    name: Annotated[str, Meta(pattern=r"^[A-Za-z0-9][^/\\\x00-\x1f]*$")]  # of folders and files
    extends: str = ""
    without: list[str] = []
    title: str = ""
    description: str = ""
    robot: RobotConfig | None = None
    variables: dict[str, VariableConfig]
    baseline: dict[str, float | str] = {}
    materials: dict[str, MaterialConfig] = {}
    parts: list[PartConfig]
    fem: FemConfig = FemConfig()
    flight: FlightConfig | None = None
    trajectories: dict[str, TrajectoryConfig] = {}
    objectives: ObjectivesConfig = ObjectivesConfig()
    constraints: ConstraintsConfig = ConstraintsConfig()
    interference: InterferenceSettings | None = None
    validation: ValidationConfig = ValidationConfig()
    tolerances: TolerancesConfig = TolerancesConfig()
    optimizer: OptimizerConfig = OptimizerConfig()
    execution: ExecutionConfig = ExecutionConfig()

    @property
    def flown(self) -> FlightConfig:
        """The section [flight]. Raises: StudyError: the study has none, its parts are all that it judges."""
        if self.flight is None:
            raise StudyError(f"{self.name}: a study of parts alone; this needs its section [flight]")
        return self.flight


# Sections that decide the numbers of an evaluation; the rest (search, execution) does not enter the study's hash.
DECIDING_SECTIONS = (
    "robot", "variables", "materials", "parts", "fem", "flight", "trajectories", "objectives", "constraints",
    "interference", "tolerances",
)  # fmt: skip

RawStudy = dict[str, Any]
