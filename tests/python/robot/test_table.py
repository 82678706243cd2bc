"""The shipped robot: made from its table, figures as published, physical."""

from pathlib import Path

import msgspec
import numpy as np
import pytest

from codesign.errors import UrdfError
from codesign.robot.description import RobotDescription
from codesign.robot.table import generated_urdf, load_table, main, urdf_from_table
from codesign.studies import ironcub

FOLDER = Path(ironcub.__file__).parent
REPAIRED = ("l_arm_jet_turbine", "r_arm_jet_turbine")
TORSO = ["torso_pitch", "torso_roll", "torso_yaw"]
ARM = ["shoulder_pitch", "shoulder_roll", "shoulder_yaw", "elbow"]
LEG = ["hip_pitch", "hip_roll", "hip_yaw", "knee", "ankle_pitch", "ankle_roll"]
JOINTS = [*TORSO, *(f"{side}_{joint}" for limb in (ARM, LEG) for side in "lr" for joint in limb)]

TINY = """
name = "tiny"
[materials]
grey = [0.5, 0.5, 0.5, 1]
[[links]]
name = "base"
mass = 1
com = [0, 0, 0]
inertia = { xx = 1, yy = 1, zz = 1, xy = 0, xz = 0, yz = 0 }
shapes = [{ sphere = 0.1, material = "grey" }, { cylinder = [0.1, 0.3], rpy_deg = [90, 0, 0] }]
[[links]]
name = "arm"
joint = { name = "j", type = "revolute", parent = "base", xyz = [0.1, 0, 0], axis = [0, 0, 2], limits_deg = [-90, 180] }
"""


@pytest.fixture(scope="module")
def shipped():
    return RobotDescription.load(FOLDER / "robot.urdf")


@pytest.fixture(scope="module")
def published(shared_data):
    return RobotDescription.load(shared_data / "published" / "base_robot.urdf", as_published=True)


def test_shipped_urdf_is_what_the_table_says():
    assert (FOLDER / "robot.urdf").read_text() == generated_urdf(FOLDER / "robot.toml")


def test_shipped_robot_has_the_joints_jets_soles_and_part_links(shipped):
    assert set(shipped.moving_joint_names) == {*JOINTS, "neck_pitch", "neck_roll", "neck_yaw"}
    frames = {"l_sole", "r_sole", *REPAIRED, "chest_l_jet_turbine", "chest_r_jet_turbine"}
    parts = {"chest_l_bracket", "chest_r_bracket", "l_forearm", "r_forearm"}
    assert frames | parts <= set(shipped.link_names)
    assert shipped.root_link == "root_link"


def test_every_link_with_mass_is_drawn_and_can_collide(shipped):
    for name in shipped.link_names:
        link = shipped.link(name)
        assert (link.inertial is not None) == bool(link.visuals) == bool(link.collisions)


def test_masses_centers_and_inertias_are_the_published_ones(shipped, published):
    massive = [name for name in published.link_names if published.inertial(name) is not None]
    assert massive == [name for name in shipped.link_names if shipped.inertial(name) is not None]
    for name in massive:
        ours, theirs = shipped.inertial(name), published.inertial(name)
        assert ours.mass == theirs.mass
        np.testing.assert_allclose(ours.com, theirs.com, rtol=0, atol=1e-12)
        if name not in REPAIRED:
            np.testing.assert_allclose(ours.inertia, theirs.inertia, rtol=0, atol=1e-11 * theirs.inertia.max())
    assert shipped.total_mass == pytest.approx(66.249972, abs=1e-9)


def test_arm_turbines_have_the_repaired_tensor(shipped):
    for name in REPAIRED:
        np.testing.assert_array_equal(shipped.inertial(name).inertia, np.diag([0.00824, 0.00824, 0.00278]))


def test_kinematics_and_ranges_are_the_published_ones(shipped, published):
    generator = np.random.default_rng(3)
    for _ in range(5):
        positions = dict(zip(JOINTS, generator.uniform(-1.5, 1.5, len(JOINTS)), strict=True))
        ours, theirs = shipped.frame_poses(positions), published.frame_poses(positions)
        for name, pose in ours.items():
            np.testing.assert_allclose(pose, theirs[name], rtol=0, atol=2e-11)  # 1e-12 m, 1e-10° along 12 joints
    for name in shipped.moving_joint_names:
        ours, theirs = shipped.joint(name).limit, published.joint(name).limit
        np.testing.assert_allclose([ours.lower, ours.upper], [theirs.lower, theirs.upper], rtol=1e-9)


def test_joint_axes_have_length_one(shipped):
    for name in shipped.moving_joint_names:
        assert np.linalg.norm(shipped.joint(name).axis) == pytest.approx(1.0, abs=1e-15)


def test_a_table_of_a_new_robot_becomes_urdf(tmp_path):
    (tmp_path / "tiny.toml").write_text(TINY)
    assert main([str(tmp_path / "tiny.toml"), str(tmp_path / "tiny.urdf")]) == 0
    robot = RobotDescription.load(tmp_path / "tiny.urdf")
    assert robot.name == "tiny"
    assert robot.inertial("base").mass == 1.0
    assert robot.inertial("arm") is None
    np.testing.assert_array_equal(robot.joint("j").axis, [0, 0, 1])
    assert robot.joint("j").limit.lower == -np.pi / 2
    sphere, cylinder = robot.link("base").visuals
    assert sphere.geometry.sphere.radius == 0.1
    assert sphere.material.name == "grey"
    assert (cylinder.geometry.cylinder.radius, cylinder.geometry.cylinder.length) == (0.1, 0.3)
    np.testing.assert_array_equal(robot.frame_poses({"j": np.pi / 2})["arm"][:3, 3], [0.1, 0, 0])


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("mass = 1", "mas = 1", "mas"),
        ("mass = 1\n", "", "mass, com and inertia"),
        ("xx = 1", 'xx = "1"', "Expected `float`"),
        ("xx = 1", "xx = 9", "a principal moment exceeds"),
        ("sphere = 0.1,", "sphere = 0.1, box = [1, 1, 1],", "one of box, cylinder, sphere"),
        ('material = "grey"', 'material = "gray"', "'gray'"),
        ("axis = [0, 0, 2], ", "", "moving joints have an axis"),
        ("axis = [0, 0, 2]", "axis = [0, 0, 0]", "length zero"),
        (", limits_deg = [-90, 180]", "", "limits_deg"),
        ("[-90, 180]", "[90, -180]", "lower limit"),
        ('parent = "base"', 'parent = "bass"', '"bass", which does not exist'),
        ('name = "arm"', 'name = "base"', "defined twice"),
        ("name = ", "name : ", "line 2"),
    ],
)
def test_tables_with_mistakes_are_refused_with_a_reason(tmp_path, old, new, message):
    assert old in TINY
    (tmp_path / "tiny.toml").write_text(TINY.replace(old, new, 1))
    with pytest.raises(UrdfError, match=message):
        generated_urdf(tmp_path / "tiny.toml")


def test_a_missing_table_is_refused_with_its_name(tmp_path):
    with pytest.raises(UrdfError, match=r"nothing\.toml"):
        load_table(tmp_path / "nothing.toml")


def test_numbers_of_a_table_survive_the_urdf_exactly():
    table = load_table(FOLDER / "robot.toml")
    robot = RobotDescription.from_text(urdf_from_table(table))
    for row in table.links:
        if row.inertia is not None:
            assert robot.inertial(row.name).mass == row.mass
            assert tuple(robot.inertial(row.name).com) == row.com
            assert robot.inertial(row.name).inertia[0, 2] == row.inertia.xz
        if row.joint is not None:
            assert tuple(robot.joint_origin(row.joint.name)[:3, 3]) == row.joint.xyz
    assert msgspec.structs.asdict(table)["name"] == robot.name
