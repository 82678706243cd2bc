"""A robot description as an immutable value: read, checked, edited by copy, written.

The XML is the data: what an edit does not touch is written as it was read, digit for digit, with the elements that only
other tools know (sensors, transmissions, simulator settings). `urdf_elements` gives the typed view of the same text.
"""

from __future__ import annotations

import copy
import xml.etree.ElementTree as ET
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike

from codesign.dynamics import check_urdf
from codesign.errors import UrdfError
from codesign.files import write_text
from codesign.robot.inertial import Inertial
from codesign.robot.urdf_elements import Joint, Link, joints_of, links_of
from codesign.robot.urdf_xml import MOVING, normalized, number_text, parsed, resolved_mimics, without_shapes
from codesign.transforms import Matrix, require_pose, rotation_about, rpy_from_rotation

Found = TypeVar("Found")
UPPER_TRIANGLE = ("xx", "xy", "xz", "yy", "yz", "zz")


@dataclass(frozen=True, eq=False)
class RobotDescription:
    """Links, joints, inertials and shapes of a robot. Made by `load` or `from_text`; edits return a new one.

    root_link: the link no joint moves. directory: where relative mesh paths start, if known.
    Descriptions share the elements they have in common, so an edit costs the element it replaces.
    """

    root_link: str
    directory: Path | None
    _xml: ET.Element  # never changed: an edit replaces elements in a copy of the root

    @classmethod
    def load(cls, path: str | Path, as_published: bool = False) -> RobotDescription:
        """Reads a URDF file; see `from_text`. Relative mesh paths start at the file's folder."""
        path = Path(path)
        try:
            content = path.read_bytes()
        except OSError as error:
            raise UrdfError(f"{path}: cannot be read: {error.strerror}") from error
        try:
            return cls.from_text(content, as_published, path.resolve().parent)
        except UrdfError as error:
            raise UrdfError(f"{path}: {error}") from error

    @classmethod
    def from_text(
        cls, text: str | bytes, as_published: bool = False, directory: Path | None = None
    ) -> RobotDescription:
        """Checks and reads URDF text.

        as_published: accept inertias that no body can have (they are refused otherwise).
        Raises: UrdfError naming the links or joints: malformed or too large text, document types, duplicate names,
        missing or non-finite numbers, links that are not one tree, negative mass, non-physical inertia of links that
        move as one.
        """
        # A string has its characters already, whatever encoding it declares; lone surrogates are refused as no UTF-8.
        content = text.encode("utf-8", "surrogatepass") if isinstance(text, str) else text
        root_link = check_urdf(content, isinstance(text, str), as_published)
        return cls(root_link, directory, parsed(content, ("utf-8",) if isinstance(text, str) else (None, "utf-8")))

    # ---- reading

    @property
    def name(self) -> str:
        """Name of the robot."""
        return str(self._xml.get("name"))

    @property
    def link_names(self) -> tuple[str, ...]:
        """Names of all links, in the file's order."""
        return tuple(self._links)

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Names of all joints, fixed ones included, in the file's order."""
        return tuple(self._joints)

    @property
    def moving_joint_names(self) -> tuple[str, ...]:
        """Names of the joints with one degree of freedom that mimic no other one, in the file's order."""
        return tuple(name for name, joint in self._joints.items() if joint.type in MOVING and name not in self.mimics)

    @cached_property
    def mimics(self) -> dict[str, tuple[str, float, float]]:
        """Joint that mimics another -> that one, multiplier, offset: multiplier times its position plus offset.

        A joint that follows one which follows a third is given by the third.
        """
        return resolved_mimics(self._joints)

    @property
    def total_mass(self) -> float:
        """Sum of the masses of all links [kg]."""
        return sum(inertial.mass for name in self._links if (inertial := self.inertial(name)) is not None)

    def link(self, name: str) -> Link:
        """The link (do not change its arrays); UrdfError if there is none."""
        return _find(self._links, name, "link")

    def joint(self, name: str) -> Joint:
        """The joint (do not change its arrays); UrdfError if there is none."""
        return _find(self._joints, name, "joint")

    def inertial(self, link: str) -> Inertial | None:
        """Inertial of a link in link axes; None for a link without mass."""
        read = self.link(link).inertial
        if read is None:
            return None
        origin = np.eye(4) if read.origin is None else read.origin
        local = Inertial(read.mass, np.zeros(3), read.inertia)
        return local if np.array_equal(origin, np.eye(4)) else local.moved(origin)

    def joint_parent(self, joint: str) -> str:
        """Name of the link a joint hangs from."""
        parent = self._element("joint", joint).find("parent")
        return "" if parent is None else parent.get("link", "")

    def joint_origin(self, joint: str) -> Matrix:
        """parent_T_child (4, 4) of a joint at position zero."""
        origin = self.joint(joint).origin
        return np.eye(4) if origin is None else np.array(origin)

    def frame_poses(self, positions: Mapping[str, ArrayLike] | None = None) -> dict[str, Matrix]:
        """root_T_link (4, 4) of every link; `positions`: joint name -> rad or m, zero where not given.

        With positions (n,) of n postures, links that they move get (n, 4, 4).
        """
        positions = positions or {}
        for name in positions:
            if self.joint(name).type not in MOVING:
                raise UrdfError(f"joint {name} does not move")
            if name in self.mimics:
                raise UrdfError(f"joint {name} mimics joint {self.mimics[name][0]}: give the position of that one")
        poses = {self.root_link: np.eye(4)}
        children: dict[str, list[Joint]] = {}
        for joint in self._joints.values():
            children.setdefault(joint.parent, []).append(joint)
        pending = [self.root_link]
        while pending:
            parent = pending.pop()
            for joint in children.get(parent, ()):
                motion = _joint_motion(joint, self._position(joint.name, positions))
                poses[joint.child] = poses[parent] @ self.joint_origin(joint.name) @ motion
                pending.append(joint.child)
        return poses

    def _position(self, joint: str, positions: Mapping[str, ArrayLike]) -> ArrayLike:
        """Position of a joint, zero where neither it nor what it follows is given."""
        followed, multiplier, offset = self.mimics.get(joint, (joint, 1.0, 0.0))
        return multiplier * np.asarray(positions.get(followed, 0.0), dtype=float) + offset

    def mesh_filenames(self) -> list[tuple[str, str]]:
        """(link, filename) of every mesh of the robot's visuals and collisions, as written in the file."""
        return [
            (str(link.get("name")), str(mesh.get("filename")))
            for link in self._xml.findall("link")
            for mesh in link.iter("mesh")
        ]

    def material_colors(self) -> dict[str, tuple[float, ...]]:
        """Material -> red, green, blue, alpha (0 to 1), of every material with a color."""
        colors = {}
        for material in self._xml.iter("material"):
            color = material.find("color")
            if color is not None:
                colors[str(material.get("name"))] = tuple(float(c) for c in str(color.get("rgba")).split())
        return colors

    # ---- editing: each returns a new description

    def replace_inertial(self, link: str, inertial: Inertial) -> RobotDescription:
        """The robot with the whole inertial of a link replaced: mass, center of mass and full tensor, link axes.

        Raises: UrdfError naming the link if it does not exist or the inertial is not physical.
        """
        inertial.require_physical(link)
        element = self._copied("link", link)
        _replace(element, "inertial", _inertial_element(inertial))
        return self._with(element)

    def set_joint_origin(self, joint: str, parent_T_child: ArrayLike) -> RobotDescription:
        """The robot with a joint's child placed at `parent_T_child` (4, 4) in its parent, at joint position zero."""
        T = require_pose(parent_T_child, f"origin of joint {joint}")
        element = self._copied("joint", joint)
        _replace(element, "origin", _origin_element(T))
        return self._with(element)

    def edited(self, tag: str, name: str, edit: Callable[[ET.Element], None]) -> RobotDescription:
        """The robot with what `edit` does to a copy of the link's or joint's (tag) element."""
        element = self._copied(tag, name)
        edit(element)
        return self._with(element)

    def set_mesh(
        self,
        link: str,
        filename: str,
        link_T_mesh: ArrayLike,
        scale: float = 1.0,
        material: str | None = None,
        collisions: Sequence[str] = (),
    ) -> RobotDescription:
        """The robot with one mesh as the only visual of a link, and its collision shapes.

        filename: as it is to stand in the URDF (relative path or package://…). scale: file units to meters.
        link_T_mesh: (4, 4). material: name of a material of the robot; None keeps the link's first one.
        collisions: meshes of the same frame and scale to collide with; the visual's mesh if there are none.
        """
        T = require_pose(link_T_mesh, f"mesh of link {link}")
        element = self._copied("link", link)
        old_material = element.find("visual/material")
        for shape in (*element.findall("visual"), *element.findall("collision")):
            element.remove(shape)
        colliding = [("collision", name) for name in collisions or (filename,)]
        for tag, name in (("visual", filename), *colliding):
            shape = ET.SubElement(element, tag)
            shape.append(_origin_element(T))
            geometry = ET.SubElement(shape, "geometry")
            ET.SubElement(geometry, "mesh", filename=name, scale=number_text([scale] * 3))
            if tag == "visual" and material is not None:
                ET.SubElement(shape, "material", name=material)
            elif tag == "visual" and old_material is not None:
                shape.append(old_material)
        return self._with(element)

    def with_mesh_filenames(self, renamed: Mapping[str, str]) -> RobotDescription:
        """The robot with mesh filenames replaced: old -> new; those not named stay."""
        xml = copy.deepcopy(self._xml)
        for mesh in xml.iter("mesh"):
            mesh.set("filename", renamed.get(str(mesh.get("filename")), str(mesh.get("filename"))))
        return RobotDescription(self.root_link, self.directory, xml)

    def with_joint_bounds(self, effort: float, velocity: float) -> RobotDescription:
        """The robot with no moving joint above these bounds [N m or N, rad/s or m/s]; lower ones stay."""
        xml = copy.deepcopy(self._xml)
        for joint in xml.findall("joint"):
            if joint.get("type") not in MOVING:
                continue
            limit = joint.find("limit")
            if limit is None:
                limit = ET.SubElement(joint, "limit")
            for key, bound in (("effort", effort), ("velocity", velocity)):
                limit.set(key, number_text(min(bound, float(limit.get(key, bound)))))
        return RobotDescription(self.root_link, self.directory, xml)

    def renamed(self, name: str) -> RobotDescription:
        """The same robot by another name."""
        xml = copy.copy(self._xml)
        xml.set("name", name)
        return RobotDescription(self.root_link, self.directory, xml)

    def with_elements(
        self, elements: Sequence[ET.Element], namespaces: Mapping[str, str], comment: str = ""
    ) -> RobotDescription:
        """The robot with a comment and elements that only other tools read at its end.

        namespaces: attributes of the root that declare the prefixes of their names, such as `xmlns:drake`.
        """
        xml = copy.copy(self._xml)
        xml.attrib = {**self._xml.attrib, **namespaces}
        if comment:
            xml.append(ET.Comment(comment))
        xml.extend(elements)
        return RobotDescription(self.root_link, self.directory, xml)

    def with_link(
        self, name: str, joint: str, parent: str, parent_T_link: ArrayLike, inertial: Inertial | None = None
    ) -> RobotDescription:
        """The robot with one more link, held by a fixed joint at `parent_T_link` (4, 4) of the link `parent`.

        Raises: UrdfError: a name is taken, there is no such parent, or the inertial is not physical.
        """
        self.link(parent)
        if name in self._links or joint in self._joints:
            raise UrdfError(f"the robot has a link {name!r} or a joint {joint!r} already")
        xml = copy.copy(self._xml)
        link = ET.SubElement(xml, "link", name=name)
        if inertial is not None:
            inertial.require_physical(name)
            link.append(_inertial_element(inertial))
        fixed = ET.SubElement(xml, "joint", name=joint, type="fixed")
        fixed.append(_origin_element(require_pose(parent_T_link, f"origin of joint {joint}")))
        ET.SubElement(fixed, "parent", link=parent)
        ET.SubElement(fixed, "child", link=name)
        return RobotDescription(self.root_link, self.directory, xml)

    def hung_from(self, joint: str, parent: str, parent_T_child: ArrayLike) -> RobotDescription:
        """The robot with a joint hung from another link at a pose (4, 4). Raises: UrdfError: no such joint or link."""
        self.link(parent)
        moved = self.set_joint_origin(joint, parent_T_child)
        element = moved._copied("joint", joint)
        _replace(element, "parent", ET.Element("parent", link=parent))
        return moved._with(element)

    # ---- writing

    def to_text(self) -> str:
        """URDF text; what no edit touched stands as it was read."""
        xml = copy.deepcopy(self._xml)
        ET.indent(xml)
        return '<?xml version="1.0"?>\n' + ET.tostring(xml, encoding="unicode") + "\n"

    def to_dynamics(self) -> str:
        """URDF text of masses and joints alone: all that a flight needs, in a quarter of the time."""
        return without_shapes(self._xml)

    def write(self, path: str | Path) -> Path:
        """Writes the URDF, whole or not at all; returns the path."""
        return write_text(path, self.to_text())

    # ---- internal

    @cached_property
    def _normalized(self) -> ET.Element:
        return normalized(self._xml)

    @cached_property
    def _links(self) -> dict[str, Link]:
        return {link.name: link for link in links_of(self._normalized)}

    @cached_property
    def _joints(self) -> dict[str, Joint]:
        return {joint.name: joint for joint in joints_of(self._normalized)}

    def _element(self, tag: str, name: str) -> ET.Element:
        for element in self._xml.findall(tag):
            if element.get("name") == name:
                return element
        raise UrdfError(f"the robot has no {tag} {name!r}")

    def _copied(self, tag: str, name: str) -> ET.Element:
        return copy.deepcopy(self._element(tag, name))

    def _with(self, element: ET.Element) -> RobotDescription:
        xml = copy.copy(self._xml)
        for index, old in enumerate(xml):
            if old.tag == element.tag and old.get("name") == element.get("name"):
                xml[index] = element
        edited = RobotDescription(self.root_link, self.directory, xml)
        if not vars(self).keys().isdisjoint(("_links", "_joints")):  # read already: all but one stays
            alone = ET.Element(xml.tag, name=self.name)
            alone.append(element)
            one = normalized(alone)
            vars(edited)["_links"] = self._links | {link.name: link for link in links_of(one)}
            vars(edited)["_joints"] = self._joints | {joint.name: joint for joint in joints_of(one)}
        return edited


def _find(named: Mapping[str, Found], name: str, kind: str) -> Found:
    try:
        return named[name]
    except KeyError:
        raise UrdfError(f"the robot has no {kind} {name!r}") from None


def _joint_motion(joint: Joint, position: ArrayLike) -> Matrix:
    position = np.asarray(position, dtype=float)
    motion = np.broadcast_to(np.eye(4), (*position.shape, 4, 4)).copy()
    if joint.type in MOVING:
        axis = joint.axis / np.linalg.norm(joint.axis)
        if joint.type == "prismatic":
            motion[..., :3, 3] = position[..., None] * axis
        else:
            motion[..., :3, :3] = rotation_about(axis, position)
    return motion


def _replace(element: ET.Element, tag: str, child: ET.Element) -> None:
    old = element.find(tag)
    position = 0 if old is None else list(element).index(old)
    if old is not None:
        element.remove(old)
    element.insert(position, child)


def _origin_element(T: Matrix) -> ET.Element:
    return ET.Element("origin", xyz=number_text(T[:3, 3]), rpy=number_text(rpy_from_rotation(T[:3, :3])))


def _inertial_element(inertial: Inertial) -> ET.Element:
    element = ET.Element("inertial")
    ET.SubElement(element, "origin", xyz=number_text(inertial.com), rpy=number_text(np.zeros(3)))
    ET.SubElement(element, "mass", value=number_text(inertial.mass))
    entries = {
        f"i{key}": number_text(inertial.inertia["xyz".index(key[0]), "xyz".index(key[1])]) for key in UPPER_TRIANGLE
    }
    ET.SubElement(element, "inertia", entries)
    return element
