"""The exported MJCF in MuJoCo is the exported URDF in Pinocchio, and flies as flown."""

import re

import mujoco
import numpy as np
import pytest

from codesign import dynamics as dyn
from codesign.robot.description import RobotDescription
from codesign.robot.formats.mjcf import mjcf_text
from codesign.transforms import quaternion
from exported_robots import ORIGINAL, Exported, export_robot, random_design
from robot_readers import differences
from robot_readers import mujoco as mujoco_reader

POSTURES = 10


@pytest.fixture(scope="module", params=ORIGINAL)
def exported(request, tmp_path_factory) -> Exported:
    return export_robot(request.param, ORIGINAL[request.param], tmp_path_factory.mktemp("export") / "robot")


def load(exported):
    model = mujoco.MjModel.from_xml_path(str(exported.folder / "robot.xml"))
    return model, mujoco.MjData(model)


def test_masses_frames_and_gravity_are_those_of_the_urdf(exported):
    assert {
        name: value for name, value in differences(exported, mujoco_reader(exported), POSTURES).items() if value > 1e-11
    } == {}


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(10))
@pytest.mark.parametrize("study", ORIGINAL)
def test_random_designs_agree(study, seed, tmp_path):
    exported = export_robot(study, random_design(study, seed), tmp_path / "robot", duration=1.0)
    assert {
        name: value for name, value in differences(exported, mujoco_reader(exported), POSTURES).items() if value > 1e-11
    } == {}


def test_the_start_is_in_the_file(exported):
    model, data = load(exported)
    settings = exported.settings
    mujoco.mj_resetDataKeyframe(model, data, model.key("start").id)
    mujoco.mj_forward(model, data)
    np.testing.assert_array_equal(data.qpos[:3], settings.base_pose[:3, 3])
    np.testing.assert_allclose(data.xmat[1].reshape(3, 3), settings.base_pose[:3, :3], atol=1e-15)
    for name in exported.joints:
        angles = dict(zip(settings.joints, settings.initial_joints, strict=True))
        assert data.joint(name).qpos[0] == angles.get(name, 0.0)
        limit = exported.robot.joint(name).limit
        np.testing.assert_array_equal(model.joint(name).range, [limit.lower, limit.upper])
    np.testing.assert_array_equal(data.act, settings.initial_thrusts)


def test_jets_push_as_flown(exported):
    model, data = load(exported)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    for jet, thrust in zip(exported.settings.actuators, exported.settings.initial_thrusts, strict=True):
        actuator = model.actuator(jet.frame)
        np.testing.assert_array_equal(actuator.actrange, [jet.thrust_min, jet.thrust_max])
        np.testing.assert_array_equal(actuator.ctrlrange, [-jet.thrust_rate, jet.thrust_rate])
        assert data.actuator(jet.frame).force[0] == thrust
        jacobian = np.zeros((3, model.nv))
        site = model.site(f"{jet.frame}_jet").id
        mujoco.mj_jacSite(model, data, jacobian, None, site)
        dense = np.zeros((model.nu, model.nv))
        mujoco.mju_sparse2dense(dense, data.actuator_moment, data.moment_rownnz, data.moment_rowadr, data.moment_colind)
        moment = dense[actuator.id]
        axis = data.site_xmat[site].reshape(3, 3) @ jet.axis
        np.testing.assert_allclose(moment, jacobian.T @ axis, atol=1e-14)


def test_no_contacts_where_the_robot_flies(exported):
    model, data = load(exported)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    assert data.ncon == 0
    for k in range(0, exported.log.samples, 25):
        for number, name in enumerate(exported.settings.joints):
            data.joint(name).qpos = exported.log.joint_positions[k, number]
        mujoco.mj_forward(model, data)
        assert data.ncon == 0
    every = mjcf_text(exported.robot, exported.settings, {})
    (exported.folder / "colliding.xml").write_text(every)
    model = mujoco.MjModel.from_xml_path(str(exported.folder / "colliding.xml"))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    overlapping = [pair for pair, reason in exported.ignored.items() if reason == "Default"]
    assert (data.ncon > 0) == bool(overlapping)


def test_every_sample_follows_from_the_one_before(exported):
    """Contacts and limits off, joints that the flight holds fixed; the flight's thrusts and torques held."""
    settings, log = exported.settings, exported.log
    text = exported.robot.to_text()
    for name in set(exported.joints) - set(settings.joints):
        text = re.sub(rf'(<joint name="{name}" type=)"revolute"', r'\1"fixed"', text)
    (exported.folder / "flown.xml").write_text(mjcf_text(RobotDescription.from_text(text), settings, exported.ignored))
    model = mujoco.MjModel.from_xml_path(str(exported.folder / "flown.xml"))
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT | mujoco.mjtDisableBit.mjDSBL_LIMIT
    data = mujoco.MjData(model)
    steps = round(settings.step / model.opt.timestep)
    assert steps == settings.substeps

    def state(k):
        R = log.base_rotation[k]
        data.qpos[:7] = [*log.base_position[k], *quaternion(R)]
        data.qvel[:6] = [*log.velocity[k, :3], *(R.T @ log.velocity[k, 3:6])]
        for number, name in enumerate(settings.joints):
            data.joint(name).qpos = log.joint_positions[k, number]
            data.joint(name).qvel = log.velocity[k, 6 + number]
        return data.qpos.copy(), data.qvel.copy()

    for k in range(1, log.samples - 1, 7):
        expected = state(k + 1)
        state(k)
        for number, jet in enumerate(settings.actuators):
            assert isinstance(jet.dynamics, dyn.RateIntegrator)
            data.act[model.actuator(jet.frame).actadr] = log.thrust[k, number]
            data.ctrl[model.actuator(jet.frame).id] = 0.0
        for number, name in enumerate(settings.joints):
            data.ctrl[model.actuator(name).id] = log.torque[k, number]
        mujoco.mj_step(model, data, steps)
        np.testing.assert_allclose(data.qpos[:3], expected[0][:3], atol=1e-11)
        turned = np.sign(data.qpos[3:7] @ expected[0][3:7])
        np.testing.assert_allclose(turned * data.qpos[3:7], expected[0][3:7], atol=1e-11)
        np.testing.assert_allclose(data.qpos[7:], expected[0][7:], atol=1e-11)
        np.testing.assert_allclose(data.qvel, expected[1], atol=1e-9)


def test_lags_and_turbines_and_reactions():
    """A lag follows its command, a turbine's thrust is its control; a reaction turns about the axis of the thrust."""
    text = "".join(
        f'<link name="{name}"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'
        "</inertial></link>"
        for name in ("base", "jet")
    )
    text += '<joint name="j" type="fixed"><parent link="base"/><child link="jet"/></joint>'
    robot = RobotDescription.from_text(f'<robot name="r">{text}</robot>')
    settings = dyn.FlightSettings()
    settings.initial_thrusts = np.array([4.0])
    up = {"frame": "jet", "axis": np.array([0.0, 0.0, 1.0]), "reaction": 0.25, "thrust_max": 10.0, "thrust_rate": 5.0}
    for dynamics in (dyn.FirstOrderLag(time=0.1), dyn.Turbine()):
        settings.actuators = [dyn.Actuator(dynamics=dynamics, **up)]
        model = mujoco.MjModel.from_xml_string(mjcf_text(robot, settings, {}))
        data = mujoco.MjData(model)
        mujoco.mj_resetDataKeyframe(model, data, 0)
        mujoco.mj_forward(model, data)
        np.testing.assert_allclose(data.qfrc_actuator, [0, 0, 4.0, 0, 0, 1.0], atol=1e-15)
        np.testing.assert_array_equal(model.actuator("jet").ctrlrange, [0.0, 10.0])
        assert model.na == (1 if isinstance(dynamics, dyn.FirstOrderLag) else 0)
        data.ctrl[0] = 8.0
        mujoco.mj_step(model, data, 100)
        mujoco.mj_forward(model, data)
        expected = 8.0 - 4.0 * np.exp(-1.0) if model.na else 8.0
        assert data.actuator("jet").force[0] == pytest.approx(expected, rel=1e-8)


def mimicking():
    """A lead and a follower on a base, 1 kg each."""
    inertial = '<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>'
    text = "".join(f'<link name="{name}">{inertial}</link>' for name in ("base", "lead", "follower"))
    for name, inside in (("lead", ""), ("follower", '<mimic joint="lead" multiplier="-2" offset="0.3"/>')):
        text += (
            f'<joint name="{name}" type="continuous"><parent link="base"/><child link="{name}"/>'
            f'<origin xyz="0.5 0 0"/><axis xyz="0 0 1"/>{inside}</joint>'
        )
    return RobotDescription.from_text(f'<robot name="m">{text}</robot>')


def test_mimic_joints_are_equalities_without_motor():
    settings = dyn.FlightSettings()
    settings.joints, settings.initial_joints = ["lead"], np.array([0.2])
    model = mujoco.MjModel.from_xml_string(mjcf_text(mimicking(), settings, {}))
    data = mujoco.MjData(model)
    assert [model.actuator(k).name for k in range(model.nu)] == ["lead"]
    mujoco.mj_resetDataKeyframe(model, data, 0)
    assert data.joint("follower").qpos[0] == -2 * 0.2 + 0.3
    mujoco.mj_forward(model, data)
    assert np.abs(data.efc_pos).max() < 1e-15
    assert data.nefc == 1
