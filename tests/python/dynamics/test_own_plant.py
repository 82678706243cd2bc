"""Flights around a plant of the caller's own: MuJoCo on the exported MJCF under the flight's controllers."""

import re

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

DESIGN = {
    "angle": 5,
    "distance": 62,
    "offset": 108,
    "length": 142,
    "bracket_material": "ergal",
    "forearm_material": "ti-6al-4v",
}


class MujocoPlant:
    """The robot of an MJCF text in MuJoCo, its joints other than the flown ones fixed; Runge-Kutta at 2 ms."""

    def __init__(self, robot: RobotDescription, settings: dyn.FlightSettings) -> None:
        text = robot.to_text()
        for name in set(robot.moving_joint_names) - set(settings.joints):
            text = re.sub(rf'(<joint name="{name}" type=)"revolute"', r'\1"fixed"', text)
        text = re.sub(r"<(visual|collision)\b.*?</\1>", "", text, flags=re.DOTALL)
        self.model = mujoco.MjModel.from_xml_string(mjcf_text(RobotDescription.from_text(text), settings, {}))
        self.model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_LIMIT
        self.model.opt.timestep = 0.002
        self.data = mujoco.MjData(self.model)
        self.base = self.model.body(robot.root_link).id
        positions = [self.model.joint(name).qposadr[0] for name in settings.joints]
        velocities = [self.model.joint(name).dofadr[0] for name in settings.joints]
        self.places = np.array(positions), np.array(velocities)
        self.jets = [self.model.actuator(jet.frame).id for jet in settings.actuators]
        self.motors = [self.model.actuator(name).id for name in settings.joints]

    def __call__(self, inputs: dyn.PlantInputs, duration: float, state: dyn.RobotState) -> dyn.RobotState:
        data, (positions, velocities), R = self.data, self.places, state.base_rotation
        data.qpos[:7] = [*state.base_position, *quaternion(R)]
        data.qvel[:6] = [*state.velocity[:3], *(R.T @ state.velocity[3:6])]
        data.qpos[positions], data.qvel[velocities] = state.joints, state.velocity[6:]
        data.ctrl[self.jets], data.ctrl[self.motors] = inputs.thrust, inputs.torque
        self._push(inputs.base_force, state)
        mujoco.mj_step(self.model, data, round(duration / self.model.opt.timestep))
        R = data.qpos[3:7].copy()
        turned = np.zeros(9)
        mujoco.mju_quat2Mat(turned, R)
        R = turned.reshape(3, 3)
        velocity = np.concatenate([data.qvel[:3], R @ data.qvel[3:6], data.qvel[velocities]])
        return dyn.RobotState(
            base_rotation=R, base_position=data.qpos[:3], joints=data.qpos[positions], velocity=velocity
        )

    def _push(self, force: np.ndarray, state: dyn.RobotState) -> None:
        """A force on the base's origin; MuJoCo's acts on the center of mass of the body."""
        arm = -state.base_rotation @ self.model.body_ipos[self.base]
        self.data.xfrc_applied[self.base] = [*force, *np.cross(arm, force)]


@pytest.fixture
def flown() -> tuple[RobotDescription, dyn.FlightSettings]:
    """The default study for 3 s without what is the plant's own: errors of mass and thrust, fuel."""
    study = load_study("ironcub")
    design = study.space.design(DESIGN)
    config = study.configured(design)
    settings = flight_settings(config.flight, find_trajectory(config, config.flight.trajectory))
    settings.duration, settings.tank, settings.rotation_deadband = 3.0, None, 0.0
    settings.disturbances.mass_deviation = settings.disturbances.thrust_deviation = 0.0
    return build_robot(study, design), settings


@pytest.mark.parametrize("gusts", [False, True])
def test_mujoco_under_these_controllers_flies_as_the_own_plant(flown, gusts):
    robot, settings = flown
    if not gusts:
        settings.disturbances.gust_deviation = np.zeros(3)
    model = dyn.load_urdf(robot.to_text(), joints=settings.joints)
    own = dyn.simulate_flight(model, settings)
    other = dyn.simulate_flight(model, settings, plant=MujocoPlant(robot, dyn.fitted_settings(model, settings)))
    assert own.status == other.status == dyn.FlightStatus.completed
    assert np.abs(own.joint_positions - own.joint_positions[0]).max() > 1e-3
    # MuJoCo holds the moment of a gust about the body's center over a step, this plant the point that it pushes.
    tolerance = 1e-6 if gusts else 1e-12
    assert np.abs(own.joint_positions - other.joint_positions).max() < tolerance  # rad
    assert np.abs(own.base_position - other.base_position).max() < tolerance  # m


def test_rotors_are_armatures(flown):
    robot, settings = flown
    plant = MujocoPlant(robot, settings)
    np.testing.assert_array_equal(plant.model.dof_armature[plant.places[1]], settings.rotor_inertia)
    assert np.all(settings.rotor_inertia > 0)


def test_what_a_plant_raises_ends_the_flight(flown):
    robot, settings = flown
    model = dyn.load_urdf(robot.to_text(), joints=settings.joints)

    def broken(inputs, duration, state):
        raise RuntimeError("the simulator is gone")

    with pytest.raises(RuntimeError, match="the simulator is gone"):
        dyn.simulate_flight(model, settings, plant=broken)

    def short(inputs, duration, state):
        return dyn.RobotState(
            base_rotation=state.base_rotation, base_position=state.base_position, joints=[0.0], velocity=state.velocity
        )

    with pytest.raises(ValueError, match="the plant returned 1 joint positions"):
        dyn.simulate_flight(model, settings, plant=short)

    settings.controller = dyn.Controller.predictive
    with pytest.raises(ValueError, match="momentum controller only"):
        dyn.simulate_flight(model, settings, plant=broken)


def test_a_plant_that_gives_no_numbers_loses_the_flight(flown):
    robot, settings = flown
    model = dyn.load_urdf(robot.to_text(), joints=settings.joints)

    def lost(inputs, duration, state):
        velocity = np.full_like(state.velocity, np.nan)
        return dyn.RobotState(
            base_rotation=state.base_rotation,
            base_position=state.base_position,
            joints=state.joints,
            velocity=velocity,
        )

    log = dyn.simulate_flight(model, settings, plant=lost)
    assert log.status == dyn.FlightStatus.failed
    assert "finite" in log.failure_reason
