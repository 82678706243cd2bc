"""Robot regeneration: puts a design's parts into the base robot.

A part is placed as data: in which link its frame sits and how, whether as its mirror image, and which joints hang from
which of its interfaces. The formulas of a particular part stay in the part: it names the poses of its interfaces.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import msgspec
import numpy as np

from codesign.errors import StudyError, UrdfError
from codesign.robot.description import RobotDescription
from codesign.robot.inertial import Inertial, MassProperties
from codesign.transforms import Axis, Matrix, mirrored_pose, pose, reflection, require_pose
from codesign.units import DEGREE, MILLIMETER

Vector = tuple[float, float, float]


class Pose(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A pose as written in a study: mm and degrees; fixed-axis roll, pitch, yaw."""

    xyz_mm: Vector = (0.0, 0.0, 0.0)
    rpy_deg: Vector = (0.0, 0.0, 0.0)

    def matrix(self) -> Matrix:
        """(4, 4), meters."""
        return pose([x * MILLIMETER for x in self.xyz_mm], [angle * DEGREE for angle in self.rpy_deg])


class JointAttachment(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A joint whose origin follows an interface of the part: parent_T_child = link_T_part · part_T_interface · offset.

    interface_T_child: the constant offset between interface and the joint's child.
    """

    interface: str
    interface_T_child: Pose = Pose()


class PartPlacement(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Where a part sits in the robot.

    link: the link the part is (its inertial and shapes are replaced whole). link_T_part: the part's frame in the link.
    mirror: the part is built as its mirror image along this axis of the part frame before it is placed.
    joints: joints that hang from the link, and the interface each follows.
    """

    link: str
    link_T_part: Pose = Pose()
    mirror: Axis | None = None
    joints: dict[str, JointAttachment] = {}


@dataclass(frozen=True, slots=True, eq=False)
class PartBody:
    """What the robot needs of a built part, in the part frame.

    properties: mass, com, inertia (3, 3) about the com. interfaces: name -> part_T_interface (4, 4) [m].
    mesh, mirrored_mesh: path of the mesh of the part and of its mirror image as it is to stand in the URDF; None leaves
    the link's shapes. mesh_scale: file units to meters. carried: what hangs on an interface, in its axes: links without
    a mass of their own take it.
    """

    properties: MassProperties
    interfaces: Mapping[str, Matrix] = field(default_factory=dict)
    mesh: str | None = None
    mirrored_mesh: str | None = None
    mesh_scale: float = MILLIMETER
    carried: Mapping[str, Inertial] = field(default_factory=dict)


def assemble(
    base: RobotDescription, placements: Mapping[str, Sequence[PartPlacement]], parts: Mapping[str, PartBody]
) -> RobotDescription:
    """The base robot with every placed part in it: whole inertials, joint origins and, where given, meshes.

    placements: part name -> its places. parts: part name -> the built part.
    Raises: UrdfError if a link or joint does not exist, a joint does not hang from the placed link, or an inertial is
    not physical; StudyError if a part or interface is missing or a link is placed twice.
    """
    _require_each_link_once(placements)
    robot = base
    for name, places in placements.items():
        if name not in parts:
            raise StudyError(f"part {name!r} is placed on the robot but was not built")
        for place in places:
            robot = _placed(robot, place, name, parts[name])
    return robot


def place_inertial(place: PartPlacement, properties: MassProperties) -> Inertial:
    """Inertial of a placed part in link axes."""
    body = Inertial.of(properties)
    return (body if place.mirror is None else body.mirrored(place.mirror)).moved(place.link_T_part.matrix())


def place_interface(place: PartPlacement, part_T_interface: Matrix) -> Matrix:
    """link_T_interface (4, 4) of a placed part; the interface's y axis is turned round in a mirror image."""
    local = part_T_interface if place.mirror is None else mirrored_pose(part_T_interface, place.mirror)
    return place.link_T_part.matrix() @ local


def place_carried(place: PartPlacement, attachment: JointAttachment, body: Inertial) -> Inertial:
    """What hangs on an interface, given in its axes, in axes of the link that hangs there."""
    local = body if place.mirror is None else body.mirrored(place.mirror)
    return local.moved(np.linalg.inv(attachment.interface_T_child.matrix()))


def place_points(place: PartPlacement, points: Matrix) -> Matrix:
    """Points (n, 3) of a placed part in link axes [m]."""
    T = place.link_T_part.matrix()
    local = points if place.mirror is None else points @ reflection(place.mirror)
    return local @ T[:3, :3].T + T[:3, 3]


def _placed(robot: RobotDescription, place: PartPlacement, name: str, part: PartBody) -> RobotDescription:
    robot = robot.replace_inertial(place.link, place_inertial(place, part.properties))
    for joint, attachment in place.joints.items():
        if robot.joint_parent(joint) != place.link:
            raise UrdfError(f"joint {joint} hangs from link {robot.joint_parent(joint)}, not from {place.link}")
        if attachment.interface not in part.interfaces:
            known = ", ".join(part.interfaces) or "none"
            raise StudyError(f"part {name}: no interface {attachment.interface!r}; it has {known}")
        interface = require_pose(part.interfaces[attachment.interface], f"{name}: {attachment.interface}")
        link_T_child = place_interface(place, interface) @ attachment.interface_T_child.matrix()
        robot = robot.set_joint_origin(joint, link_T_child)
        child = robot.joint(joint).child
        if attachment.interface in part.carried and robot.inertial(child) is None:
            robot = robot.replace_inertial(child, place_carried(place, attachment, part.carried[attachment.interface]))
    mesh = part.mesh if place.mirror is None else part.mirrored_mesh
    if mesh is not None:
        robot = robot.set_mesh(place.link, mesh, place.link_T_part.matrix(), part.mesh_scale)
    return robot


def _require_each_link_once(placements: Mapping[str, Sequence[PartPlacement]]) -> None:
    owner: dict[str, str] = {}
    for name, places in placements.items():
        for place in places:
            if place.link in owner:
                raise StudyError(f"link {place.link} is taken by part {owner[place.link]!r} and by part {name!r}")
            owner[place.link] = name
