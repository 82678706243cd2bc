"""Loads in the plane of symmetry y = 0 of a part: which ones one half of it can stand for.

A load that is its own mirror image moves the part symmetrically, one whose mirror image has the opposite sign
antisymmetrically; of either the von Mises stress of the other half is the mirror image of this one's.
"""

from __future__ import annotations

from collections.abc import Sequence
from enum import Enum

import numpy as np
from numpy.typing import ArrayLike

from codesign import fem
from codesign.parts.load_case import PartLoad, PressedFace, PushedFace

PLANE = fem.Plane((0.0, 0.0, 0.0), (0.0, 1.0, 0.0))


class Parity(Enum):
    """What a load's mirror image in y = 0 is."""

    SYMMETRIC = "itself"
    ANTISYMMETRIC = "itself, with the opposite sign"
    NEITHER = "another load"


def parity(loads: Sequence[PartLoad]) -> Parity:
    """Of loads that act together, on faces that are their own mirror image."""
    kinds = {_parity(load) for load in loads}
    return kinds.pop() if len(kinds) == 1 else Parity.NEITHER


def is_symmetric(mass: fem.RemoteMass) -> bool:
    """Whether a body is its own mirror image."""
    position, inertia = np.asarray(mass.position, dtype=float), np.asarray(mass.inertia, dtype=float)
    return _vanishes(position[1], position) and _vanishes(inertia[1, [0, 2]], inertia)


def _parity(load: PartLoad) -> Parity:
    if isinstance(load, PressedFace | fem.Pressure):
        return Parity.SYMMETRIC
    if isinstance(load, PushedFace):
        return _of_vectors(load.force)
    if isinstance(load, fem.Acceleration):
        return Parity.NEITHER if np.any(load.gradient) else _of_vectors(load.acceleration)
    if isinstance(load, fem.AffineTraction):
        point = np.asarray(load.point, dtype=float)
        return _of_vectors(load.force, load.moment) if _vanishes(point[1], point) else Parity.NEITHER
    return Parity.NEITHER


def _of_vectors(force: ArrayLike, moment: ArrayLike = (0.0, 0.0, 0.0)) -> Parity:
    """Of a force in the plane and a moment, whose mirror image turns the other way."""
    force, moment = np.asarray(force, dtype=float), np.asarray(moment, dtype=float)
    if _vanishes(force[1], force) and _vanishes(moment[[0, 2]], moment):
        return Parity.SYMMETRIC
    if _vanishes(force[[0, 2]], force) and _vanishes(moment[1], moment):
        return Parity.ANTISYMMETRIC
    return Parity.NEITHER


def _vanishes(components: ArrayLike, of: np.ndarray) -> bool:
    """Up to the round-off of a change of axes."""
    return bool(np.max(np.abs(components)) <= 1e-12 * np.max(np.abs(of)))
