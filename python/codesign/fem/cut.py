"""Cuts facets of a surface along the planes of a box, so that what lies in the box is whole facets."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from codesign import fem

ON_PLANE = 1e-9  # of the surface's extent: a corner this near to a plane lies on it

Array = NDArray[np.float64]
Edge = tuple[int, int]


def cut_by_box(surface: fem.SurfaceMesh, lower: ArrayLike, upper: ArrayLike) -> fem.SurfaceMesh:
    """The same surface with the facets that meet a box [m] cut along its planes; neighbors share the new corners."""
    low, high = np.asarray(lower, dtype=float), np.asarray(upper, dtype=float)
    points = [np.asarray(point) for point in surface.points]
    pieces = [(tuple(row), face) for row, face in zip(surface.triangles.tolist(), surface.face, strict=True)]
    tolerance = ON_PLANE * float(np.linalg.norm(np.ptp(surface.points, axis=0)))
    for axis in range(3):
        for value in (low[axis], high[axis]):
            crossed = _crossed_edges(points, pieces, (low - tolerance, high + tolerance), axis, value, tolerance)
            pieces = [(part, face) for piece, face in pieces for part in _split(piece, crossed)]
    faces = [int(face) for _, face in pieces]
    return fem.SurfaceMesh(np.array(points), np.array([p for p, _ in pieces], np.int32), faces, surface.face_names)


def _crossed_edges(
    points: list[Array],
    pieces: list[tuple[tuple[int, ...], int]],
    box: tuple[Array, Array],
    axis: int,
    value: float,
    tolerance: float,
) -> dict[Edge, int]:
    """New corners where a plane crosses edges of facets that meet the box; they are added to the points."""
    low, high = box
    crossed: dict[Edge, int] = {}
    for piece, _ in pieces:
        corners = np.array([points[i] for i in piece])
        if np.any(corners.min(axis=0) > high) or np.any(corners.max(axis=0) < low):
            continue
        for a, b in zip(piece, (*piece[1:], piece[0]), strict=True):
            edge = (min(a, b), max(a, b))
            before, after = (points[i][axis] - value for i in edge)
            if edge in crossed or min(abs(before), abs(after)) <= tolerance or before * after > 0.0:
                continue
            middle = points[edge[0]] + before / (before - after) * (points[edge[1]] - points[edge[0]])
            middle[axis] = value
            crossed[edge] = len(points)
            points.append(middle)
    return crossed


def _split(piece: tuple[int, ...], crossed: dict[Edge, int]) -> list[tuple[int, ...]]:
    """A triangle in pieces that hold the new corners on its edges: at most two of them, since a plane made them."""
    new = [crossed.get((min(a, b), max(a, b)), -1) for a, b in zip(piece, (*piece[1:], piece[0]), strict=True)]
    count = sum(corner >= 0 for corner in new)
    if count == 0:
        return [piece]
    turn = next(k for k in range(3) if new[k] >= 0 and (count == 1 or new[(k + 2) % 3] >= 0))
    a, b, c = (piece[(turn + k) % 3] for k in range(3))
    first, last = new[turn], new[(turn + 2) % 3]
    if count == 1:
        return [(a, first, c), (first, b, c)]
    return [(a, first, last), (first, b, c), (first, c, last)]
