"""Removes what booleans leave behind and meshers stumble over: tiny edges and flat triangles.

Booleans of exact coordinates are watertight, but two outlines that nearly meet leave edges of a few micrometres. Such
an edge is shrunk to one of its ends; a flat triangle exchanges its longest edge with the neighbour on the same face.
Faces keep their numbers, no point moves by more than `SHORTEST_EDGE`, the surface stays closed.
"""

from __future__ import annotations

import numpy as np

from codesign.geometry.profile import Vector
from codesign.geometry.tessellate import Indices

SHORTEST_EDGE = 0.05  # mm
SMALLEST_HEIGHT = 0.002  # mm, of a triangle
_KEPT_DIRECTION = 0.5  # cosine by which the normal of a triangle may turn when a tiny edge beside it goes


def tidy(points: Vector, triangles: Indices, face: Indices) -> tuple[Vector, Indices, Indices]:
    """The same surface without edges below SHORTEST_EDGE and, where possible, heights below SMALLEST_HEIGHT.

    points (n, 3) mm; triangles (m, 3); face (m,) number of the face of each triangle. Edges that cannot go without
    tearing or folding the surface stay.
    """
    surface = _Surface(points, triangles, face)
    for start, end in surface.short_edges():
        surface.shrink(start, end)
    for triangle in surface.flat_triangles():
        surface.flip(triangle)
    return surface.result()


def without_unused(points: Vector, triangles: Indices) -> tuple[Vector, Indices]:
    """The points that triangles use, in their order, and the triangles numbered accordingly."""
    used = np.zeros(len(points), dtype=bool)
    used[triangles] = True
    number = np.cumsum(used) - 1
    return points[used], number[triangles]


class _Surface:
    """A surface under repair; removed triangles are marked, points that nothing uses are dropped at the end."""

    def __init__(self, points: Vector, triangles: Indices, face: Indices) -> None:
        self.points, self.triangles, self.face = points, triangles.copy(), face
        self.alive = np.ones(len(triangles), dtype=bool)
        self._near = np.arange(0)  # triangles in which the points under repair are looked up

    def short_edges(self) -> list[tuple[int, int]]:
        """Edges below the tolerance, shortest first."""
        edges = np.concatenate([self.triangles[:, [k, (k + 1) % 3]] for k in range(3)])
        edges = edges[edges[:, 0] < edges[:, 1]]
        squared = ((self.points[edges[:, 1]] - self.points[edges[:, 0]]) ** 2).sum(axis=1)
        short = np.flatnonzero(squared < SHORTEST_EDGE**2)
        edges = edges[short[np.argsort(squared[short], kind="stable")]]
        self._look_near(edges)
        return [(int(a), int(b)) for a, b in edges]

    def flat_triangles(self) -> list[int]:
        """Triangles lower than the tolerance."""
        corners = self.points[self.triangles]
        sides = np.roll(corners, -1, axis=1) - corners
        doubled = ((np.cross(sides[:, 0], sides[:, 1])) ** 2).sum(axis=1)
        longest = (sides**2).sum(axis=2).max(axis=1)
        flat = np.flatnonzero((doubled < SMALLEST_HEIGHT**2 * longest) & self.alive)
        self._look_near(self.triangles[flat])
        return [int(k) for k in flat]

    def _look_near(self, points: Indices) -> None:
        marked = np.zeros(len(self.points), dtype=bool)
        marked[points.ravel()] = True
        self._near = np.flatnonzero(marked[self.triangles].any(axis=1))

    def _around(self, *points: int) -> Indices:
        """Living triangles that use all the points."""
        near = self._near[self.alive[self._near]]
        for point in points:
            near = near[(self.triangles[near] == point).any(axis=1)]
        return near

    def shrink(self, first: int, second: int) -> None:
        """Moves one end of an edge onto the other, if that folds nothing."""
        around = {v: self._around(v) for v in (first, second)}
        shared = np.intersect1d(around[first], around[second])
        if len(shared) != 2 or np.linalg.norm(self.points[first] - self.points[second]) >= SHORTEST_EDGE:
            return
        neighbours = [set(self.triangles[around[v]].ravel().tolist()) for v in (first, second)]
        if len(neighbours[0] & neighbours[1]) != 4:  # the ends and one point on each side
            return
        choices = []
        for gone, kept in ((first, second), (second, first)):
            moving = np.setdiff1d(around[gone], shared)
            moved = np.where(self.triangles[moving] == gone, kept, self.triangles[moving])
            turn = (self._normals(self.triangles[moving]) * self._normals(moved)).sum(axis=1).min(initial=1.0)
            if turn >= _KEPT_DIRECTION:
                choices.append((self._swept_volume(moving, kept), gone, kept))
        if not choices:
            return
        _, gone, kept = min(choices)
        self.alive[shared] = False
        self.triangles[around[gone]] = np.where(
            self.triangles[around[gone]] == gone, kept, self.triangles[around[gone]]
        )

    def flip(self, flat: int) -> None:
        """Gives a flat triangle and its neighbour over its longest edge the other diagonal, if they share a plane."""
        corners = self.triangles[flat]
        sides = self.points[np.roll(corners, -1)] - self.points[corners]
        k = int(np.linalg.norm(sides, axis=1).argmax())
        a, b, tip = (int(corners[(k + i) % 3]) for i in range(3))
        other = np.setdiff1d(self._around(a, b), [flat])
        if len(other) != 1 or self.face[other[0]] != self.face[flat]:
            return
        opposite = int(np.setdiff1d(self.triangles[other[0]], [a, b])[0])
        if len(self._around(tip, opposite)):
            return
        new = np.array([[tip, a, opposite], [opposite, b, tip]])
        before = self._normals(self.triangles[other])[0]
        if (self._normals(new) @ before).min() < 1.0 - 1e-9:
            return
        self.triangles[[flat, other[0]]] = new

    def _swept_volume(self, triangles: Indices, point: int) -> float:
        """Sum of the volumes between triangles and a point: what a move to that point changes at most."""
        a, b, c = (self.points[self.triangles[triangles, k]] - self.points[point] for k in range(3))
        return float(np.abs((a * np.cross(b, c)).sum(axis=1)).sum())

    def _normals(self, triangles: Indices) -> Vector:
        a, b, c = (self.points[triangles[:, k]] for k in range(3))
        normals: Vector = np.cross(b - a, c - a)
        length = np.linalg.norm(normals, axis=1, keepdims=True)
        return normals / np.where(length > 0.0, length, 1.0)

    def result(self) -> tuple[Vector, Indices, Indices]:
        """Points in use, triangles and faces."""
        return *without_unused(self.points, self.triangles[self.alive]), self.face[self.alive]
