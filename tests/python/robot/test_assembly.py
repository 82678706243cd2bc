"""Robot regeneration: placed parts, mirrored sides, the shipped robot's joints."""

from dataclasses import dataclass
from pathlib import Path

import msgspec
import numpy as np
import pytest

from codesign.errors import StudyError, UrdfError
from codesign.robot.assembly import JointAttachment, PartBody, PartPlacement, Pose, assemble
from codesign.robot.description import RobotDescription
from codesign.robot.inertial import Inertial
from codesign.studies import ironcub
from codesign.studies.ironcub.bracket import JetpackBracket
from codesign.studies.ironcub.forearm import ForearmJetSupport
from codesign.transforms import pose, rotation_from_rpy


@dataclass
class Properties:
    mass: float
    com: np.ndarray
    inertia: np.ndarray


def tensor(xx, yy, zz, xy=0.0, xz=0.0, yz=0.0):
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


# Original bracket (15°, 42 mm) in its part frame: values of the exact solid
BRACKET = Properties(0.227882, np.array([0.040185, 0.0, 0.013639]), 1e-6 * tensor(67.701, 218.820, 262.671, xz=-37.170))
# Forearm support, left: Offset 88, Length 50
FOREARM = Properties(
    0.68965, np.array([-0.08286, 0.01508, -0.02719]), 1e-6 * tensor(2111.3, 2063.4, 957.6, -3.95, -245.5, -1.53)
)


def seat_of(angle_deg, distance_mm):
    """part_T_interface of the bracket's seat: z out of the pocket floor, x along the slab; independent formula."""
    a = np.deg2rad(angle_deg)
    t, n = np.array([np.cos(a), 0, np.sin(a)]), np.array([-np.sin(a), 0, np.cos(a)])
    h = np.tan(a / 2)
    T = np.eye(4)
    T[:3, :3] = np.column_stack([t, np.cross(-n, t), -n])
    T[:3, 3] = 1e-3 * (np.array([25 - 15 * h, 0, 15]) + distance_mm * t - 14 * n)
    return T


def turbine_of(offset_mm, length_mm):
    """part_T_interface of the left forearm support's turbine: origin at the nozzle, z along the jet (part −x)."""
    T = pose([-(204 + length_mm) * 1e-3, 0.015, -offset_mm * 1e-3])
    T[:3, :3] = np.column_stack([[0, 0, 1], [0, 1, 0], [-1, 0, 0]])
    return T


PLACEMENTS = {
    "bracket": [
        PartPlacement(
            f"chest_{s}_bracket",
            Pose(rpy_deg=(180, 0, 0)),
            None,
            {f"{s}_turbine_support": JointAttachment("turbine_seat")},
        )
        for s in "lr"
    ],
    "forearm": [
        PartPlacement("l_forearm", Pose((-6, -15, 0)), None, {"l_elbow_turbine": JointAttachment("turbine")}),
        PartPlacement(
            "r_forearm",
            Pose((-6, -15, 0)),
            "z",
            {"r_elbow_turbine": JointAttachment("turbine", Pose(rpy_deg=(0, 0, 165)))},
        ),
    ],
}


def bodies(angle=15, distance=42, offset=88, length=50):
    return {
        "bracket": PartBody(BRACKET, {"turbine_seat": seat_of(angle, distance)}),
        "forearm": PartBody(FOREARM, {"turbine": turbine_of(offset, length)}),
    }


@pytest.fixture(scope="module")
def base():
    return RobotDescription.load(Path(ironcub.__file__).with_name("robot.urdf"))


@pytest.fixture(scope="module")
def assembled(base):
    return assemble(base, PLACEMENTS, bodies())


@pytest.mark.parametrize(("angle", "distance"), [(1, 40), (15, 42), (79, 100)])
def test_bracket_names_the_seat_as_its_interface(angle, distance):
    interfaces = JetpackBracket(angle, distance).interfaces()
    assert list(interfaces) == ["turbine_seat"]
    np.testing.assert_allclose(interfaces["turbine_seat"], seat_of(angle, distance), atol=1e-16)


@pytest.mark.parametrize(("offset", "length"), [(80, 50), (88, 108), (120, 150)])
def test_forearm_names_the_turbine_as_its_interface(offset, length):
    interfaces = ForearmJetSupport(offset, length).interfaces()
    assert list(interfaces) == ["turbine"]
    np.testing.assert_allclose(interfaces["turbine"], turbine_of(offset, length), atol=1e-15)


def test_real_parts_assemble_into_a_physical_robot_with_their_masses(base):
    bracket, forearm = JetpackBracket(15, 42), ForearmJetSupport(80, 108)
    parts = {
        name: PartBody(p.mass_properties(), p.interfaces()) for name, p in [("bracket", bracket), ("forearm", forearm)]
    }
    robot = RobotDescription.from_text(assemble(base, PLACEMENTS, parts).to_text())
    replaced = 2 * (parts["bracket"].properties.mass + parts["forearm"].properties.mass)
    original = 2 * (0.227881 + 0.681091)
    assert robot.total_mass == pytest.approx(base.total_mass - original + replaced, abs=1e-12)
    np.testing.assert_allclose(robot.joint_origin("l_turbine_support")[:3, 3], [0.067218, 0, -0.012347], atol=5e-7)


@pytest.mark.parametrize(("angle", "distance"), [(1, 40), (15, 42), (15, 48), (79, 100)])
@pytest.mark.parametrize("joint", ["l_turbine_support", "r_turbine_support"])
def test_bracket_moves_its_turbine_support(base, joint, angle, distance):
    origin = assemble(base, PLACEMENTS, bodies(angle, distance)).joint_origin(joint)
    a = np.deg2rad(angle)
    x = 25 - 15 * np.tan(a / 2) + distance * np.cos(a) + 14 * np.sin(a)
    z = -(15 + distance * np.sin(a) - 14 * np.cos(a))
    np.testing.assert_allclose(origin, pose([x * 1e-3, 0, z * 1e-3], [0, a, 0]), atol=1e-15)


def test_original_bracket_puts_the_support_where_the_published_robot_has_it(base, assembled):
    for joint in ("l_turbine_support", "r_turbine_support"):
        np.testing.assert_allclose(assembled.joint_origin(joint), base.joint_origin(joint), atol=3e-6)  # 5 digits there


@pytest.mark.parametrize(("side", "sign"), [("l", -1), ("r", 1)])
def test_forearm_moves_its_turbine_and_keeps_its_orientation(base, side, sign):
    robot = assemble(base, PLACEMENTS, bodies(offset=90, length=108))
    origin, published = robot.joint_origin(f"{side}_elbow_turbine"), base.joint_origin(f"{side}_elbow_turbine")
    np.testing.assert_allclose(origin[:3, 3], [-0.318, 0, sign * 0.09], atol=1e-15)
    np.testing.assert_allclose(origin[:3, :3], published[:3, :3], atol=5e-7)  # the published angles scatter by 3e-7
    np.testing.assert_allclose(origin[:3, 3], published[:3, 3], atol=4e-4)  # 0.08971 and 0.09028 there


def test_bracket_inertial_equals_the_published_original(base, assembled):
    for link in ("chest_l_bracket", "chest_r_bracket"):
        ours, published = assembled.inertial(link), base.inertial(link)
        assert ours.mass == pytest.approx(published.mass, rel=1e-5)
        np.testing.assert_allclose(ours.com, published.com, atol=2e-6)
        np.testing.assert_allclose(ours.inertia, published.inertia, atol=2e-8)  # sign of Ixz included


def test_mirrored_forearm_changes_the_signs_of_the_products_with_z(assembled):
    left, right = assembled.inertial("l_forearm"), assembled.inertial("r_forearm")
    assert left.mass == right.mass == FOREARM.mass
    np.testing.assert_allclose(left.com, FOREARM.com + np.array([-0.006, -0.015, 0]), atol=1e-16)
    np.testing.assert_array_equal(right.com, left.com * [1, 1, -1])
    np.testing.assert_array_equal(left.inertia, FOREARM.inertia)
    np.testing.assert_array_equal(right.inertia, FOREARM.inertia * [[1, 1, -1], [1, 1, -1], [-1, -1, 1]])


def test_assembled_inertials_have_no_rotation_left_in_the_file(assembled):
    for link in ("chest_l_bracket", "r_forearm"):
        np.testing.assert_array_equal(assembled.link(link).inertial.origin[:3, :3], np.eye(3))


def test_what_no_part_touches_stays_digit_for_digit(base, assembled):
    touched = ("chest_l_bracket", "chest_r_bracket", "l_forearm", "r_forearm")
    for link in base.link_names:
        if link not in touched:
            np.testing.assert_array_equal(assembled.link(link).inertial, base.link(link).inertial)
    for joint in base.joint_names:
        if joint not in [j for places in PLACEMENTS.values() for p in places for j in p.joints]:
            np.testing.assert_array_equal(assembled.joint_origin(joint), base.joint_origin(joint))


def test_assembling_leaves_the_base_as_it_was(base):
    before = base.to_text()
    assemble(base, PLACEMENTS, bodies(79, 100, 120, 150))
    assert base.to_text() == before


def test_left_and_right_jets_are_mirror_images_about_the_robots_middle(assembled):
    poses = assembled.frame_poses()
    for left, right in [("l_arm_jet_turbine", "r_arm_jet_turbine"), ("chest_l_jet_turbine", "chest_r_jet_turbine")]:
        mirror = np.array([1, -1, 1])
        np.testing.assert_allclose(
            poses[right][:3, 3], poses[left][:3, 3] * mirror, atol=1e-3
        )  # the robot itself: 0.3 mm
        np.testing.assert_allclose(poses[right][:3, 2], poses[left][:3, 2] * mirror, atol=1e-5)


def test_meshes_take_the_place_of_the_links_shapes(base):
    parts = bodies()
    parts["forearm"] = PartBody(FOREARM, parts["forearm"].interfaces, "meshes/left.stl", "meshes/right.stl")
    robot = assemble(base, PLACEMENTS, parts)
    for side, file in (("l", "left"), ("r", "right")):
        link = robot.link(f"{side}_forearm")
        for shapes in (link.visuals, link.collisions):
            assert [s.geometry.mesh.filename for s in shapes] == [f"meshes/{file}.stl"]
            np.testing.assert_array_equal(shapes[0].geometry.mesh.scale, [1e-3] * 3)
            np.testing.assert_allclose(shapes[0].origin, pose([-0.006, -0.015, 0]))
        assert link.visuals[0].material.name == "part"
    assert robot.link("chest_l_bracket").visuals[0].geometry.box is not None


def test_placements_read_from_a_study_and_refuse_unknown_keys():
    text = """
    link = "r_forearm"
    mirror = "z"
    link_T_part = { xyz_mm = [-6, -15, 0] }
    joints = { r_elbow_turbine = { interface = "turbine", interface_T_child = { rpy_deg = [0, 0, 165] } } }
    """
    assert msgspec.toml.decode(text, type=PartPlacement) == PLACEMENTS["forearm"][1]
    with pytest.raises(msgspec.ValidationError, match="miror"):
        msgspec.toml.decode('link = "a"\nmiror = "z"', type=PartPlacement)


@pytest.mark.parametrize(
    ("placement", "error", "message"),
    [
        (PartPlacement("nowhere"), UrdfError, "nowhere"),
        (
            PartPlacement("chest", joints={"l_elbow": JointAttachment("turbine_seat")}),
            UrdfError,
            "l_elbow hangs from link l_upper_arm",
        ),
        (PartPlacement("chest", joints={"nothing": JointAttachment("turbine_seat")}), UrdfError, "nothing"),
        (PartPlacement("chest_l_bracket", joints={"l_turbine_support": JointAttachment("sea")}), StudyError, "'sea'"),
    ],
)
def test_placements_that_do_not_fit_the_robot_are_refused(base, placement, error, message):
    with pytest.raises(error, match=message):
        assemble(base, {"bracket": [placement]}, bodies())


def test_a_link_taken_twice_and_a_part_not_built_are_refused(base):
    with pytest.raises(StudyError, match="chest_l_bracket is taken"):
        assemble(base, {"bracket": PLACEMENTS["bracket"][:1] * 2}, bodies())
    with pytest.raises(StudyError, match="'wing'"):
        assemble(base, {"wing": PLACEMENTS["bracket"]}, bodies())


def test_a_part_that_is_no_body_is_refused_with_the_links_name(base):
    wrong = PartBody(Properties(1.0, np.zeros(3), np.diag([1.0, 1.0, 3.0])), {"turbine_seat": seat_of(15, 42)})
    with pytest.raises(UrdfError, match=r"chest_l_bracket.*exceeds"):
        assemble(base, {"bracket": PLACEMENTS["bracket"]}, {"bracket": wrong})


def test_turning_a_body_and_back_changes_nothing():
    R = rotation_from_rpy([0.3, -1.1, 2.0])
    turned = Properties(FOREARM.mass, R @ FOREARM.com, R @ FOREARM.inertia @ R.T)
    undo = np.eye(4)
    undo[:3, :3] = R.T
    inertial = Inertial.of(turned).moved(undo)
    np.testing.assert_allclose(inertial.com, FOREARM.com, atol=1e-16)
    np.testing.assert_allclose(inertial.inertia, FOREARM.inertia, rtol=1e-13, atol=1e-17)
