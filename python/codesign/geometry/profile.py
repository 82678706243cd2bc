"""Plane outlines of straight lines and circular arcs: what extrusions and revolutions are made from."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from codesign.errors import GeometryError

Vector = npt.NDArray[np.float64]
FULL_TURN = 2.0 * math.pi


@dataclass(frozen=True, slots=True)
class Resolution:
    """How finely circles are divided: `segments` a full turn, fewer where the chord stays within `chord_mm` of the arc.

    chord_mm: None takes 0.06 mm at 48 segments and scales it like the sagitta of a circle, with 1 / segments².
    Roundings (arcs of less than a full turn) get at least 8 chords a quarter turn: what their stress needs.
    refine: multiplies every count; a mesh of refine = 2 has exactly twice the segments of refine = 1 on every arc,
    which makes extrapolation to the true curve possible.
    """

    segments: int = 48
    chord_mm: float | None = None
    refine: int = 1

    def arc_segments(self, radius: float, angle: float) -> int:
        """Number of chords on an arc of `radius` [mm] and `angle` [rad]."""
        chord = 0.06 * (48.0 / self.segments) ** 2 if self.chord_mm is None else self.chord_mm
        wanted = 8 * math.ceil(math.pi / math.acos(1.0 - min(chord / radius, 0.3)) / 8)  # whole chords on each eighth
        least = 16 if abs(angle) == FULL_TURN else 32
        full_turn = min(max(wanted, least), self.segments)
        return self.refine * max(1, math.ceil(full_turn * abs(angle) / FULL_TURN - 1e-9))


@dataclass(frozen=True, slots=True)
class Edge:
    """A line, or an arc about `center` over `sweep` [rad, left turn positive], from the previous point to `end`."""

    end: tuple[float, float]
    face: str = ""
    center: tuple[float, float] | None = None
    sweep: float = 0.0

    def middle(self, start: tuple[float, float]) -> tuple[float, float]:
        """The point half way along the edge, which leaves from `start`."""
        if self.center is None:
            return (0.5 * (start[0] + self.end[0]), 0.5 * (start[1] + self.end[1]))
        cx, cy = self.center
        angle = math.atan2(start[1] - cy, start[0] - cx) + 0.5 * self.sweep
        radius = math.hypot(start[0] - cx, start[1] - cy)
        return (cx + radius * math.cos(angle), cy + radius * math.sin(angle))

    def directions(self, start: tuple[float, float]) -> tuple[float, float]:
        """Angles [rad] of the direction of travel at both ends of the edge, which leaves from `start`."""
        if self.center is None:
            angle = math.atan2(self.end[1] - start[1], self.end[0] - start[0])
            return angle, angle
        quarter = math.copysign(0.5 * math.pi, self.sweep)
        angle = math.atan2(start[1] - self.center[1], start[0] - self.center[0]) + quarter
        return angle, angle + self.sweep


@dataclass(frozen=True, slots=True)
class Loop:
    """A closed outline in a plane [mm]; the last edge ends at `start`."""

    start: tuple[float, float]
    edges: tuple[Edge, ...]

    @property
    def starts(self) -> list[tuple[float, float]]:
        """The point (x, y) [mm] from which each edge leaves."""
        return [self.start, *(edge.end for edge in self.edges[:-1])]

    @property
    def turns_once(self) -> bool:
        """Whether the direction of travel makes one full left turn without doubling back, as on a simple outline."""
        directions = [edge.directions(start) for start, edge in zip(self.starts, self.edges, strict=True)]
        turns = [edge.sweep for edge in self.edges]
        for (_, before), (after, _) in zip(directions, directions[1:] + directions[:1], strict=True):
            turns.append((after - before + math.pi) % FULL_TURN - math.pi)
            if abs(turns[-1]) > math.pi - 1e-6:
                return False
        return abs(sum(turns) - FULL_TURN) < 1e-6

    @property
    def area(self) -> float:
        """Enclosed area [mm²], exact for arcs; positive if the loop turns left (counter-clockwise)."""
        area, (x0, y0) = 0.0, self.start
        for edge in self.edges:
            x1, y1 = edge.end
            if edge.center is None:
                area += 0.5 * (x0 * y1 - x1 * y0)
            else:
                cx, cy = edge.center
                squared_radius = (x1 - cx) ** 2 + (y1 - cy) ** 2
                area += 0.5 * (squared_radius * edge.sweep + cx * (y1 - y0) - cy * (x1 - x0))
            x0, y0 = x1, y1
        return area

    @property
    def first_moments(self) -> tuple[float, float]:
        """Integrals of x and y over the enclosed area [mm³], exact for arcs."""
        mx = my = 0.0
        x0, y0 = self.start
        for edge in self.edges:
            x1, y1 = edge.end
            cross = (x0 * y1 - x1 * y0) / 6.0  # triangle with the origin
            mx, my = mx + cross * (x0 + x1), my + cross * (y0 + y1)
            if edge.center is not None:  # segment between chord and arc
                (cx, cy), sweep = edge.center, edge.sweep
                r = math.hypot(x1 - cx, y1 - cy)
                area = 0.5 * r * r * (sweep - math.sin(sweep))
                middle = math.atan2(y0 - cy, x0 - cx) + 0.5 * sweep
                reach = 2.0 / 3.0 * r**3 * math.sin(0.5 * sweep) ** 3  # moment about the center, along the middle
                mx += area * cx + reach * math.cos(middle)
                my += area * cy + reach * math.sin(middle)
            x0, y0 = x1, y1
        return mx, my

    def points(self, resolution: Resolution) -> tuple[Vector, npt.NDArray[np.int64]]:
        """Polygon: (k, 2) points, and for the side leaving each point the number of its edge."""
        points: list[Vector] = []
        sides: list[int] = []
        x0, y0 = self.start
        for number, edge in enumerate(self.edges):
            count = 1
            points.append(np.array([[x0, y0]]))
            if edge.center is not None:
                cx, cy = edge.center
                radius = math.hypot(x0 - cx, y0 - cy)
                count = resolution.arc_segments(radius, edge.sweep)
                angles = math.atan2(y0 - cy, x0 - cx) + edge.sweep * np.arange(1, count) / count
                points.append(np.column_stack((cx + radius * np.cos(angles), cy + radius * np.sin(angles))))
            sides += [number] * count
            x0, y0 = edge.end
        return np.vstack(points), np.array(sides)


@dataclass(frozen=True, slots=True)
class Profile:
    """A plane region: one outer loop and the holes in it. Lengths in mm, loops counter-clockwise.

    Raises: GeometryError for a loop without area, a clockwise one (it would be a solid turned inside out), or one that
        does not turn exactly once or doubles back (an arc drawn the wrong way round, a crossing).
    """

    outer: Loop
    holes: tuple[Loop, ...] = ()

    def __post_init__(self) -> None:
        for loop in self.loops:
            if not loop.area > 0.0:
                raise GeometryError(f"profile starting at {loop.start}: area {loop.area:g} mm² must be positive")
            if not loop.turns_once:
                raise GeometryError(
                    f"profile starting at {loop.start} crosses itself or doubles back: does an arc turn the wrong way?"
                )

    @property
    def loops(self) -> tuple[Loop, ...]:
        """The outer loop, then the holes."""
        return (self.outer, *self.holes)

    @property
    def area(self) -> float:
        """Exact area [mm²]."""
        return self.outer.area - sum(hole.area for hole in self.holes)

    @property
    def first_moments(self) -> tuple[float, float]:
        """Integrals of x and y over the region [mm³], exact."""
        moments = [loop.first_moments for loop in self.loops]
        return 2 * moments[0][0] - sum(m[0] for m in moments), 2 * moments[0][1] - sum(m[1] for m in moments)

    def without(self, *holes: Profile) -> Profile:
        """The same region with holes, which must lie inside and apart from each other."""
        return Profile(self.outer, self.holes + tuple(hole.outer for hole in holes))


@dataclass(frozen=True, slots=True)
class _Corner:
    """A point of a path under construction; `radius` or `chamfer` acts on the corner between two lines."""

    edge: Edge
    radius: float = 0.0
    chamfer: float = 0.0


class Path:
    """Outline drawn edge by edge from a first point; `close()` gives the profile. Each step returns a new path.

    Path(0, 0).line(40, 0).line(40, 20, radius=3).arc(0, 20, center=(20, 20), turn="left").close()
    """

    __slots__ = ("_corners", "_start")

    def __init__(self, x: float, y: float, _corners: tuple[_Corner, ...] = ()) -> None:
        self._start = (float(x), float(y))
        self._corners = _corners

    def _then(self, corner: _Corner) -> Path:
        return Path(*self._start, (*self._corners, corner))

    @property
    def _here(self) -> tuple[float, float]:
        return self._corners[-1].edge.end if self._corners else self._start

    def line(self, x: float, y: float, *, radius: float = 0.0, chamfer: float = 0.0, face: str = "") -> Path:
        """Straight to (x, y). If the next edge is a line too, the corner there can be rounded or chamfered."""
        return self._then(_Corner(Edge((float(x), float(y)), face), radius, chamfer))

    def arc(self, x: float, y: float, *, center: tuple[float, float], turn: str = "left", face: str = "") -> Path:
        """Circular arc to (x, y) about `center`, turning "left" (counter-clockwise) or "right"."""
        (x0, y0), (cx, cy) = self._here, center
        r0, r1 = math.hypot(x0 - cx, y0 - cy), math.hypot(x - cx, y - cy)
        if abs(r0 - r1) > 1e-9 * max(r0, r1, 1.0):
            raise GeometryError(f"arc from ({x0:g}, {y0:g}) to ({x:g}, {y:g}): radii {r0!r} and {r1!r} differ")
        if turn not in ("left", "right"):
            raise ValueError(f"turn = {turn!r}: must be 'left' or 'right'")
        sweep = (math.atan2(y - cy, x - cx) - math.atan2(y0 - cy, x0 - cx)) % FULL_TURN
        if turn == "right":
            sweep -= FULL_TURN
        return self._then(_Corner(Edge((float(x), float(y)), face, (float(cx), float(cy)), sweep)))

    def close(self, *, face: str = "") -> Profile:
        """The closed profile; a straight edge back to the start is added if the path has not returned there."""
        path = self if self._here == self._start else self.line(*self._start, face=face)
        corners = path._corners
        edges: list[Edge] = []
        for corner, following in zip(corners, (*corners[1:], corners[0]), strict=True):
            size = corner.radius or corner.chamfer
            if not size:
                edges.append(corner.edge)
                continue
            if corner.edge.center or following.edge.center or following is corners[0]:
                raise GeometryError(f"corner {corner.edge.end}: only a corner between two lines can be rounded")
            before = edges[-1].end if edges else self._start
            edges += _cut_corner(before, corner, following.edge.end)
        return Profile(Loop(self._start, tuple(edges)))


def _cut_corner(before: tuple[float, float], corner: _Corner, after: tuple[float, float]) -> list[Edge]:
    """The line up to the corner's rounding or chamfer, and the rounding or chamfer."""
    point = np.array(corner.edge.end)
    back, ahead = np.array(before) - point, np.array(after) - point
    lengths = np.hypot(*back), np.hypot(*ahead)
    back, ahead = back / lengths[0], ahead / lengths[1]
    turn = back[1] * ahead[0] - back[0] * ahead[1]  # > 0: the path turns left here
    half_angle = 0.5 * math.acos(max(-1.0, min(1.0, float(back @ ahead))))
    reach = corner.chamfer or corner.radius / math.tan(half_angle)
    if reach > min(lengths) * (1.0 + 1e-9):
        size = corner.radius or corner.chamfer
        raise GeometryError(f"corner {corner.edge.end}: {size:g} mm does not fit between its neighbors")
    first, second = point + reach * back, point + reach * ahead
    line = Edge((float(first[0]), float(first[1])), corner.edge.face)
    end = (float(second[0]), float(second[1]))
    if corner.chamfer:
        return [line, Edge(end)]
    bisector = (back + ahead) / np.hypot(*(back + ahead))
    center = point + corner.radius / math.sin(half_angle) * bisector
    sweep = math.copysign(math.pi - 2.0 * half_angle, turn)
    return [line, Edge(end, "", (float(center[0]), float(center[1])), sweep)]


def circle(x: float, y: float, radius: float, *, face: str = "") -> Profile:
    """A full circle [mm]; its seam lies at the smallest y: two circles about points on a line never share it."""
    start = (float(x), float(y) - radius)
    return Profile(Loop(start, (Edge(start, face, (float(x), float(y)), FULL_TURN),)))


def polygon(*points: tuple[float, float], faces: Sequence[str] = ()) -> Profile:
    """Straight-edged outline through `points` [mm], counter-clockwise; `faces` names the sides leaving each point."""
    names = list(faces) or [""] * len(points)
    path = Path(*points[0])
    for (x, y), name in zip(points[1:], names, strict=False):
        path = path.line(x, y, face=name)
    return path.close(face=names[-1])


def rectangle(x0: float, y0: float, x1: float, y1: float, *, radius: float = 0.0) -> Profile:
    """Axis-parallel rectangle from (x0, y0) to (x1, y1) [mm]; `radius` rounds its four corners."""
    if not radius:
        return polygon((x0, y0), (x1, y0), (x1, y1), (x0, y1))
    path = Path(0.5 * (x0 + x1), y0)
    for x, y in ((x1, y0), (x1, y1), (x0, y1), (x0, y0)):
        path = path.line(x, y, radius=radius)
    return path.close()
