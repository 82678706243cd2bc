"""Typed view of the links and joints of a checked URDF whose words are in order (`urdf_xml.normalized`)."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from codesign.transforms import Matrix


@dataclass(frozen=True, slots=True)
class Box:
    """size: edges along x, y, z [m]."""

    size: Matrix


@dataclass(frozen=True, slots=True)
class Cylinder:
    """Along z [m]."""

    radius: float
    length: float


@dataclass(frozen=True, slots=True)
class Sphere:
    """[m]."""

    radius: float


@dataclass(frozen=True, slots=True)
class Mesh:
    """filename: as written. scale: (3,) factors or (1,) for all axes, None where none is given."""

    filename: str
    scale: Matrix | None


@dataclass(frozen=True, slots=True)
class Geometry:
    """One of these is given."""

    box: Box | None = None
    cylinder: Cylinder | None = None
    sphere: Sphere | None = None
    mesh: Mesh | None = None


@dataclass(frozen=True, slots=True)
class Color:
    """rgba: (4,) red, green, blue, alpha, 0 to 1."""

    rgba: Matrix


@dataclass(frozen=True, slots=True)
class Material:
    """color: None where the material has none of its own."""

    name: str | None
    color: Color | None


@dataclass(frozen=True, slots=True)
class Shape:
    """A visual or a collision shape. origin: link_T_shape (4, 4), None where none is given."""

    name: str | None
    origin: Matrix | None
    geometry: Geometry
    material: Material | None


@dataclass(frozen=True, slots=True)
class LinkInertial:
    """As written. origin: link_T_inertial (4, 4), None where none is given; mass [kg]; inertia (3, 3) [kg m²]."""

    origin: Matrix | None
    mass: float
    inertia: Matrix


@dataclass(frozen=True, slots=True)
class Link:
    """A body."""

    name: str
    inertial: LinkInertial | None
    visuals: tuple[Shape, ...]
    collisions: tuple[Shape, ...]


@dataclass(frozen=True, slots=True)
class Limit:
    """N m or N, rad/s or m/s, rad or m; None where not given."""

    effort: float | None
    velocity: float | None
    lower: float | None
    upper: float | None


@dataclass(frozen=True, slots=True)
class Friction:
    """damping [N m s/rad or N s/m], friction [N m or N]; None where not given."""

    damping: float | None
    friction: float | None


@dataclass(frozen=True, slots=True)
class Mimic:
    """position = multiplier * that of `joint` + offset."""

    joint: str
    multiplier: float
    offset: float


@dataclass(frozen=True, slots=True)
class Joint:
    """origin: parent_T_child (4, 4) at position zero, None where none is given. axis: (3,) as written, else x."""

    name: str
    type: str
    parent: str
    child: str
    origin: Matrix | None
    axis: Matrix
    dynamics: Friction | None
    limit: Limit | None
    mimic: Mimic | None


def links_of(root: ET.Element) -> Iterator[Link]:
    """Links of a robot in the file's order."""
    for element in root.findall("link"):
        yield Link(
            str(element.get("name")),
            _inertial(element.find("inertial")),
            tuple(_shape(visual) for visual in element.findall("visual")),
            tuple(_shape(collision) for collision in element.findall("collision")),
        )


def joints_of(root: ET.Element) -> Iterator[Joint]:
    """Joints of a robot in the file's order."""
    for element in root.findall("joint"):
        yield Joint(
            str(element.get("name")),
            str(element.get("type")),
            str(_child(element, "parent").get("link")),
            str(_child(element, "child").get("link")),
            _origin(element),
            _axis(element.find("axis")),
            _dynamics(element.find("dynamics")),
            _limit(element.find("limit")),
            _mimic(element.find("mimic")),
        )


def materials_of(root: ET.Element) -> Iterator[Material]:
    """Materials that stand beside the links."""
    for element in root.findall("material"):
        color = element.find("color")
        yield Material(element.get("name"), None if color is None else Color(_numbers(color, "rgba", "1 1 1 1")))


def _shape(element: ET.Element) -> Shape:
    return Shape(
        element.get("name"),
        _origin(element),
        _geometry(element),
        next(materials_of(element), None),
    )


def _geometry(element: ET.Element) -> Geometry:
    for box in element.iterfind("geometry/box"):
        return Geometry(box=Box(_numbers(box, "size")))
    for cylinder in element.iterfind("geometry/cylinder"):
        return Geometry(cylinder=Cylinder(float(cylinder.attrib["radius"]), float(cylinder.attrib["length"])))
    for sphere in element.iterfind("geometry/sphere"):
        return Geometry(sphere=Sphere(float(sphere.attrib["radius"])))
    for mesh in element.iterfind("geometry/mesh"):
        scale = _numbers(mesh, "scale") if mesh.get("scale", "").strip() else None
        return Geometry(mesh=Mesh(str(mesh.get("filename")), scale))
    return Geometry()


def _inertial(element: ET.Element | None) -> LinkInertial | None:
    if element is None:
        return None
    tensor = _child(element, "inertia").attrib
    entries = [[float(tensor[f"i{min(a, b)}{max(a, b)}"]) for b in "xyz"] for a in "xyz"]
    return LinkInertial(_origin(element), float(_child(element, "mass").attrib["value"]), np.array(entries))


def _origin(element: ET.Element) -> Matrix | None:
    """Pose of a shape, an inertial or a joint, its angles turned about fixed axes; no negative zeros."""
    origin = element.find("origin")
    if origin is None:
        return None
    (sr, sp, sy), (cr, cp, cy) = (f(_numbers(origin, "rpy", "0 0 0")) for f in (np.sin, np.cos))
    pose = np.eye(4)
    pose[:3, :3] = [
        [cp * cy, sp * (sr * cy) - cr * sy, sp * (cr * cy) + sr * sy],
        [cp * sy, sp * (sr * sy) + cr * cy, sp * (cr * sy) - sr * cy],
        [-sp, cp * sr, cp * cr],
    ]
    pose[:3, 3] = _numbers(origin, "xyz", "0 0 0")
    return pose + 0.0


def _axis(element: ET.Element | None) -> Matrix:
    return np.array([1.0, 0.0, 0.0]) if element is None else _numbers(element, "xyz", "1 0 0")


def _dynamics(element: ET.Element | None) -> Friction | None:
    return None if element is None else Friction(_number(element, "damping"), _number(element, "friction"))


def _limit(element: ET.Element | None) -> Limit | None:
    keys = ("effort", "velocity", "lower", "upper")
    return None if element is None else Limit(*(_number(element, key) for key in keys))


def _mimic(element: ET.Element | None) -> Mimic | None:
    if element is None:
        return None
    factors = (float(element.get(key, usual)) for key, usual in (("multiplier", 1.0), ("offset", 0.0)))
    return Mimic(str(element.get("joint")), *factors)


def _child(element: ET.Element, tag: str) -> ET.Element:
    found = element.find(tag)
    assert found is not None  # the robot was checked
    return found


def _number(element: ET.Element, key: str) -> float | None:
    text = element.get(key)
    return None if text is None else float(text)


def _numbers(element: ET.Element, key: str, usual: str = "") -> Matrix:
    return np.array([float(number) for number in element.get(key, usual).split()])
