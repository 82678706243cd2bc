"""Round holes of a surface: faces whose corners lie on a cylinder with the material around it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from codesign._core.fem import SurfaceMesh

FLAT = 1e-3  # share of the squared normals along the axis, and of the radius that corners may be off the circle
LEAST_FACETS = 4


@dataclass(frozen=True, slots=True)
class Cylinder:
    """A round face: axis (3,) unit vector, center (3,) a point of it [m], radius [m]; hollow: the wall of a hole."""

    axis: NDArray[np.float64]
    center: NDArray[np.float64]
    radius: float
    hollow: bool


def holes(surface: SurfaceMesh) -> dict[int, Cylinder]:
    """Faces (indices into `surface.face_names`) that are walls of round holes."""
    face = np.asarray(surface.face)
    found = {int(index): cylinder_of(surface, face == index) for index in np.unique(face)}
    return {index: cylinder for index, cylinder in found.items() if cylinder is not None and cylinder.hollow}


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
