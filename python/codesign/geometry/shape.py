"""The part language: an immutable expression of primitives, booleans and motions, in mm.

The same expression is evaluated as a triangulated solid (`solid.py`, manifold3d) and as an exact B-rep (`brep.py`,
OpenCASCADE). Faces get their names from the primitive that makes them and keep them through booleans and motions.
Solids that are united must overlap, or share a plane written with the very same number.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from codesign.errors import GeometryError
from codesign.geometry.profile import Path, Profile, Vector, circle, polygon

Triple = tuple[float, float, float]
_AXES: dict[str, Triple] = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


def _dot(a: Triple, b: Triple) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@dataclass(frozen=True, slots=True)
class Frame:
    """Where a profile is drawn: origin and two orthonormal axes; the third, `z`, is their cross product."""

    origin: Triple = (0.0, 0.0, 0.0)
    x: Triple = _AXES["x"]
    y: Triple = _AXES["y"]

    def __post_init__(self) -> None:
        errors = (_dot(self.x, self.x) - 1.0, _dot(self.y, self.y) - 1.0, _dot(self.x, self.y))
        if not max(map(abs, errors)) < 1e-9:
            raise ValueError(f"frame axes {self.x} and {self.y} are not orthonormal")

    @property
    def z(self) -> Triple:
        """Direction in which profiles are extruded."""
        (a, b, c), (d, e, f) = self.x, self.y
        return (b * f - c * e, c * d - a * f, a * e - b * d)

    def point(self, u: float, v: float, w: float = 0.0) -> Triple:
        """Coordinates (u, v, w) of this frame [mm] as a point of the part [mm]."""
        x, y, z = (o + u * a + v * b + w * c for o, a, b, c in zip(self.origin, self.x, self.y, self.z, strict=True))
        return (x, y, z)

    def at(self, u: float, v: float, w: float = 0.0) -> Frame:
        """The same axes with the origin at (u, v, w) of this frame [mm]."""
        return Frame(self.point(u, v, w), self.x, self.y)


XY = Frame()  # the part frame itself


class Shape:
    """A solid made of primitives: `a + b` unites, `a - b` cuts, `a & b` intersects."""

    __slots__ = ()

    def __add__(self, other: Shape) -> Shape:
        return union(self, other)

    def __sub__(self, other: Shape) -> Shape:
        if isinstance(self, Difference):
            return Difference(self.base, (*self.tools, other))
        return Difference(self, (other,))

    def __and__(self, other: Shape) -> Shape:
        return Intersection((self, other))

    def moved(self, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Shape:
        """The solid shifted by (x, y, z) mm."""
        motion = np.eye(4)
        motion[:3, 3] = (x, y, z)
        return Moved.by(self, motion)

    def rotated(self, axis: str, angle_deg: float, about: Triple = (0.0, 0.0, 0.0)) -> Shape:
        """The solid turned counter-clockwise about the axis "x", "y" or "z" through the point `about` [mm]."""
        k = np.array(_AXES[axis])
        skew = np.array([[0.0, -k[2], k[1]], [k[2], 0.0, -k[0]], [-k[1], k[0], 0.0]])
        angle = math.radians(angle_deg)
        motion = np.eye(4)
        motion[:3, :3] += math.sin(angle) * skew + (1.0 - math.cos(angle)) * skew @ skew
        motion[:3, 3] = np.array(about) - motion[:3, :3] @ np.array(about)
        return Moved.by(self, motion)

    def placed(self, frame: Frame) -> Shape:
        """A solid drawn about the origin, put into a frame."""
        motion = np.eye(4)
        motion[:3] = np.array([frame.x, frame.y, frame.z, frame.origin]).T
        return Moved.by(self, motion)

    def mirrored(self, axis: str) -> Shape:
        """The mirror image in the plane through the origin normal to "x", "y" or "z"."""
        return Moved.by(self, reflection(axis))


@dataclass(frozen=True, slots=True)
class Extrusion(Shape):
    """A profile swept along its frame's z from `start` to `end` mm; profile edges name the side faces."""

    profile: Profile
    start: float
    end: float
    frame: Frame = XY
    start_face: str = ""
    end_face: str = ""

    def __post_init__(self) -> None:
        if not self.end > self.start:
            raise GeometryError(f"extrusion from {self.start!r} to {self.end!r} mm: the end must lie above the start")


@dataclass(frozen=True, slots=True)
class Revolution(Shape):
    """A profile of (axial, radial) coordinates, radial >= 0, turned once about the x axis of its frame.

    divided_as: radius [mm] whose number of chords it takes as a mesh; by default its largest one.
    """

    profile: Profile
    frame: Frame = XY
    divided_as: float | None = None

    def __post_init__(self) -> None:
        if self.profile.holes:
            raise ValueError("a revolved profile has no holes")
        if min(self.profile.outer.start[1], *(edge.end[1] for edge in self.profile.outer.edges)) < 0.0:
            raise GeometryError("a revolved profile must not cross its axis")


@dataclass(frozen=True, slots=True)
class Union(Shape):
    """Everything that lies in at least one of the solids."""

    shapes: tuple[Shape, ...]


@dataclass(frozen=True, slots=True)
class Difference(Shape):
    """What remains of `base` without the tools."""

    base: Shape
    tools: tuple[Shape, ...]


@dataclass(frozen=True, slots=True)
class Intersection(Shape):
    """What lies in all the solids."""

    shapes: tuple[Shape, ...]


@dataclass(frozen=True, slots=True)
class Moved(Shape):
    """A solid under a rigid motion or a reflection; `matrix` is 4x4, as rows."""

    shape: Shape
    matrix: tuple[tuple[float, ...], ...]

    @staticmethod
    def by(shape: Shape, matrix: Vector) -> Moved:
        """`shape` moved by a matrix (4, 4) [mm]."""
        rotation = matrix[:3, :3]
        if not np.abs(rotation @ rotation.T - np.eye(3)).max() < 1e-9:
            raise ValueError("only rotations, reflections and translations keep circles round")
        return Moved(shape, tuple(tuple(row) for row in matrix.tolist()))


def reflection(axis: str) -> Vector:
    """(4, 4) mirror in the plane through the origin normal to "x", "y" or "z"."""
    if axis not in _AXES:
        raise ValueError(f"axis = {axis!r}: must be 'x', 'y' or 'z'")
    return np.diag([*(1.0 - 2.0 * np.array(_AXES[axis])), 1.0])


def union(*shapes: Shape) -> Shape:
    """All the solids as one."""
    parts: list[Shape] = []
    for shape in shapes:
        parts += shape.shapes if isinstance(shape, Union) else (shape,)
    return parts[0] if len(parts) == 1 else Union(tuple(parts))


def box(low: Triple, high: Triple, **faces: str) -> Shape:
    """Box between two corners; faces named by keyword: x0, x1, y0, y1, z0, z1 (0 the lower side, 1 the upper)."""
    unknown = set(faces) - {"x0", "x1", "y0", "y1", "z0", "z1"}
    if unknown:
        raise ValueError(f"a box has no face {sorted(unknown)[0]!r}")
    (x0, y0, z0), (x1, y1, z1) = low, high
    profile = polygon(
        (x0, y0), (x1, y0), (x1, y1), (x0, y1), faces=[faces.get(k, "") for k in ("y0", "x1", "y1", "x0")]
    )
    return Extrusion(profile, z0, z1, Frame(), faces.get("z0", ""), faces.get("z1", ""))


def plate(profile: Profile, thickness: float, frame: Frame = XY, *, face: str = "", top_face: str = "") -> Shape:
    """A profile given a thickness along the frame's z; `face` names the side it is drawn on."""
    return Extrusion(profile, 0.0, thickness, frame, face, top_face)


def cylinder(
    radius: float,
    start: float,
    end: float,
    frame: Frame = XY,
    *,
    start_face: str = "",
    end_face: str = "",
    face: str = "",
) -> Shape:  # fmt: skip
    """Cylinder about the frame's z axis from `start` to `end`; `face` names its side."""
    return Extrusion(circle(0.0, 0.0, radius, face=face), start, end, frame, start_face, end_face)


def stepped_hole(*steps: tuple[float, float, float], shoulder_face: str = "") -> Shape:
    """Tool for a hole along z with counterbores: (radius, from, to) [mm] of each step, ascending, without gaps."""
    outline = Path(steps[0][1], 0.0).line(steps[-1][2], 0.0)
    for k, (radius, low, high) in enumerate(reversed(steps)):
        outline = outline.line(high, radius, face=shoulder_face if k > 0 else "").line(low, radius)
    return Revolution(outline.close(), Frame(x=_AXES["z"], y=_AXES["x"]))


def cone(
    start: float, start_radius: float, end: float, end_radius: float, frame: Frame = XY, *, face: str = ""
) -> Shape:
    """Truncated cone about the frame's x axis."""
    profile = polygon((start, 0.0), (end, 0.0), (end, end_radius), (start, start_radius), faces=["", "", face, ""])
    return Revolution(profile, frame)


def at_points(shape: Shape, points: Iterable[tuple[float, float]]) -> Shape:
    """Copies of a solid shifted to points (x, y): hole patterns."""
    return union(*(shape.moved(x, y) for x, y in points))


def polar(radius: float, *angles_deg: float) -> list[tuple[float, float]]:
    """Points (x, y) on a circle about the origin, in the unit of the radius, for `at_points`."""
    return [(radius * math.cos(math.radians(a)), radius * math.sin(math.radians(a))) for a in angles_deg]


def face_names(shape: Shape) -> tuple[str, ...]:
    """Names that the primitives of a shape give to their faces, in order of appearance."""
    names: list[str] = []
    if isinstance(shape, Extrusion):
        names += [shape.start_face, shape.end_face]
        names += [edge.face for loop in shape.profile.loops for edge in loop.edges]
    elif isinstance(shape, Revolution):
        names += [edge.face for edge in shape.profile.outer.edges]
    elif isinstance(shape, Moved):
        names += face_names(shape.shape)
    elif isinstance(shape, Difference):
        names += [name for part in (shape.base, *shape.tools) for name in face_names(part)]
    elif isinstance(shape, Union | Intersection):
        names += [name for part in shape.shapes for name in face_names(part)]
    else:
        names += getattr(shape, "names", ())  # an imported solid's
    return tuple(dict.fromkeys(name for name in names if name))
