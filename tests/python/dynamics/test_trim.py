"""Trim for hover: balance, nearness, ranges, and what cannot hover."""

import numpy as np
import pytest

import codesign
import ironcub_flight
from codesign import dynamics as dyn
from codesign.errors import UnknownNameError

ARMS = ironcub_flight.LEFT_ARM + ironcub_flight.RIGHT_ARM


@pytest.fixture(scope="module")
def robot() -> dyn.Model:
    urdf = codesign.load_study("ironcub_paper").build_robot({"angle": 15, "distance": 42, "offset": 80, "length": 108})
    return dyn.load_urdf(urdf, joints=ironcub_flight.JOINTS)


def ranges(robot: dyn.Model) -> tuple[np.ndarray, np.ndarray]:
    limits = [robot.joint_limits[name] for name in robot.joint_names]
    return np.array([limit["lower"] for limit in limits]), np.array([limit["upper"] for limit in limits])


def trim(robot: dyn.Model, moving=ARMS, lower=None, upper=None, actuators=None, **options) -> dyn.Trim:
    settings = ironcub_flight.settings()
    base_pose = np.eye(4)
    base_pose[2, 3] = 0.8
    low, high = ranges(robot)
    return dyn.trim_hover(
        robot,
        actuators or settings.actuators,
        base_pose,
        settings.initial_joints,
        moving=moving,
        joint_lower=low if lower is None else lower,
        joint_upper=high if upper is None else upper,
        **options,
    )


def unbalanced(robot: dyn.Model, found: dyn.Trim) -> np.ndarray:
    """Force and moment about the base origin that thrusts and weight leave over, from inverse dynamics at rest."""
    needed = dyn.gravity_forces(robot, found.base_pose, found.joints)[:6]
    for frame, thrust in zip(ironcub_flight.JETS, found.thrusts, strict=True):
        pose = dyn.frame_pose(robot, found.base_pose, found.joints, frame)
        force = -thrust * pose[:3, 2]
        needed -= np.concatenate([force, np.cross(pose[:3, 3] - found.base_pose[:3, 3], force)])
    return needed


def test_thrusts_carry_the_weight_without_a_moment(robot):
    found = trim(robot)
    assert found.reached
    assert np.abs(unbalanced(robot, found)).max() < 1e-9
    low, high = ranges(robot)
    moving = [robot.joint_names.index(name) for name in ARMS]
    assert (found.joints[moving] >= low[moving]).all()
    assert (found.joints[moving] <= high[moving]).all()


def test_agrees_with_an_independent_solution_of_the_same_problem(robot):
    # Angles to the digits that an independent program prints; its thrusts are of other chest inertials.
    found = trim(robot)
    arms = np.rad2deg(found.joints[3:11])
    assert arms == pytest.approx([-6.81, 23.96, 41.50, 12.62, -6.78, 23.88, 41.51, 12.68], abs=0.006)
    assert np.rad2deg(np.arcsin(-found.base_pose[2, 0])) == pytest.approx(2.83, abs=0.005)
    assert found.thrusts == pytest.approx([178.78, 179.17, 163.98, 164.46], abs=0.08)


def cost(found: dyn.Trim, tilt: np.ndarray) -> float:
    moved = found.joints - ironcub_flight.settings().initial_joints
    return float(moved @ moved + 9.0 * tilt @ tilt + 9e-6 * ((found.thrusts - found.thrusts.mean()) ** 2).sum())


def test_is_the_nearest_hover(robot):
    # Where a joint is held elsewhere, the rest balances at a higher cost; quadratically for a small change.
    best = trim(robot)
    tilt = lambda found: np.array([found.base_pose[2, 1], -found.base_pose[2, 0]])  # noqa: E731
    low, high = ranges(robot)
    elbow = robot.joint_names.index("l_elbow")
    rises = []
    for change in (-0.02, -0.01, 0.01, 0.02):
        lower, upper = low.copy(), high.copy()
        lower[elbow], upper[elbow] = best.joints[elbow] + change, best.joints[elbow] + change + 1e-12
        held = trim(robot, lower=lower, upper=upper)
        assert held.reached
        rises.append(cost(held, tilt(held)) - cost(best, tilt(best)))
    assert min(rises) > 0.0
    assert rises[0] / rises[1] == pytest.approx(4.0, rel=0.1)
    assert rises[3] / rises[2] == pytest.approx(4.0, rel=0.1)


def test_what_cannot_hover_is_said(robot):
    weak = ironcub_flight.settings().actuators
    for jet in weak:
        jet.thrust_max = 150.0
    found = trim(robot, actuators=weak)
    assert not found.reached
    assert found.residual >= robot.total_mass * 9.81 - 600.0
    assert (found.thrusts <= 150.0).all()


def test_refuses_what_does_not_fit(robot):
    with pytest.raises(UnknownNameError, match="elbo"):
        trim(robot, moving=["elbo"])
    with pytest.raises(ValueError, match="one value per joint of the model"):
        trim(robot, lower=np.zeros(3))
    with pytest.raises(ValueError, match="range of a joint is empty"):
        trim(robot, lower=np.full(23, 9.0))
    with pytest.raises(ValueError, match="must be positive"):
        trim(robot, tilt_weight=0.0)
