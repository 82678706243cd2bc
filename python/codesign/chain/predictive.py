"""From the sections of predictive control to native settings: names and units, no physics."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from codesign import dynamics as dyn
from codesign.units import DEGREE

if TYPE_CHECKING:
    from codesign.study.controller.config import MpcConfig, ServoConfig, StandardizedJetConfig
    from codesign.study.flight_config import FlightConfig, TrajectoryConfig

STANDARDIZED = ("c", "K_T", "K_D", "K_TD", "K_TT", "K_DD", "B", "B_T", "B_D", "B_TD", "B_TT", "B_DD", "B_UU")
VECTOR_WEIGHTS = ("com", "com_integral", "linear_momentum", "attitude", "attitude_integral", "angular_momentum")


def set_predictive(settings: dyn.FlightSettings, flight: FlightConfig, mpc: MpcConfig, servo: ServoConfig) -> None:
    """Makes the settings those of a predictive flight; joints and step are set."""
    settings.controller = dyn.Controller.predictive
    settings.predictive = dyn.PredictiveSettings(
        period=flight.step_s,
        throttle_every=mpc.throttle_every,
        small_steps=mpc.small_steps,
        large_steps=mpc.large_steps,
        large_step=mpc.large_step_s,
        control_steps=mpc.control_steps,
        body=mpc.body,
        joints=mpc.joints,
        joint_speed=math.inf if mpc.joint_speed_rad_s is None else mpc.joint_speed_rad_s,
        integral=getattr(dyn.PredictiveIntegral, mpc.integral),
        model=dyn.PredictiveModelOptions(
            gravity_coupling=mpc.gravity_coupling, jet_dynamics=mpc.jet_dynamics, varying=mpc.varying
        ),
        weights=predictive_weights(mpc),
    )
    settings.servo_plant = dyn.ServoPlantSettings(
        servo=_servos(servo, settings.joints),
        integrator=getattr(dyn.ServoIntegrator, servo.integrator),
        step=servo.step_s,
    )


def predictive_weights(mpc: MpcConfig) -> dyn.PredictiveWeights:
    """Weights times their powers of ten."""
    weights, exponents = mpc.weights, mpc.weight_exponents
    throttle = 10.0**exponents.throttle
    return dyn.PredictiveWeights(
        **{name: np.array(getattr(weights, name)) * 10.0 ** getattr(exponents, name) for name in VECTOR_WEIGHTS},
        joint_displacement=weights.joint_displacement * 10.0**exponents.joint_displacement,
        posture=weights.posture,
        throttle_first=weights.throttle_first * throttle,
        throttle_change=weights.throttle_change * throttle,
    )


def _servos(servo: ServoConfig, joints: list[str]) -> dyn.ServoSettings:
    rows = {
        joint: (group.stiffness_n_m_rad, group.damping_ratio, group.passive_n_m_s_rad)
        for group in servo.groups
        for joint in group.joints
    }
    values = np.array([rows[joint] for joint in joints]).reshape(-1, 3)
    return dyn.ServoSettings(stiffness=values[:, 0], damping_ratio=values[:, 1], passive=values[:, 2])


def standardized_turbine(jet: StandardizedJetConfig) -> dyn.StandardizedTurbine:
    """A jet model of the study."""
    return dyn.StandardizedTurbine(
        thrust_mean=jet.thrust_mean_n,
        thrust_scale=jet.thrust_scale_n,
        throttle_mean=jet.throttle_mean_percent,
        throttle_scale=jet.throttle_scale_percent,
        throttle_max=jet.max_throttle_percent,
        rate_gain=jet.throttle_gain,
        **{name: getattr(jet, name) for name in STANDARDIZED},
    )


def waypoint_path(trajectory: TrajectoryConfig) -> dyn.WaypointPath:
    """Way-points of a trajectory; none: a piloted one."""
    return dyn.WaypointPath(
        start=trajectory.rest_s,
        kind=getattr(dyn.WaypointKind, trajectory.kind),
        waypoints=[
            dyn.Waypoint(position=np.array(w.m), yaw=w.yaw_deg * DEGREE, duration=w.duration_s, rest=w.rest_s)
            for w in trajectory.waypoints
        ],
    )


def pulses(trajectory: TrajectoryConfig) -> list[dyn.Pulse]:
    """Forces and moments that disturb a trajectory for a time."""
    return [
        dyn.Pulse(start=p.at_s, duration=p.for_s, force=np.array(p.force_n), moment=np.array(p.moment_n_m))
        for p in trajectory.pulses
    ]
