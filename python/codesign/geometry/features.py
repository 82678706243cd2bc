"""What a workshop sees in an exact solid: bores, bosses and flat faces."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepGProp import BRepGProp
from OCP.BRepTools import BRepTools
from OCP.GeomAbs import GeomAbs_SurfaceType
from OCP.GProp import GProp_GProps
from OCP.TopAbs import TopAbs_Orientation, TopAbs_ShapeEnum
from OCP.TopoDS import TopoDS, TopoDS_Face

from codesign.geometry.brep import Brep, explore
from codesign.geometry.profile import Vector

FULL = 2.0 * np.pi - 1e-6  # rad: a face round its axis
SAME = 1e-5  # mm and direction entries: two cylinders with one axis


@dataclass(frozen=True, eq=False)
class Cylinder:
    """A cylindrical face that goes all round, in mm.

    axis: unit vector; point: where the axis passes nearest to the origin. low, high: ends along the axis, measured from
    that point. hollow: a bore, with material around it. face: of the solid.
    """

    radius: float
    axis: Vector
    point: Vector
    low: float
    high: float
    hollow: bool
    face: TopoDS_Face

    @property
    def length(self) -> float:
        """Length of the face along its axis [mm]."""
        return self.high - self.low

    def shares_axis(self, other: Cylinder) -> bool:
        """Whether both are on one line."""
        return np.allclose(self.axis, other.axis, atol=SAME) and np.allclose(self.point, other.point, atol=SAME)


@dataclass(frozen=True, eq=False)
class Flat:
    """A plane face: unit normal out of the material, its distance from the origin [mm], its area [mm²]."""

    normal: Vector
    distance: float
    area: float
    face: TopoDS_Face


def cylinders(brep: Brep) -> list[Cylinder]:
    """Cylindrical faces that go all round, also where seams cut them into pieces, smallest radius first."""
    pieces: dict[tuple[float, ...], list[tuple[Cylinder, float]]] = {}
    for face in _faces(brep):
        surface = BRepAdaptor_Surface(face)
        if surface.GetType() != GeomAbs_SurfaceType.GeomAbs_Cylinder:
            continue
        found, angle = _cylinder(face, surface)
        numbers = [found.radius, *found.axis, *found.point, found.low, found.high]
        key = (*(round(float(number) / SAME) for number in numbers), found.hollow)
        pieces.setdefault(key, []).append((found, angle))
    whole = [items[0][0] for items in pieces.values() if sum(angle for _, angle in items) >= FULL]
    return sorted(whole, key=lambda c: (c.radius, *c.point.round(6).tolist()))


def flats(brep: Brep) -> list[Flat]:
    """Plane faces, largest first."""
    found = []
    for face in _faces(brep):
        surface = BRepAdaptor_Surface(face)
        if surface.GetType() != GeomAbs_SurfaceType.GeomAbs_Plane:
            continue
        position = surface.Plane().Position()
        normal = np.cross(_vector(position.XDirection()), _vector(position.YDirection()))
        if face.Orientation() == TopAbs_Orientation.TopAbs_REVERSED:
            normal = -normal
        properties = GProp_GProps()
        BRepGProp.SurfaceProperties_s(face, properties)
        distance = float(normal @ _vector(position.Location()))
        found.append(Flat(normal, distance, float(properties.Mass()), face))
    return sorted(found, key=lambda flat: -flat.area)


def coaxial(found: Iterable[Cylinder]) -> list[list[Cylinder]]:
    """Cylinders by axis, each group from its narrowest one: a bore with its counterbores."""
    groups: list[list[Cylinder]] = []
    for cylinder in found:
        group = next((group for group in groups if group[0].shares_axis(cylinder)), None)
        if group is None:
            groups.append([cylinder])
        else:
            group.append(cylinder)
    return groups


def _faces(brep: Brep) -> list[TopoDS_Face]:
    return [TopoDS.Face(face) for face in explore(brep.shape, TopAbs_ShapeEnum.TopAbs_FACE)]


def _cylinder(face: TopoDS_Face, surface: BRepAdaptor_Surface) -> tuple[Cylinder, float]:
    """A cylindrical face, and the angle [rad] that it goes round."""
    cylinder = surface.Cylinder()
    position = cylinder.Position()
    axis, through = _vector(position.Direction()), _vector(position.Location())
    u0, u1, v0, v1 = BRepTools.UVBounds_s(face)
    ends = [float(axis @ through) + v for v in (v0, v1)]
    point = through - (axis @ through) * axis
    if axis[np.argmax(np.abs(axis))] < 0.0:  # one sense for every axis
        axis, ends = -axis, [-end for end in reversed(ends)]
    # The natural normal points away from the axis, or to it where the axes are left-handed, as in mirror images.
    reverse = face.Orientation() == TopAbs_Orientation.TopAbs_REVERSED
    hollow = reverse == position.Direct()
    radius = float(f"{cylinder.Radius():.9g}")
    return Cylinder(radius, axis, point, ends[0], ends[1], hollow, face), u1 - u0


def _vector(xyz: object) -> Vector:
    return np.array([xyz.X(), xyz.Y(), xyz.Z()])  # type: ignore[attr-defined]
