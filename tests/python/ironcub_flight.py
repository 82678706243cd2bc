"""Flight settings of the iRonCub study, in numbers, independent of its study.toml; for tests and benchmarks."""

import numpy as np

from codesign import dynamics as dyn

ARM = ("shoulder_pitch", "shoulder_roll", "shoulder_yaw", "elbow")
LEG = ("hip_pitch", "hip_roll", "hip_yaw", "knee", "ankle_pitch", "ankle_roll")
TORSO = ["torso_pitch", "torso_roll", "torso_yaw"]
LEFT_ARM = [f"l_{name}" for name in ARM]
RIGHT_ARM = [f"r_{name}" for name in ARM]
JOINTS = TORSO + LEFT_ARM + RIGHT_ARM + [f"l_{name}" for name in LEG] + [f"r_{name}" for name in LEG]
JETS = ["l_arm_jet_turbine", "r_arm_jet_turbine", "chest_l_jet_turbine", "chest_r_jet_turbine"]

# name: windows (start, end, command), [s]; signs of forward, up, nose-down pitch, counter-clockwise yaw.
TRAJECTORIES: dict[int, list[tuple[float, float, dict[str, float]]]] = {
    1: [
        (10, 15, {"up": 1}),
        (18, 23, {"front": 1}),
        (25, 30, {"pitch": 1}),
        (32, 35, {"up": -1}),
        (38, 40, {"yaw": 1}),
    ],
    2: [
        (10, 15, {"up": 1, "yaw": 1}),
        (15, 23, {"front": -1}),
        (23, 30, {"yaw": -1}),
        (30, 35, {"front": 1}),
        (35, 40, {"up": -1, "yaw": 1}),
    ],
    3: [
        (10, 15, {"up": 1}),
        (15, 23, {"front": 1}),
        (23, 25, {"up": -1}),
        (25, 30, {"front": -1}),
        (30, 38, {"front": -1}),
        (38, 42, {"up": -1}),
    ],
    4: [
        (10, 25, {"up": 1}),
        (25, 26, {"front": 1}),
        (26, 28, {"up": -1}),
        (28, 30, {"front": 1}),
        (30, 38, {"front": -1}),
        (38, 42, {"up": -1}),
    ],
    5: [
        (10, 13, {"up": 1, "yaw": 1}),
        (13, 23, {"up": 1, "yaw": -1}),
        (23, 30, {"yaw": -1}),
        (30, 35, {"front": 1}),
        (35, 43, {"up": -1, "yaw": 1}),
    ],
    6: [
        (10, 12, {"up": 1, "yaw": 1}),
        (12, 15, {"up": 1, "yaw": -1}),
        (15, 18, {"up": 1, "yaw": 1}),
        (18, 20, {"up": 1, "yaw": -1}),
        (20, 25, {"yaw": -1}),
        (25, 26, {"front": 1}),
        (26, 28, {"up": -1}),
        (28, 30, {"front": 1}),
        (30, 38, {"front": -1}),
        (38, 42, {"up": -1}),
    ],
}

P220 = {
    "K_T": 0.237755,
    "K_TT": -0.012799,
    "K_D": -0.860374,
    "K_DD": 0.023606,
    "K_TD": 0.008599,
    "B_U": 1.139026,
    "B_T": 0.019914,
    "B_D": -0.050257,
    "B_UU": 0.000302,
    "c": -0.692913,
}


def windows(trajectory: int) -> list[dyn.CommandWindow]:
    """Command windows of one of the six trajectories."""
    return [dyn.CommandWindow(start=a, end=b, **signs) for a, b, signs in TRAJECTORIES[trajectory]]


def gains() -> dyn.Gains:
    """As published."""
    return dyn.Gains(
        momentum_proportional=1.5,
        momentum_derivative=2.5 * 1.5**0.5,
        momentum_integral=10.0,
        attitude_proportional=50.0,
        attitude_derivative=2.0 * 50.0**0.5,
        posture=np.array([30.0] * 3 + [20.0] * 8 + [30.0] * 12),
        torque_proportional=2.0 * 50.0**0.5,
        torque_integral=50.0,
    )


def weights() -> dyn.Weights:
    """As published."""
    return dyn.Weights(
        momentum=10.0,
        constant_inertia=150.0,
        posture=2.5,
        joint_velocity=10.0,
        thrust_rate=0.01,
        thrust_symmetry=0.1,
        regularization=1e-4,
        torque=1.1e-3,
    )


def settings(trajectory: int = 1) -> dyn.FlightSettings:
    """Settings of the published study on one trajectory, integrator jets, 8 ms explicit Euler."""
    base_pose = np.diag([-1.0, -1.0, 1.0, 1.0])
    base_pose[2, 3] = 0.8
    arm = [-0.1745, 0.4363, 0.6981, 0.2618]
    initial_joints = [0.1744, 0.0007, 0.0001, *arm, *arm]
    initial_joints += [0.0003, 0.0, -0.0001, 0.0004, -0.0004, 0.0003]
    initial_joints += [0.0002, 0.0001, -0.0002, 0.0004, -0.0005, 0.0003]
    torso_range = [(-18, 45), (-23, 23), (-43, 43)]
    arm_range = [(12, 163), (-175, 20), (-50, 80), (-3, 75)]
    leg_range = [(-10, 112), (-45, 115), (-80, 80), (-45, 45), (-70, 5), (-25, 25)]
    ranges = np.deg2rad(np.array(torso_range + 2 * arm_range + 2 * leg_range, dtype=float))
    return dyn.FlightSettings(
        step=0.008,
        duration=42.0,
        initial_free_fall=True,
        command_speeds=dyn.CommandSpeeds(
            front=0.9375, left=0.3125, up=0.9375, roll=np.deg2rad(18.75), pitch=np.deg2rad(43.75), yaw=np.deg2rad(43.75)
        ),
        reference=dyn.ReferenceSettings(
            roll_min=np.deg2rad(-5.0),
            roll_max=np.deg2rad(5.0),
            pitch_min=np.deg2rad(-30.0),
            com_time=1.5,
            jerk_time=0.005,
            rotation_gain=1.0,
            angular_velocity_time=0.05,
        ),
        joints=JOINTS,
        actuators=[dyn.Actuator(frame=frame, thrust_max=250.0, thrust_rate=200.0) for frame in JETS],
        base_pose=base_pose,
        initial_joints=np.array(initial_joints),
        initial_thrusts=np.full(4, 175.0),
        trajectory=windows(trajectory),
        symmetry_pairs=[(0, 1), (2, 3)],
        gains=gains(),
        weights=weights(),
        limits=dyn.Limits(
            joint_lower=ranges[:, 0],
            joint_upper=ranges[:, 1],
            joint_range_scale=np.array([0.7] * 3 + [0.8] * 8 + [0.5] * 12),
            joint_speed=np.deg2rad(45.0),
            joint_slope=10.0,
            thrust_slope=2.0,
            torque=50.0,
            torque_rate=300.0,
        ),
        groups=[
            dyn.JointGroup(name="torso", joints=TORSO, weight=2.0),
            dyn.JointGroup(name="left_arm", joints=LEFT_ARM),
            dyn.JointGroup(name="right_arm", joints=RIGHT_ARM),
        ],
        failure=dyn.FailureLimits(com_error=2.0, attitude_error=0.5 * np.pi, joint_speed=50.0),
        contact_points=[
            dyn.ContactPoint(frame=frame, position=np.array([x, y, 0.0]))
            for frame in ("l_sole", "r_sole")
            for x in (-0.06, 0.11)
            for y in (0.04, -0.035)
        ],
    )
