"""Mesh files: found inside the search path only; exported packages that every reader loads alike."""

from pathlib import Path

import numpy as np
import pytest
import trimesh

from codesign import dynamics
from codesign.errors import UrdfError
from codesign.robot.assembly import JointAttachment, PartBody, PartPlacement, Pose, assemble
from codesign.robot.description import RobotDescription
from codesign.robot.package import resolve_mesh, write_urdf_package
from codesign.studies import ironcub
from codesign.studies.ironcub.bracket import JetpackBracket
from codesign.studies.ironcub.forearm import ForearmJetSupport

LEG = ["hip_pitch", "hip_roll", "hip_yaw", "knee", "ankle_pitch", "ankle_roll"]
ARM = ["shoulder_pitch", "shoulder_roll", "shoulder_yaw", "elbow"]
JOINTS = [
    "torso_pitch",
    "torso_roll",
    "torso_yaw",
    *(f"{side}_{joint}" for part in (ARM, LEG) for side in "lr" for joint in part),
]
JOINTS += ["neck_pitch", "neck_roll", "neck_yaw"]
FRAMES = [
    "l_sole",
    "r_sole",
    "l_arm_jet_turbine",
    "r_arm_jet_turbine",
    "chest_l_jet_turbine",
    "chest_r_jet_turbine",
    "head",
]


@pytest.fixture(scope="module")
def parts():
    return {"bracket": JetpackBracket(30, 60), "forearm": ForearmJetSupport(90, 70)}


@pytest.fixture(scope="module")
def robot(parts):
    placements = {
        "bracket": [
            PartPlacement(
                f"chest_{side}_bracket",
                Pose(rpy_deg=(180, 0, 0)),
                joints={f"{side}_turbine_support": JointAttachment("turbine_seat")},
            )
            for side in "lr"
        ],
        "forearm": [
            PartPlacement("l_forearm", Pose((-6, -15, 0)), joints={"l_elbow_turbine": JointAttachment("turbine")})
        ],
    }
    bodies = {
        name: PartBody(part.mass_properties(), part.interfaces(), f"meshes/{name}.stl") for name, part in parts.items()
    }
    return assemble(RobotDescription.load(Path(ironcub.__file__).with_name("robot.urdf")), placements, bodies)


def export(robot, parts, folder, **options):
    return write_urdf_package(robot, folder, {f"meshes/{n}.stl": p.write_stl for n, p in parts.items()}, **options)


def posture():
    return np.random.default_rng(7).uniform(-0.6, 0.6, len(JOINTS))


def test_package_holds_urdf_and_meshes_with_relative_paths(robot, parts, tmp_path):
    urdf = export(robot, parts, tmp_path / "robot")
    names = sorted(str(path.relative_to(tmp_path)) for path in tmp_path.rglob("*") if path.is_file())
    assert names == ["robot/meshes/bracket.stl", "robot/meshes/forearm.stl", "robot/robot.urdf"]
    again = RobotDescription.load(urdf)
    assert again.to_text() == robot.to_text()
    for _, filename in again.mesh_filenames():
        assert trimesh.load(resolve_mesh(filename, again.directory)).is_watertight


def test_package_paths_resolve_from_the_parent_folder(robot, parts, tmp_path):
    urdf = export(robot, parts, tmp_path / "flyer", package="flyer")
    again = RobotDescription.load(urdf)
    assert {filename for _, filename in again.mesh_filenames()} == {
        "package://flyer/meshes/bracket.stl",
        "package://flyer/meshes/forearm.stl",
    }
    for packages in ([tmp_path], [tmp_path / "flyer"]):
        assert (
            resolve_mesh("package://flyer/meshes/forearm.stl", None, packages) == tmp_path / "flyer/meshes/forearm.stl"
        )
    assert "<name>flyer</name>" in (tmp_path / "flyer" / "package.xml").read_text()


def test_package_names_that_ros_does_not_take_are_refused(robot, parts, tmp_path):
    with pytest.raises(UrdfError, match=r"'iRonCub-Mk3': ROS wants lower-case .* such as 'ironcub_mk3'"):
        export(robot, parts, tmp_path / "robot", package="iRonCub-Mk3")
    assert not list(tmp_path.iterdir())


def test_exporting_a_package_again_from_its_own_files(robot, parts, tmp_path):
    first = RobotDescription.load(export(robot, parts, tmp_path / "a", package="a"))
    second = RobotDescription.load(write_urdf_package(first, tmp_path / "b", packages=[tmp_path]))
    assert second.to_text() == robot.to_text()
    assert (tmp_path / "a/meshes/bracket.stl").read_bytes() == (tmp_path / "b/meshes/bracket.stl").read_bytes()


def test_meshes_of_one_name_in_two_folders_stay_apart(robot, tmp_path):
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "m.stl").write_text(folder)
    two = robot.set_mesh("l_forearm", "a/m.stl", np.eye(4)).set_mesh("r_forearm", "b/m.stl", np.eye(4))
    two = two.set_mesh("chest_l_bracket", "a/m.stl", np.eye(4)).set_mesh("chest_r_bracket", "a/m.stl", np.eye(4))
    source = RobotDescription.load(two.write(tmp_path / "two.urdf"))
    out = RobotDescription.load(write_urdf_package(source, tmp_path / "out"))
    assert {(tmp_path / "out" / f).read_text() for link, f in out.mesh_filenames() if link == "r_forearm"} == {"b"}
    assert {(tmp_path / "out" / f).read_text() for link, f in out.mesh_filenames() if link != "r_forearm"} == {"a"}


def test_a_missing_mesh_names_the_link_and_leaves_nothing_behind(robot, tmp_path):
    with pytest.raises(UrdfError, match=r"link chest_r_bracket|link l_forearm|link chest_l_bracket"):
        write_urdf_package(robot, tmp_path / "out")
    assert list(tmp_path.iterdir()) == []


def test_a_failing_mesh_writer_leaves_the_old_package(robot, parts, tmp_path):
    urdf = export(robot, parts, tmp_path / "out")
    before = urdf.read_text()

    def fail(path):
        path.write_text("half")
        raise OSError("disk full")

    with pytest.raises(OSError, match="disk full"):
        write_urdf_package(
            robot.replace_inertial("chest", robot.inertial("head")), tmp_path / "out", {"meshes/bracket.stl": fail}
        )
    assert urdf.read_text() == before
    assert sorted(path.name for path in tmp_path.iterdir()) == ["out"]


@pytest.mark.parametrize(
    ("filename", "message"),
    [
        ("../secret.stl", "leaves"),
        ("meshes/../../secret.stl", "leaves"),
        ("package://pack/../secret.stl", "leaves"),
        ("package://pack/../../secret.stl", "leaves"),
        ("package://../secret.stl", "no package name"),
        ("file:///etc/hostname", "leaves"),
        ("/etc/hostname", "leaves"),
        ("meshes/link.stl", "leaves"),
        ("meshes/none.stl", "not found"),
        ("package://other/a.stl", "not found"),
        ("http://host/a.stl", "scheme 'http'"),
    ],
)
def test_mesh_paths_that_leave_the_search_path_or_are_missing_are_refused(tmp_path, filename, message):
    home = tmp_path / "robot"
    (home / "meshes").mkdir(parents=True)
    (tmp_path / "secret.stl").write_text("secret")
    (tmp_path / "packages" / "pack").mkdir(parents=True)
    (tmp_path / "packages" / "secret.stl").write_text("secret")
    (home / "meshes" / "link.stl").symlink_to(tmp_path / "secret.stl")
    with pytest.raises(UrdfError, match=message):
        resolve_mesh(filename, home, [tmp_path / "packages"])


def test_our_core_reads_the_same_masses_and_frames(robot):
    model = dynamics.load_urdf(robot.to_text(), joints=JOINTS)
    s = posture()
    poses = robot.frame_poses(dict(zip(JOINTS, s, strict=True)))
    assert model.total_mass == pytest.approx(robot.total_mass, rel=1e-14)
    for frame in FRAMES:
        np.testing.assert_allclose(dynamics.frame_pose(model, np.eye(4), s, frame), poses[frame], atol=1e-14)
    np.testing.assert_allclose(dynamics.center_of_mass(model, np.eye(4), s), center_of_mass(robot, poses), atol=1e-14)


def test_pinocchio_reads_the_same_robot(robot, parts, tmp_path):
    import pinocchio as pin

    urdf = export(robot, parts, tmp_path / "flyer", package="flyer")
    model = pin.buildModelFromUrdf(str(urdf), pin.JointModelFreeFlyer())
    data = model.createData()
    q = pin.neutral(model)
    for name, value in zip(JOINTS, posture(), strict=True):
        q[model.joints[model.getJointId(name)].idx_q] = value
    pin.framesForwardKinematics(model, data, q)
    poses = robot.frame_poses(dict(zip(JOINTS, posture(), strict=True)))
    for frame in FRAMES:
        np.testing.assert_allclose(data.oMf[model.getFrameId(frame)].homogeneous, poses[frame], atol=1e-14)
    assert pin.computeTotalMass(model) == pytest.approx(robot.total_mass, rel=1e-14)
    np.testing.assert_allclose(pin.centerOfMass(model, data, q), center_of_mass(robot, poses), atol=1e-14)
    pin.crba(model, data, q)
    pin.ccrba(model, data, q, np.zeros(model.nv))
    np.testing.assert_allclose(data.Ig.inertia, rotational_inertia(robot, poses), rtol=1e-12, atol=1e-13)
    geometry = pin.buildGeomFromUrdf(model, str(urdf), pin.GeometryType.COLLISION, package_dirs=[str(tmp_path)])
    meshes = [g for g in geometry.geometryObjects if g.meshPath.endswith(".stl")]
    assert len(meshes) == 3


def test_idyntree_reads_the_same_robot(robot, tmp_path):
    from idyntree import bindings as idyn

    loader = idyn.ModelLoader()
    assert loader.loadModelFromString(robot.to_text())
    computations = idyn.KinDynComputations()
    assert computations.loadRobotModel(loader.model())
    model = computations.model()
    s = np.zeros(model.getNrOfDOFs())
    for name, value in zip(JOINTS, posture(), strict=True):
        s[model.getJoint(model.getJointIndex(name)).getDOFsOffset()] = value
    assert computations.setJointPos(s)
    computations.setFloatingBase("root_link")
    poses = robot.frame_poses(dict(zip(JOINTS, posture(), strict=True)))
    for frame in FRAMES:
        transform = computations.getRelativeTransform("root_link", frame)
        np.testing.assert_allclose(transform.asHomogeneousTransform().toNumPy(), poses[frame], atol=1e-14)
    assert model.getTotalMass() == pytest.approx(robot.total_mass, rel=1e-14)
    com = computations.getCenterOfMassPosition().toNumPy()
    np.testing.assert_allclose(com, center_of_mass(robot, poses), atol=1e-14)


def test_yourdfpy_builds_the_scene_with_the_meshes(robot, parts, tmp_path):
    import yourdfpy

    urdf = export(robot, parts, tmp_path / "robot")
    scene = yourdfpy.URDF.load(str(urdf), mesh_dir=str(urdf.parent))
    scene.update_cfg(dict(zip(JOINTS, posture(), strict=True)))
    poses = robot.frame_poses(dict(zip(JOINTS, posture(), strict=True)))
    for frame in FRAMES:
        np.testing.assert_allclose(scene.get_transform(frame, "root_link"), poses[frame], atol=1e-12)
    volumes = np.array([shape.volume for shape in scene.scene.geometry.values()])
    for part in parts.values():
        assert np.abs(volumes / part.mass_properties().volume - 1.0).min() < 1e-3


def center_of_mass(robot, poses):
    moments = [
        inertial.mass * (poses[link] @ [*inertial.com, 1.0])[:3]
        for link in robot.link_names
        if (inertial := robot.inertial(link)) is not None
    ]
    return np.sum(moments, axis=0) / robot.total_mass


def rotational_inertia(robot, poses):
    """About the center of mass, axes of the root link."""
    com, total = center_of_mass(robot, poses), np.zeros((3, 3))
    for link in robot.link_names:
        inertial = robot.inertial(link)
        if inertial is not None:
            body = inertial.moved(poses[link])
            r = body.com - com
            total += body.inertia + body.mass * (r @ r * np.eye(3) - np.outer(r, r))
    return total


def textured(folder, color):
    """An OBJ file with a material whose texture lies in another folder."""
    (folder / "meshes").mkdir(parents=True)
    (folder / "textures").mkdir()
    (folder / "meshes/body.obj").write_text("mtllib body.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl skin\nf 1 2 3\n")
    (folder / "meshes/body.mtl").write_text(f"newmtl skin\nKd {color} 0 0\nmap_Kd -s 1 1 1 ../textures/skin.png\n")
    (folder / "textures/skin.png").write_bytes(b"png")


def test_materials_textures_and_buffers_come_with_a_mesh(robot, tmp_path):
    for folder, color in (("a", "1"), ("b", "0.5")):
        textured(tmp_path / folder, color)
    (tmp_path / "c.gltf").write_text('{"buffers": [{"uri": "my%20data.bin"}, {"uri": "data:,x"}]}')
    (tmp_path / "my data.bin").write_bytes(b"buffer")
    (tmp_path / "d.dae").write_text("<COLLADA><init_from>a/textures/skin.png</init_from></COLLADA>")
    names = dict(
        zip(
            ("l_forearm", "r_forearm", "chest_l_bracket", "head"),
            ("a/meshes/body.obj", "b/meshes/body.obj", "c.gltf", "d.dae"),
            strict=True,
        )
    )
    for link, name in names.items():
        robot = robot.set_mesh(link, name, np.eye(4))
    for link in set(robot.link_names) - set(names):
        if any(name == link for name, _ in robot.mesh_filenames()):
            robot = robot.set_mesh(link, "d.dae", np.eye(4))
    source = RobotDescription.load(robot.write(tmp_path / "robot.urdf"))
    again = RobotDescription.load(write_urdf_package(source, tmp_path / "out"))
    copies = {link: resolve_mesh(filename, again.directory) for link, filename in again.mesh_filenames()}
    for link, color in (("l_forearm", "Kd 1 "), ("r_forearm", "Kd 0.5 ")):
        assert color in copies[link].with_name("body.mtl").read_text()
        assert (copies[link].parent / "../textures/skin.png").read_bytes() == b"png"
    assert copies["chest_l_bracket"].with_name("my data.bin").read_bytes() == b"buffer"
    assert (copies["head"].parent / "a/textures/skin.png").is_file()
    third = RobotDescription.load(write_urdf_package(again, tmp_path / "again"))
    assert sorted(p.name for p in (tmp_path / "again").rglob("*.mtl")) == ["body.mtl"] * 2
    assert third.name == robot.name


def test_files_of_a_mesh_outside_the_folders_are_refused(robot, tmp_path):
    textured(tmp_path / "a", "1")
    (tmp_path / "robots").mkdir()
    (tmp_path / "robots/x.obj").write_text("mtllib ../a/meshes/body.mtl\nv 0 0 0\n")
    for link in {link for link, _ in robot.mesh_filenames()}:
        robot = robot.set_mesh(link, "x.obj", np.eye(4))
    source = RobotDescription.load(robot.write(tmp_path / "robots/robot.urdf"))
    with pytest.raises(UrdfError, match=r"x\.obj: '\.\./a/meshes/body\.mtl' leaves the folders"):
        write_urdf_package(source, tmp_path / "out")
