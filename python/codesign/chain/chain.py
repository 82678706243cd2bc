"""The chain: design -> parts -> stress, robot -> flight -> objectives and constraints."""

from __future__ import annotations

import hashlib
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from codesign import _core
from codesign import dynamics as dyn
from codesign.chain.clearances import clearances
from codesign.chain.documents import flight_document, objective_families
from codesign.chain.flight import find_trajectory, flight_duration, flight_seeds, flight_settings, refusals
from codesign.chain.flown import decided_cases, with_flown
from codesign.chain.judge import judge
from codesign.chain.loads import asked_of, carried_masses, case_settings, flown_settings
from codesign.chain.provenance import provenance
from codesign.chain.recent import Recent
from codesign.chain.scatter import made, split_sample
from codesign.errors import CodesignError
from codesign.fem import Material
from codesign.parts.load_case import StressSettings, part_case
from codesign.parts.part import Part
from codesign.parts.strength import Confirmation, confirm, part_document
from codesign.problem.design_space import Design, DesignValue
from codesign.problem.evaluation import Evaluation
from codesign.robot.assembly import PartBody, assemble
from codesign.robot.changes import change_robot
from codesign.robot.description import RobotDescription
from codesign.robot.inertial import Inertial
from codesign.study.choices import numbers_of
from codesign.study.config import StudyConfig
from codesign.study.parts import carried_bodies, make_part
from codesign.units import GIGA, MEBIBYTE, MEGA, MILLIMETER

# Answers of parts to unit loads, by cache key: the last of this process, since a search and its tasks repeat parts.
_ANSWERS: Recent[list[_core.fem.UnitResponses]] = Recent(4)
MODES = 3  # natural frequencies of a part, where a study limits the first

if TYPE_CHECKING:
    from codesign.problem.protocols import PartCache
    from codesign.study import StudyData


def evaluate(
    study: StudyData,
    design: Design,
    trajectory: str | None = None,
    cache: PartCache | None = None,
    flown: Flown | None = None,
) -> Evaluation:
    """One design through the whole chain; `flown`: what of it was done before.

    A CodesignError on the way (no mesh, say) gives a failed evaluation; anything else is a bug and is raised.
    Raises: StudyError if there is no such trajectory.
    """
    _check_trajectory(study.config, trajectory)
    try:
        return _evaluate(study, design, trajectory, cache, flown)[0]
    except CodesignError as error:
        return Evaluation.failure(design.to_dict(), f"{type(error).__name__}: {error}", provenance(study))


def evaluate_with_fields(
    study: StudyData, design: Design, trajectory: str | None = None
) -> tuple[Evaluation, dict[str, _core.PartAnalysis], dyn.FlightLog | None]:
    """As `evaluate`, together with what its numbers were read from: stress field of each part, the flight if any.

    Of several flights under paired disturbances, the first.

    Raises: CodesignError where the chain does.
    """
    _check_trajectory(study.config, trajectory)
    evaluation, result = _evaluate(study, design, trajectory, None)
    flight = result.flights[0] if result.flights else None
    return evaluation, dict(zip(evaluation.parts, result.parts, strict=True)), flight


def fly_design(study: StudyData, design: Design) -> dyn.FlightLog | None:
    """The flight of a design on the study's own trajectory (the first of several seeds); None: the study has none."""
    config = study.configured(design)
    if config.flight is None:
        return None
    return compute(study, config, [], build_robot(study, design), None).flights[0]


def _check_trajectory(config: StudyConfig, trajectory: str | None) -> None:
    """Raises: StudyError: there is no such trajectory, or one is named where nothing flies."""
    trajectory, _ = split_sample(trajectory)
    if config.flight is not None or trajectory is not None:
        find_trajectory(config, trajectory or config.flown.trajectory)


@dataclass(frozen=True, slots=True)
class Computed:
    """What the native code gave: analyses of the parts that were not known, the flight for every seed, times [s].

    settings: of the flights. seeds: one for each.
    """

    parts: list[_core.PartAnalysis]
    flights: list[dyn.FlightLog]
    seconds: dict[str, float]
    settings: dyn.FlightSettings | None = None
    seeds: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class Made:
    """A design before anything of it is analyzed or flown, by the names of its parts.

    stress: how parts are analyzed. keys: of their numbers in the cache. known: the numbers that the cache has.
    masses: of the parts. robot: with the parts in it. seconds: what making it took.
    """

    parts: dict[str, Part]
    stress: dict[str, StressSettings]
    keys: dict[str, str]
    known: dict[str, dict[str, Any]]
    masses: dict[str, Any]
    robot: RobotDescription
    seconds: float


@dataclass(frozen=True, slots=True)
class Flown:
    """A design that has flown, before its parts are analyzed.

    seconds: what that took. numbers: those of its flight, if clearances are among them.
    """

    made: Made
    computed: Computed
    seconds: float
    numbers: dict[str, Any] | None = None


def make(
    study: StudyData, design: Mapping[str, DesignValue], config: StudyConfig, cache: PartCache | None = None
) -> Made:
    """Parts and robot of a design, and what the cache knows of them."""
    start = time.perf_counter()
    parts = build_parts(study, design, config)
    stress = {name: stress_settings(config, name) for name in parts}
    keys = {name: part_key(study, part, stress[name]) for name, part in parts.items()}
    known = _known_documents(keys, cache)
    masses = {name: _mass(known[name]) if name in known else part.mass_properties() for name, part in parts.items()}
    robot = _assemble(study, design, config, parts, masses)
    return Made(parts, stress, keys, known, masses, robot, time.perf_counter() - start)


def compute(
    study: StudyData,
    config: StudyConfig,
    cases: list[_core.PartCase],
    robot: RobotDescription,
    trajectory: str | None,
    flown: Computed | None = None,
) -> Computed:
    """Meshes and solves the parts; flies the robot if the study has a flight. flown: the flight, if it is known."""
    if config.flight is None or flown is not None:
        start = time.perf_counter()
        analyses = [_core.analyze_part(case) for case in cases]
        done = flown or Computed([], [], {})
        return replace(done, parts=analyses, seconds=done.seconds | {"fem": time.perf_counter() - start})
    name = trajectory or config.flight.trajectory
    settings = flight_settings(config.flight, find_trajectory(config, name))
    with refusals(study.path):
        seeds = flight_seeds(config, name)
        result = _core.evaluate(cases, robot.to_dynamics(), settings, seeds)
    return Computed(list(result.parts), list(result.flights), result.seconds, settings, tuple(seeds))


def _evaluate(
    study: StudyData,
    design: Design,
    trajectory: str | None,
    cache: PartCache | None,
    flown: Flown | None = None,
) -> tuple[Evaluation, Computed]:
    start = time.perf_counter()
    trajectory, sample = split_sample(trajectory)
    config, values = study.configured(design), dict(design)
    if sample is not None:
        config, values = made(config, values, sample)
    done = flown.made if flown is not None else make(study, values, config, cache)
    parts, stress, keys, known = done.parts, done.stress, done.keys, done.known
    answers = {name: _ANSWERS[keys[name]] for name in parts if keys[name] in _ANSWERS}
    wanted = [name for name in parts if name not in known or (stress[name].flown and name not in answers)]
    cases = {name: part_case(parts[name], stress[name]) for name in wanted}
    built = time.perf_counter()
    before = flown.computed if flown is not None else None
    result = compute(study, config, list(cases.values()), done.robot, trajectory, before)
    documents = {name: known[name] for name in parts if name in known}
    for name, analysis in zip(wanted, result.parts, strict=True):
        documents[name] = part_document(done.masses[name], analysis)
        if stress[name].flown:
            answers[name] = _ANSWERS.put(keys[name], list(analysis.responses))
        if cache is not None and name not in known:
            cache.put(keys[name], documents[name])
    documents = {name: documents[name] for name in parts}
    if answers and result.flights and all(flight.completed for flight in result.flights):
        documents |= _flown_strength(config, parts, done.robot, result, documents, answers)
    numbers = flown.numbers if flown is not None else None
    document = {"parts": documents, **(numbers or flight_numbers(config, parts, done.robot, result, trajectory))}
    verdict = judge(config, {"design": design.to_dict(), **document}, study.functions)
    evaluation = Evaluation(
        design=design.to_dict(),
        status=verdict.status,
        reason=verdict.reason,
        objectives=verdict.objectives,
        constraints=verdict.constraints,
        violations=verdict.violations,
        margins=verdict.margins,
        **document,
        seconds=_seconds(start, built, result, flown),
        provenance=provenance(study),
    )
    return evaluation, result


def _seconds(start: float, built: float, result: Computed, flown: Flown | None) -> dict[str, float]:
    """Times [s] by stage and in all, those of what was done before included."""
    earlier, making = (flown.seconds, flown.made.seconds) if flown is not None else (0.0, 0.0)
    total = earlier + time.perf_counter() - start
    return {"geometry": making + built - start, **result.seconds, "total": total}


def _known_documents(keys: Mapping[str, str], cache: PartCache | None) -> dict[str, dict[str, Any]]:
    """Documents of the parts that the cache has, without what a flight adds."""
    found = {name: cache.get(key) for name, key in keys.items()} if cache is not None else {}
    return {name: document for name, document in found.items() if document is not None}


def _flown_strength(
    config: StudyConfig,
    parts: Mapping[str, Part],
    robot: RobotDescription,
    result: Computed,
    documents: Mapping[str, dict[str, Any]],
    answers: Mapping[str, Sequence[_core.fem.UnitResponses]],
) -> dict[str, dict[str, Any]]:
    """Documents of the parts with flown load cases, these included."""
    if result.settings is None:
        return {}
    flights = dict(zip(result.seeds, result.flights, strict=True))
    decided = decided_cases(config, parts, robot, result.settings, flights, answers)
    return {
        part.name: with_flown(
            documents[part.name], decided[part.name], flown_settings(part, config), asked_of(part, config)
        )
        for part in config.parts
        if part.name in decided
    }


def flight_numbers(
    config: StudyConfig,
    parts: Mapping[str, Part],
    robot: RobotDescription,
    result: Computed,
    trajectory: str | None = None,
) -> dict[str, Any]:
    """Flight with clearances and objective families of an evaluation; both empty without a flight."""
    flights = result.flights
    if not flights:
        return {"flight": {}, "objective_families": {}}
    document = flown_document(config, flights, result.seconds["flight"], trajectory)
    found = clearances(config, parts, robot, flights)
    return document | ({"flight": document["flight"] | {"interference": found}} if found else {})


def flown_document(
    config: StudyConfig, logs: Sequence[dyn.FlightLog], seconds: float, trajectory: str | None = None
) -> dict[str, Any]:
    """What an evaluation says of its flights before clearances; objective families only if all were completed."""
    name = trajectory or config.flown.trajectory
    wanted = flight_duration(config.flown, find_trajectory(config, name))
    flight = flight_document(name, logs, config.flown, seconds, flight_seeds(config, name), wanted)
    return {
        "flight": flight,
        "objective_families": objective_families(logs) if flight["completed"] else {},
    }


def build_parts(
    study: StudyData, design: Mapping[str, DesignValue], config: StudyConfig | None = None
) -> dict[str, Part]:
    """Parts of a design by name."""
    config = config or study.configured(design)
    return {part.name: make_part(part, config, study.part_classes[part.name], design) for part in config.parts}


def stress_settings(config: StudyConfig, part_name: str) -> StressSettings:
    """Stress settings of one part."""
    part = next(part for part in config.parts if part.name == part_name)
    material, stress = config.materials[part.material], config.fem
    return StressSettings(
        material=Material(
            part.material,
            young_modulus=material.young_modulus_gpa * GIGA,
            poisson_ratio=material.poisson_ratio,
            density=part.density_kg_m3 or material.density_kg_m3,
            yield_strength=material.yield_strength_mpa * MEGA,
        ),
        supports=tuple(part.supports),
        cases=case_settings(part, config),
        flown=flown_settings(part, config),
        masses=carried_masses(part),
        geometry=stress.geometry,
        load=stress.load,
        support=stress.support,
        accuracy=stress.accuracy,
        exclusion=stress.exclusion,
        exclusion_distance=None if stress.exclusion_distance_mm is None else stress.exclusion_distance_mm * MILLIMETER,
        edge_length=None if stress.edge_length_mm is None else stress.edge_length_mm * MILLIMETER,
        tolerance=stress.tolerance,
        memory_limit=stress.memory_limit_mib * MEBIBYTE,
        modes=MODES if _asks_for(config, "first_frequency", "frequencies") else 0,
        buckling=1 if _asks_for(config, "buckling_factor") else 0,
    )


def _asks_for(config: StudyConfig, *names: str) -> bool:
    """Whether an objective or a constraint needs one of these numbers of a part."""
    asked = {*config.constraints.part_minima, *config.constraints.limits, *config.objectives.names}
    return any(name in key for name in names for key in asked)


def confirm_parts(study: StudyData, design: Design) -> dict[str, Confirmation]:
    """Every part of a design as the study analyses it, beside its full geometry on a fine mesh.

    Raises: MeshError, SolverError, GeometryError.
    """
    config = study.configured(design)
    return {
        name: confirm(part, stress_settings(config, name)) for name, part in build_parts(study, design, config).items()
    }


def build_robot(study: StudyData, design: Mapping[str, DesignValue]) -> RobotDescription:
    """The base robot with this design's parts in it."""
    config = study.configured(design)
    parts = build_parts(study, design, config)
    return _assemble(study, design, config, parts, {name: part.mass_properties() for name, part in parts.items()})


def _assemble(
    study: StudyData,
    design: Mapping[str, DesignValue],
    config: StudyConfig,
    parts: Mapping[str, Part],
    masses: Mapping[str, Any],
) -> RobotDescription:
    carried = {part.name: carried_bodies(part) for part in config.parts}
    bodies = {name: PartBody(masses[name], part.interfaces(), carried=carried[name]) for name, part in parts.items()}
    changes = config.robot.changes if config.robot is not None else []
    base = change_robot(study.base_robot, changes, numbers_of(config, design))
    return assemble(base, {part.name: part.placements for part in config.parts}, bodies)


def part_key(study: StudyData, part: Part, settings: StressSettings) -> str:
    """Cache key of a part's numbers: the code, every value of the part (`repr` is exact), how it is analyzed."""
    return f"{study.code_hash}/{part.name}/{hashlib.sha256(repr((part, settings)).encode()).hexdigest()[:24]}"


def _mass(document: Mapping[str, Any]) -> Inertial:
    return Inertial(document["mass"], np.array(document["com"]), np.array(document["inertia"]))
