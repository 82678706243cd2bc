"""Repair of surfaces that bound no solid as they are written, with a report of what changed."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from codesign._core import fem as _core
from codesign._core.fem import SurfaceMesh
from codesign.errors import MeshError
from codesign.fem import stitching, union
from codesign.fem.stitching import Points, Triangles

TOLERANCE = 2e-4  # of the extent, if none is given
_RESOLUTION = 1e-7  # of the extent: heights of triangles below it are rounding of single precision
_LARGEST = 1e30  # m: the powers of a larger extent are no numbers
_FEWEST = 4  # triangles of a solid


@dataclass(frozen=True)
class RepairReport:
    """What `repair_surface` did.

    Args:
        reason: why the surface was no solid; empty if it was one, and then nothing was changed.
        tolerance: [m] width of gaps that were closed, distance of simplification.
        doubled, flat: facets dropped: written twice or walls without thickness; without height.
        t_junctions: corners found on edges, where the facet was split.
        merged_points: ends of open edges merged.
        turned: facets turned like their neighbors. turned_shells: shells that were inside-out.
        united: bodies united into one or several.
        simplified: whether tiny triangles were removed to end crossings.
        volume, area, triangles, bodies: before and after; the volume before is None for an open surface. [m³, m²]
        largest_shift: [m] of a corner of the repaired surface from the given one, and, unless bodies were united, the
            other way round.
    """

    reason: str
    tolerance: float
    volume: tuple[float | None, float]
    area: tuple[float, float]
    triangles: tuple[int, int]
    bodies: tuple[int, int]
    doubled: int = 0
    flat: int = 0
    t_junctions: int = 0
    merged_points: int = 0
    turned: int = 0
    turned_shells: int = 0
    united: int = 0
    simplified: bool = False
    largest_shift: float = 0.0

    @property
    def changed(self) -> bool:
        """Whether anything was done."""
        return bool(self.reason)


def repair_surface(surface: SurfaceMesh, tolerance: float | None = None) -> tuple[SurfaceMesh, RepairReport]:
    """A surface that bounds one solid, from one that does so but for faults of its file.

    Closes T-junctions and gaps up to the tolerance, drops facets written twice, turns facets and shells outward, unites
    bodies that overlap or touch, and simplifies within the tolerance where tiny triangles cross. A sound surface is
    returned with its names; a changed one has unnamed faces. Holes wider than the tolerance are not filled.

    Args:
        surface: as `fem.read_stl` gives it.
        tolerance: [m]; 0.0002 of the extent if absent.

    Raises:
        MeshError: what is wrong, and why it could not be repaired.
        ValueError: a tolerance that is not positive.
    """
    reason = _fault(surface)
    extent = math.hypot(*np.ptp(surface.points, axis=0).tolist()) if len(surface.points) else 0.0
    if reason and not (len(surface.triangles) and 0.0 < extent < _LARGEST):
        raise MeshError(reason)
    if tolerance is None:
        tolerance = TOLERANCE * extent
    if not (math.isfinite(tolerance) and tolerance > 0.0):
        raise ValueError(f"tolerance = {tolerance}: a positive number of meters is needed")
    points, triangles = np.array(surface.points), np.array(surface.triangles, dtype=np.int64)
    if not reason:
        return surface, _measured(RepairReport("", tolerance, (0.0, 0.0), (0.0, 0.0), (0, 0), (0, 0)), surface, surface)
    last = reason
    for tried, corners, report in _attempts(points, triangles, tolerance):
        used, number = np.unique(corners, return_inverse=True)
        repaired = _core.label_by_angle(SurfaceMesh(tried[used], number.reshape(corners.shape)))
        last = _fault(repaired)
        if not last:
            return repaired, _measured(replace(report, reason=reason), surface, repaired)
    remains = "" if last == reason else f", and then {last}"
    raise MeshError(f"{reason}; repair within {tolerance * 1e3:.3g} mm does not help{remains}")


def _fault(surface: SurfaceMesh) -> str:
    """Why a surface bounds no single solid; empty if it does."""
    try:
        _core.check_surface(surface)
    except MeshError as error:
        return str(error)
    return ""


def _attempts(
    points: Points, triangles: Triangles, tolerance: float
) -> Iterator[tuple[Points, Triangles, RepairReport]]:
    """The surface after each further step of repair, the mildest first, until a step is impossible."""
    report = RepairReport("", tolerance, (None, 0.0), (0.0, 0.0), (0, 0), (0, 0))
    resolution = _RESOLUTION * float(np.linalg.norm(np.ptp(points, axis=0)))
    for gap in (resolution, tolerance):
        triangles, report = _stitched(points, triangles, gap, report)
        if len(triangles) < _FEWEST:
            return
        triangles, shells = union.faced_outward(points, triangles)
        report = replace(report, turned_shells=report.turned_shells + shells)
        yield points, triangles, report
    bodies = int(stitching.shells_of(triangles).max()) + 1
    steps: list[Callable[[Points, Triangles], tuple[Points, Triangles]]] = [
        union.united,
        lambda p, t: union.simplified(p, t, 0.1 * tolerance),
        lambda p, t: union.simplified(p, t, tolerance),
    ]
    for step, work in enumerate(steps):
        try:
            points, triangles = work(points, triangles)
        except MeshError:
            return
        if len(triangles) < _FEWEST:
            return
        report = replace(report, united=bodies if bodies > 1 else 0, simplified=step > 0)
        yield points, triangles, report


def _stitched(points: Points, triangles: Triangles, gap: float, report: RepairReport) -> tuple[Triangles, RepairReport]:
    """Facets dropped, T-junctions split, gaps closed, neighbors turned the same way."""
    high = stitching.without_flat(points, triangles, min(gap, 1e-3 * report.tolerance))
    single = stitching.without_doubled(high)
    split, junctions = stitching.split_t_junctions(points, single, gap)
    merged, points_merged = stitching.merge_open_points(points, split, gap)
    again, more = stitching.split_t_junctions(points, merged, gap)
    clean = stitching.without_doubled(again)
    turned, facets = stitching.oriented(clean)
    return turned, replace(
        report,
        flat=report.flat + len(triangles) - len(high),
        doubled=report.doubled + len(high) - len(single) + len(again) - len(clean),
        t_junctions=report.t_junctions + junctions + more,
        merged_points=report.merged_points + points_merged,
        turned=report.turned + facets,
    )


def _measured(report: RepairReport, before: SurfaceMesh, after: SurfaceMesh) -> RepairReport:
    """The report with the measures of both surfaces."""
    measures = [_measures(surface) for surface in (before, after)]
    closed = stitching.is_closed(np.array(before.triangles, dtype=np.int64))
    shift = _core.largest_distance(after, before) if report.changed else 0.0
    if report.changed and not report.united:
        shift = max(shift, _core.largest_distance(before, after))
    return replace(
        report,
        volume=(measures[0][0] if closed else None, measures[1][0]),
        area=(measures[0][1], measures[1][1]),
        triangles=(len(before.triangles), len(after.triangles)),
        bodies=(measures[0][2], measures[1][2]),
        largest_shift=shift,
    )


def _measures(surface: SurfaceMesh) -> tuple[float, float, int]:
    """Volume [m³], area [m²], bodies: shells that are no cavities."""
    points, triangles = np.array(surface.points), np.array(surface.triangles, dtype=np.int64)
    a, b, c = (points[triangles[:, k]] for k in range(3))
    area = 0.5 * float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())
    volumes = union.shell_volumes(points, triangles)
    if not stitching.is_closed(triangles):
        return 0.0, area, stitching.count_pieces(triangles)
    return float(volumes.sum()), area, max(1, int((volumes > 0.0).sum()))
