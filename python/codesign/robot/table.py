"""A robot as a readable table (TOML), and the URDF made from it.

The table lists links; each link but the first carries the joint that attaches it. Units: m, kg, kg m² and degrees where
a key says so. `python -m codesign.robot.table robot.toml robot.urdf` writes the URDF of a table.
"""

from __future__ import annotations

import math
import sys
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Literal

import msgspec

from codesign.errors import UrdfError
from codesign.files import write_text
from codesign.robot.description import UPPER_TRIANGLE, RobotDescription
from codesign.robot.urdf_xml import number_text
from codesign.units import DEGREE

Vector = tuple[float, float, float]
ZERO: Vector = (0.0, 0.0, 0.0)


class ShapeRow(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A primitive, drawn and collided with: `box` edges; `cylinder` radius and length along z; `sphere` radius [m]."""

    box: Vector | None = None
    cylinder: tuple[float, float] | None = None
    sphere: float | None = None
    xyz: Vector = ZERO
    rpy_deg: Vector = ZERO
    material: str | None = None

    def __post_init__(self) -> None:
        if sum(kind is not None for kind in (self.box, self.cylinder, self.sphere)) != 1:
            raise ValueError("a shape is one of box, cylinder, sphere")


class JointRow(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The joint that carries a link: pose of the link in `parent` at zero [m, deg], axis in link axes, range [deg]."""

    name: str
    type: Literal["fixed", "revolute", "continuous"]
    parent: str
    xyz: Vector = ZERO
    rpy_deg: Vector = ZERO
    axis: Vector | None = None
    limits_deg: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        if (self.type == "fixed") != (self.axis is None):
            raise ValueError(f"joint {self.name}: moving joints have an axis, fixed ones have none")
        if (self.type == "revolute") != (self.limits_deg is not None):
            raise ValueError(f"joint {self.name}: limits_deg belongs to every revolute joint and to no other")


class InertiaRow(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Inertia about the center of mass, link axes, entries of the matrix [kg m²]."""

    xx: float
    yy: float
    zz: float
    xy: float
    xz: float
    yz: float


class LinkRow(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A link; without `mass` it is a frame only."""

    name: str
    joint: JointRow | None = None
    mass: float | None = None
    com: Vector | None = None
    inertia: InertiaRow | None = None
    shapes: tuple[ShapeRow, ...] = ()

    def __post_init__(self) -> None:
        given = [value is not None for value in (self.mass, self.com, self.inertia)]
        if any(given) and not all(given):
            raise ValueError(f"link {self.name}: mass, com and inertia are given together or not at all")


class RobotTable(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A whole robot. `joint_effort` [N m] and `joint_velocity` [rad/s] fill the limits that URDF demands."""

    name: str
    links: tuple[LinkRow, ...]
    materials: dict[str, tuple[float, float, float, float]] = {}
    joint_effort: float = 1e3
    joint_velocity: float = 1e2


def load_table(path: str | Path) -> RobotTable:
    """Reads a table. Raises: UrdfError naming file, key and reason."""
    path = Path(path)
    try:
        return msgspec.toml.decode(path.read_bytes(), type=RobotTable)
    except OSError as error:
        raise UrdfError(f"{path}: cannot be read: {error.strerror}") from error
    except (msgspec.DecodeError, ValueError) as error:
        raise UrdfError(f"{path}: {error}") from error


def urdf_from_table(table: RobotTable, comment: str = "") -> str:
    """URDF text of a table; every number with as many digits as it takes to read the same one back."""
    used = {shape.material for link in table.links for shape in link.shapes if shape.material is not None}
    if unknown := sorted(used - table.materials.keys()):
        raise UrdfError(f"material {unknown[0]!r} is not in [materials]")
    root = ET.Element("robot", name=table.name)
    if comment:
        root.append(ET.Comment(f" {comment} "))
    for name, rgba in table.materials.items():
        ET.SubElement(ET.SubElement(root, "material", name=name), "color", rgba=number_text(rgba))
    for link in table.links:
        _append_link(root, link)
    for link in table.links:
        if link.joint is not None:
            _append_joint(root, link.joint, link.name, table)
    ET.indent(root)
    return '<?xml version="1.0"?>\n' + ET.tostring(root, encoding="unicode") + "\n"


def _append_link(root: ET.Element, link: LinkRow) -> None:
    element = ET.SubElement(root, "link", name=link.name)
    if link.mass is not None and link.com is not None and link.inertia is not None:
        inertial = ET.SubElement(element, "inertial")
        ET.SubElement(inertial, "origin", xyz=number_text(link.com), rpy=number_text(ZERO))
        ET.SubElement(inertial, "mass", value=number_text(link.mass))
        tensor = {f"i{key}": number_text(getattr(link.inertia, key)) for key in UPPER_TRIANGLE}
        ET.SubElement(inertial, "inertia", tensor)
    for tag in ("visual", "collision"):
        for shape in link.shapes:
            _append_shape(ET.SubElement(element, tag), shape, with_material=tag == "visual")


def _append_shape(parent: ET.Element, shape: ShapeRow, with_material: bool) -> None:
    _append_origin(parent, shape.xyz, shape.rpy_deg)
    geometry = ET.SubElement(parent, "geometry")
    if shape.box is not None:
        ET.SubElement(geometry, "box", size=number_text(shape.box))
    elif shape.cylinder is not None:
        radius, length = shape.cylinder
        ET.SubElement(geometry, "cylinder", radius=number_text(radius), length=number_text(length))
    elif shape.sphere is not None:
        ET.SubElement(geometry, "sphere", radius=number_text(shape.sphere))
    if with_material and shape.material is not None:
        ET.SubElement(parent, "material", name=shape.material)


def _append_joint(root: ET.Element, joint: JointRow, child: str, table: RobotTable) -> None:
    element = ET.SubElement(root, "joint", name=joint.name, type=joint.type)
    _append_origin(element, joint.xyz, joint.rpy_deg)
    ET.SubElement(element, "parent", link=joint.parent)
    ET.SubElement(element, "child", link=child)
    if joint.axis is None:
        return
    ET.SubElement(element, "axis", xyz=number_text(_normalized(joint)))
    limit = {"effort": number_text(table.joint_effort), "velocity": number_text(table.joint_velocity)}
    if joint.limits_deg is not None:
        lower, upper = (angle * DEGREE for angle in joint.limits_deg)
        limit |= {"lower": number_text(lower), "upper": number_text(upper)}
    ET.SubElement(element, "limit", limit)


def _append_origin(parent: ET.Element, xyz: Vector, rpy_deg: Vector) -> None:
    roll, pitch, yaw = (angle * DEGREE for angle in rpy_deg)
    ET.SubElement(parent, "origin", xyz=number_text(xyz), rpy=number_text((roll, pitch, yaw)))


def _normalized(joint: JointRow) -> Vector:
    assert joint.axis is not None
    x, y, z = joint.axis
    norm = math.hypot(x, y, z)
    if not norm > 0.0:
        raise UrdfError(f"joint {joint.name}: axis of length zero")
    return (x / norm, y / norm, z / norm)


def main(arguments: list[str]) -> int:
    """Writes the URDF (second argument) of a table (first argument)."""
    source, target = (Path(argument) for argument in arguments)
    write_text(target, generated_urdf(source))
    return 0


def generated_urdf(path: str | Path) -> str:
    """URDF text of the table in a file, with a comment that names the file. Raises: UrdfError as `from_text` does."""
    text = written_urdf(path)
    RobotDescription.from_text(text)
    return text


def written_urdf(path: str | Path) -> str:
    """As `generated_urdf`, but not read back: to be compared with a text that is known to be sound."""
    path = Path(path)
    return urdf_from_table(load_table(path), comment=f"made from {path.name}, which says where the figures come from")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
