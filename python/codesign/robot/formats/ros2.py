"""The robot as a package for ROS 2: xacro with the design's values, meshes, a launch file that shows it in RViz.

Built by `colcon build` (ament_cmake); what the texts hold is of the ROS 2 releases since Humble.
"""

from __future__ import annotations

import copy
import re
import shutil
import xml.etree.ElementTree as ET
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.sax.saxutils import escape

from codesign import dynamics as dyn
from codesign.errors import UrdfError
from codesign.files import write_text
from codesign.names import identifier
from codesign.robot.description import RobotDescription
from codesign.robot.mesh_companions import companions
from codesign.robot.urdf_xml import parsed

ROS_NAME = r"[a-z][a-z0-9_]*"  # of packages, REP 144
XACRO = {"xmlns:xacro": "http://www.ros.org/wiki/xacro"}
PREFIXED = {
    "link": ("name",),
    "joint": ("name",),
    "parent": ("link",),
    "child": ("link",),
    "mimic": ("joint",),
    "gazebo": ("reference",),
    "transmission": ("name",),
    "actuator": ("name",),
    "drake:collision_filter_group": ("name",),
    "drake:member": ("link",),
    "drake:ignored_collision_filter_group": ("name",),
    "virtual_joint": ("name", "child_link"),
    "disable_collisions": ("link1", "link2"),
}  # element -> its attributes that name something of this robot alone
STATED = " what the design is; other values here change no part: export the other design "


@dataclass(frozen=True)
class RosPackage:
    """What a package is called and says.

    name: of the package and its files. description: for package.xml. values: design variable with its unit, such as
    `offset_mm`, and its value in words; they become properties of the xacro.
    """

    name: str
    description: str
    values: Mapping[str, str]


def ros_name(text: str) -> str:
    """The text as a name that ROS takes for a package."""
    plain = re.sub(r"[^a-z0-9]+", "_", text.lower()).strip("_")
    return plain if re.fullmatch(ROS_NAME, plain) else f"robot_{plain}".rstrip("_")


def require_ros_name(name: str) -> None:
    """Raises: UrdfError for a name that ROS does not take for a package."""
    if not re.fullmatch(ROS_NAME, name):
        raise UrdfError(
            f"package name {name!r}: ROS wants lower-case letters, digits and _, such as {ros_name(name)!r}"
        )


def write_ros2_package(
    robot: RobotDescription, srdf: str, settings: dyn.FlightSettings, package: RosPackage, folder: Path
) -> None:
    """Writes the package into a folder named as it is, below `folder`.

    robot: its meshes in the folder `meshes` beside its file. srdf: collisions to be left out, as text.
    Raises: UrdfError for a name that ROS does not take, or a robot whose meshes lie elsewhere.
    """
    require_ros_name(package.name)
    below, name = folder / package.name, package.name
    if robot.directory is None or any(not mesh.startswith("meshes/") for _, mesh in robot.mesh_filenames()):
        raise UrdfError("a ROS package needs the robot's meshes in the folder meshes beside its URDF")
    home = robot.directory.resolve()
    meshes = [home / mesh for _, mesh in robot.mesh_filenames()]
    (below / "meshes").mkdir(parents=True, exist_ok=True)
    for file in {path for mesh in meshes for path in (mesh, *companions(mesh, [home]))}:
        target = below / file.relative_to(home)
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(file, target)
    values = {"robot": robot.name, "name": name, "root": robot.root_link}
    texts = {
        "package.xml": package_xml(name, package.description, launched=True),
        "CMakeLists.txt": cmake_text(name, ["config", "launch", "meshes", "rviz", "urdf"], hooks=True),
        f"env-hooks/{name}.dsv.in": _HOOKS,
        "launch/display.launch.py": _launch(robot, settings, name),
        f"rviz/{name}.rviz": _RVIZ % values,
        f"urdf/{name}_macro.xacro": _macro(robot, name),
        f"urdf/{name}.urdf.xacro": _top(robot, package),
        f"config/{name}.srdf.xacro": _srdf(srdf),
    }
    for path, text in texts.items():
        (below / path).parent.mkdir(parents=True, exist_ok=True)
        write_text(below / path, text)


def package_xml(name: str, description: str, launched: bool = False) -> str:
    """package.xml of format 3, built by ament_cmake; launched: with what `display.launch.py` runs."""
    needed = "".join(f"\n  <exec_depend>{other}</exec_depend>" for other in (_RUN if launched else ()))
    return f"""<?xml version="1.0"?>
<package format="3">
  <name>{name}</name>
  <version>0.0.0</version>
  <description>{escape(description)}</description>
  <maintainer email="user@example.com">user</maintainer>
  <license>see the robot's own terms</license>
  <buildtool_depend>ament_cmake</buildtool_depend>{needed}
  <export>
    <build_type>ament_cmake</build_type>
  </export>
</package>
"""


def cmake_text(package: str, folders: Sequence[str], files: Sequence[str] = (), hooks: bool = False) -> str:
    """CMakeLists.txt that installs folders and files as they are; hooks: and `env-hooks/PACKAGE.dsv.in`."""
    lines = ["cmake_minimum_required(VERSION 3.8)", f"project({package} NONE)", "find_package(ament_cmake REQUIRED)"]
    lines += [f"install(FILES {' '.join(files)} DESTINATION share/${{PROJECT_NAME}})"] if files else []
    lines += [f"install(DIRECTORY {' '.join(folders)} DESTINATION share/${{PROJECT_NAME}})"]
    hook = '"${CMAKE_CURRENT_SOURCE_DIR}/env-hooks/${PROJECT_NAME}.dsv.in"'
    lines += [f"ament_environment_hooks({hook})"] if hooks else []
    return "\n".join([*lines, "ament_package()", ""])


def _prefixed(root: ET.Element, prefix: str) -> list[ET.Element]:
    """Copies of the elements below the root, with `prefix` before all names of its own, safe for xacro."""
    elements = [copy.deepcopy(element) for element in root]
    for element in (inner for outer in elements for inner in outer.iter()):
        if not isinstance(element.tag, str):  # a comment
            continue
        for key, value in element.attrib.items():
            plain = re.sub(r"\$(?=[({])", "$$", value)
            element.set(key, prefix + plain if key in PREFIXED.get(element.tag, ()) else plain)
        if element.text:
            element.text = re.sub(r"\$(?=[({])", "$$", element.text)
    return elements


def _text(root: ET.Element) -> str:
    ET.indent(root)
    return '<?xml version="1.0"?>\n' + ET.tostring(root, encoding="unicode") + "\n"


def _macro(robot: RobotDescription, name: str) -> str:
    """The robot as a macro with the parameters prefix and base, so that others can build on it."""
    meshes = {mesh: f"package://{name}/{mesh}" for _, mesh in robot.mesh_filenames()}
    source = parsed(robot.with_mesh_filenames(meshes).to_text().encode(), ("utf-8",))
    spaces = {key: value for key, value in source.attrib.items() if key.startswith("xmlns:")}
    root = ET.Element("robot", spaces | XACRO)
    macro = ET.SubElement(root, "xacro:macro", name=identifier(name), params="prefix:='' base:=''")
    macro.extend(_prefixed(source, "${prefix}"))
    held = ET.SubElement(macro, "xacro:if", value="${base != ''}")
    joint = ET.SubElement(held, "joint", name=f"${{prefix}}{robot.root_link}_to_base", type="fixed")
    ET.SubElement(joint, "parent", link="${base}")
    ET.SubElement(joint, "child", link=f"${{prefix}}{robot.root_link}")
    return _text(root)


def _top(robot: RobotDescription, package: RosPackage) -> str:
    root = ET.Element("robot", {"name": robot.name} | XACRO)
    root.append(ET.Comment(STATED))
    for key, value in package.values.items():
        ET.SubElement(root, "xacro:property", name=f"design_{identifier(key)}", value=value)
    for name in ("prefix", "base"):
        ET.SubElement(root, "xacro:arg", name=name, default="")
    ET.SubElement(root, "xacro:include", filename=f"{package.name}_macro.xacro")
    ET.SubElement(root, "xacro:property", name="base", value="$(arg base)")
    held = ET.SubElement(root, "xacro:if", value="${base != ''}")
    ET.SubElement(held, "link", name="${base}")
    ET.SubElement(root, f"xacro:{identifier(package.name)}", prefix="$(arg prefix)", base="${base}")
    return _text(root)


def _srdf(srdf: str) -> str:
    source = ET.fromstring(srdf)
    root = ET.Element("robot", {"name": str(source.get("name"))} | XACRO)
    ET.SubElement(root, "xacro:arg", name="prefix", default="")
    root.extend(_prefixed(source, "$(arg prefix)"))
    return _text(root)


def _launch(robot: RobotDescription, settings: dyn.FlightSettings, name: str) -> str:
    start = dict(zip(settings.joints, settings.initial_joints.tolist(), strict=True))
    lines = "".join(f'    "{joint}": {angle!r},\n' for joint, angle in start.items())
    table = f"{{\n{lines}}}" if start else "{}"
    return _LAUNCH.replace("PACKAGE", name).replace("ROOT", robot.root_link).replace("TABLE", table)


_RUN = (
    "joint_state_publisher",
    "joint_state_publisher_gui",
    "launch",
    "launch_ros",
    "robot_state_publisher",
    "rviz2",
    "xacro",
)
_HOOKS = """prepend-non-duplicate;GZ_SIM_RESOURCE_PATH;share
prepend-non-duplicate;IGN_GAZEBO_RESOURCE_PATH;share
prepend-non-duplicate;ROS_PACKAGE_PATH;share
"""
_LAUNCH = '''"""The robot in RViz: ros2 launch PACKAGE display.launch.py [prefix:=a_] [base:=world] [gui:=false]."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution, PythonExpression
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

START = TABLE  # rad, m: the posture in which the flight begins


def generate_launch_description():
    share = FindPackageShare("PACKAGE")
    prefix, base, gui = (LaunchConfiguration(name) for name in ("prefix", "base", "gui"))
    xacro = PathJoinSubstitution([share, "urdf", "PACKAGE.urdf.xacro"])
    description = Command(["xacro ", xacro, " prefix:=", prefix, " base:=", base])
    frame = PythonExpression(["'", base, "' or '", prefix, "ROOT'"])
    start = [{("zeros.", prefix, name): angle for name, angle in START.items()}] if START else []
    joints = ("joint_state_publisher_gui", IfCondition(gui)), ("joint_state_publisher", UnlessCondition(gui))
    return LaunchDescription(
        [
            DeclareLaunchArgument("prefix", default_value="", description="before all names of links and joints"),
            DeclareLaunchArgument("base", default_value="", description="link that holds the robot; none if empty"),
            DeclareLaunchArgument("gui", default_value="true", description="sliders for the joints"),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[{"robot_description": ParameterValue(description, value_type=str)}],
            ),
            *(Node(package=name, executable=name, condition=when, parameters=start) for name, when in joints),
            Node(
                package="rviz2",
                executable="rviz2",
                arguments=["-d", PathJoinSubstitution([share, "rviz", "PACKAGE.rviz"]), "-f", frame],
            ),
        ]
    )
'''
_RVIZ = """Panels:
  - Class: rviz_common/Displays
    Name: Displays
  - Class: rviz_common/Views
    Name: Views
Visualization Manager:
  Class: ""
  Displays:
    - Class: rviz_default_plugins/Grid
      Enabled: true
      Name: Grid
    - Class: rviz_default_plugins/RobotModel
      Collision Enabled: false
      Description Source: Topic
      Description Topic:
        Depth: 1
        Durability Policy: Transient Local
        Reliability Policy: Reliable
        Value: /robot_description
      Enabled: true
      Name: %(robot)s
      Visual Enabled: true
    - Class: rviz_default_plugins/TF
      Enabled: false
      Name: TF
  Enabled: true
  Global Options:
    Fixed Frame: %(root)s
    Frame Rate: 30
  Name: root
  Tools:
    - Class: rviz_default_plugins/Interact
    - Class: rviz_default_plugins/MoveCamera
    - Class: rviz_default_plugins/Select
  Views:
    Current:
      Class: rviz_default_plugins/Orbit
      Distance: 3
      Name: Current View
      Pitch: 0.3
      Target Frame: <Fixed Frame>
      Value: Orbit (rviz)
      Yaw: 0.8
"""
