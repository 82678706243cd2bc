"""Design variables of the whole robot: joints that are shifted, links that are stretched or scaled.

A stretch along the unit vector d of a link maps its points by x' = x + d (k - 1) (clip(d·x, from, to) - pole), with
k = 1 + change / (to - from): what lies between `from` and `to` grows in proportion, what lies beyond is moved as it is,
and `pole` stays. Shapes follow their ends along d and keep their section. The inertial follows as a pseudo-inertia
(P. M. Wensing, S. Kim, J.-J. E. Slotine, "Linear matrix inequalities for physically consistent inertial parameter
identification", RA-L 2018): an affine image of a mass distribution is one again, so every result is a possible body. A
scaled link is a similar body of the same density: lengths grow by k, mass by k³, inertia by k⁵.
"""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from collections.abc import Iterable, Mapping
from typing import Annotated

import msgspec
import numpy as np

from codesign.errors import UrdfError
from codesign.robot.description import RobotDescription
from codesign.robot.inertial import Inertial
from codesign.robot.urdf_xml import number_text
from codesign.transforms import Matrix, pose
from codesign.units import DEGREE, MILLIMETER

Vector = tuple[float, float, float]
ALIGNED = math.cos(1.0 * DEGREE)  # a shape's axis this near to the direction follows the stretch
UNIT_TOLERANCE = 1e-6  # of the length of a direction


class RobotChange(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """What a design variable changes: a joint that is shifted, a link that is stretched or scaled.

    variable: in mm, or `variable.key` of its choices; per_unit times its value is the change. reference_mm: the link is
    drawn for this value of the variable and scaled about its origin to others. joint: its origin moves along direction,
    axes of its parent. link: it is stretched along direction, link axes, between from_m and to_m, pole_m stays.
    mass_share: 1, mass grows with the length as of a beam; 0, no mass is added.
    """

    variable: str
    joint: str | None = None
    link: str | None = None
    direction: Vector | None = None
    reference_mm: Annotated[float, msgspec.Meta(gt=0)] | None = None
    from_m: float | None = None
    to_m: float | None = None
    pole_m: float = 0.0
    per_unit: float = 1.0
    mass_share: Annotated[float, msgspec.Meta(ge=0, le=1)] = 1.0

    def __post_init__(self) -> None:
        if (self.joint is None) == (self.link is None):
            raise ValueError("a change is that of a joint (shift) or of a link (stretch): name one of both")
        if self.reference_mm is not None:
            if self.link is None or (self.direction, self.from_m, self.to_m) != (None, None, None):
                raise ValueError("reference_mm scales a link, which needs nothing else")
            return
        if self.direction is None:
            raise ValueError("a shift or stretch needs its direction")
        if abs(math.hypot(*self.direction) - 1.0) > UNIT_TOLERANCE:
            raise ValueError(f"direction {list(self.direction)} is no unit vector")
        if self.link is None:
            if self.from_m is not None or self.to_m is not None:
                raise ValueError("from_m and to_m belong to a link that is stretched")
        elif self.from_m is None or self.to_m is None or not self.from_m <= self.pole_m <= self.to_m != self.from_m:
            raise ValueError("a stretch needs from_m below to_m and pole_m between them")

    def change(self, value: float) -> float:
        """By how much the joint moves or the link grows for a value of the variable [m]."""
        return self.per_unit * value * MILLIMETER


def change_robot(
    robot: RobotDescription, changes: Iterable[RobotChange], values: Mapping[str, float]
) -> RobotDescription:
    """The robot with all changes made, in their order; a change of zero touches nothing.

    values: design variable -> value [mm].
    Raises: UrdfError: a link or joint is not there, or would shrink to nothing; a mesh that cannot follow.
    """
    for change in changes:
        if change.reference_mm is not None:
            robot = _scaled(robot, str(change.link), values[change.variable] / change.reference_mm)
            continue
        amount = change.change(values[change.variable])
        if amount == 0.0:
            continue
        robot = _shifted(robot, change, amount) if change.joint is not None else _stretched(robot, change, amount)
    return robot


def _shifted(robot: RobotDescription, change: RobotChange, amount: float) -> RobotDescription:
    joint = str(change.joint)
    assert change.direction is not None
    return _move_joint(robot, joint, robot.joint_origin(joint)[:3, 3] + amount * np.array(change.direction))


def _scaled(robot: RobotDescription, link: str, factor: float) -> RobotDescription:
    """The robot with a link of the same density and shape, `factor` times as large; its joints move with it."""

    def shapes(element: ET.Element) -> None:
        for shape in (*element.findall("visual"), *element.findall("collision")):
            _set_position(shape, factor * np.array(_numbers(shape.find("origin"), "xyz")))
            geometry = shape.find("geometry")
            for solid in geometry if geometry is not None else ():
                if solid.tag == "mesh":
                    solid.set("scale", solid.get("scale", "1 1 1"))
                for name in ("size", "radius", "length", "scale"):
                    if text := solid.get(name):
                        solid.set(name, number_text([factor * float(x) for x in text.split()]))

    inertial = robot.inertial(link)
    robot = robot.edited("link", link, shapes)
    if inertial is not None:
        grown = Inertial(factor**3 * inertial.mass, factor * inertial.com, factor**5 * inertial.inertia)
        robot = robot.replace_inertial(link, grown)
    for joint in robot.joint_names:
        if robot.joint_parent(joint) == link:
            robot = _move_joint(robot, joint, factor * robot.joint_origin(joint)[:3, 3])
    return robot


class Stretch:
    """A stretch of one link as a map of its points, lengths and mass."""

    def __init__(self, change: RobotChange, amount: float) -> None:
        """amount: change of the length between from_m and to_m [m]. Raises: UrdfError: nothing would be left of it."""
        assert change.from_m is not None and change.to_m is not None and change.direction is not None
        self.direction = np.array(change.direction)
        self.ends, self.pole, self.mass_share = (change.from_m, change.to_m), change.pole_m, change.mass_share
        self.factor = 1.0 + amount / (change.to_m - change.from_m)
        if self.factor <= 0.0:
            raise UrdfError(
                f"link {change.link}: {change.variable} shortens it by {-1e3 * amount:.4g} mm of "
                f"{1e3 * (change.to_m - change.from_m):.4g} mm"
            )

    def point(self, x: Matrix) -> Matrix:
        """Where a point (3,) of the link goes."""
        along = float(np.clip(self.direction @ x, *self.ends))
        moved: Matrix = x + self.direction * (self.factor - 1.0) * (along - self.pole)
        return moved

    def inertial(self, body: Inertial) -> Inertial:
        """The link's inertial after the stretch."""
        P = pseudo_inertia(body)
        E = np.eye(4)
        E[:3, :3] += (self.factor - 1.0) * np.outer(self.direction, self.direction)
        E[:3, 3] = -(self.factor - 1.0) * self.pole * self.direction
        return inertial_of((1.0 + self.mass_share * (self.factor - 1.0)) * (E @ P @ E.T))

    def shapes(self, element: ET.Element) -> None:
        """Changes every visual and collision shape of a link's element; their rotations stand."""
        for shape in (*element.findall("visual"), *element.findall("collision")):
            origin, geometry = shape.find("origin"), shape.find("geometry")
            if geometry is not None and len(geometry):
                xyz, rpy = (_numbers(origin, name) for name in ("xyz", "rpy"))
                _set_position(shape, self.shape(pose(xyz, rpy), geometry[0]))

    def shape(self, link_T_shape: Matrix, geometry: ET.Element) -> Matrix:
        """Lengthens a shape along the direction and returns its new position (3,)."""
        position = link_T_shape[:3, 3]
        axes = link_T_shape[:3, :3].T @ self.direction
        axis = int(np.argmax(np.abs(axes)))
        aligned = abs(axes[axis]) >= ALIGNED
        if geometry.tag == "mesh":
            if not aligned:
                raise UrdfError(f"mesh {geometry.get('filename')}: a stretched link's mesh must lie along the stretch")
            scale = [float(x) for x in str(geometry.get("scale", "1 1 1")).split()]
            scale[axis] *= self.factor
            geometry.set("scale", number_text(scale))
            moved: Matrix = position + self.direction * (self.factor - 1.0) * (self.direction @ position - self.pole)
            return moved
        key = {"box": "size", "cylinder": "length"}.get(geometry.tag)
        if key is None or not aligned or (geometry.tag == "cylinder" and axis != 2):
            return self.point(position)
        lengths = [float(x) for x in str(geometry.get(key)).split()]
        index = axis if geometry.tag == "box" else 0
        half = 0.5 * lengths[index] * self.direction
        low, high = self.point(position - half), self.point(position + half)
        lengths[index] = float(self.direction @ (high - low))
        geometry.set(key, number_text(lengths))
        across = position - self.direction * (self.direction @ position)
        return across + self.direction * (0.5 * float(self.direction @ (low + high)))


def pseudo_inertia(body: Inertial) -> Matrix:
    """(4, 4): second moments of the mass about the frame's origin, m c, and m. Positive definite for a real body."""
    m, c = body.mass, body.com
    second = 0.5 * np.trace(body.inertia) * np.eye(3) - body.inertia + m * np.outer(c, c)
    P = np.empty((4, 4))
    P[:3, :3], P[:3, 3], P[3, :3], P[3, 3] = second, m * c, m * c, m
    return P


def inertial_of(P: Matrix) -> Inertial:
    """The inertial of a pseudo-inertia (4, 4) [kg, kg m, kg m²]."""
    mass = float(P[3, 3])
    com = P[:3, 3] / mass
    second = P[:3, :3] - mass * np.outer(com, com)
    second = 0.5 * (second + second.T)
    return Inertial(mass, com, np.trace(second) * np.eye(3) - second)


def _stretched(robot: RobotDescription, change: RobotChange, amount: float) -> RobotDescription:
    link = str(change.link)
    stretch = Stretch(change, amount)
    inertial = robot.inertial(link)
    robot = robot.edited("link", link, stretch.shapes)
    if inertial is not None:
        robot = robot.replace_inertial(link, stretch.inertial(inertial))
    for joint in robot.joint_names:
        if robot.joint_parent(joint) == link:
            robot = _move_joint(robot, joint, stretch.point(robot.joint_origin(joint)[:3, 3]))
    return robot


def _move_joint(robot: RobotDescription, joint: str, position: Matrix) -> RobotDescription:
    """The robot with the origin of a joint at `position` (3,) [m] in its parent; its rotation stands as it was."""
    return robot.edited("joint", joint, lambda element: _set_position(element, position))


def _numbers(origin: ET.Element | None, name: str) -> list[float]:
    text = None if origin is None else origin.get(name)
    return [float(number) for number in text.split()] if text else [0.0, 0.0, 0.0]


def _set_position(element: ET.Element, position: Matrix) -> None:
    origin = element.find("origin")
    if origin is None:
        origin = ET.Element("origin", rpy=number_text(np.zeros(3)))
        element.insert(0, origin)
    origin.set("xyz", number_text(position))
