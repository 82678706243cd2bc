"""Predictive flights of the iRonCub study in numbers, independent of its study files; for tests and benchmarks."""

import functools

import numpy as np

import ironcub_flight
from codesign import dynamics as dyn
from codesign import load_study

DESIGN = {"angle": 15, "distance": 42, "offset": 80, "length": 108}
ARMS = ironcub_flight.LEFT_ARM + ironcub_flight.RIGHT_ARM

# Mk3's jet, identified in standardized variables by the authors of the predictive controller.
MK3 = dyn.StandardizedTurbine(
    thrust_mean=108.309,
    thrust_scale=65.793,
    throttle_mean=47.333,
    throttle_scale=31.483,
    c=-0.464730485,
    K_T=-8.13171858,
    K_D=-6.19539230,
    K_TD=0.661113140,
    K_TT=1.67673231,
    K_DD=-0.483287064,
    B=8.77996617,
    B_T=-1.01096376,
    B_D=-0.586442286,
    B_TD=0.519093322,
    B_TT=-0.423782666,
    B_DD=-1.45705257,
    B_UU=-0.00783052261,
)

ROUTE = [  # x, y, z [m], yaw [deg], duration, rest [s]
    (0, 0, 1.0, 0, 4, 1),
    (2, 1, 1.5, 0, 6, 1),
    (2, 1, 1.5, 60, 5, 1),
    (0, 0, 1.0, 60, 6, 0.5),
    (0, 0, 0.5, 60, 3, 0.5),
]


def route() -> dyn.WaypointPath:
    """The acceptance trajectory of 30 s; its reference numbers start 1 ms late."""
    points = [
        dyn.Waypoint(position=np.array([x, y, z], dtype=float), yaw=np.deg2rad(yaw), duration=duration, rest=rest)
        for x, y, z, yaw, duration, rest in ROUTE
    ]
    return dyn.WaypointPath(start=2.001, waypoints=points)


def step(x: float = 0.2, y: float = 0.1, z: float = 0.1) -> dyn.WaypointPath:
    """A reference that jumps right after t = 0."""
    return dyn.WaypointPath(waypoints=[dyn.Waypoint(position=np.array([x, y, z]), duration=1e-9)])


def servos() -> dyn.ServoSettings:
    """Stiffness and damping ratio of the joints' servos."""
    arm = {"shoulder_pitch": (3000, 0.3), "shoulder_roll": (3000, 0.3), "shoulder_yaw": (3000, 0.3)}
    arm |= {"elbow": (3000, 0.3)}
    leg = {"hip_pitch": (1200, 0.2), "hip_roll": (1200, 0.2), "hip_yaw": (1200, 0.5), "knee": (1800, 0.8)}
    leg |= {"ankle_pitch": (1800, 0.8), "ankle_roll": (1800, 0.8)}
    torso = {"torso_pitch": (1500, 0.3), "torso_roll": (1500, 0.2), "torso_yaw": (1500, 0.4)}
    table = torso | {f"{side}_{name}": value for side in "lr" for name, value in (arm | leg).items()}
    values = np.array([table[joint] for joint in ironcub_flight.JOINTS], dtype=float)
    return dyn.ServoSettings(stiffness=values[:, 0], damping_ratio=values[:, 1], passive=np.full(len(values), 2.0))


@functools.cache
def robot() -> dyn.Model:
    """The standard study's robot of `DESIGN`."""
    return dyn.load_urdf(load_study("ironcub_paper").build_robot(DESIGN), joints=ironcub_flight.JOINTS)


def actuators() -> list[dyn.Actuator]:
    """Four jets of the Mk3."""
    return [
        dyn.Actuator(frame=frame, thrust_max=222.127, thrust_rate=200.0, dynamics=MK3) for frame in ironcub_flight.JETS
    ]


@functools.cache
def trim() -> dyn.Trim:
    """Hover of `DESIGN` nearest to the study's posture."""
    published = ironcub_flight.settings()
    limits = [robot().joint_limits[name] for name in ironcub_flight.JOINTS]
    base_pose = np.eye(4)
    base_pose[2, 3] = 0.8
    return dyn.trim_hover(
        robot(),
        actuators(),
        base_pose,
        published.initial_joints,
        moving=ARMS,
        joint_lower=np.array([limit["lower"] for limit in limits]),
        joint_upper=np.array([limit["upper"] for limit in limits]),
    )


def settings(recommended: bool = True, reference: bool = True) -> dyn.FlightSettings:
    """Predictive flight from the trimmed hover.

    recommended: with gravity in the prediction and bounds on joint speeds, else as published. reference: plant by
    Runge-Kutta, else by the implicit step.
    """
    settings = ironcub_flight.settings()
    hover = trim()
    settings.controller = dyn.Controller.predictive
    settings.initial_free_fall = False
    settings.step = 0.005
    settings.duration = 30.0
    settings.trajectory = []
    settings.actuators = actuators()
    settings.base_pose, settings.initial_joints, settings.initial_thrusts = hover.base_pose, hover.joints, hover.thrusts
    settings.predictive = dyn.PredictiveSettings(
        body="chest",
        joints=ARMS,
        joint_speed=2.0 if recommended else np.inf,
        model=dyn.PredictiveModelOptions(gravity_coupling=recommended),
    )
    integrator = dyn.ServoIntegrator.runge_kutta_4 if reference else dyn.ServoIntegrator.implicit
    settings.servo_plant = dyn.ServoPlantSettings(servo=servos(), integrator=integrator)
    settings.fuel = dyn.FuelRate(idle=1.3825e-3, per_newton=3.820e-5)
    return settings
