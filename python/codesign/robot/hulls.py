"""Solids as convex pieces: hulls of points, and of the slices of a closed surface; angles to them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import Any

import manifold3d
import numpy as np
from numpy.typing import NDArray

from codesign.errors import MeshError
from codesign.transforms import Matrix

Indices = NDArray[np.intp]
ROUNDING = 1e-9  # rad
FLAT = 1e-12  # of the cube of a hull's size: volume of a flat one
SLIVER = 1e-9  # of the square of a hull's size: area of a facet whose normal is not trusted


def hull_vertices(points: Matrix) -> Matrix:
    """Points (m, 3) that span the convex hull of points (n, 3); all of them if they lie in a plane."""
    found, triangles = _hull_mesh(points)
    return found if len(triangles) else np.ascontiguousarray(points, dtype=float)


def _hull_mesh(points: Matrix) -> tuple[Matrix, Indices]:
    """Points (m, 3) and triangles (k, 3), outwards, of a convex hull; no triangles if the points lie in a plane."""
    hull = manifold3d.Manifold.hull_points(np.ascontiguousarray(points, dtype=float))
    mesh = hull.to_mesh64()
    solid = hull.volume() > FLAT * np.ptp(points, axis=0).max() ** 3
    triangles = mesh.tri_verts if solid else np.zeros((0, 3))
    return np.array(mesh.vert_properties[:, :3], dtype=float, order="C"), np.array(triangles, dtype=np.intp)


def convex_pieces(points: Matrix, triangles: NDArray[Any], count: int) -> list[Matrix]:
    """Vertices of `count` convex pieces that cover a solid: hulls of slices across its longest extent.

    A slice's corners are those of the solid in it and the places where edges cross its two planes, so no solid needs to
    be cut.

    points (n, 3), triangles (m, 3): closed surface. Raises: MeshError if it is not closed.
    """
    _require_closed(triangles, len(points))
    axis = int(np.argmax(np.ptp(points, axis=0)))
    along = points[:, axis]
    planes = np.linspace(along.max(), along.min(), count + 1)
    reach = along[triangles]
    lowest, highest = reach.min(axis=1), reach.max(axis=1)
    starts, ends = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    once = starts < ends  # the edge's other triangle has it the other way round
    crossings = [_crossings(points, starts[once], ends[once], axis, plane) for plane in planes]
    pieces = []
    for k, (high, low) in enumerate(pairwise(planes)):
        inside = triangles[(lowest < high) & (highest > low)]
        if len(inside):
            corner = np.zeros(len(points), dtype=bool)
            corner[inside] = True
            corner &= (along >= low) & (along <= high)
            pieces.append(hull_vertices(np.vstack([points[corner], crossings[k], crossings[k + 1]])))
    return pieces


def _require_closed(triangles: NDArray[Any], count: int) -> None:
    """Refuses a surface that does not have every edge once in each direction."""
    start, end = triangles.astype(np.int64).ravel(), np.roll(triangles, -1, axis=1).astype(np.int64).ravel()
    forth, back = np.sort(start * count + end), np.sort(end * count + start)
    if not len(forth) or (forth[1:] == forth[:-1]).any() or (forth != back).any():
        raise MeshError("no convex pieces: the surface is not closed")


def _crossings(points: Matrix, starts: Indices, ends: Indices, axis: int, plane: float) -> Matrix:
    """Points (k, 3) where edges, of which points (m,) are the starts and ends, cross a plane square to an axis."""
    below = points[:, axis] < plane
    crosses = below[starts] != below[ends]
    a, b = points[starts[crosses]], points[ends[crosses]]
    share = (plane - a[:, axis]) / (b[:, axis] - a[:, axis])
    found = a + share[:, None] * (b - a)
    found[:, axis] = plane
    return np.asarray(found)


@dataclass(frozen=True, slots=True)
class _Hull:
    """corners (c, 3); normals (f, 3), outwards, and offsets (f,) of facets: normal · x + offset = 0; edges (e, 2)."""

    corners: Matrix
    normals: Matrix
    offsets: Matrix
    edges: Indices


@lru_cache(maxsize=512)
def _hull(points: bytes) -> _Hull:
    """The hull of points (n, 3) as C-contiguous floats; kept, since a robot's shapes are the same in every design."""
    corners, triangles = _hull_mesh(np.frombuffer(points).reshape(-1, 3))
    if not len(triangles):
        raise MeshError("no angle to a shape without volume")
    a, b, c = (corners[triangles[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    areas = np.linalg.norm(normals, axis=1)
    flat = areas <= SLIVER * np.ptp(corners, axis=0).max() ** 2  # what lies between neighbors of one plane says nothing
    normals = normals[~flat] / areas[~flat, None]
    edges = np.vstack([triangles[:, [i, j]] for i, j in ((0, 1), (1, 2), (2, 0))])
    return _Hull(corners, normals, -np.einsum("ij,ij->i", normals, a[~flat]), edges[edges[:, 0] < edges[:, 1]])


def smallest_axis_angle(pieces: Sequence[Matrix], frame_T_points: Matrix) -> float:
    """Smallest `axis_angle` [rad] of several pieces (n, 3), whose spheres bound theirs from below.

    frame_T_points: (4, 4) pose of the points' frame.
    """
    bounds = [_least_axis_angle(piece, frame_T_points) for piece in pieces]
    smallest = np.inf
    for k in np.argsort(bounds, kind="stable"):
        if bounds[k] > smallest + ROUNDING:
            break
        smallest = min(smallest, axis_angle(pieces[k], frame_T_points))
    return float(smallest)


def _least_axis_angle(points: Matrix, frame_T_points: Matrix) -> float:
    """Angle [rad] between a frame's z axis and the sphere around the box of points (n, 3), seen from its origin."""
    low, high = points.min(axis=0), points.max(axis=0)
    x, y, z = frame_T_points[:3, :3] @ (0.5 * (low + high)) + frame_T_points[:3, 3]
    radius, distance = 0.5 * np.linalg.norm(high - low), np.sqrt(x * x + y * y + z * z)
    return 0.0 if distance <= radius else float(np.arctan2(np.hypot(x, y), z) - np.arcsin(radius / distance))


def axis_angle(points: Matrix, frame_T_points: Matrix | None = None) -> float:
    """Smallest angle [rad] between a frame's z axis and the hull of a solid's points (n, 3), seen from its origin.

    Zero where the axis meets the hull; else on an edge p + t (q − p), where its cosine is stationary.

    frame_T_points: (4, 4) pose of the points' frame, if it is another. Raises: MeshError: the points lie in a plane.
    """
    hull = _hull(np.ascontiguousarray(points, dtype=float).tobytes())
    motion = np.eye(4) if frame_T_points is None else frame_T_points
    corners = hull.corners @ motion[:3, :3].T + motion[:3, 3]
    normals = hull.normals @ motion[:3, :3].T
    offsets, facing = hull.offsets - normals @ motion[:3, 3], normals[:, 2]
    with np.errstate(divide="ignore", invalid="ignore"):
        crossings = np.where(facing != 0.0, -offsets / facing, np.nan)
    enters = np.max(crossings[facing < 0.0], initial=0.0)
    leaves = np.min(crossings[facing > 0.0], initial=np.inf)
    if enters <= leaves and np.all(offsets[facing == 0.0] <= 0.0):
        return 0.0
    p, d = corners[hull.edges[:, 0]], corners[hull.edges[:, 1]] - corners[hull.edges[:, 0]]
    pp, pd, dd = (np.einsum("ij,ij->i", a, b) for a, b in ((p, p), (p, d), (d, d)))
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (d[:, 2] * pp - p[:, 2] * pd) / (p[:, 2] * dd - d[:, 2] * pd)
    nearest = p + np.clip(np.nan_to_num(t), 0.0, 1.0)[:, None] * d
    candidates = np.vstack([corners, nearest])
    return float(np.arctan2(np.hypot(candidates[:, 0], candidates[:, 1]), candidates[:, 2]).min())
