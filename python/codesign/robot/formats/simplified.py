"""Robots for readers that want less than the format allows: no links without mass, axes along coordinate axes."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from codesign.robot.bodies import has_mass
from codesign.robot.description import UPPER_TRIANGLE, RobotDescription
from codesign.robot.urdf_xml import MOVING, number_text, parsed
from codesign.transforms import Matrix, rpy_from_rotation

Frames = Literal["keep", "drop", "tiny"]
TINY_MASS, TINY_INERTIA = 1e-9, 1e-15  # kg, kg m²: a ball of 1.6 mm
NEAR = 1e-5  # of a direction's entry from 0, 1 or -1: meant to be it
SAME = 1e-12  # rounding of angles in the file
MOVED = 1e-6  # m that rounding may move a flown frame
Postures = Mapping[str, Matrix]


@dataclass(frozen=True)
class Simplification:
    """What is written differently from the robot that was flown.

    frames: links without mass and shapes that a fixed joint holds and nothing hangs from are kept, dropped, or get a
    tiny inertial in URDF files. exact_axes: see `with_exact_axes`.
    """

    frames: Frames = "keep"
    exact_axes: bool = False


def without_frames(robot: RobotDescription, kept: Collection[str]) -> RobotDescription:
    """The robot without links that have neither mass nor shapes, are held by fixed joints and hold nothing themselves.

    Repeated until none is left. kept: names of links that stay, such as jets.
    """
    root = _xml(robot)
    joints = {str(child.get("link")): joint for joint, child in _children(root)}
    while True:
        parents = {str(parent.get("link")) for joint in joints.values() for parent in joint.findall("parent")}
        empty = [
            link
            for link in root.findall("link")
            if (name := str(link.get("name"))) in joints
            and joints[name].get("type") == "fixed"
            and name not in parents
            and name not in kept
            and not has_mass(robot, name)
            and not link.findall("visual")
            and not link.findall("collision")
        ]
        if not empty:
            return _robot(root, robot)
        for link in empty:
            root.remove(link)
            root.remove(joints.pop(str(link.get("name"))))


def with_tiny_inertials(robot: RobotDescription) -> RobotDescription:
    """The robot with 1e-9 kg in every link without mass: some readers give 1 kg to those, others lose them."""
    root = _xml(robot)
    for link in root.findall("link"):
        if not has_mass(robot, str(link.get("name"))):
            for old in link.findall("inertial"):
                link.remove(old)
            inertial = ET.SubElement(link, "inertial")
            ET.SubElement(inertial, "mass", value=number_text(TINY_MASS))
            diagonal = {f"i{key}": number_text(TINY_INERTIA if key[0] == key[1] else 0.0) for key in UPPER_TRIANGLE}
            ET.SubElement(inertial, "inertia", diagonal)
    return _robot(root, robot)


def with_exact_axes(robot: RobotDescription, postures: Postures) -> tuple[RobotDescription, float]:
    """The robot with axes and turned frames that lie along coordinate axes but for 1e-5 exactly along them.

    Joint by joint, the one that moves frames least first, as long as no frame moves by 1e-6 m in any posture (joint ->
    positions (n,)). Returns how far one moves at most [m]. Masses and inertias stay as they are.
    """
    positions = {name: values for name, values in postures.items() if name in robot.moving_joint_names}
    before = robot.frame_poses(positions)

    def moved(other: RobotDescription) -> float:
        after = other.frame_poses(positions)
        return max(float(np.abs(after[link] - before[link])[..., :3, 3].max()) for link in before)

    candidates = []
    for name in robot.joint_names:
        rounded = _rounded(robot, name)
        if rounded is not None:
            candidates.append((moved(rounded), name))
    result, largest = robot, 0.0
    for _, name in sorted(candidates):
        rounded = _rounded(result, name)
        assert rounded is not None  # it was a candidate
        distance = moved(rounded)
        if distance < MOVED:
            result, largest = rounded, distance
    return result, largest


def simplified(
    robot: RobotDescription, how: Simplification, jets: Collection[str], postures: Postures
) -> tuple[RobotDescription, str]:
    """The robot as a simplification has it but for tiny inertials, and a comment on it for the file ("" if none)."""
    words = ""
    if how.exact_axes:
        robot, largest = with_exact_axes(robot, postures)
        words = f" axes and frames are rounded to exact ones: none moves by more than {largest:.1g} m in the flight "
    return (without_frames(robot, jets) if how.frames == "drop" else robot), words


def _rounded(robot: RobotDescription, name: str) -> RobotDescription | None:
    """The robot with one joint's axis and frame rounded; None if there is nothing to round."""
    joint = robot.joint(name)
    R = robot.joint_origin(name)[:3, :3]
    axis = np.asarray(joint.axis, dtype=float)
    exact_R, exact_axis = np.round(R), np.round(axis)
    turn = SAME < np.abs(R - exact_R).max() < NEAR
    direct = joint.type in MOVING and SAME < np.abs(axis - exact_axis).max() < NEAR
    rpy = number_text(rpy_from_rotation(exact_R))

    def edit(element: ET.Element) -> None:
        origin, direction = element.find("origin"), element.find("axis")
        if turn and origin is not None:
            origin.attrib.pop("quat_xyzw", None)
            origin.set("rpy", rpy)
        if direct and direction is not None:
            direction.set("xyz", number_text(exact_axis))

    return robot.edited("joint", name, edit) if turn or direct else None


def _xml(robot: RobotDescription) -> ET.Element:
    return parsed(robot.to_text().encode(), ("utf-8",))


def _robot(root: ET.Element, robot: RobotDescription) -> RobotDescription:
    return RobotDescription.from_text(ET.tostring(root, encoding="unicode"), True, robot.directory)


def _children(root: ET.Element) -> Iterator[tuple[ET.Element, ET.Element]]:
    """Joints with their elements that name the child."""
    for joint in root.findall("joint"):
        for child in joint.findall("child"):
            yield joint, child
