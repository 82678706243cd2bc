"""What is wrong with a study's flight: joints, jets, times, trajectories, and names that the robot does not have."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from codesign.errors import UrdfError
from codesign.problem.quantities import FAMILY, QUANTITIES
from codesign.robot.clearance import InterferenceSettings, link_pieces
from codesign.robot.description import RobotDescription
from codesign.study.checking.problems import Problem, repeated, unknown
from codesign.study.config import StudyConfig
from codesign.study.controller.checks import controller_names, controller_problems
from codesign.study.flight_config import FlightConfig

MOST_SAMPLES = 1_000_000  # of a flight
MOST_PLANT_STEPS = 100_000_000
UNIT_TOLERANCE = 1e-6  # of the length of an axis
OPTIONAL_OF_GROUPS = ("reference_rad", "ranges_deg")
PER_JOINT = ("rotor_inertia_kg_m2", "viscous_friction_n_m_per_rad_s", "coulomb_friction_n_m")  # one number, or a list
PER_JET = ("max_thrust_n", "max_thrust_rate_n_s", "min_thrust_n", "reaction_n_m_per_n", "lag_s")


def flight_problems(config: StudyConfig) -> Iterator[Problem]:
    """What can be judged from the file alone."""
    flight = config.flight
    if flight is None:
        yield from _flightless_problems(config)
        return
    yield from _time_problems(flight)
    yield from _joint_problems(flight)
    yield from _jet_problems(flight)
    if flight.references is not None:
        for key, limits in (("roll", flight.references.roll_range_deg), ("pitch", flight.references.pitch_range_deg)):
            if limits[0] > limits[1]:
                yield f"flight.references.{key}_range_deg", f"{limits[0]:g} is above {limits[1]:g}"
    if bool(flight.ground.frames) != bool(flight.ground.points_m):
        yield "flight.ground", "frames and points_m belong together: the points stand in each of the frames"
    yield from _air_and_start_problems(config, flight)
    yield from controller_problems(config, flight)
    yield from _trajectory_problems(config)


def _air_and_start_problems(config: StudyConfig, flight: FlightConfig) -> Iterator[Problem]:
    """Drag areas, wind without any, and a start that both hovers and falls."""
    if flight.drag is not None:
        for name in ("areas_m2", "positions_m"):
            given = getattr(flight.drag, name)
            optional = name == "positions_m" and not given
            if isinstance(given, list) and not optional and len(given) != len(flight.drag.frames):
                yield f"flight.drag.{name}", f"needs {len(flight.drag.frames)} entries, one for each of frames"
    elif windy := [name for name, flown in config.trajectories.items() if any(flown.disturbances.wind_m_s)]:
        yield f"trajectories.{windy[0]}.disturbances.wind_m_s", "needs [flight.drag], the areas that air drags"
    start = flight.initial_state
    if start.trim is not None:
        if start.free_fall_first_step:
            yield "flight.initial_state.free_fall_first_step", "a robot that starts in a trimmed hover does not fall"
        joints = [joint for group in flight.joint_groups for joint in group.joints]
        for joint in start.trim.joints:
            yield from unknown("flight.initial_state.trim.joints", "joint", joint, joints)


def _flightless_problems(config: StudyConfig) -> Iterator[Problem]:
    """What needs a flight in a study that has none."""
    for key, asked in (
        ("trajectories", config.trajectories),
        ("validation.trajectories", config.validation.trajectories),
        ("interference", config.interference),
    ):
        if asked:
            yield key, "needs the section [flight]"
    for name in {*config.objectives.names, *config.constraints.limits}:
        path = QUANTITIES[name].path if name in QUANTITIES else name
        if name in FAMILY or path.startswith(("flight.", "objective_families.")):
            yield "objectives or constraints", f"{name!r} needs the section [flight]; parts have mass, safety_factor, …"
    for part in config.parts:
        for case in part.cases:
            if case.flown:
                yield f"parts.{part.name}.cases[{case.name}].flown", "needs a flight to take its loads from"


def _time_problems(flight: FlightConfig) -> Iterator[Problem]:
    torque_step = flight.torque_step_s or flight.step_s
    for key, whole, part in (
        ("torque_step_s", flight.step_s, torque_step),
        ("plant_step_s", torque_step, flight.plant_step_s or torque_step),
        ("drives.momentum_delay_s", flight.drives.momentum_delay_s, flight.step_s),
        ("drives.torque_delay_s", flight.drives.torque_delay_s, torque_step),
    ):
        if not _is_multiple(whole, part) or (whole < part and not key.startswith("drives")):
            yield f"flight.{key}", f"{whole:g} s is not a whole number of steps of {part:g} s"
    plant_step = flight.plant_step_s or torque_step
    if flight.duration_s / plant_step > MOST_PLANT_STEPS:
        yield "flight.plant_step_s", f"{plant_step:g} gives more than {MOST_PLANT_STEPS} steps of the simulation"
    if twice := repeated(str(seed) for seed in flight.seeds):
        yield "flight.seeds", f"seed {twice} is named twice"
    steps = flight.duration_s / flight.step_s
    if steps > MOST_SAMPLES:
        yield "flight.step_s", f"{flight.step_s:g} gives more than {MOST_SAMPLES} samples"
    elif round(steps) < 1 or not _is_multiple(flight.duration_s, flight.step_s):
        yield "flight.duration_s", f"{flight.duration_s:g} is not a whole number of steps of {flight.step_s:g} s"


def _is_multiple(whole: float, part: float) -> bool:
    ratio = whole / part
    return math.isfinite(ratio) and abs(ratio - round(ratio)) <= 1e-6


def _joint_problems(flight: FlightConfig) -> Iterator[Problem]:
    groups = flight.joint_groups
    for name in OPTIONAL_OF_GROUPS:
        if len({bool(getattr(group, name)) for group in groups if group.joints}) > 1:
            yield f"flight.joint_groups.{name}", "stands in some groups only: give it in all of them, or in none"
    if twice := repeated(group.name for group in groups):
        yield "flight.joint_groups", f"two groups have the name {twice!r}"
    if twice := repeated(joint for group in groups for joint in group.joints):
        yield "flight.joint_groups", f"joint {twice!r} is named twice"
    for group in groups:
        key = f"flight.joint_groups[{group.name}]"
        if not group.joints:
            yield f"{key}.joints", "empty: leave out a group without joints"
        if flight.controller == "momentum_qp" and group.posture_gain_hz is None:
            yield f"{key}.posture_gain_hz", "the controller 'momentum_qp' needs it"
        for name in ("initial_rad", *OPTIONAL_OF_GROUPS, *PER_JOINT):
            value = getattr(group, name)
            if not isinstance(value, list) or (not value and name in OPTIONAL_OF_GROUPS):
                continue
            if len(value) != len(group.joints):
                yield f"{key}.{name}", f"needs {len(group.joints)} entries, one per joint, has {len(value)}"
        for joint, (low, high) in zip(group.joints, group.ranges_deg, strict=False):
            if low >= high:
                yield f"{key}.ranges_deg", f"{joint}: {low:g} must be below {high:g}"


def _jet_problems(flight: FlightConfig) -> Iterator[Problem]:
    jets = flight.jets
    if not jets.frames:
        yield "flight.jets.frames", "empty: a robot flies on at least one jet"
    if twice := repeated(jets.frames):
        yield "flight.jets.frames", f"jet {twice!r} is named twice"
    yield from _per_jet_problems(flight)
    for pair in jets.symmetric_pairs:
        for jet in pair:
            yield from unknown("flight.jets.symmetric_pairs", "jet", jet, jets.frames)
        if pair[0] == pair[1]:
            yield "flight.jets.symmetric_pairs", f"{pair[0]!r} is paired with itself"


def _per_jet_problems(flight: FlightConfig) -> Iterator[Problem]:
    """Lists that do not fit the frames, axes that are no unit vectors, empty ranges of thrust."""
    jets, count = flight.jets, len(flight.jets.frames)
    lists = {f"flight.jets.{name}": getattr(jets, name) for name in PER_JET}
    lists |= {"flight.initial_state.thrust_n": flight.initial_state.thrust_n}
    for key, value in lists.items():
        if isinstance(value, list) and len(value) != count:
            yield key, f"needs one number, or {count}: one for each of flight.jets.frames"
    if jets.senses and len(jets.senses) != count:
        yield "flight.jets.senses", f"needs {count} entries, one for each of frames"
    if jets.axes and len(jets.axes) != count:
        yield "flight.jets.axes", f"needs {count} vectors, one for each of frames"
    for frame, axis in zip(jets.frames, jets.axes, strict=False):
        if abs(math.hypot(*axis) - 1.0) > UNIT_TOLERANCE:
            yield "flight.jets.axes", f"{frame}: {list(axis)} is no unit vector"
    least, most = np.atleast_1d(jets.min_thrust_n), np.atleast_1d(jets.max_thrust_n)
    if len(least) in (1, len(most)) and not (least < most).all():
        yield "flight.jets.min_thrust_n", "must be below max_thrust_n"


def _trajectory_problems(config: StudyConfig) -> Iterator[Problem]:
    if not config.trajectories:
        yield "trajectories", "a study needs at least one trajectory"
    yield from unknown("flight.trajectory", "trajectory", config.flown.trajectory, config.trajectories)
    for name in config.validation.trajectories:
        yield from unknown("validation.trajectories", "trajectory", name, config.trajectories)
    for name, trajectory in config.trajectories.items():
        if not name or "@" in name:
            yield f"trajectories.{name}", "a trajectory's name must not be empty or hold @, which stands before a seed"
        for window in trajectory.windows:
            if window.to_s <= window.from_s:
                yield f"trajectories.{name}.windows", f"to_s = {window.to_s:g} is not after {window.from_s:g}"


def robot_problems(config: StudyConfig, robot: RobotDescription) -> Iterator[Problem]:
    """Names of joints, frames and links that the robot does not have."""
    for index, change in enumerate(config.robot.changes if config.robot is not None else []):
        if change.joint is not None:
            yield from unknown(f"robot.changes[{index}].joint", "joint", change.joint, robot.joint_names)
        if change.link is not None:
            yield from unknown(f"robot.changes[{index}].link", "link", change.link, robot.link_names)
    flight = config.flight
    if flight is None:
        return
    for group in flight.joint_groups:
        for joint in group.joints:
            key = f"flight.joint_groups[{group.name}].joints"
            yield from unknown(key, "moving joint", joint, robot.moving_joint_names)
    yield from controller_names(flight, robot)
    for jet in flight.jets.frames:
        yield from unknown("flight.jets.frames", "link", jet, robot.link_names)
    frames = {"flight.ground.frames": flight.ground.frames}
    frames["flight.drag.frames"] = flight.drag.frames if flight.drag is not None else []
    frames["flight.tank.frame"] = [flight.tank.frame] if flight.tank is not None else []
    for key, links in frames.items():
        for link in links:
            yield from unknown(key, "link", link, robot.link_names)
    if config.interference is not None:
        yield from _interference_problems(config, config.interference, robot)


def _interference_problems(
    config: StudyConfig, measured: InterferenceSettings, robot: RobotDescription
) -> Iterator[Problem]:
    for jet in measured.plumes.jets:
        yield from unknown("interference.plumes.jets", "link", jet, robot.link_names)
    placed = {place.link: () for part in config.parts for place in part.placements}
    try:
        shapes = link_pieces(robot, placed)
    except UrdfError as error:
        yield "interference", str(error)
        return
    for key, links in (
        ("interference.bodies", measured.bodies),
        ("interference.ignore", [link for pair in measured.ignore for link in pair]),
    ):
        for link in links:
            yield from unknown(key, "link with a shape", link, shapes)
