"""The shipped hexarotor: its arms, its propellers, its flights, and the numbers of its own."""

import math

import numpy as np
import pytest

from codesign.chain.fly import fly_robot
from codesign.chain.study import load_study
from codesign.robot.description import RobotDescription
from codesign.studies.hexarotor.arm import Arm
from codesign.studies.hexarotor.power import power_in_watts, propeller_diameter

DESIGN = {"length": 220, "tilt": 25, "tube": "16x2"}


@pytest.fixture(scope="module")
def study():
    return load_study("hexarotor")


def test_neighboring_rotors_tilt_to_opposite_sides(study):
    robot = RobotDescription.from_text(study.build_robot(DESIGN))
    poses = robot.frame_poses()
    axes = np.array([poses[f"rotor_{k}"][:3, 2] for k in range(1, 7)])
    np.testing.assert_allclose(axes[:, 2], np.cos(np.deg2rad(25.0)), atol=1e-12)
    np.testing.assert_allclose(axes.sum(axis=0)[:2], 0.0, atol=1e-12)
    radial = np.array([poses[f"rotor_{k}"][:3, 3] for k in range(1, 7)])
    turning = np.cross(radial, axes)[:, 2]  # moment about the vertical
    assert (np.sign(turning) == [1, -1, 1, -1, 1, -1]).all() or (np.sign(turning) == [-1, 1, -1, 1, -1, 1]).all()


def test_the_arm_weighs_what_its_solids_do():
    arm = Arm(length=200.0, tilt=0.0, diameter=16.0, wall=2.0)
    tube = np.pi * (8.0**2 - 6.0**2) * 216.0
    assert 1e9 * arm.mass_properties().volume > tube
    tilted = Arm(length=200.0, tilt=30.0, diameter=16.0, wall=2.0)
    assert tilted.mass_properties().mass == pytest.approx(arm.mass_properties().mass, rel=1e-5)


@pytest.mark.parametrize("trajectory", ["box", "gusts"])
def test_it_flies(study, trajectory):
    flown = fly_robot(study, study.build_robot(DESIGN), trajectory)
    assert flown["status"] == "completed"
    assert flown["flight"]["max_attitude_error"] < 0.05
    assert flown["flight"]["max_com_error"] < 0.5
    assert 0.2 <= flown["flight"]["min_thrust"] <= flown["flight"]["max_thrust"] <= 12.0


def test_tilt_costs_thrust_and_buys_nothing_in_lift(study):
    thrust = {
        tilt: fly_robot(study, study.build_robot(DESIGN | {"tilt": tilt}))["objectives"]["thrust"]
        for tilt in (15, 32.5)
    }
    assert thrust[32.5] / thrust[15] == pytest.approx(np.cos(np.deg2rad(15)) / np.cos(np.deg2rad(32.5)), rel=0.02)


def test_sideways_flight_needs_tilt(study):
    tracking = {
        tilt: fly_robot(study, study.build_robot(DESIGN | {"tilt": tilt}))["flight"]["tracking"]
        for tilt in (15, 20, 30)
    }
    assert tracking[15] > 1.5 * tracking[20] > 5.0 * tracking[30]


def test_an_arm_with_its_motor_swings_as_rayleigh_says(study):
    design = {"length": 280, "tilt": 15, "tube": "10x2"}
    arm = study.evaluate(design).parts["arm"]
    stiffness = 12.0 / arm["cases"]["thrust"]["max_displacement"]
    moving = 0.11 + 33.0 / 140.0 * arm["mass"]  # motor, and the share of a cantilever's own mass
    assert arm["first_frequency"] == pytest.approx(math.sqrt(stiffness / moving) / (2.0 * math.pi), rel=0.02)


def test_larger_propellers_take_less_power(study):
    assert propeller_diameter(0.16) == pytest.approx(0.22)
    hover = {"thrust_impulse": 6 * 5.0 * 12.0, "duration": 12.0}
    power = [power_in_watts({"design": {"length": length}, "flight": hover}) for length in (160, 320)]
    assert power[0] == pytest.approx(6 * 5.0 * math.sqrt(5.0 / (2 * 1.225 * math.pi * 0.11**2)) / 0.6)
    assert power[0] / power[1] == pytest.approx(0.38 / 0.22)  # by the disks' diameters
