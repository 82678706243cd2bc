"""Roundings and bevels of edges where two named faces of a finished solid meet.

An edge is found on a coarse mesh, whose corners lie on the true curves, and becomes a tool of the part language, so
that both evaluators make the same solid of it. What is cut or filled is compared with what the edge alone would take:
an edge that ends at anything but a face square to it, or has no room, is refused.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from codesign.errors import GeometryError
from codesign.geometry.profile import FULL_TURN, Path, Profile, Resolution, Vector
from codesign.geometry.shape import Difference, Extrusion, Frame, Revolution, Shape, Triple
from codesign.geometry.solid import Solid, build_solid, mesh_volume

Pair = tuple[str, str]
_COARSE, _FINE = Resolution(8), Resolution(48)
_SAME = 1e-7  # mm and direction entries
_FIT = 1e-6  # relative difference of volumes
_MARGIN = 0.25  # of the size: how far a tool reaches beyond the faces


@dataclass(frozen=True)
class _Place:
    """An edge between two faces: a line or a full circle.

    a, b: unit vectors from the edge along the faces, at `start`. length: of a line, along `along`; 0 for a circle
    about the axis `along` through `center` with `radius`. hollow: material is added, not taken away.
    """

    start: Vector
    along: Vector
    a: Vector
    b: Vector
    length: float
    hollow: bool
    center: Vector
    radius: float

    @property
    def angle(self) -> float:
        """Between the faces, inside the material or, where it is added, outside [rad]."""
        return math.acos(float(np.clip(self.a @ self.b, -1.0, 1.0)))

    @property
    def inwards(self) -> bool:
        """Of a circle: whether the plane lies inside it."""
        return bool(self.a @ (self.start - self.center) < 0.0)


def fillet(shape: Shape, *edges: Pair, radius: float, face: str = "") -> Shape:
    """The solid with edges rounded by `radius` [mm]; see `chamfer` for which. face: name of the new faces."""
    return _worked(shape, edges, radius, face, round_=True)


def chamfer(shape: Shape, *edges: Pair, size: float, face: str = "") -> Shape:
    """The solid with edges beveled by `size` [mm] along both faces.

    Args:
        edges: pairs of names of faces, ("top", "bore"); every edge between two such faces is meant. It is a straight
            outer edge of two planes that ends at planes square to it or at another edge of the call, or a whole circle
            of a plane and a cylinder square to it, outer or inner.
        face: name of the new faces.
    Raises: GeometryError: the faces do not meet, an edge is of another kind, or there is no room.
    """
    return _worked(shape, edges, size, face, round_=False)


def _worked(shape: Shape, edges: tuple[Pair, ...], size: float, face: str, round_: bool) -> Shape:
    if not size > 0.0 or not edges:
        raise GeometryError(f"an edge is worked by {size!r} mm: name edges, and a size above 0")
    solid = build_solid(shape, _COARSE)
    before, result = mesh_volume(shape, _FINE), shape
    for place in (place for pair in edges for place in _places(solid, pair)):
        tool = _tool(place, size, face, round_)
        alone = shape + tool if place.hollow else Difference(shape, (tool,))
        changed, bare = abs(mesh_volume(alone, _FINE) - before), _bare_volume(place, size, round_)
        if abs(changed - bare) > _FIT * bare:
            words = ", ".join(f"{a!r} and {b!r}" for a, b in edges)
            raise GeometryError(
                f"edge of {words}: {size:g} mm has no room there, or the edge ends at a face that is not square to it "
                f"({changed:.6g} mm³ instead of {bare:.6g}): draw it in the profile"
            )
        result = result + tool if place.hollow else result - tool
    return result


def _places(solid: Solid, pair: Pair) -> list[_Place]:
    """The edges between faces of two names, one for each pair of analytic faces that meet there."""
    corners = solid.points[solid.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    names = np.array([solid.face_names[k] for k in solid.face])
    for name in pair:
        if name not in solid.names:
            raise GeometryError(f"edge of {pair[0]!r} and {pair[1]!r}: the solid has no face {name!r}")
    sides: dict[tuple[int, int], int] = {}
    for number, triangle in enumerate(solid.triangles.tolist()):
        for k in range(3):
            sides[triangle[k], triangle[(k + 1) % 3]] = number
    chains: dict[tuple[int, int], list[tuple[int, int, int, int]]] = {}
    for (i, j), one in sides.items():
        other = sides[j, i]
        if (names[one], names[other]) == pair and solid.face[one] != solid.face[other]:
            chains.setdefault((int(solid.face[one]), int(solid.face[other])), []).append((i, j, one, other))
    if not chains:
        raise GeometryError(f"faces {pair[0]!r} and {pair[1]!r} meet in no edge")
    found = []
    for faces, chain in chains.items():
        flat = [_plane(normals[solid.face == face]) for face in faces]
        found += _lines_or_circle(solid, pair, flat, chain)
    return found


def _plane(normals: Vector) -> Vector | None:
    """The unit normal of a face, None if it is curved. normals (n, 3): twice the areas of its triangles."""
    total = normals.sum(axis=0) / np.linalg.norm(normals.sum(axis=0))
    lengths = np.linalg.norm(normals, axis=1)
    return total if np.abs(normals @ total - lengths).max() < _SAME * lengths.max() else None


def _lines_or_circle(
    solid: Solid, pair: Pair, flat: list[Vector | None], chain: list[tuple[int, int, int, int]]
) -> list[_Place]:
    words = f"edge of {pair[0]!r} and {pair[1]!r}"
    if flat[0] is not None and flat[1] is not None:
        return [_line(solid, words, flat[0], flat[1], chain)]
    if flat[0] is None and flat[1] is not None:
        chain = [(j, i, other, one) for i, j, one, other in chain]
        flat = flat[::-1]
    if flat[0] is None:
        raise GeometryError(f"{words}: at least one of them must be a plane")
    return [_circle(solid, words, flat[0], chain)]


def _line(solid: Solid, words: str, normal: Vector, other: Vector, chain: list[tuple[int, int, int, int]]) -> _Place:
    points = solid.points[[k for i, j, *_ in chain for k in (i, j)]]
    along = np.cross(normal, other)
    along /= np.linalg.norm(along)
    order = np.argsort(points @ along)
    start, end = points[order[0]], points[order[-1]]
    length = float((end - start) @ along)
    whole = sum(float(np.linalg.norm(solid.points[j] - solid.points[i])) for i, j, *_ in chain)
    if abs(whole - length) > _SAME * length:
        raise GeometryError(f"{words}: the edge is interrupted: work it before what cuts it")
    i, j, first, second = chain[0]
    middle = 0.5 * (solid.points[i] + solid.points[j])
    a, b = (np.cross(n, along) for n in (normal, other))
    a = a * np.sign((solid.points[solid.triangles[first]].mean(axis=0) - middle) @ a)
    b = b * np.sign((solid.points[solid.triangles[second]].mean(axis=0) - middle) @ b)
    if b @ normal > 0.0:
        raise GeometryError(f"{words}: a straight inner edge: draw its rounding in the profile")
    return _Place(start, along, a, b, length, False, start, 0.0)


def _circle(solid: Solid, words: str, normal: Vector, chain: list[tuple[int, int, int, int]]) -> _Place:
    points = solid.points[sorted({k for i, j, *_ in chain for k in (i, j)})]
    center = points.mean(axis=0)
    away = points - center
    radius = float(np.linalg.norm(away, axis=1).mean())
    whole = len(points) == len(chain) == 8 and np.abs(np.linalg.norm(away, axis=1) - radius).max() < _SAME
    i, j, first, second = chain[0]
    corners = solid.points[solid.triangles[second]]
    side = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    if not whole or abs(side @ normal) > _SAME * np.linalg.norm(side):
        raise GeometryError(f"{words}: neither a line nor a whole circle of a cylinder square to the plane")
    middle = 0.5 * (solid.points[i] + solid.points[j])
    outward = middle - center
    start = points[0]
    radial = (start - center) / radius
    a = radial * np.sign((solid.points[solid.triangles[first]].mean(axis=0) - middle) @ outward)
    b = normal * np.sign((corners.mean(axis=0) - middle) @ normal)
    return _Place(start, normal, a, b, 0.0, bool(b @ normal > 0.0), center, radius)


def _tool(place: _Place, size: float, face: str, round_: bool) -> Shape:
    """What is cut or filled; it reaches beyond the faces and the ends."""
    if place.length:
        second = np.cross(place.along, place.a)
        sign = 1.0 if second @ place.b > 0.0 else -1.0
        frame, beyond = _frame(place.start, place.a, sign * second), _MARGIN * size
        low, high = (-beyond, place.length + beyond) if sign > 0.0 else (-place.length - beyond, beyond)
        return Extrusion(_corner(place.angle, size, face, round_), low, high, frame)
    if place.inwards and size > place.radius:
        raise GeometryError(f"an edge of radius {place.radius:g} mm cannot be worked by {size:g} mm")
    axial, radial = float(np.sign(place.b @ place.along)), -1.0 if place.inwards else 1.0
    frame = _frame(place.center, place.along, place.start - place.center)
    profile = _turned(_corner(place.angle, size, face, round_), axial, radial, place.radius)
    return Revolution(profile, frame, place.radius)


def _bare_volume(place: _Place, size: float, round_: bool) -> float:
    """Volume [mm³] between an edge and its rounding or bevel, with the chords of the mesh."""
    points, _ = _corner(place.angle, size, "", round_).outer.points(_FINE)
    region = np.vstack([[0.0, 0.0], points[2:-1]])  # without what lies beyond the faces
    ahead = np.roll(region, -1, axis=0)
    cross = region[:, 0] * ahead[:, 1] - ahead[:, 0] * region[:, 1]
    area, moment = 0.5 * cross.sum(), (cross * (region[:, 0] + ahead[:, 0])).sum() / 6.0
    if place.length:
        return float(area * place.length)
    steps = _FINE.arc_segments(place.radius, FULL_TURN)
    across = place.radius * area + (-moment if place.inwards else moment)
    return float(steps * math.sin(FULL_TURN / steps) * across)


def _corner(angle: float, size: float, face: str, round_: bool) -> Profile:
    """The region between a corner at the origin and its rounding or bevel, one leg along x, the other at `angle`.

    It reaches beyond the legs. Its first two points and its last one are those that lie there.
    """
    reach, beyond = size / math.tan(0.5 * angle) if round_ else size, _MARGIN * size
    cosine, sine = math.cos(angle), math.sin(angle)
    tip = -beyond / math.sin(0.5 * angle)
    path = Path(tip * math.cos(0.5 * angle), tip * math.sin(0.5 * angle)).line(reach, -beyond).line(reach, 0.0)
    end = (reach * cosine, reach * sine)
    path = path.arc(*end, center=(reach, size), turn="right", face=face) if round_ else path.line(*end, face=face)
    return path.line(end[0] - beyond * sine, end[1] + beyond * cosine).close()


def _turned(profile: Profile, axial: float, radial: float, radius: float) -> Profile:
    """A corner between the plane (x: radially) and the cylinder (y: axially) in (axial, radial) coordinates."""

    def put(point: tuple[float, float]) -> tuple[float, float]:
        return axial * point[1], radius + radial * point[0]

    loop = profile.outer
    starts, edges = loop.starts, list(loop.edges)
    if axial * radial > 0.0:  # the map turns loops round: the other way along it the arc turns right again
        starts, edges = [edge.end for edge in reversed(edges)], edges[::-1]
    ends = [*starts[1:], starts[0]]
    path = Path(*put(starts[0]))
    for end, edge in zip(ends, edges, strict=True):
        if edge.center is None:
            path = path.line(*put(end), face=edge.face)
        else:
            path = path.arc(*put(end), center=put(edge.center), turn="right", face=edge.face)
    return path.close()


def _frame(origin: Vector, x: Vector, y: Vector) -> Frame:
    def triple(v: Vector) -> Triple:
        return (float(v[0]), float(v[1]), float(v[2]))

    return Frame(triple(origin), triple(x / np.linalg.norm(x)), triple(y / np.linalg.norm(y)))
