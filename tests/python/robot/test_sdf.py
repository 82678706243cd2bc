"""The exported SDF says what the URDF says, link by link, and the SRDF what may touch."""

import xml.etree.ElementTree as ET

import numpy as np
import pinocchio as pin
import pytest

from codesign import dynamics as dyn
from codesign.errors import UrdfError
from codesign.robot.collisions import ADJACENT, ignored_pairs
from codesign.robot.description import RobotDescription
from codesign.robot.formats.mjcf import mjcf_text
from codesign.robot.formats.sdf import host_links, sdf_text
from codesign.transforms import inverse, pose, rotation_about
from exported_robots import ORIGINAL, Exported, export_robot

INERTIAL = (
    '<inertial><origin xyz="0.1 0 0"/><mass value="2"/>'
    '<inertia ixx="0.1" ixy="0" ixz="0" iyy="0.2" iyz="0.01" izz="0.2"/></inertial>'
)
BALL = '<collision><origin xyz="0 0 0.3"/><geometry><sphere radius="0.2"/></geometry></collision>'


@pytest.fixture(scope="module", params=ORIGINAL)
def exported(request, tmp_path_factory) -> Exported:
    return export_robot(request.param, ORIGINAL[request.param], tmp_path_factory.mktemp("export") / "robot", 1.0)


def robot(links, joints):
    text = "".join(f'<link name="{name}">{inside}</link>' for name, inside in links.items())
    text += "".join(
        f'<joint name="{name}" type="{kind}"><origin xyz="0.1 0.2 {0.1 * len(name)}" rpy="0.1 -0.2 0.3"/>'
        f'<parent link="{parent}"/><child link="{child}"/><axis xyz="0 0 1"/><limit effort="1" velocity="1" lower="-1" '
        'upper="2"/></joint>'
        for name, kind, parent, child in joints
    )
    return RobotDescription.from_text(f'<robot name="r">{text}</robot>')


def vector(element):
    return np.array([float(number) for number in element.text.split()])


def read_sdf(text, positions=()):
    """World poses of all links and frames, and name -> (mass, com, inertia) of the links, as SDF 1.9 means them."""
    root = ET.fromstring(text)
    assert root.get("version") == "1.9"
    (model,) = root.findall("model")
    placed = {e.get("name"): e for kind in ("link", "joint", "frame") for e in model.findall(kind)}
    joints = {e.find("child").text: e for e in model.findall("joint")}
    known = {}

    def world(name):
        if name not in known:
            element = placed[name]
            given = element.find("pose")
            local = np.eye(4) if given is None else pose(vector(given)[:3], vector(given)[3:])
            base = None if given is None else given.get("relative_to")
            base = base or element.get("attached_to")
            T = local if base is None else world(base) @ local
            if element.tag == "joint" and element.get("type") != "fixed":
                axis = vector(element.find("axis/xyz"))
                T = T @ pose_of(rotation_about(axis, dict(positions).get(name, 0.0)))
            known[name] = T
        return known[name]

    # A joint's pose is that of its child at zero; what is placed in the joint turns with it.
    names = [e.get("name") for kind in ("link", "frame") for e in model.findall(kind)]
    assert len(joints) == len(model.findall("joint"))
    masses = {
        e.get("name"): (
            float(e.find("inertial/mass").text),
            vector(e.find("inertial/pose"))[:3],
            np.array([[float(e.find(f"inertial/inertia/i{min(a, b)}{max(a, b)}").text) for a in "xyz"] for b in "xyz"]),
        )
        for e in model.findall("link")
    }
    return {name: world(name) for name in names}, masses, model


def pose_of(R):
    T = np.eye(4)
    T[:3, :3] = R
    return T


def compare(description, settings, text, tolerance=1e-14):
    rng = np.random.default_rng(5)
    positions = {name: rng.uniform(-1.0, 1.0) for name in description.moving_joint_names}
    poses, masses, model = read_sdf(text, positions.items())
    expected = description.frame_poses(positions)
    jets = {f"{jet.frame}_jet": jet.frame for jet in settings.actuators}
    assert set(poses) == set(expected) | set(jets)
    origin = inverse(poses[description.root_link])  # a root link without mass is not where the model is
    for name, T in poses.items():
        np.testing.assert_allclose(origin @ T, expected[jets.get(name, name)], atol=tolerance)
    for name, (mass, com, inertia) in masses.items():
        body = description.inertial(name)
        assert mass == body.mass
        np.testing.assert_array_equal(com, body.com)
        np.testing.assert_array_equal(inertia, body.inertia)
    assert sum(mass for mass, _, _ in masses.values()) == pytest.approx(description.total_mass, rel=1e-14)
    return model


def test_links_frames_joints_and_jets(exported):
    model = compare(exported.robot, exported.settings, (exported.folder / "robot.sdf").read_text(), 1e-13)
    moving = {e.get("name") for e in model.findall("joint") if e.get("type") != "fixed"}
    assert moving == set(exported.joints)
    for name in exported.joints:
        limit = exported.robot.joint(name).limit
        for key in ("lower", "upper"):
            assert float(model.find(f"joint[@name='{name}']/axis/limit/{key}").text) == getattr(limit, key)
    jets = model.findall("{codesign}jet")
    assert [jet.get("frame") for jet in jets] == [f"{jet.frame}_jet" for jet in exported.settings.actuators]
    assert [float(jet.find("{codesign}max_thrust_n").text) for jet in jets] == [250.0] * 4
    for uri in model.iter("uri"):
        assert (exported.folder / uri.text).suffix == ".obj"
        assert (exported.folder / uri.text).is_file()
    names = [e.get("name") for e in model if e.get("name")]
    assert len(names) == len(set(names))  # libsdformat refuses others, whatever the elements


def test_srdf_leaves_out_the_same_pairs_in_pinocchio(exported):
    urdf = str(exported.folder / "robot.urdf")
    model = pin.buildModelFromUrdf(urdf, pin.JointModelFreeFlyer())
    geometry = pin.buildGeomFromUrdf(model, urdf, pin.GeometryType.COLLISION, package_dirs=[str(exported.folder)])
    geometry.addAllCollisionPairs()
    before = len(geometry.collisionPairs)
    pin.removeCollisionPairs(model, geometry, str(exported.folder / "robot.srdf"))
    assert len(geometry.collisionPairs) < before
    pin.loadReferenceConfigurations(model, str(exported.folder / "robot.srdf"))
    q = model.referenceConfigurations["start"]
    for name, angle in zip(exported.settings.joints, exported.settings.initial_joints, strict=True):
        assert q[model.joints[model.getJointId(name)].idx_q] == angle
    q = q.copy()
    q[:7] = [0, 0, 0, 0, 0, 0, 1]
    data, shapes = model.createData(), geometry.createData()
    assert not pin.computeCollisions(model, data, geometry, shapes, q, False)


def test_links_without_mass_anywhere_in_a_body_become_frames():
    links = {
        "root": BALL,
        "trunk": INERTIAL,
        "flange": BALL,
        "tool": "",
        "arm": INERTIAL,
        "wrist": "",
        "hand": INERTIAL,
    }
    joints = [
        ("to_trunk", "fixed", "root", "trunk"),
        ("shoulder", "revolute", "root", "flange"),
        ("to_arm", "fixed", "flange", "arm"),
        ("to_tool", "fixed", "flange", "tool"),
        ("to_wrist", "fixed", "arm", "wrist"),
        ("hand_joint", "continuous", "wrist", "hand"),
    ]
    description = robot(links, joints)
    assert host_links(description) == {
        "root": "trunk",
        "trunk": "trunk",
        "flange": "arm",
        "arm": "arm",
        "tool": "arm",
        "wrist": "arm",
        "hand": "hand",
    }
    settings = dyn.FlightSettings()
    model = compare(description, settings, sdf_text(description, settings, {}))
    assert {e.get("name") for e in model.findall("joint")} == {"shoulder", "hand_joint"}
    assert {e.get("name") for e in model.iter("collision")} == {"root_collision_0", "flange_collision_0"}
    assert model.find("joint[@name='hand_joint']/axis/limit/lower") is None


def test_a_moving_body_without_mass_is_refused():
    description = robot(
        {"root": INERTIAL, "cross": "", "arm": INERTIAL},
        [("a", "revolute", "root", "cross"), ("b", "revolute", "cross", "arm")],
    )
    with pytest.raises(UrdfError, match="link cross moves but has no mass"):
        sdf_text(description, dyn.FlightSettings(), {})


def test_joints_of_many_directions_and_missing_jets_are_refused():
    two = {"root": INERTIAL, "arm": INERTIAL}
    floating = robot(two, [("a", "floating", "root", "arm")])
    settings = dyn.FlightSettings()
    for write in (sdf_text, mjcf_text):
        with pytest.raises(UrdfError, match="joint a: a floating joint cannot be exported"):
            write(floating, settings, {})
    settings.actuators = [
        dyn.Actuator(frame="nozzle", axis=np.array([0.0, 0.0, -1.0]), thrust_max=1.0, thrust_rate=1.0)
    ]
    settings.initial_thrusts = np.zeros(1)
    for write in (sdf_text, mjcf_text):
        with pytest.raises(UrdfError, match="no jet frame 'nozzle'"):
            write(robot(two, [("a", "revolute", "root", "arm")]), settings, {})


def test_pairs_are_neighbors_and_what_overlaps():
    links = {name: INERTIAL + BALL for name in ("root", "stiff", "arm", "hand")}
    joints = [
        ("a", "fixed", "root", "stiff"),
        ("shoulder_far_away_from_it", "revolute", "stiff", "arm"),
        ("c", "revolute", "arm", "hand"),
    ]
    description = robot(links, joints)
    pairs = ignored_pairs(description, {})
    assert {pair for pair, reason in pairs.items() if reason == ADJACENT} == {
        ("root", "stiff"),
        ("root", "arm"),
        ("stiff", "arm"),
        ("arm", "hand"),
    }
    assert ("root", "hand") not in pairs
    near = robot(links, [*joints[:1], ("b", "revolute", "stiff", "arm"), joints[2]])
    assert ignored_pairs(near, {})["stiff", "hand"] == "Default"


def test_mimic_joints_are_said_in_a_later_version():
    description = robot(
        {"root": INERTIAL, "lead": INERTIAL, "follower": INERTIAL},
        [("a", "revolute", "root", "lead"), ("b", "revolute", "root", "follower")],
    )
    first, second, third = description.to_text().partition('<joint name="b"')
    text = first + second + third.replace("<axis", '<mimic joint="a" multiplier="2" offset="0.5"/><axis')
    root = ET.fromstring(sdf_text(RobotDescription.from_text(text), dyn.FlightSettings(), {}))
    assert root.get("version") == "1.11"
    (mimic,) = root.iter("mimic")
    assert mimic.get("joint") == "a"
    assert [float(mimic.find(key).text) for key in ("multiplier", "offset", "reference")] == [2.0, 0.5, 0.0]
