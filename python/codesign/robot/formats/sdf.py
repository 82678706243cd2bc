"""The robot with its jets as an SDF file, for Gazebo and Drake; every number reads back exactly.

A link of an SDF has mass, so links without become frames of the link they are fixed to, which keeps their names.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET

import numpy as np
from numpy.typing import ArrayLike

from codesign import dynamics as dyn
from codesign.errors import UrdfError
from codesign.robot.bodies import depth_first, has_mass, rigid_bodies
from codesign.robot.collisions import Pairs
from codesign.robot.description import RobotDescription
from codesign.robot.formats.drake_filters import collision_filters
from codesign.robot.jets import torque_limit
from codesign.robot.urdf_elements import Geometry
from codesign.robot.urdf_xml import MOVING, number_text
from codesign.transforms import Matrix, inverse, rpy_from_rotation

VERSION = "1.9"  # the highest one that libsdformat 12 knows
WITH_MIMICS = "1.11"  # the lowest one in which a joint can follow another
OURS = "codesign"
LIMITS = ("lower", "upper", "effort", "velocity")


def sdf_text(robot: RobotDescription, settings: dyn.FlightSettings, ignored: Pairs) -> str:
    """SDF of the free-floating robot, its jets as frames JET_jet and as elements `codesign:jet`.

    Version 1.9, or 1.11 where joints mimic others. SDF has no word for a jet, and Gazebo's thruster turns a propeller
    on a joint: `codesign:jet` names frame, axis and limits as `robot.json` does, and readers skip it.
    `drake:collision_filter_group` leaves out the pairs `ignored`.

    robot: its meshes with paths relative to where the text will stand (Drake reads OBJ alone).
    Raises: UrdfError for joints that SDF cannot say, a moving body without mass, a jet whose frame the robot lacks.
    """
    ET.register_namespace(OURS, OURS)
    root = ET.Element("sdf", version=WITH_MIMICS if robot.mimics else VERSION)
    model = ET.SubElement(root, "model", name=robot.name)
    writer = _Writer(robot, settings, model)
    writer.append_link(robot.root_link, None)
    for name in depth_first(robot):
        writer.append_joint(name)
    for jet in settings.actuators:
        _append_jet(model, robot, jet)
    model.extend(collision_filters(ignored, writer.hosts))
    ET.indent(root)
    return '<?xml version="1.0"?>\n' + ET.tostring(root, encoding="unicode") + "\n"


def host_links(robot: RobotDescription) -> dict[str, str]:
    """Link -> the link that is written for it: itself if it has mass, else the one nearest above it in its rigid body.

    Where none above has mass, the first one of the body with mass. Raises: UrdfError for a body without any.
    """
    first = rigid_bodies(robot)
    heavy = {name for name in robot.link_names if has_mass(robot, name)}
    heads = {
        body: next((link for link in first if first[link] == body and link in heavy), None) for body in first.values()
    }
    for body, head in heads.items():
        if head is None:
            raise UrdfError(f"link {body} moves but has no mass, nor has a link fixed to it: SDF has no such links")
    hosts = {robot.root_link: str(heads[robot.root_link])}
    for name in depth_first(robot):
        joint = robot.joint(name)
        above = hosts[joint.parent] if joint.type == "fixed" else str(heads[first[joint.child]])
        hosts[joint.child] = joint.child if joint.child in heavy else above
    return hosts


class _Writer:
    """Appends links, frames and joints to a model."""

    def __init__(self, robot: RobotDescription, settings: dyn.FlightSettings, model: ET.Element) -> None:
        self.robot, self.settings, self.model = robot, settings, model
        self.hosts = host_links(robot)
        self.poses = robot.frame_poses()
        self.written: set[str] = set()
        self.colors = robot.material_colors()

    def append_joint(self, name: str) -> None:
        """A joint, unless it fixes a link without mass; with its child."""
        joint = self.robot.joint(name)
        host = self.hosts[joint.child]
        if joint.type == "fixed" and (host != joint.child or host in self.written):
            self.append_link(joint.child, None)
            return
        element = ET.SubElement(self.model, "joint", name=name, type=joint.type)
        pose = self._between(self.hosts[joint.parent], joint.child)
        element.append(_pose(pose, self.hosts[joint.parent]))
        ET.SubElement(element, "parent").text = self.hosts[joint.parent]
        ET.SubElement(element, "child").text = host
        if joint.type in MOVING:
            element.append(self._axis(name))
        self.append_link(joint.child, name)

    def append_link(self, name: str, joint: str | None) -> None:
        """A link, or a frame for a link without mass and, before it, the link that carries it."""
        host = self.hosts[name]
        if host not in self.written:
            self.written.add(host)
            self.model.append(self._link(host, name, joint))
        if host != name:
            frame = ET.SubElement(self.model, "frame", {"name": name, "attached_to": host})
            frame.append(_pose(self._between(host, name), host))

    def _link(self, host: str, at: str, joint: str | None) -> ET.Element:
        """The link `host`, placed in the joint that carries the link `at`; with the shapes of all it stands for."""
        element = ET.Element("link", name=host)
        if joint is not None:
            element.append(_pose(self._between(at, host), joint))
        inertial = self.robot.inertial(host)
        assert inertial is not None  # host_links
        item = ET.SubElement(element, "inertial")
        item.append(_pose(_shifted(inertial.com)))
        ET.SubElement(item, "mass").text = number_text(inertial.mass)
        tensor = ET.SubElement(item, "inertia")
        for i, j in ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)):
            ET.SubElement(tensor, f"i{'xyz'[i]}{'xyz'[j]}").text = number_text(inertial.inertia[i, j])
        for link in self.robot.link_names:
            if self.hosts[link] == host:
                self._append_shapes(element, link, self._between(host, link))
        return element

    def _append_shapes(self, element: ET.Element, link: str, host_T_link: Matrix) -> None:
        read = self.robot.link(link)
        for tag, shapes in (("visual", read.visuals), ("collision", read.collisions)):
            for number, shape in enumerate(shapes):
                item = ET.SubElement(element, tag, name=f"{link}_{tag}_{number}")
                item.append(_pose(host_T_link if shape.origin is None else host_T_link @ shape.origin))
                item.append(_geometry(shape.geometry))
                rgba = self.colors.get(getattr(getattr(shape, "material", None), "name", None) or "")
                if rgba is not None:
                    material = ET.SubElement(item, "material")
                    for light in ("ambient", "diffuse"):
                        ET.SubElement(material, light).text = number_text(rgba)

    def _axis(self, name: str) -> ET.Element:
        joint = self.robot.joint(name)
        axis = ET.Element("axis")
        ET.SubElement(axis, "xyz").text = number_text(joint.axis)
        limit = ET.SubElement(axis, "limit")
        for key in LIMITS:
            value = getattr(joint.limit, key, None)
            if key == "effort" and name in self.settings.joints:
                value = torque_limit(self.settings, value)
            if value is not None and not (joint.type == "continuous" and key in ("lower", "upper")):
                ET.SubElement(limit, key).text = number_text(value)
        if name in self.robot.mimics:
            followed, multiplier, offset = self.robot.mimics[name]
            mimic = ET.SubElement(axis, "mimic", joint=followed)
            for key, value in (("multiplier", multiplier), ("offset", offset), ("reference", 0.0)):
                ET.SubElement(mimic, key).text = number_text(value)
        if joint.dynamics is not None:
            dynamics = ET.SubElement(axis, "dynamics")
            for key in ("damping", "friction"):
                ET.SubElement(dynamics, key).text = number_text(getattr(joint.dynamics, key) or 0.0)
        return axis

    def _between(self, a: str, b: str) -> Matrix:
        """a_T_b (4, 4) of links, joints at zero; exactly the joint's origin where one joint is between them."""
        if a == b:
            return np.eye(4)
        for name in self.robot.joint_names:
            joint = self.robot.joint(name)
            if (joint.parent, joint.child) == (a, b):
                return self.robot.joint_origin(name)
        return inverse(self.poses[a]) @ self.poses[b]


def _append_jet(model: ET.Element, robot: RobotDescription, jet: dyn.Actuator) -> None:
    if jet.frame not in robot.link_names:
        raise UrdfError(f"the robot has no jet frame {jet.frame!r}")
    ET.SubElement(model, "frame", {"name": f"{jet.frame}_jet", "attached_to": jet.frame})
    numbers: dict[str, ArrayLike] = {
        "axis": jet.axis,
        "min_thrust_n": jet.thrust_min,
        "max_thrust_n": jet.thrust_max,
        "max_thrust_rate_n_s": jet.thrust_rate,
        "reaction_n_m_per_n": jet.reaction,
    }
    element = ET.SubElement(model, f"{{{OURS}}}jet", frame=f"{jet.frame}_jet")  # a name would clash with the link
    for key, value in numbers.items():
        ET.SubElement(element, f"{{{OURS}}}{key}").text = number_text(value)


def _pose(a_T_b: Matrix, relative_to: str | None = None) -> ET.Element:
    element = ET.Element("pose", {} if relative_to is None else {"relative_to": relative_to})
    element.text = number_text([*a_T_b[:3, 3], *rpy_from_rotation(a_T_b[:3, :3])])
    return element


def _shifted(xyz: Matrix) -> Matrix:
    T = np.eye(4)
    T[:3, 3] = xyz
    return T


def _geometry(geometry: Geometry) -> ET.Element:
    element = ET.Element("geometry")
    box, cylinder, sphere, mesh = geometry.box, geometry.cylinder, geometry.sphere, geometry.mesh
    if box is not None:
        ET.SubElement(ET.SubElement(element, "box"), "size").text = number_text(box.size)
    elif cylinder is not None:
        item = ET.SubElement(element, "cylinder")
        ET.SubElement(item, "radius").text = number_text(cylinder.radius)
        ET.SubElement(item, "length").text = number_text(cylinder.length)
    elif sphere is not None:
        ET.SubElement(ET.SubElement(element, "sphere"), "radius").text = number_text(sphere.radius)
    elif mesh is not None:
        item = ET.SubElement(element, "mesh")
        ET.SubElement(item, "uri").text = mesh.filename
        ET.SubElement(item, "scale").text = number_text(np.broadcast_to(1.0 if mesh.scale is None else mesh.scale, 3))
    return element
