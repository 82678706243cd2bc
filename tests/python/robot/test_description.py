"""Robot descriptions: reading, refusing, editing by copy, writing."""

import numpy as np
import pytest

from codesign import dynamics as dyn
from codesign.errors import UrdfError
from codesign.robot.description import RobotDescription
from codesign.robot.inertial import Inertial
from codesign.transforms import pose

INERTIAL = """<inertial><origin xyz="0 0 0.1" rpy="0 0 1.5707963267948966"/><mass value="2"/>
<inertia ixx="0.03" ixy="0" ixz="0.001" iyy="0.04" iyz="0" izz="0.05"/></inertial>"""
BOX = '<origin xyz="0 0 0.1"/><geometry><box size="0.1 0.1 0.2"/></geometry>'
URDF = f"""<?xml version="1.0"?>
<robot name="pair">
  <!-- kept -->
  <link name="base">{INERTIAL}<visual>{BOX}<material name="grey"/></visual><collision>{BOX}</collision></link>
  <link name="arm">{INERTIAL}</link>
  <link name="tool"/>
  <joint name="turn" type="revolute">
    <origin xyz="0.30000000000000004 0 0" rpy="0 0.1 0"/><parent link="base"/><child link="arm"/><axis xyz="0 0 2"/>
    <limit lower="-1" upper="1" effort="5" velocity="5"/><dynamics damping="2.0"/><safety_controller k_velocity="1"/>
  </joint>
  <joint name="slide" type="prismatic">
    <parent link="arm"/><child link="tool"/><axis xyz="1 0 0"/><limit lower="0" upper="1" effort="5" velocity="5"/>
  </joint>
  <gazebo reference="arm"><mu1>0.2</mu1></gazebo>
  <sensor name="imu" type="imu"/>
</robot>"""
BOMB = """<?xml version="1.0"?><!DOCTYPE r [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;">]>
<robot name="&b;"/>"""


@pytest.fixture
def robot():
    return RobotDescription.from_text(URDF)


def test_reads_names_masses_and_frames(robot):
    assert (robot.name, robot.root_link) == ("pair", "base")
    assert robot.link_names == ("base", "arm", "tool")
    assert robot.moving_joint_names == ("turn", "slide")
    assert robot.total_mass == 4.0
    assert robot.inertial("tool") is None
    # the inertial frame is turned by 90° about z: xx and yy change places, xz becomes yz
    expected = [[0.04, 0, 0], [0, 0.03, 0.001], [0, 0.001, 0.05]]
    np.testing.assert_allclose(robot.inertial("arm").inertia, expected, atol=1e-17)
    poses = robot.frame_poses({"turn": 0.5, "slide": 0.2})
    tool = pose([0.3, 0, 0], [0, 0.1, 0]) @ pose(rpy=[0, 0, 0.5]) @ pose([0.2, 0, 0])
    np.testing.assert_allclose(poses["tool"], tool, atol=1e-15)


def test_writes_back_what_it_read(robot, tmp_path):
    again = RobotDescription.load(robot.write(tmp_path / "a.urdf"))
    assert again.to_text() == robot.to_text()
    for kept in ("kept", "0.30000000000000004", "<safety_controller", "<gazebo", "<sensor", 'damping="2.0"'):
        assert kept in again.to_text()
    assert [path.name for path in tmp_path.iterdir()] == ["a.urdf"]


def test_what_flies_needs_no_shapes(robot):
    bare = robot.to_dynamics()
    assert "<visual" not in bare and "<collision" not in bare and "<gazebo" in bare
    assert "<visual" in robot.to_text()  # the robot itself keeps them
    again = RobotDescription.from_text(bare)
    assert again.link_names == robot.link_names and again.moving_joint_names == robot.moving_joint_names
    np.testing.assert_array_equal(again.inertial("base").inertia, robot.inertial("base").inertia)
    heavy = robot.replace_inertial("tool", robot.inertial("arm"))
    models = [dyn.load_urdf(text) for text in (heavy.to_text(), heavy.to_dynamics())]
    assert models[0].total_mass == models[1].total_mass == 6.0


def test_an_inertial_is_replaced_whole(robot):
    new = Inertial(1 / 3, [0.1, -0.2, 1e-17], [[0.3, 0.01, -0.02], [0.01, 0.4, 1 / 70], [-0.02, 1 / 70, 0.5]])
    edited = RobotDescription.from_text(robot.replace_inertial("arm", new).to_text())
    read = edited.inertial("arm")
    assert read.mass == new.mass
    np.testing.assert_array_equal(read.com, new.com)
    np.testing.assert_array_equal(read.inertia, new.inertia)
    np.testing.assert_array_equal(edited.link("arm").inertial.origin[:3, :3], np.eye(3))
    assert robot.inertial("arm").mass == 2.0
    assert edited.inertial("base").mass == 2.0


def test_a_link_without_inertial_gets_one(robot):
    assert robot.replace_inertial("tool", Inertial(0.1, np.zeros(3), np.eye(3))).inertial("tool").mass == 0.1


@pytest.mark.parametrize(
    "rpy", [[0.1, 0.2, 0.3], [0.3, np.pi / 2, -1], [1, -np.pi / 2 + 1e-9, 2], [np.pi, 1e-9, -np.pi]]
)
def test_a_joint_origin_survives_the_text_at_every_orientation(robot, rpy):
    T = pose([0.1, 1 / 3, -2e-20], rpy)
    read = RobotDescription.from_text(robot.set_joint_origin("slide", T).to_text()).joint_origin("slide")
    np.testing.assert_array_equal(read[:3, 3], T[:3, 3])
    np.testing.assert_allclose(read, T, rtol=0, atol=5e-16)


def test_a_mesh_replaces_all_shapes_and_keeps_the_color(robot):
    link = robot.set_mesh("base", "package://pair/base.stl", pose([0, 0, 1]), 0.001).link("base")
    assert len(link.visuals) == len(link.collisions) == 1
    assert link.visuals[0].geometry.mesh.filename == "package://pair/base.stl"
    assert link.visuals[0].material.name == "grey"
    assert link.collisions[0].origin[2, 3] == 1.0


@pytest.mark.parametrize("what", ["inertial", "joint", "mesh"])
def test_edits_of_what_is_not_there_are_refused(robot, what):
    edit = {
        "inertial": lambda: robot.replace_inertial("nose", Inertial(1, np.zeros(3), np.eye(3))),
        "joint": lambda: robot.set_joint_origin("nose", np.eye(4)),
        "mesh": lambda: robot.set_mesh("nose", "a.stl", np.eye(4)),
    }[what]
    with pytest.raises(UrdfError, match="nose"):
        edit()


@pytest.mark.parametrize("T", [np.diag([1, 1, 1, 2]), np.diag([1, 1, -1, 1]), np.full((4, 4), np.nan), np.eye(3)])
def test_a_joint_origin_that_is_no_rigid_motion_is_refused(robot, T):
    with pytest.raises(ValueError, match="slide"):
        robot.set_joint_origin("slide", T)


@pytest.mark.parametrize(
    ("mass", "inertia", "message"),
    [
        (-1.0, np.eye(3), "negative mass"),
        (np.nan, np.eye(3), "not finite"),
        (1.0, np.diag([1, 1, -1e-3]), "a principal moment is negative"),
        (1.0, np.diag([1, 1, 2.1]), "exceeds the sum of the others.*as_published accepts it"),
        (1.0, np.eye(3) + np.eye(3, k=1) * 0.1, "not symmetric"),
        (0.0, np.eye(3), "principal moments without mass"),
    ],
)
def test_inertials_that_no_body_has_are_refused_with_the_links_name(robot, mass, inertia, message):
    with pytest.raises(UrdfError, match=f'link "?arm"?: .*{message}'):
        robot.replace_inertial("arm", Inertial(mass, np.zeros(3), inertia))


@pytest.mark.parametrize("moments", [(1, 1, 2), (1, 1, 0), (0, 0, 0), (1, 1, 2.0199)])
def test_plates_rods_points_and_rounded_tensors_are_physical(robot, moments):
    robot.replace_inertial("arm", Inertial(1.0, np.zeros(3), np.diag(moments)))


@pytest.mark.parametrize("moments", [(1, 1, 2), (1, 1, 2.03), (1, 1, 2.05), (1, 1, -1e-3), (1, 0.5, 1.505), (3, 1, 1)])
def test_reading_and_flying_know_one_rule_for_inertias(moments):
    tensor = '<inertia ixx="{}" ixy="0" ixz="0" iyy="{}" iyz="0" izz="{}"/>'.format(*moments)
    text = f'<robot name="one"><link name="base"><inertial><mass value="1"/>{tensor}</inertial></link></robot>'
    verdicts = []
    for read in (RobotDescription.from_text, dyn.load_urdf):
        try:
            read(text)
        except UrdfError as error:
            verdicts.append(str(error))
        else:
            verdicts.append("")
    assert verdicts[0] == verdicts[1]


def test_reading_and_flying_know_one_size_limit():
    text = f'<robot name="one"><link name="base"/><!--{dyn.MAX_URDF_BYTES * " "}--></robot>'
    for read in (RobotDescription.from_text, dyn.load_urdf):
        with pytest.raises(UrdfError, match="larger than 64 MiB"):
            read(text)


def test_non_physical_inertia_is_refused_on_reading_unless_asked_for():
    text = URDF.replace('izz="0.05"', 'izz="-0.05"', 1)
    with pytest.raises(UrdfError, match='link "base": non-physical inertia, a principal moment is negative'):
        RobotDescription.from_text(text)
    assert RobotDescription.from_text(text, as_published=True).total_mass == 4.0


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("</robot>", "", "line 18: the text ends inside <robot>"),
        ('<robot name="pair"', '<bobot name="pair"', "line 2: the root element is <bobot>, not <robot>"),
        ('<robot name="pair">', "<robot>", "no name"),
        ('<link name="tool"/>', '<link name="arm"/>', 'link "arm" is defined twice'),
        ('<link name="tool"/>', "<link/>", "line 8: link without a name"),
        ('name="slide"', 'name="turn"', 'joint "turn" is defined twice'),
        ('<child link="tool"/>', '<child link="tol"/>', 'joint "slide" has the child link "tol", which does not exist'),
        (
            '<child link="tool"/>',
            '<child link="base"/>',
            'link "tool" is a second root: no joint leads to it, nor to "base"|loop',
        ),
        ('<child link="tool"/>', '<child link="arm"/>', 'link "arm" is the child of two joints, "turn" and "slide"'),
        ('<parent link="arm"/>', "", 'joint "slide" has no parent link'),
        ('type="prismatic"', 'type="sliding"', 'joint "slide": its type "sliding" is unknown: one of fixed, revolute'),
        ('type="prismatic"', "", 'joint "slide": it has no type'),
        ('<mass value="2"/>', "", 'line 5: link "base": its <inertial> has no <mass>'),
        ('<mass value="2"/>', "<mass/>", 'link "base": its <mass> has no value'),
        ('<mass value="2"/>', '<mass value="2,5"/>', 'link "base": mass value: "2,5" is not a number'),
        ('<mass value="2"/>', '<mass value="nan"/>', '"nan" is not a finite number'),
        ('<mass value="2"/>', '<mass value="1e999"/>', '"1e999" is not a finite number'),
        ('<mass value="2"/>', '<mass value="1_0"/>', '"1_0" is not a number'),
        ('<mass value="2"/>', '<mass value="-2"/>', 'link "base": negative mass'),
        ('ixy="0" ', "", 'link "base": its <inertia> has no ixy'),
        ('xyz="0 0 0.1"', 'xyz="0 0.1"', "2 numbers instead of 3"),
        ('size="0.1 0.1 0.2"', 'size="0.1 -1 0.2"', 'box size: "-1" is below zero'),
        ("<box", "<cone", 'link "base": <cone> is no shape: box, cylinder'),
        ('<box size="0.1 0.1 0.2"/>', "", 'link "base": its <geometry> is empty'),
        (
            '<box size="0.1 0.1 0.2"/>',
            '<sphere radius="1"/><box size="1 1 1"/>',
            'link "base": <geometry> with two shapes',
        ),
        ('<box size="0.1 0.1 0.2"/>', '<mesh scale="1 1 1"/>', 'link "base": its <mesh> has no filename'),
        ('<box size="0.1 0.1 0.2"/>', '<mesh filename="a" scale="1 1"/>', "mesh scale has 2 numbers instead of 1 or 3"),
        (
            '<material name="grey"/>',
            "<material><color rgba='1 0 x 1'/></material>",
            'link "base": color rgba: "x" is not',
        ),
        ('<axis xyz="0 0 2"/>', '<axis xyz="0 0 0"/>', 'joint "turn": an axis of length zero'),
        ('lower="-1" upper="1"', 'lower="1" upper="-1"', 'joint "turn": its lower limit 1 is above its upper limit -1'),
        ('<limit lower="0" upper="1" effort="5" velocity="5"/>', "", 'joint "slide": a prismatic joint needs limits'),
        ('effort="5"', "", 'joint "turn": its <limit> has no effort'),
    ],
)
def test_unusable_text_is_refused_with_a_reason(old, new, message):
    assert old in URDF
    with pytest.raises(UrdfError, match=message):
        RobotDescription.from_text(URDF.replace(old, new, 1))


def test_bytes_are_read_in_their_encoding_and_strings_as_they_are():
    text = '\n<?xml version="1.0" encoding="{}"?><robot name="r"><link name="é"/><!-- kept: é --></robot>'
    readings = [text.format("ISO-8859-1").encode("latin-1"), text.format("utf8").encode(), text.format("ISO-8859-1")]
    for robot in map(RobotDescription.from_text, readings):
        assert robot.root_link == "é"
        assert "<!-- kept: é -->" in robot.to_text()
    for unreadable in (text.format("utf-8").encode("latin-1"), text.format("utf-8").replace("é", "\udcff")):
        with pytest.raises(UrdfError, match=r"line 2: not well-formed"):
            RobotDescription.from_text(unreadable)


def test_a_robot_whose_links_form_a_ring_is_refused():
    text = URDF.replace(
        "<gazebo", '<joint name="back" type="fixed"><parent link="tool"/><child link="base"/></joint><gazebo'
    )
    with pytest.raises(UrdfError, match="the joints form a loop"):
        RobotDescription.from_text(text)


def test_two_robots_in_one_file_are_refused():
    with pytest.raises(UrdfError, match='link "island" is a second root'):
        RobotDescription.from_text('<robot name="r"><link name="tool"/><link name="island"/></robot>')


@pytest.mark.parametrize("text", ["", "robot", "<robot name='r'/>", b"\xff\xfe\x00", b"\x00" * 10, "<html/>"])
def test_what_is_not_a_robot_is_refused(text):
    with pytest.raises(UrdfError):
        RobotDescription.from_text(text)


def test_entity_bombs_and_external_entities_are_refused_before_they_expand():
    with pytest.raises(UrdfError, match="document type"):
        RobotDescription.from_text(BOMB)
    with pytest.raises(UrdfError, match="document type"):
        RobotDescription.from_text('<!DOCTYPE r SYSTEM "file:///etc/passwd"><robot name="r"><link name="a"/></robot>')


def test_huge_text_is_refused():
    with pytest.raises(UrdfError, match="larger than 64 MiB"):
        RobotDescription.from_text(b" " * (dyn.MAX_URDF_BYTES + 1))


def test_a_missing_file_is_refused_with_its_name(tmp_path):
    with pytest.raises(UrdfError, match=r"none\.urdf"):
        RobotDescription.load(tmp_path / "none.urdf")


def test_a_failed_write_leaves_the_old_file(robot, tmp_path, monkeypatch):
    target = tmp_path / "robot.urdf"
    target.write_text("old")
    monkeypatch.setattr("pathlib.Path.replace", lambda *_: (_ for _ in ()).throw(OSError("full")))
    with pytest.raises(OSError, match="full"):
        robot.write(target)
    assert target.read_text() == "old"
    assert list(tmp_path.iterdir()) == [target]


def test_odd_drawings_cost_no_robot():
    """Prefixes that nobody declares, primitives without extent, capsules, elements beside a shape."""
    text = URDF.replace("<sensor", '<gazebo:plugin drake:name="x"/><sensor').replace(
        "<limit", '<limit drake:jerk="1"', 1
    )
    text = text.replace('<box size="0.1 0.1 0.2"/>', '<capsule radius="0.1" length="0.4"/><material name="x"/>', 1)
    text = text.replace('<box size="0.1 0.1 0.2"/>', '<box size="0.1 0 0.2"/>', 1)
    robot = RobotDescription.from_text(text)
    assert "<gazebo:plugin" in robot.to_text()
    shapes = robot.link("base").visuals
    assert [(s.geometry.sphere is not None, s.origin[2, 3]) for s in shapes] == [
        (True, pytest.approx(-0.1)),
        (True, pytest.approx(0.3)),
        (False, pytest.approx(0.1)),
    ]
    assert shapes[2].geometry.cylinder.length == 0.4
    assert robot.link("base").collisions == ()
    assert RobotDescription.from_text(robot.to_text()).to_text() == robot.to_text()


def test_limits_without_ends_are_zero():
    text = URDF.replace('lower="-1" upper="1" ', "")
    limit = RobotDescription.from_text(text).joint("turn").limit
    assert (limit.lower, limit.upper, limit.effort) == (0.0, 0.0, 5.0)


def test_mimic_joints_follow():
    slide = '<axis xyz="1 0 0"/>'
    text = URDF.replace(slide, slide + '<mimic joint="turn" multiplier="0.5" offset="0.1"/>')
    robot = RobotDescription.from_text(text)
    assert robot.mimics == {"slide": ("turn", 0.5, 0.1)}
    assert robot.moving_joint_names == ("turn",)
    free = RobotDescription.from_text(URDF)
    for turn in (0.0, 0.7, np.array([0.2, -0.4])):
        expected = free.frame_poses({"turn": turn, "slide": 0.5 * np.asarray(turn) + 0.1})
        np.testing.assert_array_equal(robot.frame_poses({"turn": turn})["tool"], expected["tool"])
    np.testing.assert_array_equal(robot.frame_poses()["tool"], free.frame_poses({"slide": 0.1})["tool"])
    with pytest.raises(UrdfError, match="joint slide mimics joint turn: give the position of that one"):
        robot.frame_poses({"slide": 0.3})
