"""The chain: design -> parts -> stress, robot -> flight -> objectives and constraints."""

from __future__ import annotations

import functools
import hashlib
import math
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from codesign import _core
from codesign import dynamics as dyn
from codesign.chain.flight import find_trajectory, flight_settings, joint_names
from codesign.chain.provenance import provenance
from codesign.errors import CodesignError
from codesign.fem import Material
from codesign.parts.load_case import Confirmation, PressedFace, StressSettings, confirm, part_case, part_document
from codesign.parts.part import Part
from codesign.problem.design_space import Design
from codesign.problem.evaluation import Evaluation
from codesign.robot.assembly import PartBody, assemble
from codesign.robot.clearance import convex_pieces, flown_interference
from codesign.robot.description import RobotDescription
from codesign.robot.inertial import Inertial
from codesign.study.config import StudyConfig
from codesign.transforms import Matrix
from codesign.units import GIGA, MEGA, MILLIMETRE

CLEARANCE_SEGMENTS = 24  # chords on a circle of the parts' surfaces: 0.6 mm inside the largest radius
MODES = 3  # natural frequencies of a part, where a study limits the first
TOO_LOW = {  # what a part misses, in words
    "safety_factor": "safety factor {:.2f} below {:g}",
    "first_frequency": "first natural frequency {:.1f} Hz below {:g} Hz",
    "buckling_factor": "buckling factor {:.2f} below {:g}",
}
CLEARANCE_SCALE = 0.01  # m: a clearance this much too small counts as much as a safety factor of zero

if TYPE_CHECKING:
    from codesign.storage.cache import PartCache
    from codesign.study import Study


def evaluate(study: Study, design: Design, trajectory: str | None = None, cache: PartCache | None = None) -> Evaluation:
    """One design through the whole chain.

    A CodesignError on the way (no mesh, say) gives a failed evaluation; anything else is a bug and is raised.
    Raises: StudyError if there is no such trajectory.
    """
    find_trajectory(study.config, trajectory or study.config.flight.trajectory)
    try:
        return _evaluate(study, design, trajectory, cache)[0]
    except CodesignError as error:
        return Evaluation.failure(design.to_dict(), f"{type(error).__name__}: {error}", provenance(study.hash))


def evaluate_with_fields(
    study: Study, design: Design, trajectory: str | None = None
) -> tuple[Evaluation, dict[str, _core.PartAnalysis], dyn.FlightLog]:
    """As `evaluate`, together with what its numbers were read from: stress field of each part, histories of the flight.

    Raises: CodesignError where the chain does.
    """
    find_trajectory(study.config, trajectory or study.config.flight.trajectory)
    evaluation, result = _evaluate(study, design, trajectory, None)
    return evaluation, dict(zip(evaluation.parts, result.parts, strict=True)), result.flight


def _evaluate(
    study: Study, design: Design, trajectory: str | None, cache: PartCache | None
) -> tuple[Evaluation, _core.DesignResult]:
    start = time.perf_counter()
    config = study.configured(design)
    settings = flight_settings(config.flight, find_trajectory(config, trajectory or config.flight.trajectory))
    parts = build_parts(study, design, config)
    stress = {name: stress_settings(config, name) for name in parts}
    keys = {name: _part_key(study, part, stress[name]) for name, part in parts.items()}
    known: dict[str, dict[str, Any]] = {}
    if cache is not None:
        found = {name: cache.get(key) for name, key in keys.items()}
        known = {name: document for name, document in found.items() if document is not None}
    masses = {name: _mass(known[name]) if name in known else part.mass_properties() for name, part in parts.items()}
    robot = _assemble(study, config, parts, masses)
    cases = {name: part_case(part, stress[name]) for name, part in parts.items() if name not in known}
    built = time.perf_counter()
    result = _core.evaluate(list(cases.values()), robot.to_text(), settings)
    documents: dict[str, dict[str, Any]] = {}
    for name in parts:
        if name in known:
            documents[name] = known[name]
            continue
        analysis = result.parts[list(cases).index(name)]
        documents[name] = part_document(masses[name], analysis)
        if cache is not None:
            cache.put(keys[name], documents[name])
    flight = result.flight
    families = objective_families(flight)
    clearances = _clearances(config, parts, robot, flight)
    constraints, violations = _constraints(config, documents, flight, clearances)
    feasible = not any(violations.values())
    lost = not flight.completed
    evaluation = Evaluation(
        design=design.to_dict(),
        status="feasible" if feasible else "infeasible",
        reason=None if feasible else _reason(config, documents, flight, clearances),
        objectives={} if lost else {n: families[config.objectives.family][n] for n in config.objectives.minimise},
        objective_families={} if lost else families,
        constraints=constraints,
        violations=violations,
        parts=documents,
        flight=flight_document(trajectory or config.flight.trajectory, flight, result.seconds["flight"])
        | ({"interference": clearances} if clearances else {}),
        seconds={"geometry": built - start, **result.seconds, "total": time.perf_counter() - start},
        provenance=provenance(study.hash),
    )
    return evaluation, result


def build_parts(study: Study, design: Mapping[str, float], config: StudyConfig | None = None) -> dict[str, Part]:
    """Parts of a design by name."""
    config = config or study.configured(design)
    parts = {}
    for part in config.parts:
        make: Callable[..., Part] = study.part_classes[part.name]
        parameters = {parameter: design[variable] for parameter, variable in part.parameters.items()}
        density = config.materials[part.material].density_kg_m3
        parts[part.name] = make(**parameters, **part.options, density=density)
    return parts


def stress_settings(config: StudyConfig, part_name: str) -> StressSettings:
    """Stress settings of one part."""
    part = next(part for part in config.parts if part.name == part_name)
    material, stress = config.materials[part.material], config.fem
    return StressSettings(
        material=Material(
            part.material,
            young_modulus=material.young_modulus_gpa * GIGA,
            poisson_ratio=material.poisson_ratio,
            density=material.density_kg_m3,
            yield_strength=material.yield_strength_mpa * MEGA,
        ),
        supports=tuple(part.supports),
        loads=tuple(PressedFace(load.face, load.pressing_n) for load in part.loads),
        geometry=stress.geometry,
        load=stress.load,
        support=stress.support,
        accuracy=stress.accuracy,
        exclusion_distance=stress.exclusion_distance_mm * MILLIMETRE,
        tolerance=stress.tolerance,
        modes=0 if config.constraints.first_frequency_min_hz is None else MODES,
        buckling=0 if config.constraints.buckling_factor_min is None else 1,
    )


def confirm_parts(study: Study, design: Design) -> dict[str, Confirmation]:
    """Every part of a design as the study analyses it, beside its full geometry on a fine mesh.

    Raises: MeshError, SolverError, GeometryError.
    """
    config = study.configured(design)
    return {
        name: confirm(part, stress_settings(config, name)) for name, part in build_parts(study, design, config).items()
    }


def build_robot(study: Study, design: Mapping[str, float]) -> RobotDescription:
    """The base robot with this design's parts in it."""
    config = study.configured(design)
    parts = build_parts(study, design, config)
    return _assemble(study, config, parts, {name: part.mass_properties() for name, part in parts.items()})


def _assemble(
    study: Study, config: StudyConfig, parts: Mapping[str, Part], masses: Mapping[str, Any]
) -> RobotDescription:
    bodies = {name: PartBody(masses[name], part.interfaces()) for name, part in parts.items()}
    return assemble(study.base_robot, {part.name: part.placements for part in config.parts}, bodies)


def fly_robot(
    study: Study,
    robot: str | Path,
    trajectory: str | None = None,
    jets: str | None = None,
    as_published: bool = False,
) -> dict[str, Any]:
    """Flies any robot that has the study's joints and jets.

    Args:
        robot: path of a URDF or its text. trajectory, jets: instead of the study's. as_published: accept non-physical
            inertias.
    Returns: the JSON document of `codesign fly`.
    Raises: UrdfError, StudyError.
    """
    config = study.config
    settings = flight_settings(config.flight, find_trajectory(config, trajectory or config.flight.trajectory), jets)
    start = time.perf_counter()
    model = dyn.load_urdf(robot, joints=joint_names(config.flight), as_published=as_published)
    loaded = time.perf_counter()
    log = dyn.simulate_flight(model, settings)
    end = time.perf_counter()
    completed = log.completed
    return {
        "robot": str(robot),
        "status": "completed" if completed else "lost",
        "reason": None if completed else _flight_reason(log),
        "objectives": objective_families(log)[config.objectives.family],
        "objective_families": objective_families(log),
        "objective_parts": {"rms": _parts_of(log, "rms", config), "script": _parts_of(log, "script", config)},
        "constraints": {"qp_failures": log.qp_failures},
        "flight": flight_document(trajectory or config.flight.trajectory, log, end - loaded),
        "seconds": {"load": loaded - start, "flight": end - loaded, "total": end - start},
        "provenance": provenance(study.hash),
    }


def objective_families(log: dyn.FlightLog) -> dict[str, dict[str, float]]:
    """All objective families of a flight; a number that is not finite is left out."""
    families = {}
    for family in ("rms", "script", "paper"):
        values = getattr(log, family)
        named = {name: getattr(values, name) for name in ("momentum", "joint_velocity", "thrust")}
        families[family] = {name: value for name, value in named.items() if math.isfinite(value)}
    return families


def flight_document(trajectory: str, log: dyn.FlightLog, seconds: float) -> dict[str, Any]:
    """Tracking figures of a flight for JSON, SI units; None for a number that is not finite."""
    document: dict[str, Any] = {"trajectory": trajectory, "duration": (log.samples - 1) * log.step}
    for name in ("max_com_error", "max_attitude_error", "min_thrust", "max_thrust", "max_torque", "min_clearance"):
        value = getattr(log, name)
        document[name] = value if math.isfinite(value) else None
    document["ground_touched"] = bool(log.ground_touched)
    document["completed"] = log.completed
    if not document["completed"]:
        document["failure_time"] = log.failure_time
        document["failure_reason"] = log.failure_reason
    document["seconds"] = seconds
    return document


def _part_key(study: Study, part: Part, settings: StressSettings) -> str:
    """Cache key of a part's numbers: the code, every value of the part (`repr` is exact), how it is analysed."""
    return f"{study.code_hash}/{part.name}/{hashlib.sha256(repr((part, settings)).encode()).hexdigest()[:24]}"


def _mass(document: Mapping[str, Any]) -> Inertial:
    return Inertial(document["mass"], np.array(document["com"]), np.array(document["inertia"]))


def _parts_of(log: dyn.FlightLog, family: str, config: StudyConfig) -> dict[str, float]:
    parts = getattr(log, f"{family}_parts")
    groups = [group.name for group in config.flight.joint_groups if group.velocity_weight > 0]
    return {
        "linear_momentum": parts.linear_momentum,
        "angular_momentum": parts.angular_momentum,
        **dict(zip(groups, parts.joint_velocity, strict=True)),
    }


def _clearances(
    config: StudyConfig, parts: Mapping[str, Part], robot: RobotDescription, flight: dyn.FlightLog
) -> dict[str, Any]:
    """Clearances over the flown postures; empty if the study does not ask for them."""
    history = flight.joint_positions[np.isfinite(flight.joint_positions).all(axis=1)]
    if config.interference is None or not len(history):
        return {}
    slices = config.interference.slices
    placed = {part.name: (part.placements, _convex_pieces(parts[part.name], slices)) for part in config.parts}
    return flown_interference(
        robot, config.interference, placed, joint_names(config.flight), history, config.flight.step_s
    )


@functools.lru_cache(maxsize=64)
def _convex_pieces(part: Part, slices: int) -> tuple[Matrix, ...]:
    """Convex pieces of a part, part axes [m]; kept, since designs share parts."""
    surface = part.surface(CLEARANCE_SEGMENTS)
    return tuple(convex_pieces(surface.points, surface.triangles, slices))


def _short_clearances(config: StudyConfig, clearances: Mapping[str, Any]) -> dict[str, tuple[float, float]]:
    """Clearances below what the study demands: name -> value and limit [m]."""
    limits = {
        "body_clearance": config.constraints.body_clearance_min_mm,
        "plume_clearance": config.constraints.plume_clearance_min_mm,
    }
    wanted = {name: limit * MILLIMETRE for name, limit in limits.items() if limit is not None and name in clearances}
    return {name: (clearances[name], limit) for name, limit in wanted.items() if clearances[name] < limit}


def _constraints(
    config: StudyConfig,
    parts: Mapping[str, Mapping[str, Any]],
    flight: dyn.FlightLog,
    clearances: Mapping[str, Any],
) -> tuple[dict[str, float], dict[str, float]]:
    """Constraint values, and by how much of its limit each is violated (0: it holds)."""
    lost = not flight.completed
    constraints = {"qp_failures": float(max(flight.qp_failures, int(lost)))}
    violations = {}
    for name, limit in config.constraints.part_minima.items() if parts else ():
        smallest = min(_number(part, name) for part in parts.values())
        if math.isfinite(smallest):
            constraints[name] = smallest
        violations[name] = max(0.0, (limit - smallest) / limit)
    if config.constraints.flight_completed:
        # The share of the flight that was missed: of two lost designs the one that flew longer is better.
        flown = (flight.failure_time or 0.0) / config.flight.duration_s
        violations["qp_failures"] = max(1.0 - flown, 1e-6) if lost else 0.0
    constraints |= {name: clearances[name] for name in ("body_clearance", "plume_clearance") if name in clearances}
    for name, (value, limit) in _short_clearances(config, clearances).items():
        violations[name] = (limit - value) / CLEARANCE_SCALE
    return constraints, violations


def _number(part: Mapping[str, Any], name: str) -> float:
    """A number of a part's document; infinite where it has none: a load that cannot buckle the part."""
    return math.inf if part[name] is None else float(part[name])


def _reason(
    config: StudyConfig,
    parts: Mapping[str, Mapping[str, Any]],
    flight: dyn.FlightLog,
    clearances: Mapping[str, Any],
) -> str:
    reasons = [
        f"{name}: {TOO_LOW[key].format(_number(part, key), limit)}"
        for key, limit in config.constraints.part_minima.items()
        for name, part in parts.items()
        if _number(part, key) < limit
    ]
    if not flight.completed:
        reasons.append(_flight_reason(flight))
    for name, (value, limit) in _short_clearances(config, clearances).items():
        reasons.append(f"{name.replace('_', ' ')} {value / MILLIMETRE:.1f} mm below {limit / MILLIMETRE:g} mm")
    return "; ".join(reasons)


def _flight_reason(flight: dyn.FlightLog) -> str:
    return f"flight lost at {flight.failure_time:.2f} s: {flight.failure_reason}"
