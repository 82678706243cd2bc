"""The shipped hexarotor: its arms, its propellers, its flights, and the numbers of its own."""

import math
import tomllib

import numpy as np
import pytest

from codesign.chain.fly import fly_robot
from codesign.chain.study import load_study
from codesign.robot.description import RobotDescription
from codesign.studies.hexarotor import propeller
from codesign.studies.hexarotor.arm import Arm
from codesign.study.loading import STUDIES

DESIGN = {"propeller": "11in", "tilt": 25, "tube": "16x2"}
CHOICES = tomllib.loads((STUDIES / "hexarotor" / "study.toml").read_text())["variables"]["propeller"]["choices"]


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
@pytest.mark.parametrize("size", ["8in", "13in"])
def test_it_flies(study, trajectory, size):
    flown = fly_robot(study, study.build_robot(DESIGN | {"propeller": size}), trajectory)
    assert flown["status"] == "completed"
    assert flown["flight"]["max_attitude_error"] < 0.05
    assert flown["flight"]["max_com_error"] < 0.5
    assert 0.2 <= flown["flight"]["min_thrust"] <= flown["flight"]["max_thrust"] <= propeller.MAX_THRUST


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
    limit = study.config.constraints.limits["tracking"].maximum
    assert tracking[30] < limit < tracking[20]


def test_an_arm_with_its_motor_swings_as_rayleigh_says(study):
    design = {"propeller": "8in", "tilt": 15, "tube": "12x2"}
    arm = study.evaluate(design).parts["arm"]
    stiffness = 260.0 / arm["cases"]["landing"]["max_displacement"]
    moving = CHOICES["8in"]["parts.arm.masses.0.mass_kg"] + 33.0 / 140.0 * arm["mass"]  # and of a cantilever's own
    assert arm["first_frequency"] == pytest.approx(math.sqrt(stiffness / moving) / (2.0 * math.pi), rel=0.05)
    assert arm["tolerance_reached"]


def test_landing_decides_for_long_arms_on_tubes_that_are_stiff_enough(study):
    """A twentieth more than the limit of the frequency, and too weak."""
    evaluation = study.evaluate({"propeller": "13in", "tilt": 25, "tube": "20x2"})
    assert evaluation.status == "infeasible"
    assert [key for key, margin in evaluation.margins.items() if margin < 0.0] == ["safety_factor"]


def test_propellers_of_the_study_are_those_of_the_relation():
    assert list(CHOICES) == [f"{inches}in" for inches in range(8, 14)]
    for name, written in CHOICES.items():
        printed = tomllib.loads(propeller.choice(int(name.removesuffix("in"))))
        assert printed["variables"]["propeller"]["choices"][name] == written


def test_propellers_obey_momentum_theory_and_similarity():
    thrust, size = 5.0, 0.254
    ideal = thrust * math.sqrt(thrust / (2.0 * propeller.AIR_DENSITY * math.pi / 4.0 * size**2))
    assert propeller.power(thrust, size) == pytest.approx(ideal / propeller.FIGURE_OF_MERIT)
    turning = 2.0 * math.pi * propeller.revolutions(thrust, size) * propeller.drag_torque(size) * thrust
    assert propeller.power(thrust, size) == pytest.approx(turning)
    assert propeller.power(thrust, size) / propeller.power(thrust, 2.0 * size) == pytest.approx(2.0)
    assert propeller.revolutions(thrust, size) / propeller.revolutions(thrust, 2.0 * size) == pytest.approx(4.0)


@pytest.mark.parametrize("size", ["8in", "13in"])
def test_mass_and_disk_of_the_rotors_follow_the_propeller(study, size):
    robot = RobotDescription.from_text(study.build_robot(DESIGN | {"propeller": size}))
    written, poses = CHOICES[size], robot.frame_poses()
    for k in range(1, 7):
        body = robot.inertial(f"rotor_{k}")
        assert body.mass == written["parts.arm.masses.0.mass_kg"]
        assert body.com[2] == pytest.approx(1e-3 * written["parts.arm.masses.0.point_mm.2"])
        disk = robot.link(f"rotor_{k}").visuals[1].geometry.cylinder
        assert 2e3 * disk.radius == pytest.approx(written["diameter"])
    angle = np.linspace(0.0, 2.0 * np.pi, 361)
    rim, above = 0.5e-3 * written["diameter"], propeller.PROPELLER_HEIGHT * 1e-3 * written["diameter"]
    circle = np.stack([rim * np.cos(angle), rim * np.sin(angle), np.full(361, above), np.ones(361)])
    rims = [(poses[f"rotor_{k}"] @ circle)[:3].T for k in range(1, 7)]
    gaps = [np.linalg.norm(rims[k][:, None] - rims[(k + 1) % 6], axis=2).min() for k in range(6)]
    assert propeller.TIP_GAP - 1e-4 <= min(gaps) <= propeller.TIP_GAP + 0.008  # 5 mm steps, other tilts, thinner tubes


def test_rotors_of_neighbors_keep_the_clearance_at_every_tilt(study):
    tilts = study.config.variables["tilt"]
    assert (tilts.minimum, tilts.maximum) == propeller.TILTS
    limit = 1e-3 * study.config.constraints.body_clearance_min_mm
    assert limit < propeller.TIP_GAP - 0.004  # disks are drawn 4 mm thick


def test_own_numbers_are_those_of_the_flight(study):
    document = {
        "design": {"propeller": "10in"},
        "flight": {"thrust_impulse": 6 * 5.0 * 12.0, "duration": 12.0},
        "parts": {"arm": {"mass": 0.07, "first_frequency": 120.0}},
    }
    assert propeller.power_in_watts(document) == pytest.approx(6 * propeller.power(5.0, 0.254))
    assert propeller.mass_in_kg(document) == pytest.approx(6 * (0.07 + 0.0971), abs=1e-3)
    assert propeller.frequency_over_revolutions(document) == pytest.approx(
        120.0 / propeller.revolutions(5.0, 0.254), abs=0.025
    )
