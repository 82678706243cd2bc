"""The exported package for ROS 2: built by colcon, the robot of its xacro is the one of the URDF."""

import os
import re
import runpy
import subprocess
import sys
import xml.etree.ElementTree as ET
from pathlib import Path
from unittest.mock import MagicMock, patch

import numpy as np
import pinocchio as pin
import pytest
import xacro
from catkin_pkg.package import parse_package

from codesign import dynamics as dyn
from codesign.errors import UrdfError
from codesign.robot.description import RobotDescription
from codesign.robot.formats.ros2 import RosPackage, ros_name, write_ros2_package
from codesign.robot.formats.srdf import srdf_text
from codesign.robot.package import write_urdf_package
from exported_robots import ORIGINAL, export_robot

NAME = "flyer_description"


@pytest.fixture(scope="module")
def exported(tmp_path_factory):
    """A robot with meshes, its package below the folder src."""
    exported = export_robot(
        "ironcub_paper", ORIGINAL["ironcub_paper"], tmp_path_factory.mktemp("ros") / "robot", duration=0.2
    )
    robot = RobotDescription.load(exported.folder / "robot.urdf")
    srdf = srdf_text(exported.robot, exported.settings, exported.ignored)
    package = RosPackage(NAME, "flyer: a < b", {"angle_deg": "15", "kind": "a"})
    write_ros2_package(robot, srdf, exported.settings, package, exported.folder.parent / "src")
    return exported


@pytest.fixture(scope="module")
def package(exported) -> Path:
    return exported.folder.parent / "src" / NAME


def expanded(package: Path, kind: str = "urdf", **arguments: str) -> str:
    folder = {"urdf": "urdf", "srdf": "config"}[kind]
    return xacro.process_file(str(package / folder / f"{NAME}.{kind}.xacro"), mappings=arguments).toxml()


def flat(text: str, mesh: str = "") -> list[tuple[str, dict[str, str]]]:
    """All elements in order with their attributes, meshes without what stands before their path."""
    elements = [element for element in ET.fromstring(text).iter() if element.tag != "robot"]
    for element in elements:
        if "filename" in element.attrib:
            element.set("filename", element.get("filename", "").removeprefix(mesh))
    return [(element.tag, dict(element.attrib)) for element in elements]


def test_the_xacro_is_the_urdf(exported, package):
    text = (exported.folder / "robot.urdf").read_text()
    assert flat(expanded(package), f"package://{NAME}/") == flat(text)
    assert flat(expanded(package, "srdf")) == flat((exported.folder / "robot.srdf").read_text())
    root = ET.parse(package / f"urdf/{NAME}.urdf.xacro").getroot()
    values = {e.get("name"): e.get("value") for e in root.iter("{http://www.ros.org/wiki/xacro}property")}
    assert (values["design_angle_deg"], values["design_kind"]) == ("15", "a")


def test_a_prefix_and_a_base_change_names_alone(exported, package):
    plain = pin.buildModelFromXML((exported.folder / "robot.urdf").read_text(), pin.JointModelFreeFlyer())
    text = expanded(package, prefix="a_", base="world")
    held = pin.buildModelFromXML(text)
    assert held.getFrameId("world") < held.nframes
    mass = pin.computeTotalMass(held) + held.inertias[0].mass  # what is fixed to the base counts apart
    assert mass == pytest.approx(pin.computeTotalMass(plain), rel=1e-12)
    data, other = plain.createData(), held.createData()
    rng = np.random.default_rng(4)
    q, p = pin.neutral(plain), pin.neutral(held)
    for name in exported.joints:
        angle = rng.uniform(-1.0, 1.0)
        q[plain.joints[plain.getJointId(name)].idx_q] = angle
        p[held.joints[held.getJointId(f"a_{name}")].idx_q] = angle
    pin.framesForwardKinematics(plain, data, q)
    pin.framesForwardKinematics(held, other, p)
    for link in exported.robot.link_names:
        expected = data.oMf[plain.getFrameId(link)].homogeneous
        np.testing.assert_allclose(other.oMf[held.getFrameId(f"a_{link}")].homogeneous, expected, atol=1e-12)
    links = {f"a_{link}" for link in exported.robot.link_names}
    pairs = ET.fromstring(expanded(package, "srdf", prefix="a_")).iter("disable_collisions")
    assert all({pair.get("link1"), pair.get("link2")} <= links for pair in pairs)
    filters = [element for element in ET.fromstring(text).iter("{drake.mit.edu}member")]
    assert filters
    assert all(element.get("link") in links for element in filters)


def test_colcon_builds_it_and_its_setup_finds_it(package):
    ws = package.parents[1]
    sh = {**os.environ, "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"}
    # The Python of Debian has the modules of ament.
    build = "colcon --log-base log build --cmake-args -DPython3_EXECUTABLE=/usr/bin/python3"
    subprocess.run(
        [sys.executable, "-m", "colcon", *build.split()[1:]], cwd=ws, env=sh, check=True, capture_output=True
    )
    script = "source install/setup.bash && echo $AMENT_PREFIX_PATH && echo $GZ_SIM_RESOURCE_PATH"
    clean = {key: sh[key] for key in ("PATH", "HOME")}
    found = subprocess.run(["bash", "-c", script], cwd=ws, env=clean, check=True, capture_output=True, text=True)
    prefix, share = (Path(line) for line in found.stdout.split())
    assert share == prefix / "share"
    assert (prefix / "share/ament_index/resource_index/packages" / NAME).is_file()
    assert flat(expanded(share / NAME)) == flat(expanded(package))
    meshes = re.findall(r'filename="package://(.*?)"', expanded(package))
    assert meshes
    assert all((share / mesh).is_file() for mesh in meshes)


def test_ros_reads_package_xml(package, exported, tmp_path):
    read = parse_package(package)
    read.validate()
    assert (read.name, read.description) == (NAME, "flyer: a &lt; b")  # as XML
    assert {depend.name for depend in read.buildtool_depends} == {"ament_cmake"}
    assert {"xacro", "robot_state_publisher", "rviz2"} <= {depend.name for depend in read.exec_depends}
    robot = RobotDescription.load(exported.folder / "robot.urdf")
    write_urdf_package(robot, tmp_path / "flyer", package="flyer")
    parse_package(tmp_path / "flyer").validate()
    assert "install(FILES robot.urdf " in (tmp_path / "flyer/CMakeLists.txt").read_text()


def test_the_launch_file_starts_what_shows_the_robot(exported, package):
    names = ("launch", "launch.actions", "launch.conditions", "launch.substitutions")
    ros = ("launch_ros", "launch_ros.actions", "launch_ros.parameter_descriptions", "launch_ros.substitutions")
    stand_ins = {name: MagicMock() for name in (*names, *ros)}
    with patch.dict(sys.modules, stand_ins):
        launch = runpy.run_path(str(package / "launch/display.launch.py"))
        launch["generate_launch_description"]()
    started = [call.kwargs for call in stand_ins["launch_ros.actions"].Node.call_args_list]
    assert [node["package"] for node in started] == [
        "robot_state_publisher",
        "joint_state_publisher_gui",
        "joint_state_publisher",
        "rviz2",
    ]
    depends = {depend.name for depend in parse_package(package).exec_depends}
    assert {node["package"] for node in started} <= depends
    assert launch["START"] == dict(
        zip(exported.settings.joints, exported.settings.initial_joints.tolist(), strict=True)
    )
    assert f"Fixed Frame: {exported.robot.root_link}" in (package / f"rviz/{NAME}.rviz").read_text()


def test_companions_of_meshes_and_dollars(tmp_path):
    (tmp_path / "meshes/body.obj").mkdir(parents=True)
    (tmp_path / "meshes/body.obj/body.obj").write_text("mtllib body.mtl\nv 0 0 0\n")
    (tmp_path / "meshes/body.obj/body.mtl").write_text("newmtl a\n")
    link = (
        '<link name="l"><visual><geometry><mesh filename="meshes/body.obj/body.obj"/></geometry></visual></link>'
        '<gazebo reference="l"><material>${a} $(b) $c</material></gazebo>'
    )
    (tmp_path / "robot.urdf").write_text(f'<robot name="r">{link}</robot>')
    robot = RobotDescription.load(tmp_path / "robot.urdf")
    package = RosPackage(NAME, "r", {})
    write_ros2_package(robot, '<robot name="r"/>', dyn.FlightSettings(), package, tmp_path / "src")
    assert (tmp_path / "src" / NAME / "meshes/body.obj/body.mtl").is_file()
    root = ET.fromstring(expanded(tmp_path / "src" / NAME, prefix="a_"))
    assert root.findtext("gazebo/material") == "${a} $(b) $c"
    assert root.find("gazebo").get("reference") == "a_l"
    assert "START = {}" in (tmp_path / "src" / NAME / "launch/display.launch.py").read_text()


def test_names_that_ros_takes():
    assert [ros_name(text) for text in ("iRonCub-Mk3", "quad", "3 arms", "äö")] == [
        "ironcub_mk3",
        "quad",
        "robot_3_arms",
        "robot",
    ]
    with pytest.raises(UrdfError, match="package name 'A': ROS wants lower-case letters, digits and _, such as 'a'"):
        write_ros2_package(MagicMock(), "", MagicMock(), RosPackage("A", "", {}), Path())
