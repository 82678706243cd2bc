"""What is wrong with the controller of a study's flight: sections that it needs, its joints, servos, steps, paths."""

from __future__ import annotations

from collections.abc import Iterator

from codesign.robot.description import RobotDescription
from codesign.study.checking.problems import Problem, repeated, unknown
from codesign.study.config import StudyConfig
from codesign.study.controller.config import MpcConfig, ServoConfig
from codesign.study.flight_config import FlightConfig, TrajectoryConfig

NEEDED = {"momentum_qp": ("command_speeds", "references", "gains", "weights", "limits"), "mpc": ("mpc", "servo")}
JET_MODELS = ("integrator", "lag", "turbine")  # besides those of [flight.jet_models]


def controller_problems(config: StudyConfig, flight: FlightConfig) -> Iterator[Problem]:
    """What can be judged from the file alone."""
    for section in NEEDED[flight.controller]:
        if getattr(flight, section) is None:
            yield "flight.controller", f"{flight.controller!r} needs [flight.{section}]"
    yield from unknown("flight.jet_model", "jet model", flight.jet_model, [*JET_MODELS, *flight.jet_models])
    if flight.jet_model == "turbine" and flight.turbine is None:
        yield "flight.jet_model", "'turbine' needs [flight.turbine]"
    for name in set(JET_MODELS) & set(flight.jet_models):
        yield f"flight.jet_models.{name}", "is the name of a jet model that is always there"
    joints = [joint for group in flight.joint_groups for joint in group.joints]
    if flight.controller == "mpc":
        if flight.mpc is not None:
            yield from _mpc_problems(flight, flight.mpc, joints)
        if flight.servo is not None:
            yield from _servo_problems(flight.servo, joints)
    for name, trajectory in config.trajectories.items():
        yield from _path_problems(f"trajectories.{name}", flight, trajectory)


def _mpc_problems(flight: FlightConfig, mpc: MpcConfig, joints: list[str]) -> Iterator[Problem]:
    if flight.jet_model not in flight.jet_models:
        known = ", ".join(flight.jet_models) or "none"
        yield (
            "flight.jet_model",
            f"controller 'mpc' needs one of [flight.jet_models] ({known}), not {flight.jet_model!r}",
        )
    if twice := repeated(mpc.joints):
        yield "flight.mpc.joints", f"joint {twice!r} is named twice"
    for joint in mpc.joints:
        yield from unknown("flight.mpc.joints", "joint of joint_groups", joint, joints)
    if not mpc.small_steps <= mpc.control_steps <= mpc.small_steps + mpc.large_steps:
        yield "flight.mpc.control_steps", "must be between small_steps and the number of all steps"
    least = mpc.small_steps * flight.step_s
    if mpc.large_step_s < least * (1.0 - 1e-9):
        yield "flight.mpc.large_step_s", f"{mpc.large_step_s:g} is shorter than small_steps of step_s, {least:g}"
    if mpc.small_steps == 1 and abs(mpc.large_step_s - least) > 1e-9 * least:
        yield "flight.mpc.small_steps", "one small step is a large one, so large_step_s must be flight.step_s"


def _servo_problems(servo: ServoConfig, joints: list[str]) -> Iterator[Problem]:
    held = [joint for group in servo.groups for joint in group.joints]
    if twice := repeated(held):
        yield "flight.servo.groups", f"joint {twice!r} is named twice"
    for joint in held:
        yield from unknown("flight.servo.groups", "joint of joint_groups", joint, joints)
    if missing := [joint for joint in joints if joint not in held]:
        yield "flight.servo.groups", f"no servo for joint {missing[0]!r}"


def _path_problems(key: str, flight: FlightConfig, trajectory: TrajectoryConfig) -> Iterator[Problem]:
    if trajectory.windows and trajectory.waypoints:
        yield key, "has windows and waypoints; a trajectory is piloted or goes through points"
    if trajectory.windows and flight.controller == "mpc":
        yield f"{key}.windows", "controller 'mpc' flies waypoints"
    if trajectory.duration_s is not None:
        steps = trajectory.duration_s / flight.step_s
        if abs(steps - round(steps)) > 1e-6:
            yield (
                f"{key}.duration_s",
                f"{trajectory.duration_s:g} is not a whole number of steps of {flight.step_s:g} s",
            )


def controller_names(flight: FlightConfig, robot: RobotDescription) -> Iterator[Problem]:
    """Names that the robot does not have."""
    if flight.mpc is not None:
        yield from unknown("flight.mpc.body", "link", flight.mpc.body, robot.link_names)
