"""A flight with joints that mimic others: its plant is that of the equivalent equations of motion, and of MuJoCo."""

import mujoco
import numpy as np
import pytest

from codesign import dynamics as dyn
from codesign.chain.chain import build_robot
from codesign.chain.flight import find_trajectory, flight_settings
from codesign.chain.study import load_study
from codesign.robot.description import RobotDescription
from codesign.robot.formats.mjcf import mjcf_text
from codesign.transforms import quaternion

FOLLOWS = {"rear_pitch": ("front_pitch", -0.8, 0.05), "right_roll": ("left_roll", -1.0, 0.0)}


@pytest.fixture(scope="module")
def flown() -> tuple[RobotDescription, dyn.Model, dyn.FlightSettings, dyn.FlightLog]:
    """The shipped quadrotor with two of its eight gimbal joints geared to the opposite ones."""
    study = load_study("gimbal_quad")
    design = study.space.design({"reach": 200, "height": 30})
    config = study.configured(design)
    robot = build_robot(study, design)
    for name, (other, ratio, offset) in FOLLOWS.items():
        mimic = {"joint": other, "multiplier": str(ratio), "offset": str(offset)}
        robot = robot.edited("joint", name, lambda joint, mimic=mimic: joint.append(joint.makeelement("mimic", mimic)))
    settings = flight_settings(config.flight, find_trajectory(config, config.flight.trajectory))
    kept = [k for k, name in enumerate(settings.joints) if name not in FOLLOWS]
    gains, limits, (group,) = settings.gains, settings.limits, settings.groups
    gains.posture = gains.posture[kept]
    for name in ("joint_lower", "joint_upper", "joint_range_scale"):
        setattr(limits, name, getattr(limits, name)[kept])
    group.joints = [name for name in group.joints if name not in FOLLOWS]
    settings.joints, settings.initial_joints = list(group.joints), settings.initial_joints[kept]
    settings.gains, settings.limits, settings.groups = gains, limits, [group]
    settings.integrator, settings.substeps, settings.duration = dyn.Integrator.runge_kutta_4, 8, 6.0
    settings.rotation_deadband = 0.0
    model = dyn.load_urdf(robot.to_text(), joints=settings.joints)
    return robot, model, settings, dyn.simulate_flight(model, settings)


def state(log: dyn.FlightLog, k: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    base = np.eye(4)
    base[:3, :3], base[:3, 3] = log.base_rotation[k], log.base_position[k]
    return base, log.joint_positions[k], log.velocity[k]


def test_it_flies_and_the_followers_follow(flown):
    robot, model, settings, log = flown
    assert log.status == dyn.FlightStatus.completed
    assert model.joint_names == settings.joints
    assert np.ptp(log.joint_positions[:, settings.joints.index("front_pitch")]) > 0.01
    assert log.base_position[-1, 2] > 1.5  # it rose as commanded
    for k in range(0, log.samples, 100):
        base, s, _ = state(log, k)
        poses = robot.frame_poses(dict(zip(settings.joints, s, strict=True)))
        for frame in ("rear_jet", "right_jet"):
            np.testing.assert_allclose(dyn.frame_pose(model, base, s, frame), base @ poses[frame], atol=1e-12)


def test_energy_changes_by_the_work_of_jets_and_motors(flown):
    """Thrusts and torques are held over a sample; the jets' work by the trapezoidal rule."""
    _, model, settings, log = flown
    changes, works = [], []
    for k in range(1, log.samples - 1):
        (a, s, v), (b, s_next, v_next) = state(log, k), state(log, k + 1)
        energies = [
            dyn.kinetic_energy(model, pose, joints, speed) + dyn.potential_energy(model, pose, joints)
            for pose, joints, speed in ((a, s, v), (b, s_next, v_next))
        ]
        changes.append(energies[1] - energies[0])
        work = log.torque[k] @ (s_next - s)
        for number, jet in enumerate(settings.actuators):
            for pose, joints, speed in ((a, s, v), (b, s_next, v_next)):
                axis = dyn.frame_pose(model, pose, joints, jet.frame)[:3, :3] @ jet.axis
                velocity = dyn.frame_velocity(model, pose, joints, speed, jet.frame)[:3]
                work += 0.5 * settings.step * log.thrust[k, number] * (axis @ velocity)
        works.append(work)
    changes, works = np.array(changes), np.array(works)
    assert np.abs(changes - works).max() < 1e-4 * np.abs(changes).max()
    assert changes.sum() == pytest.approx(works.sum(), rel=1e-5)


def test_mujoco_moves_on_as_flown(flown):
    """Accelerations with the sample's thrusts and torques; to 2e-4 of what the joints would do without equalities."""
    robot, model, settings, log = flown
    other = mujoco.MjModel.from_xml_string(mjcf_text(robot, settings, {}))
    other.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT | mujoco.mjtDisableBit.mjDSBL_LIMIT
    data, worst = mujoco.MjData(other), 0.0
    for k in range(1, log.samples - 1, 50):
        base, s, v = state(log, k)
        R = base[:3, :3]
        angles, speeds = dict(zip(settings.joints, s, strict=True)), dict(zip(settings.joints, v[6:], strict=True))
        for name, (followed, ratio, offset) in FOLLOWS.items():
            angles[name], speeds[name] = ratio * angles[followed] + offset, ratio * speeds[followed]
        data.qpos[:7], data.qvel[:6] = [*base[:3, 3], *quaternion(R)], [*v[:3], *(R.T @ v[3:6])]
        for name, angle in angles.items():
            data.joint(name).qpos, data.joint(name).qvel = angle, speeds[name]
        for number, jet in enumerate(settings.actuators):
            data.act[other.actuator(jet.frame).actadr] = log.thrust[k, number]
        for number, name in enumerate(settings.joints):
            data.ctrl[other.actuator(name).id] = log.torque[k, number]
        mujoco.mj_forward(other, data)
        wrench = np.concatenate([np.zeros(6), log.torque[k]])
        for number, jet in enumerate(settings.actuators):
            axis = dyn.frame_pose(model, base, s, jet.frame)[:3, :3] @ jet.axis
            wrench += dyn.frame_jacobian(model, base, s, jet.frame)[:3].T @ (log.thrust[k, number] * axis)
        expected = np.linalg.solve(dyn.mass_matrix(model, base, s), wrench - dyn.bias_forces(model, base, s, v))
        found = [*data.qacc[:3], *(data.joint(name).qacc[0] for name in settings.joints)]
        own = [*expected[:3], *expected[6:]]
        worst = max(worst, np.abs(np.subtract(found, own)).max() / np.abs(data.qacc_smooth).max())
    assert worst < 2e-4
