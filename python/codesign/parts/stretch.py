"""Parts that differ in one length: a mesh of one of them, stretched, serves them all.

What a stretch leaves as it is is meshed and factorized once in a process (cpp/fem/kept_meshes.hpp). Which part is
meshed depends on the design alone, so a result never depends on what was analyzed before.
"""

from __future__ import annotations

import math

from codesign import _core
from codesign.geometry.profile import Vector
from codesign.units import MILLIMETER

RATIO = 4.5  # between neighboring lengths of parts that are meshed: a zone is stretched by its root, 2.1, at the most


def meshed_length(length: float, typical: float) -> float:
    """The nearest of ..., typical / RATIO, typical, typical · RATIO, ..., by ratio; of a zone that is stretched."""
    return float(typical * RATIO ** round(math.log(length / typical, RATIO)))


def stretch_mm(origin: Vector, direction: Vector, start: float, end: float, change: float) -> _core.Stretch:
    """Along a unit direction from an origin (3,) [m]; start, end and change of the zone in mm."""
    return _core.Stretch(origin, direction, start * MILLIMETER, end * MILLIMETER, change * MILLIMETER)
