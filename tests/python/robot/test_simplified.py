"""Robots without frames, with tiny inertials, with exact axes: what else they say stays as it was."""

import math

import numpy as np
import pytest

from codesign.robot.description import RobotDescription
from codesign.robot.formats.simplified import (
    TINY_MASS,
    Simplification,
    simplified,
    with_exact_axes,
    with_tiny_inertials,
    without_frames,
)

MASS = '<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>'
BALL = '<visual><geometry><sphere radius="1"/></geometry></visual>'
LINKS = {"base": MASS, "arm": MASS, "sole": "", "tip": "", "jet": "", "drawn": BALL, "cross": "", "hand": MASS}
JOINTS = (
    ("shoulder", "revolute", "base", "arm", "0 0 0.5", "0 0 1.5707964", "3.3e-7 0.9999999999999344 1.4e-7"),
    ("to_sole", "fixed", "base", "sole", "0 0 1", "0 0 0", ""),
    ("to_tip", "fixed", "sole", "tip", "0 0 1", "0 0 0", ""),
    ("to_jet", "fixed", "arm", "jet", "1 0 0", "0 0 0", ""),
    ("to_drawn", "fixed", "arm", "drawn", "0 0 0", "0 0 0", ""),
    ("roll", "revolute", "arm", "cross", "2 0 0", "0 0 0", "1 0 0"),
    ("pitch", "revolute", "cross", "hand", "40 0 0", "0 1e-6 0", "0 1 1e-3"),
)


@pytest.fixture
def robot() -> RobotDescription:
    text = "".join(f'<link name="{name}">{inside}</link>' for name, inside in LINKS.items())
    for name, kind, parent, child, xyz, rpy, axis in JOINTS:
        inside = f'<axis xyz="{axis}"/><limit lower="-2" upper="2" effort="1" velocity="1"/>' if axis else ""
        text += (
            f'<joint name="{name}" type="{kind}"><origin xyz="{xyz}" rpy="{rpy}"/><parent link="{parent}"/>'
            f'<child link="{child}"/>{inside}</joint>'
        )
    return RobotDescription.from_text(f'<robot name="r">{text}<transmission name="t"/></robot>')


def test_frames_go_but_for_jets_and_what_carries_something(robot):
    less = without_frames(robot, ["jet"])
    assert less.link_names == ("base", "arm", "jet", "drawn", "cross", "hand")
    assert less.joint_names == ("shoulder", "to_jet", "to_drawn", "roll", "pitch")
    assert less.total_mass == robot.total_mass
    poses, before = less.frame_poses({"roll": 0.3}), robot.frame_poses({"roll": 0.3})
    for link in less.link_names:
        np.testing.assert_array_equal(poses[link], before[link])
    assert '<transmission name="t"' in less.to_text()


def test_tiny_inertials(robot):
    heavy = with_tiny_inertials(robot)
    for link in robot.link_names:
        mass = heavy.inertial(link).mass
        assert mass == (1.0 if robot.inertial(link) is not None else TINY_MASS)
    assert heavy.total_mass == pytest.approx(robot.total_mass, rel=1e-8)


def test_axes_and_frames_are_exact_where_nothing_moves(robot):
    rng = np.random.default_rng(1)
    postures = {name: rng.uniform(-1, 1, 20) for name in robot.moving_joint_names}
    exact, largest = with_exact_axes(robot, postures)
    assert 0.0 <= largest < 1e-6
    before, after = robot.frame_poses(postures), exact.frame_poses(postures)
    moved = max(np.abs(after[link] - before[link])[..., :3, 3].max() for link in robot.link_names)
    assert moved == largest
    # The shoulder's axis would move the hand, 42 m away, by more than 1e-6 m, its frame too.
    assert exact.joint("shoulder").axis.tolist() == robot.joint("shoulder").axis.tolist()
    assert math.isclose(exact.joint_origin("pitch")[0, 2], 0.0, abs_tol=1e-16)
    assert exact.joint("pitch").axis.tolist() == [0.0, 1.0, 1e-3]  # not meant to be exact
    near = robot.edited("joint", "pitch", lambda joint: joint.find("origin").set("xyz", "0.1 0 0"))
    exact, largest = with_exact_axes(near, postures)
    assert 0.0 < largest < 1e-6
    assert exact.joint("shoulder").axis.tolist() == [0.0, 1.0, 0.0]
    np.testing.assert_allclose(exact.joint_origin("shoulder")[:3, :3], [[0, -1, 0], [1, 0, 0], [0, 0, 1]], atol=1e-16)
    again, moved_again = with_exact_axes(exact, postures)
    assert (again.to_text(), moved_again) == (exact.to_text(), 0.0)


def test_words_and_choices(robot):
    postures = {name: np.zeros(1) for name in robot.moving_joint_names}
    same, words = simplified(robot, Simplification(), ["jet"], postures)
    assert (same, words) == (robot, "")
    less, words = simplified(robot, Simplification("drop", True), ["jet"], postures)
    assert "sole" not in less.link_names
    assert "none moves by more than" in words
