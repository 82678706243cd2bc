"""Round holes of a surface: faces whose corners lie on a cylinder, with the material all around it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from codesign._core.fem import SurfaceMesh

FLAT = 1e-3  # share of the squared normals along the axis, and of the radius that corners may be off the circle
LEAST_FACETS = 4
SAME_CIRCLE = 1e-2  # of the radius, and of a right angle: what two faces of one hole may differ
OPEN = np.radians(170.0)  # a wall open this far is no hole: a fillet, the end of a slot, a groove


@dataclass(frozen=True, slots=True)
class Cylinder:
    """A round face: axis (3,) unit vector, center (3,) a point of it [m], radius [m]; hollow: material outside."""

    axis: NDArray[np.float64]
    center: NDArray[np.float64]
    radius: float
    hollow: bool


def holes(surface: SurfaceMesh) -> dict[int, Cylinder]:
    """Faces (indices into `surface.face_names`) that are walls of round holes, or together with others such a wall."""
    hollow = hollows(surface)
    face = np.asarray(surface.face)
    points = {index: surface.points[np.unique(surface.triangles[face == index])] for index in hollow}
    return {index: wall for index, wall in hollow.items() if _opening(wall, hollow, points) < OPEN}


def hollows(surface: SurfaceMesh) -> dict[int, Cylinder]:
    """Faces (indices into `surface.face_names`) that are round and hollow: holes, fillets, ends of slots, grooves."""
    face = np.asarray(surface.face)
    found = {int(index): cylinder_of(surface, face == index) for index in np.unique(face)}
    return {index: cylinder for index, cylinder in found.items() if cylinder is not None and cylinder.hollow}


def _opening(wall: Cylinder, hollow: dict[int, Cylinder], points: dict[int, NDArray[np.float64]]) -> float:
    """Largest angle [rad] around the axis of a face without a corner of it or of those that go around with it.

    Those: the same circle, and a stretch of the axis in common. points: (k, 3) corners of each face [m].
    """
    own = next((points[i] - wall.center) @ wall.axis for i, other in hollow.items() if other is wall)
    around = []
    for i, other in hollow.items():
        away = other.center - wall.center
        shifted = float(np.linalg.norm(away - wall.axis * (away @ wall.axis)))
        tilted = float(np.linalg.norm(np.cross(wall.axis, other.axis)))
        if max(tilted, shifted / wall.radius, abs(other.radius / wall.radius - 1.0)) > SAME_CIRCLE:
            continue
        arms = points[i] - wall.center
        along = arms @ wall.axis
        if min(own.max(), along.max()) - max(own.min(), along.min()) > SAME_CIRCLE * wall.radius:
            around.append(arms)
    arms = np.concatenate(around)
    first = np.cross(wall.axis, np.eye(3)[np.argmin(np.abs(wall.axis))])
    angles = np.sort(np.arctan2(arms @ np.cross(wall.axis, first), arms @ first))
    return float(np.diff(angles, append=angles[0] + 2.0 * np.pi).max())


def cylinder_of(surface: SurfaceMesh, facets: NDArray[np.bool_]) -> Cylinder | None:
    """The cylinder that the corners of some triangles (m,) lie on; None if there is none.

    The axis is the direction that all normals are normal to, the circle the best one by least squares (Kåsa).
    """
    triangles = np.asarray(surface.triangles)[facets]
    if len(triangles) < LEAST_FACETS:
        return None
    corners = np.asarray(surface.points)[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(normals, axis=1, keepdims=True)
    unit = np.divide(normals, areas, out=np.zeros_like(normals), where=areas > 0.0)
    spread, directions = np.linalg.eigh((unit * areas).T @ unit)
    if spread[0] > FLAT * spread.sum() or spread[1] < FLAT * spread.sum():
        return None  # normals in all directions, or a plane
    axis, plane = directions[:, 0], directions[:, 1:]
    points = np.unique(corners.reshape(-1, 3), axis=0)
    flat = points @ plane
    middle = flat.mean(axis=0)
    local = flat - middle
    system = np.column_stack([2.0 * local, np.ones(len(local))])
    solution, *_ = np.linalg.lstsq(system, (local**2).sum(axis=1), rcond=None)
    radius = float(np.sqrt(max(solution[2] + solution[:2] @ solution[:2], 0.0)))
    off = np.abs(np.linalg.norm(local - solution[:2], axis=1) - radius)
    if radius == 0.0 or off.max() > FLAT * radius:
        return None
    center = plane @ (middle + solution[:2]) + axis * (points.mean(axis=0) @ axis)
    outward = ((corners.mean(axis=1) - center) * unit * areas).sum()
    return Cylinder(axis, center, radius, bool(outward < 0.0))
