"""The robot with its jets as an MJCF file, for MuJoCo and what else reads it; every number reads back exactly.

Written as text: the writers of the library print six digits. Links keep their names, fixed ones too; joints are in the
order of the nested bodies.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET

import numpy as np

from codesign import dynamics as dyn
from codesign.errors import UrdfError
from codesign.robot.bodies import child_joints, depth_first, has_mass, rigid_bodies
from codesign.robot.collisions import Pairs
from codesign.robot.description import RobotDescription
from codesign.robot.jets import torque_limit
from codesign.robot.urdf_elements import Material, Mesh, Shape
from codesign.robot.urdf_xml import MOVING, number_text
from codesign.transforms import Matrix, quaternion

GRAVITY = 9.81  # m/s², along -z of the world, as flown
TIME_STEP = 1e-3  # s
DRAWN, COLLIDING = "2", "3"  # groups of geoms as viewers expect them
RIGID = "0.9999 0.9999 0.001"  # impedances of an equality, the largest there are; by default 0.9: forces 10 % off
START = "start"  # name of the posture in which the flight begins
TURBINE = " %s: the turbine's second order cannot be said here; the control is the thrust itself [N] "
LAG = " %s: the control is the thrust wanted [N], within the limits; first-order lag "
INTEGRATOR = " %s: the control is the rate of the thrust [N/s]; the activation is the thrust [N] "


def mjcf_text(robot: RobotDescription, settings: dyn.FlightSettings, ignored: Pairs) -> str:
    """MJCF of a free-floating robot with a site and an actuator for each jet and a motor for each joint.

    Bodies, joints and jets have the URDF's names; the site of a jet is JET_jet, a motor is named after its joint.
    A drive's rotor is the joint's armature.
    Keyframe "start": the posture, thrusts and controls in which the flight of the settings begins.

    robot: its meshes with paths relative to where the text will stand (OBJ is read by most). ignored: pairs of links
    whose contacts are left out.
    Raises: UrdfError for joints that MJCF cannot say, or a jet whose frame the robot lacks.
    """
    root = ET.Element("mujoco", model=robot.name)
    ET.SubElement(root, "compiler", angle="radian", autolimits="true")
    gravity = number_text([0.0, 0.0, -GRAVITY])
    ET.SubElement(root, "option", integrator="RK4", timestep=number_text(TIME_STEP), gravity=gravity)
    assets = ET.SubElement(root, "asset")
    base = ET.SubElement(ET.SubElement(root, "worldbody"), "body", name=robot.root_link)
    ET.SubElement(base, "freejoint", name="root")
    _refuse_bodies_without_mass(robot)
    _Bodies(robot, settings, assets).fill(base, robot.root_link)
    actuators = ET.SubElement(root, "actuator")
    for jet in settings.actuators:
        _append_jet(actuators, robot, jet)
    for name in (name for name in _moving(robot) if name not in robot.mimics):
        torque = _torque_range(robot, settings, name)
        ET.SubElement(actuators, "motor", {"name": name, "joint": name} | ({"ctrlrange": torque} if torque else {}))
    contact = ET.SubElement(root, "contact")
    for first, second in ignored:
        ET.SubElement(contact, "exclude", body1=first, body2=second)
    _append_mimics(root, robot)
    _append_start(root, robot, settings)
    ET.indent(root)
    return '<?xml version="1.0"?>\n' + ET.tostring(root, encoding="unicode") + "\n"


class _Bodies:
    """Writes links as nested bodies; meshes become assets, each once."""

    def __init__(self, robot: RobotDescription, settings: dyn.FlightSettings, assets: ET.Element) -> None:
        self.robot, self.assets = robot, assets
        self.children = child_joints(robot)
        self.jets = {jet.frame for jet in settings.actuators}
        rotors = settings.rotor_inertia if len(settings.rotor_inertia) else np.zeros(len(settings.joints))
        self.rotors = dict(zip(settings.joints, rotors, strict=True))
        self.colors = robot.material_colors()
        self.meshes: dict[tuple[str, str], str] = {}

    def fill(self, element: ET.Element, link: str) -> None:
        _append_inertial(element, self.robot, link)
        for drawn in self.robot.link(link).visuals:
            color = self._color(drawn.material)
            self._append_geom(element, drawn, {"group": DRAWN, "contype": "0", "conaffinity": "0", **color})
        for shape in self.robot.link(link).collisions:
            self._append_geom(element, shape, {"group": COLLIDING})
        if link in self.jets:
            ET.SubElement(element, "site", name=f"{link}_jet")
        for name in self.children[link]:
            joint = self.robot.joint(name)
            body = ET.SubElement(element, "body", {"name": joint.child} | _placed(self.robot.joint_origin(name)))
            if joint.type in MOVING:
                _append_joint(body, self.robot, name, self.rotors.get(name, 0.0))
            self.fill(body, joint.child)

    def _append_geom(self, element: ET.Element, shape: Shape, settings: dict[str, str]) -> None:
        geometry, origin = shape.geometry, shape.origin
        if geometry.box is not None:
            form = {"type": "box", "size": number_text(0.5 * np.asarray(geometry.box.size, dtype=float))}
        elif geometry.cylinder is not None:
            half = 0.5 * geometry.cylinder.length
            form = {"type": "cylinder", "size": number_text([geometry.cylinder.radius, half])}
        elif geometry.sphere is not None:
            form = {"type": "sphere", "size": number_text(geometry.sphere.radius)}
        else:
            assert geometry.mesh is not None  # the last kind
            form = {"type": "mesh", "mesh": self._mesh(geometry.mesh)}
        place = {} if origin is None else _placed(origin)
        ET.SubElement(element, "geom", {**form, **place, "mass": "0", **settings})

    def _mesh(self, mesh: Mesh) -> str:
        filename = mesh.filename
        scale = number_text(np.broadcast_to(1.0 if mesh.scale is None else mesh.scale, 3))
        if (filename, scale) not in self.meshes:
            stem = filename.rpartition("/")[2].rpartition(".")[0] or "mesh"
            name = f"{stem}_{len(self.meshes)}" if stem in self.meshes.values() else stem
            self.meshes[filename, scale] = name
            # As a shell: its volume does not matter, the geoms have no mass, and it need not be closed.
            ET.SubElement(self.assets, "mesh", name=name, file=filename, scale=scale, inertia="shell")
        return self.meshes[filename, scale]

    def _color(self, material: Material | None) -> dict[str, str]:
        rgba = self.colors.get(getattr(material, "name", None) or "")
        return {} if rgba is None else {"rgba": number_text(rgba)}


def _refuse_bodies_without_mass(robot: RobotDescription) -> None:
    body = rigid_bodies(robot)
    heavy = {body[link] for link in robot.link_names if has_mass(robot, link)}
    light = [first for first in dict.fromkeys(body.values()) if first not in heavy]
    if light:
        raise UrdfError(
            f"link {', '.join(light)} moves but has no mass, nor has a link fixed to it: MuJoCo has no such bodies; "
            "leave out mjcf"
        )


def _placed(a_T_b: Matrix) -> dict[str, str]:
    return {"pos": number_text(a_T_b[:3, 3]), "quat": number_text(quaternion(a_T_b[:3, :3]))}


def _append_inertial(element: ET.Element, robot: RobotDescription, link: str) -> None:
    inertial = robot.inertial(link)
    if inertial is None or not has_mass(robot, link):
        return
    I = inertial.inertia  # noqa: E741
    off = [I[0, 1], I[0, 2], I[1, 2]]
    name, values = ("fullinertia", [*np.diag(I), *off]) if any(off) else ("diaginertia", np.diag(I))
    numbers = {"pos": number_text(inertial.com), "mass": number_text(inertial.mass), name: number_text(values)}
    ET.SubElement(element, "inertial", numbers)


def _append_joint(body: ET.Element, robot: RobotDescription, name: str, rotor_inertia: float) -> None:
    joint = robot.joint(name)
    attributes = {
        "name": name,
        "type": "slide" if joint.type == "prismatic" else "hinge",
        "axis": number_text(joint.axis),
    }
    if joint.type != "continuous" and joint.limit is not None:
        attributes["range"] = number_text([joint.limit.lower or 0.0, joint.limit.upper or 0.0])
    if joint.dynamics is not None:
        attributes |= {
            key: number_text(value)
            for key, value in (("damping", joint.dynamics.damping), ("frictionloss", joint.dynamics.friction))
            if value
        }
    if rotor_inertia:
        attributes["armature"] = number_text(rotor_inertia)
    ET.SubElement(body, "joint", attributes)


def _append_jet(element: ET.Element, robot: RobotDescription, jet: dyn.Actuator) -> None:
    if jet.frame not in robot.link_names:
        raise UrdfError(f"the robot has no jet frame {jet.frame!r}")
    thrusts = number_text([jet.thrust_min, jet.thrust_max])
    attributes = {
        "name": jet.frame,
        "site": f"{jet.frame}_jet",
        "gear": number_text([*jet.axis, *(jet.reaction * jet.axis)]),
        "forcerange": thrusts,
    }
    if isinstance(jet.dynamics, dyn.RateIntegrator):
        rates = number_text([-jet.thrust_rate, jet.thrust_rate])
        attributes |= {"dyntype": "integrator", "ctrlrange": rates, "actrange": thrusts}
        words = INTEGRATOR
    elif isinstance(jet.dynamics, dyn.FirstOrderLag):
        attributes |= {"dyntype": "filter", "dynprm": number_text(jet.dynamics.time), "ctrlrange": thrusts}
        words = LAG
    else:
        attributes["ctrlrange"] = thrusts
        words = TURBINE
    element.append(ET.Comment(words % jet.frame))
    ET.SubElement(element, "general", attributes)


def _moving(robot: RobotDescription) -> list[str]:
    return [name for name in depth_first(robot) if robot.joint(name).type in MOVING]


def _torque_range(robot: RobotDescription, settings: dyn.FlightSettings, name: str) -> str:
    """Of a flown joint what the flight allows, of another what the URDF says; "" if neither does."""
    limit = robot.joint(name).limit
    torque = getattr(limit, "effort", None)
    torque = torque_limit(settings, torque) if name in settings.joints else torque
    return number_text([-torque, torque]) if torque else ""


def _append_mimics(root: ET.Element, robot: RobotDescription) -> None:
    if robot.mimics:
        equality = ET.SubElement(root, "equality")
        for name, (followed, multiplier, offset) in robot.mimics.items():
            coefficients = number_text([offset, multiplier, 0, 0, 0])
            pair = {"joint1": name, "joint2": followed}
            ET.SubElement(equality, "joint", {**pair, "polycoef": coefficients, "solimp": RIGID})


def _append_start(root: ET.Element, robot: RobotDescription, settings: dyn.FlightSettings) -> None:
    angles = dict(zip(settings.joints, settings.initial_joints.tolist(), strict=True))
    moving = _moving(robot)
    own = [name for name in moving if name not in robot.mimics]
    for name, (followed, multiplier, offset) in robot.mimics.items():
        angles[name] = multiplier * angles.get(followed, 0.0) + offset
    pose = settings.base_pose
    numbers = {"qpos": [*pose[:3, 3], *quaternion(pose[:3, :3]), *(angles.get(name, 0.0) for name in moving)]}
    thrusts = list(zip(settings.actuators, settings.initial_thrusts.tolist(), strict=True))
    states = [thrust for jet, thrust in thrusts if not isinstance(jet.dynamics, dyn.Turbine)]
    rates = [0.0 if isinstance(jet.dynamics, dyn.RateIntegrator) else thrust for jet, thrust in thrusts]
    numbers |= {"act": states} if states else {}
    key = {name: number_text(values) for name, values in numbers.items()}
    keyframe = ET.SubElement(root, "keyframe")
    ET.SubElement(keyframe, "key", {"name": START, **key, "ctrl": number_text([*rates, *([0.0] * len(own))])})
