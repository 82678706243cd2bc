"""Flown loads: what a part feels over a flight, as factors on unit loads, and the instant that decides its strength.

At every sample of the flight what hangs on an interface of the part pushes on it: thrust of its jets, its weight, and
the inertia of its motion. The part itself is pulled by gravity and by its own acceleration. Both are linear, so unit
loads are solved once for each part and summed over the history.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from codesign import _core
from codesign import dynamics as dyn
from codesign.chain.loads import flown_settings
from codesign.fem.fatigue import FatigueStrength, damage, signed_von_mises, von_mises
from codesign.parts.load_case import FlownCase
from codesign.parts.part import Part
from codesign.parts.strength import strength_document
from codesign.robot.assembly import PartPlacement, place_interface
from codesign.robot.description import RobotDescription
from codesign.robot.motion import GRAVITY, MotionHistory, RigidMotion, Thrust, descendants, fixed_at
from codesign.study.config import MaterialConfig, StudyConfig
from codesign.transforms import Matrix, reflection
from codesign.units import MEGA

SURVEYED, FATIGUE_NODES = 32, 16  # instants that choose the nodes whose fatigue is computed
Indices = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class FlownLoads:
    """Loads of one placement of a part over a flight.

    link: where the part sits. seed: of the flight's disturbances. time: (n,) [s]. factors: (n, units) on
    `load_case.unit_loads`, part axes: force [N] and moment [N m] of each seat, acceleration [m/s²] and its gradient
    [1/s²] at the part's origin.
    """

    link: str
    time: Matrix
    factors: Matrix
    seed: int = 0


@dataclass(frozen=True, slots=True, eq=False)
class Fatigue:
    """Where a flight fatigues a part most. damage: Miner's sum of a flight that starts and ends unloaded.

    position: (3,) [m], part axes; link: which of the places of the part.
    """

    damage: float
    position: Matrix
    link: str


@dataclass(frozen=True, slots=True, eq=False)
class Decided:
    """The instant of a flight that stresses a part most. result: static result of that instant's loads."""

    loads: FlownLoads
    instant: int
    result: _core.fem.StaticResult
    fatigue: Fatigue | None = None

    @property
    def time(self) -> float:
        """Time of the instant [s]."""
        return float(self.loads.time[self.instant])


def motion_history(robot: RobotDescription, joints: Sequence[str], log: dyn.FlightLog) -> MotionHistory:
    """The flown motion. Accelerations are those that carried each sample's velocity to the next sample's."""
    finite = np.isfinite(log.velocity).all(axis=1)
    count = int(finite.argmin()) if not finite.all() else len(finite)
    change = np.diff(log.velocity[:count], axis=0) / log.step
    velocity = log.velocity[: count - 1]
    base = RigidMotion(
        log.base_rotation[: count - 1], log.base_position[: count - 1], velocity[:, :3], velocity[:, 3:6],
        change[:, :3], change[:, 3:6],
    )  # fmt: skip
    return MotionHistory(robot, base, joints, log.joint_positions[: count - 1], velocity[:, 6:], change[:, 6:])


def thrusts(settings: dyn.FlightSettings, log: dyn.FlightLog, samples: int) -> list[Thrust]:
    """Thrust of every jet."""
    forces = log.thrust[:samples]
    return [
        Thrust(jet.frame, np.asarray(jet.axis), forces[:, i], jet.reaction) for i, jet in enumerate(settings.actuators)
    ]


def flown_loads(
    case: FlownCase,
    placements: Sequence[PartPlacement],
    interfaces: Mapping[str, Matrix],
    motion: MotionHistory,
    jets: Sequence[Thrust],
    step: float,
    seed: int = 0,
) -> Iterator[FlownLoads]:
    """The loads of a case in every place where the part sits. interfaces: part_T_interface (4, 4) [m]; step: [s].

    seed: of the flight's disturbances.
    """
    time = np.asarray(step * np.arange(len(motion.positions)), dtype=np.float64)
    for place in placements:
        link = motion.motion(place.link)
        part = fixed_at(link, place.link_T_part.matrix())
        mirror = np.eye(3) if place.mirror is None else reflection(place.mirror)
        turn = float(np.linalg.det(mirror))  # of a moment in a mirror image
        columns: list[Matrix] = []
        for interface, _ in case.seats:
            offset = place_interface(place, interfaces[interface])[:3, 3]
            point = link.position + link.rotation @ offset
            links = [
                name
                for joint, attachment in place.joints.items()
                if attachment.interface == interface
                for name in descendants(motion.robot, joint)
            ]
            force, moment = motion.wrench_on(point, links, jets)
            columns += [_in_axes(part, force) @ mirror, turn * _in_axes(part, moment) @ mirror]
        columns += _inertia(part, mirror)
        yield FlownLoads(place.link, time, np.concatenate(columns, axis=1, dtype=np.float64), seed)


def decide(
    responses: _core.fem.UnitResponses, loads: Sequence[FlownLoads], strength: FatigueStrength | None = None
) -> Decided:
    """Of all places and instants the one of the largest stress; and the fatigue, if the material has figures for it."""
    found = [responses.peak(each.factors) for each in loads]
    worst = int(np.argmax([peak.stress for peak in found]))
    instant = found[worst].instant
    result = responses.at(loads[worst].factors[instant])
    fatigue = None
    if strength is not None:
        counted = np.flatnonzero(result.counts_for_peak)
        fatigue = max((_fatigue(responses, each, counted, strength) for each in loads), key=lambda each: each.damage)
    return Decided(loads[worst], instant, result, fatigue)


def _fatigue(
    responses: _core.fem.UnitResponses, loads: FlownLoads, counted: Indices, strength: FatigueStrength
) -> Fatigue:
    """The largest damage over the nodes that see the largest stress at some of SURVEYED instants of the flight."""
    survey = loads.factors[np.linspace(0, len(loads.factors) - 1, SURVEYED).astype(int)]
    units = np.asarray(responses.stress).reshape(len(responses.stress), -1, 6)[counted]
    stress = np.einsum("tu,nuc->ntc", survey, units)
    largest = von_mises(stress.reshape(-1, 6)).reshape(len(counted), SURVEYED).max(axis=1)
    damages = {
        int(counted[i]): damage(signed_von_mises(loads.factors @ units[i]), strength)
        for i in np.argsort(largest)[-FATIGUE_NODES:]
    }
    node = max(damages, key=damages.__getitem__)
    return Fatigue(damages[node], np.asarray(responses.mesh.nodes[node]), loads.link)


def _inertia(part: RigidMotion, mirror: Matrix) -> list[Matrix]:
    """Field that pulls at the part: gravity less its acceleration at the origin (n, 3), and the gradient (n, 9)."""
    pull = _in_axes(part, GRAVITY - part.acceleration) @ mirror
    spin, turning = _cross(_in_axes(part, part.angular_velocity)), _cross(_in_axes(part, part.angular_acceleration))
    gradient = -mirror @ (turning + spin @ spin) @ mirror
    return [pull, gradient.reshape(-1, 9)]


def _in_axes(frame: RigidMotion, vectors: Matrix) -> Matrix:
    """World vectors (n, 3) in the axes of a frame."""
    return np.asarray(np.einsum("nji,nj->ni", frame.rotation, vectors))


def _cross(vectors: Matrix) -> Matrix:
    """Matrices (n, 3, 3) of the cross products with vectors (n, 3)."""
    x, y, z = vectors.T
    zero = np.zeros_like(x)
    return np.array([[zero, -z, y], [z, zero, -x], [-y, x, zero]]).transpose(2, 0, 1)


def decided_cases(
    config: StudyConfig,
    parts: Mapping[str, Part],
    robot: RobotDescription,
    settings: dyn.FlightSettings,
    flights: Mapping[int, dyn.FlightLog],
    responses: Mapping[str, Sequence[_core.fem.UnitResponses]],
) -> dict[str, dict[str, Decided]]:
    """What decides the flown cases of every part that has some: part -> case. responses: of each case of each part.

    flights: log of each seed; all of them count.
    """
    strengths = {part.name: fatigue_strength(config.materials[part.material]) for part in config.parts}
    motions = {seed: motion_history(robot, settings.joints, log) for seed, log in flights.items()}
    found: dict[str, dict[str, Decided]] = {}
    for part in (part for part in config.parts if part.flies):
        interfaces = parts[part.name].interfaces()
        found[part.name] = {
            case.name: decide(
                answers,
                [
                    loads
                    for seed, log in flights.items()
                    for loads in flown_loads(
                        case,
                        part.placements,
                        interfaces,
                        motions[seed],
                        thrusts(settings, log, len(motions[seed].positions)),
                        log.step,
                        seed,
                    )
                ],
                strengths[part.name],
            )
            for case, answers in zip(flown_settings(part, config), responses[part.name], strict=True)
        }
    return found


def with_flown(
    document: Mapping[str, Any], decided: Mapping[str, Decided], cases: Sequence[FlownCase], limits: Mapping[str, float]
) -> dict[str, Any]:
    """A part's document with its flown cases, and with their numbers where one of them governs.

    limits: safety factor that each case of the part asks for; the case whose own is smallest over that governs.
    """
    merged = dict(document) | {"cases": dict(document["cases"])}
    for case in cases:
        found = decided[case.name]
        result = found.result
        numbers = strength_document(result) | {"max_displacement": result.max_displacement, "work": result.work}
        place: dict[str, Any] = {"time": found.time, "link": found.loads.link, "seed": found.loads.seed}
        merged["cases"][case.name] = numbers | place | fatigue_document(found.fatigue)
        if _reserve(numbers, limits[case.name]) < _reserve(merged, limits[merged["load_case"]]):
            merged |= numbers | place | {"load_case": case.name}
    return merged


def fatigue_document(fatigue: Fatigue | None) -> dict[str, Any]:
    """Damage of one flight for JSON, and how many flights fail the part; None for both where it breaks at once.

    Empty without figures of the material's fatigue.
    """
    if fatigue is None:
        return {}
    value = fatigue.damage if math.isfinite(fatigue.damage) else None
    flights = 1.0 / value if value else None
    place = {"position": [float(x) for x in fatigue.position], "link": fatigue.link}
    return {"fatigue": {"damage": value, "flights": flights, **place}}


def fatigue_strength(material: MaterialConfig) -> FatigueStrength | None:
    """What a material says of fatigue; None if it lacks a figure."""
    amplitude, cycles, ultimate = (
        material.fatigue_strength_mpa, material.fatigue_cycles, material.ultimate_strength_mpa,
    )  # fmt: skip
    if amplitude is None or cycles is None or ultimate is None:
        return None
    return FatigueStrength(amplitude * MEGA, cycles, ultimate * MEGA)


def _reserve(numbers: Mapping[str, Any], limit: float) -> float:
    factor = numbers["safety_factor"]
    return math.inf if factor is None else factor / limit
