"""Removes what booleans leave behind and meshers stumble over: tiny edges and flat triangles.

Booleans of exact coordinates are watertight, but two outlines that nearly meet leave edges of a few micrometers. Such
an edge is shrunk to one of its ends; a flat triangle exchanges its longest edge with the neighbor on the same face.
Faces keep their numbers, no point moves by more than `SHORTEST_EDGE`, the surface stays closed.
"""

from __future__ import annotations

import math

import numpy as np

from codesign.geometry.profile import Vector
from codesign.geometry.tessellate import Indices

SHORTEST_EDGE = 0.05  # mm
SMALLEST_HEIGHT = 0.002  # mm, of a triangle
Place = list[float]  # (3,) mm; plain numbers are faster than arrays for a handful of triangles
_PASSES = 8
_SAME_PLANE = 0.9998  # cosine between the normals before and after a flip, about a degree
_KEPT_DIRECTION = 0.5  # cosine by which the normal of a triangle may turn when a tiny edge beside it goes


def tidy(points: Vector, triangles: Indices, face: Indices) -> tuple[Vector, Indices, Indices]:
    """The same surface without edges below SHORTEST_EDGE and, where possible, heights below SMALLEST_HEIGHT.

    points (n, 3) mm; triangles (m, 3); face (m,) number of the face of each triangle. Edges that cannot go without
    tearing or folding the surface stay.
    """
    surface = _Surface(points, triangles, face)
    for _ in range(_PASSES):  # what goes can make its neighbors short or flat
        shrunk = [surface.shrink(start, end) for start, end in surface.short_edges()]
        flipped = [surface.flip(triangle) for triangle in surface.flat_triangles()]
        if not any(shrunk + flipped):
            break
    return surface.result()


def without_unused(points: Vector, triangles: Indices) -> tuple[Vector, Indices]:
    """The points (n, 3) that triangles use, in their order, and the triangles (m, 3) numbered accordingly."""
    used = np.zeros(len(points), dtype=bool)
    used[triangles] = True
    number = np.cumsum(used) - 1
    return points[used], number[triangles]


class _Surface:
    """A surface under repair; removed triangles are marked, points that nothing uses are dropped at the end.

    Only a handful of places need repair, so what surrounds them is kept in plain lists and sets.
    """

    def __init__(self, points: Vector, triangles: Indices, face: Indices) -> None:
        self.points, self.triangles, self.face = points, triangles.copy(), face
        self._columns = np.ascontiguousarray(points.T)
        self.alive = np.ones(len(triangles), dtype=bool)
        self._fan: dict[int, set[int]] = {}  # living triangles around each point under repair

    def short_edges(self) -> list[tuple[int, int]]:
        """Edges below the tolerance, shortest first."""
        starts = self.triangles[self.alive].T
        ends = np.roll(starts, -1, axis=0)
        once = starts < ends
        start, end = starts[once], ends[once]
        squared = _squared(self._columns[:, end] - self._columns[:, start])
        short = np.flatnonzero(squared < SHORTEST_EDGE**2)
        short = short[np.argsort(squared[short], kind="stable")]
        edges = np.stack((start[short], end[short]), axis=1)
        self._look_around(edges)
        return [(int(a), int(b)) for a, b in edges]

    def flat_triangles(self) -> list[int]:
        """Triangles lower than the tolerance."""
        corners = self._columns[:, self.triangles.T]  # (coordinates, corners, triangles)
        a, b, c = (np.roll(corners, -1, axis=1) - corners).swapaxes(0, 1)
        cross = np.stack((a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]))
        doubled = _squared(cross)
        longest = np.maximum(np.maximum(_squared(a), _squared(b)), _squared(c))
        flat = np.flatnonzero((doubled < SMALLEST_HEIGHT**2 * longest) & self.alive)
        self._look_around(self.triangles[flat])
        return [int(k) for k in flat]

    def _look_around(self, points: Indices) -> None:
        marked = np.zeros(len(self.points), dtype=bool)
        marked[points] = True
        self._fan = {v: set() for v in np.flatnonzero(marked).tolist()}
        for triangle in np.flatnonzero(marked[self.triangles].any(axis=1) & self.alive).tolist():
            for v in self._fan.keys() & self._corners(triangle):
                self._fan[v].add(triangle)

    def _corners(self, triangle: int) -> list[int]:
        corners: list[int] = self.triangles[triangle].tolist()
        return corners

    def _place(self, point: int) -> Place:
        place: Place = self.points[point].tolist()
        return place

    def _corners_and_places(self, triangle: int) -> tuple[list[int], list[Place]]:
        corners = self._corners(triangle)
        return corners, [self._place(v) for v in corners]

    def shrink(self, first: int, second: int) -> bool:
        """Moves one end of an edge onto the other, if that folds nothing. Returns: whether it did."""
        shared = self._fan[first] & self._fan[second]
        if len(shared) != 2 or math.dist(self._place(first), self._place(second)) >= SHORTEST_EDGE:
            return False
        neighbors = [{v for triangle in self._fan[end] for v in self._corners(triangle)} for end in (first, second)]
        if len(neighbors[0] & neighbors[1]) != 4:  # the ends and one point on each side
            return False
        choices = []
        for gone, kept in ((first, second), (second, first)):
            target = self._place(kept)
            moves = [
                (before, [target if v == gone else place for v, place in zip(corners, before, strict=True)])
                for corners, before in map(self._corners_and_places, self._fan[gone] - shared)
            ]
            turn = min((_dot(_normal(before), _normal(after)) for before, after in moves), default=1.0)
            if turn >= _KEPT_DIRECTION:
                swept = sum(abs(_volume(before, target)) for before, _ in moves)  # what the move changes at most
                choices.append((swept, gone, kept))
        if not choices:
            return False
        _, gone, kept = min(choices)
        around = sorted(self._fan[gone])
        self.alive[list(shared)] = False
        self.triangles[around] = np.where(self.triangles[around] == gone, kept, self.triangles[around])
        self._fan[kept] |= self._fan.pop(gone)
        self._fan[gone] = set()
        for fan in self._fan.values():
            fan -= shared
        return True

    def flip(self, flat: int) -> bool:
        """Gives a flat triangle and its neighbor over its longest edge the other diagonal, if they share a plane.

        The surface moves by less than the height of the flat triangle. Returns: whether it did.
        """
        corners = self._corners(flat)
        sides = [math.dist(self._place(corners[k]), self._place(corners[k - 2])) for k in range(3)]
        k = sides.index(max(sides))
        a, b, tip = (corners[(k + i) % 3] for i in range(3))
        others = (self._fan[a] & self._fan[b]) - {flat}
        if len(others) != 1:
            return False
        (other,) = others
        if self.face[other] != self.face[flat]:
            return False
        (opposite,) = set(self._corners(other)) - {a, b}
        if any(opposite in self._corners(triangle) for triangle in self._fan[tip]):
            return False
        new = [[tip, a, opposite], [opposite, b, tip]]
        before = _normal(self._corners_and_places(other)[1])
        if min(_dot(_normal([self._place(v) for v in corners]), before) for corners in new) < _SAME_PLANE:
            return False
        self.triangles[[flat, other]] = new
        self._fan[a].discard(other)
        self._fan[b].discard(flat)
        self._fan[tip].add(other)
        if opposite in self._fan:
            self._fan[opposite].add(flat)
        return True

    def result(self) -> tuple[Vector, Indices, Indices]:
        """Points in use (n, 3), triangles (m, 3) and their faces (m,)."""
        return *without_unused(self.points, self.triangles[self.alive]), self.face[self.alive]


def _squared(vectors: Vector) -> Vector:
    """Squared lengths (n,) of vectors (3, n)."""
    x, y, z = vectors
    return np.asarray(x * x + y * y + z * z)


def _dot(a: Place, b: Place) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _cross(a: Place, b: Place) -> Place:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def _from(origin: Place, point: Place) -> Place:
    return [p - o for p, o in zip(point, origin, strict=True)]


def _normal(triangle: list[Place]) -> Place:
    """Unit normal; zero for a triangle without area."""
    a, b, c = triangle
    normal = _cross(_from(a, b), _from(a, c))
    length = math.hypot(*normal)
    return [x / length for x in normal] if length > 0.0 else normal


def _volume(triangle: list[Place], apex: Place) -> float:
    """Six times the volume between a triangle and a point."""
    a, b, c = (_from(apex, corner) for corner in triangle)
    return _dot(a, _cross(b, c))
