"""Links as a tree: what hangs from what, and which links are one rigid body."""

from __future__ import annotations

from collections.abc import Iterator

from codesign.errors import UrdfError
from codesign.robot.description import RobotDescription
from codesign.robot.urdf_xml import MOVING


def child_joints(robot: RobotDescription) -> dict[str, list[str]]:
    """Link -> names of the joints that hang from it, in the file's order.

    Raises: UrdfError for a joint with more than one degree of freedom.
    """
    children: dict[str, list[str]] = {name: [] for name in robot.link_names}
    for name in robot.joint_names:
        joint = robot.joint(name)
        if joint.type not in (*MOVING, "fixed"):
            raise UrdfError(f"joint {name}: a {joint.type} joint cannot be exported; fixed, {', '.join(MOVING)} can")
        children[joint.parent].append(name)
    return children


def has_mass(robot: RobotDescription, link: str) -> bool:
    """Whether a link has an inertial with a mass above zero."""
    inertial = robot.inertial(link)
    return inertial is not None and inertial.mass > 0.0


def depth_first(robot: RobotDescription) -> Iterator[str]:
    """Names of all joints, parents before children, each branch to its end: the order of a nested file."""
    children = child_joints(robot)
    pending = list(reversed(children[robot.root_link]))
    while pending:
        name = pending.pop()
        yield name
        pending += reversed(children[robot.joint(name).child])


def rigid_bodies(robot: RobotDescription) -> dict[str, str]:
    """Link -> the first link of the rigid body that it belongs to: links joined by fixed joints move as one."""
    first = {robot.root_link: robot.root_link}
    for name in depth_first(robot):
        joint = robot.joint(name)
        first[joint.child] = first[joint.parent] if joint.type == "fixed" else joint.child
    return first
