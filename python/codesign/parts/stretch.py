"""Parts that differ in one length: a mesh of one of them, stretched, serves them all.

What a stretch leaves as it is is meshed and factorized once in a process (cpp/fem/kept_meshes.hpp), and the meshes of
masses and clearances are made once. Which part is meshed depends on the design alone, so a result never depends on what
was analyzed before.
"""

from __future__ import annotations

import math

import numpy as np

from codesign import _core
from codesign.errors import GeometryError
from codesign.geometry.profile import Vector
from codesign.geometry.solid import Solid
from codesign.units import MILLIMETER

RATIO = 4.5  # between neighboring lengths of parts that are meshed: a zone is stretched by its root, 2.1, at the most

TILTED = 1e-6  # mm²: less is rounding


def meshed_length(length: float, typical: float) -> float:
    """The nearest of ..., typical / RATIO, typical, typical · RATIO, ..., by ratio; of a zone that is stretched."""
    return float(typical * RATIO ** round(math.log(length / typical, RATIO)))


def stretch_mm(origin: Vector, direction: Vector, start: float, end: float, change: float) -> _core.Stretch:
    """Along a unit direction from an origin (3,) [m]; start, end and change of the zone in mm."""
    return _core.Stretch(origin, direction, start * MILLIMETER, end * MILLIMETER, change * MILLIMETER)


def stretched(solid: Solid, stretch: _core.Stretch) -> Solid:
    """The mesh of the stretched body, with the same triangles: what is behind the zone moves as one."""
    change = np.asarray(stretch.direction) * stretch.change / MILLIMETER
    moved = solid.points + _share(solid, stretch)[:, None] * change
    return Solid(moved, solid.triangles, solid.face, solid.face_names)


def require_prism(solid: Solid, stretch: _core.Stretch) -> None:
    """Raises: GeometryError: the zone's cross sections differ, a face in it is not parallel to the stretch."""
    share = _share(solid, stretch)[solid.triangles]
    a, b, c = solid.points[solid.triangles[share.max(axis=1) > share.min(axis=1)]].swapaxes(0, 1)
    tilted = np.abs(np.cross(b - a, c - a) @ stretch.direction)  # twice the area, seen along the stretch
    if tilted.max(initial=0.0) > TILTED:
        zone = f"from {stretch.start / MILLIMETER:g} to {stretch.end / MILLIMETER:g} mm"
        raise GeometryError(f"the zone that is stretched, {zone}, has cross sections that differ")


def _share(solid: Solid, stretch: _core.Stretch) -> Vector:
    """(n,) of the stretch's change that each point moves by."""
    start, end = stretch.start / MILLIMETER, stretch.end / MILLIMETER
    along = (solid.points - np.asarray(stretch.origin) / MILLIMETER) @ stretch.direction
    return np.clip((along - start) / (end - start), 0.0, 1.0)
