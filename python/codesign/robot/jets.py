"""What makes the robot fly and no robot format says, for JSON: jets, start, controller settings."""

from __future__ import annotations

from typing import Any

import numpy as np

from codesign import dynamics as dyn
from codesign.robot.bodies import depth_first
from codesign.robot.description import RobotDescription
from codesign.transforms import quaternion

UNITS = "SI: m, kg, s, N, rad; velocities of the base in world axes; quaternions w, x, y, z"
KINDS = {
    dyn.RateIntegrator: "integrator",
    dyn.FirstOrderLag: "lag",
    dyn.Turbine: "turbine",
    dyn.StandardizedTurbine: "standardized turbine",
}
COMMAND_UNITS = {"integrator": "N/s", "lag": "N", "turbine": "%", "standardized turbine": "%"}
COMMANDS = {
    "integrator": "thrust rate [N/s]",
    "lag": "thrust [N]",
    "turbine": "throttle [%]",
    "standardized turbine": "throttle [%]",
}


def flying_document(robot: RobotDescription, settings: dyn.FlightSettings) -> dict[str, Any]:
    """Jets, start posture, joints and controller of a robot as the flight has them, SI units.

    jets: frame is a link of the URDF; axis, unit vector in it, along which the thrust pushes; reaction: moment about
    the axis per thrust. joints: in the order of every vector over joints; joints_held: moving joints that the flight
    keeps at zero; joints_that_mimic: position = multiplier times that of `joint` plus offset. start: of base (pose of
    the root link in the world), joints and thrusts.
    """
    pose = settings.base_pose
    own = [name for name in depth_first(robot) if name in robot.moving_joint_names]
    held = [name for name in own if name not in settings.joints]
    return {
        "robot": robot.name,
        "base_link": robot.root_link,
        "mass": robot.total_mass,
        "units": UNITS,
        "jets": [_jet(jet) for jet in settings.actuators],
        "joints": list(settings.joints),
        "joints_held": held,
        "joints_that_mimic": {
            name: {"joint": joint, "multiplier": multiplier, "offset": offset}
            for name, (joint, multiplier, offset) in robot.mimics.items()
        },
        "start": {
            "base_position": pose[:3, 3].tolist(),
            "base_quaternion": quaternion(pose[:3, :3]).tolist(),
            "joints": dict(zip(settings.joints, settings.initial_joints.tolist(), strict=True)),
            "thrusts": {
                jet.frame: thrust
                for jet, thrust in zip(settings.actuators, settings.initial_thrusts.tolist(), strict=True)
            },
        },
        "controller": {"kind": settings.controller.name, "step": settings.step} | _controller(settings),
        "plant": {"integrator": settings.integrator.name, "substeps": settings.substeps},
    }


def dynamics_kind(jet: dyn.Actuator) -> str:
    """integrator, lag or turbine, as a study calls it, or standardized turbine."""
    return KINDS[type(jet.dynamics)]


def torque_limit(settings: dyn.FlightSettings, otherwise: float | None) -> float | None:
    """What the flight's controller allows a joint [N m]; servos of a predictive flight have no limit of their own."""
    return settings.limits.torque if settings.controller == dyn.Controller.momentum_qp else otherwise


def _controller(settings: dyn.FlightSettings) -> dict[str, Any]:
    if settings.controller == dyn.Controller.momentum_qp:
        return {name: _values(getattr(settings, name)) for name in ("gains", "weights", "limits")}
    predictive = settings.predictive
    plain = ("body", "joints", "throttle_every", "small_steps", "large_steps", "large_step", "control_steps")
    return {
        **{name: getattr(predictive, name) for name in plain},
        "joint_speed": predictive.joint_speed if np.isfinite(predictive.joint_speed) else None,
        "integral": predictive.integral.name,
        "model": _values(predictive.model),
        "weights": _values(predictive.weights),
        "servos": _values(settings.servo_plant.servo),
    }


def _jet(jet: dyn.Actuator) -> dict[str, Any]:
    kind = dynamics_kind(jet)
    return {
        "frame": jet.frame,
        "axis": jet.axis.tolist(),
        "reaction": jet.reaction,
        "thrust_min": jet.thrust_min,
        "thrust_max": jet.thrust_max,
        "thrust_rate_max": jet.thrust_rate,
        "dynamics": {"kind": kind, "command": COMMANDS[kind], **_values(jet.dynamics)},
    }


def _values(settings: object) -> dict[str, Any]:
    """Numbers of a native settings object by name."""
    names = [name for name, value in vars(type(settings)).items() if isinstance(value, property)]
    values = {name: getattr(settings, name) for name in names}
    return {name: value.tolist() if isinstance(value, np.ndarray) else value for name, value in values.items()}
