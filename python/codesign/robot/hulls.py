"""Solids as convex pieces: hulls of points, and of the slices of a closed surface."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from codesign.errors import MeshError
from codesign.transforms import Matrix

Indices = NDArray[np.intp]


def hull_vertices(points: Matrix) -> Matrix:
    """Vertices (m, 3) of the convex hull of a solid's points (n, 3)."""
    from scipy.spatial import ConvexHull  # a quarter of a second to import

    return np.ascontiguousarray(points[ConvexHull(points).vertices], dtype=float)


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
    pieces = []
    for high, low in pairwise(planes):
        inside = triangles[(lowest < high) & (highest > low)]
        if len(inside):
            corners = points[np.unique(inside)]
            corners = corners[(corners[:, axis] >= low) & (corners[:, axis] <= high)]
            edges = np.concatenate([inside[:, [0, 1]], inside[:, [1, 2]], inside[:, [2, 0]]])
            edges = edges[edges[:, 0] < edges[:, 1]]  # each once: its other triangle has it the other way round
            crossed = [_crossings(points, edges, axis, plane) for plane in (high, low)]
            pieces.append(hull_vertices(np.vstack([corners, *crossed])))
    return pieces


def _require_closed(triangles: NDArray[Any], count: int) -> None:
    """Refuses a surface that does not have every edge once in each direction."""
    start, end = triangles.astype(np.int64).ravel(), np.roll(triangles, -1, axis=1).astype(np.int64).ravel()
    forth, back = np.sort(start * count + end), np.sort(end * count + start)
    if not len(forth) or (forth[1:] == forth[:-1]).any() or (forth != back).any():
        raise MeshError("no convex pieces: the surface is not closed")


def _crossings(points: Matrix, edges: Indices, axis: int, plane: float) -> Matrix:
    """Points (k, 3) where edges (m, 2) cross a plane square to an axis."""
    a, b = points[edges[:, 0]], points[edges[:, 1]]
    crosses = (a[:, axis] < plane) != (b[:, axis] < plane)
    a, b = a[crosses], b[crosses]
    share = (plane - a[:, axis]) / (b[:, axis] - a[:, axis])
    found = a + share[:, None] * (b - a)
    found[:, axis] = plane
    return np.asarray(found)
