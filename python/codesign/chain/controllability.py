"""Whether a robot can hover and hold its attitude at all: what its inputs can do to its momentum at the start posture.

The momentum rate is ḣ = A(s) T + m g: linear in the thrusts T, and the joints s turn and shift the jets. Its derivative
by thrusts and joints is the map that every controller has to work with. See docs/flight.md.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from codesign import dynamics as dyn
from codesign.chain import chain
from codesign.chain.flight import find_trajectory, flight_settings, joint_names
from codesign.errors import GeometryError

if TYPE_CHECKING:
    from codesign.problem.design_space import Design
    from codesign.study.study import StudyData

Array = NDArray[np.float64]

GRAVITY = 9.80665  # m/s², as in the native code
RANK_TOLERANCE = 1e-6  # of the largest singular value
TRIM_ANGLE = np.deg2rad(10.0)  # by which joints may turn from the start posture to balance a hover, linearized
JOINT_AUTHORITY = 1.0  # rad: no joint counts for more
DIRECTIONS = ("forward force", "sideways force", "lift", "roll moment", "pitch moment", "yaw moment")
ATTITUDE = (2, 3, 4, 5)  # lift and the three moments: what holds a hover; the rest can come from banking
MIXED = ("independent lift, roll, pitch and yaw",)  # what is lost is no single one of them
MISSED_SHARE = 1.0 - 1e-6  # length of a direction's projection on what is not reached, from which it is called missing


@dataclass(frozen=True, slots=True)
class Controllability:
    """What thrusts and joints can do at the start posture.

    rank: of the map from inputs to force and moment, 6 at most. condition: of what it reaches, inputs in units of their
    ranges, forces in units of the weight, moments in weight times radius of gyration. missing: directions that no
    input reaches. hover_margin: largest multiple of the weight that is carried in balance, 0 if none is. reason: why
    the robot cannot fly; None if nothing speaks against it. notes: what to know besides.
    """

    rank: int
    condition: float
    missing: tuple[str, ...]
    hover_margin: float
    reason: str | None
    notes: tuple[str, ...] = ()


def controllability(model: dyn.Model, settings: dyn.FlightSettings) -> Controllability:
    """Judges a robot and its actuators at the start posture of a flight. Raises: ValueError: a frame is unknown."""
    from scipy.optimize import lsq_linear  # a fifth of a second to import

    jets = _jets(model, settings)
    com = dyn.center_of_mass(model, settings.base_pose, settings.initial_joints)
    weight = np.array([0.0, 0.0, model.total_mass * GRAVITY, 0.0, 0.0, 0.0])
    locked = dyn.locked_inertia(model, settings.base_pose, settings.initial_joints)
    gyration = float(np.sqrt(np.trace(locked[-3:, -3:]) / (2.0 * model.total_mass)))  # radius, m
    units = weight[2] * np.array([1.0, 1.0, 1.0, gyration, gyration, gyration])
    thrust_map = np.column_stack([_wrench(axis, point - com, jet.reaction) for jet, axis, point in jets])
    least = np.array([jet.thrust_min for jet in settings.actuators])
    most = np.array([jet.thrust_max for jet in settings.actuators])
    hover = lsq_linear(thrust_map / units[:, None], weight / units, bounds=(least, most)).x
    joint_map = _joint_map(model, settings, jets, hover)
    low, high = _joint_room(model, settings)
    scaled = np.hstack([thrust_map * (most - least), joint_map * np.minimum(high - low, JOINT_AUTHORITY)])
    scaled /= units[:, None]
    rank, condition, unreached = _reach(scaled)
    least_carried, margin = _carried(thrust_map, joint_map, weight, units, (least, most), (low, high))
    held = _reach(scaled[list(ATTITUDE)])
    lost = () if held[0] == len(ATTITUDE) else _named(held[2], [DIRECTIONS[k] for k in ATTITUDE]) or MIXED
    missing = _named(unreached, DIRECTIONS)
    reason = _reason(lost, (least_carried, margin), [axis for _, axis, _ in jets], settings)
    return Controllability(rank, condition, missing, margin, reason, _notes(missing) if reason is None else ())


def study_controllability(study: StudyData, design: Design) -> Controllability:
    """That of a study's robot with one design's parts. Raises: GeometryError: the parts cannot be built."""
    config = study.configured(design)
    settings = flight_settings(config.flown, find_trajectory(config, config.flown.trajectory))
    robot = chain.build_robot(study, design).to_text()
    model = dyn.load_urdf(robot, joints=joint_names(config.flown))
    return controllability(model, dyn.fitted_settings(model, settings))


def grounded(study: StudyData) -> str | None:
    """Why no design of a study can fly, judged by its baseline, else the middle of its grid, and both ends of it.

    None if one of them can, or if the study has no flight.
    """
    if study.config.flight is None:
        return None
    space = study.space
    ends = [[0] * len(space.levels), [levels - 1 for levels in space.levels]]
    first = study.baseline or space.from_indices([(levels - 1) // 2 for levels in space.levels])
    why = None
    for design in (first, *(space.from_indices(indices) for indices in ends)):
        try:
            judged = study_controllability(study, design).reason
        except GeometryError:
            continue
        if judged is None:
            return None
        why = why or judged
    return why


def _jets(model: dyn.Model, settings: dyn.FlightSettings) -> list[tuple[dyn.Actuator, Array, Array]]:
    """Each actuator with its axis and its point in the world."""
    placed = []
    for jet in settings.actuators:
        world_T_jet = dyn.frame_pose(model, settings.base_pose, settings.initial_joints, jet.frame)
        placed.append((jet, world_T_jet[:3, :3] @ jet.axis, world_T_jet[:3, 3]))
    return placed


def _wrench(axis: Array, lever: Array, reaction: float) -> Array:
    """(6,) force and moment about the center of mass per newton of thrust."""
    return np.concatenate([axis, np.cross(lever, axis) + reaction * axis])


def _joint_map(
    model: dyn.Model, settings: dyn.FlightSettings, jets: list[tuple[dyn.Actuator, Array, Array]], thrusts: Array
) -> Array:
    """(6, joints) change of force and moment per radian of a joint, base held, thrusts held."""
    posture = settings.base_pose, settings.initial_joints
    count = len(settings.joints)
    com = dyn.center_of_mass(model, *posture)
    shift = dyn.center_of_mass_jacobian(model, *posture)[:, 6:]
    total = np.zeros((6, count))
    for (jet, axis, point), thrust in zip(jets, thrusts, strict=True):
        jacobian = dyn.frame_jacobian(model, *posture, jet.frame)[:, 6:]
        turn = np.cross(jacobian[3:].T, axis)
        moved = (jacobian[:3] - shift).T
        total[:3] += thrust * turn.T
        total[3:] += thrust * (np.cross(moved, axis) + np.cross(point - com, turn) + jet.reaction * turn).T
    return total


def _joint_room(model: dyn.Model, settings: dyn.FlightSettings) -> tuple[Array, Array]:
    """How far each joint can turn down and up from the start posture within the controller's ranges [rad]."""
    limits, start = settings.limits, settings.initial_joints
    if settings.controller == dyn.Controller.predictive:
        ranges = [model.joint_limits[name] for name in settings.joints]
        lower, upper = (np.array([limit[end] for limit in ranges]) for end in ("lower", "upper"))
    else:
        lower, upper = limits.joint_range_scale * limits.joint_lower, limits.joint_range_scale * limits.joint_upper
    return np.minimum(lower - start, 0.0), np.maximum(upper - start, 0.0)


def _reach(scaled: Array) -> tuple[int, float, Array]:
    """Rank, condition of what is reached, and an orthonormal basis (rows, missed) of what is not."""
    left, values, _ = np.linalg.svd(scaled)
    rank = int((values > RANK_TOLERANCE * values[0]).sum())
    return rank, float(values[0] / values[rank - 1]), left[:, rank:]


def _named(unreached: Array, names: Iterable[str]) -> tuple[str, ...]:
    """Directions that lie in the span of what is not reached."""
    lengths = np.linalg.norm(unreached, axis=1)
    return tuple(name for name, length in zip(names, lengths, strict=True) if length > MISSED_SHARE)


def _carried(
    thrust_map: Array,
    joint_map: Array,
    weight: Array,
    units: Array,
    thrusts: tuple[Array, Array],
    joints: tuple[Array, Array],
) -> tuple[float, float]:
    """Least and largest multiple of the weight that thrusts, and joints turned a little, carry in balance; (0, 0)."""
    from scipy.optimize import linprog

    low, high = np.maximum(joints[0], -TRIM_ANGLE), np.minimum(joints[1], TRIM_ANGLE)
    bounds = np.vstack([np.column_stack(thrusts), np.column_stack([low, high]), [0.0, np.inf]])
    balance = np.column_stack([thrust_map, joint_map, -weight]) / units[:, None]
    multiple = np.zeros(len(bounds))
    multiple[-1] = 1.0
    least, most = (linprog(sign * multiple, A_eq=balance, b_eq=np.zeros(6), bounds=bounds) for sign in (1.0, -1.0))
    return (float(least.x[-1]), float(most.x[-1])) if least.success and most.success else (0.0, 0.0)


def _reason(
    lost: tuple[str, ...], carried: tuple[float, float], axes: list[Array], settings: dyn.FlightSettings
) -> str | None:
    several = len(axes) > 1
    kind = "propeller" if any(jet.reaction for jet in settings.actuators) else "jet"
    jets = f"the {len(axes)} {kind}s" if several else f"the only {kind}"
    if lost:
        parallel = several and all(np.linalg.norm(np.cross(axis, axes[0])) < RANK_TOLERANCE for axis in axes)
        dragless = not any(jet.reaction for jet in settings.actuators)
        alike = (
            "are parallel, have no drag torque and give" if parallel and dragless else "give" if several else "gives"
        )
        return f"cannot hold its attitude: {jets} {alike} no {' and no '.join(lost)}"
    least, most = carried
    if least <= 1.0 <= most:
        return None
    thrust = "no thrust balances" if most == 0.0 else f"full thrust carries {most:.2g} times its weight"
    thrust = f"the least thrust carries {least:.2g} times its weight" if least > 1.0 else thrust
    return f"cannot hover: at the start posture {thrust}"


def _notes(missing: tuple[str, ...]) -> tuple[str, ...]:
    forces = [name for name in missing if name in DIRECTIONS[:2]]
    return (
        (f"no {' and no '.join(forces)} without banking, which the momentum controller does not do",) if forces else ()
    )
