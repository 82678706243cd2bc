"""The kinds of load that a finite-element model knows, and masses that its faces carry.

Each kind has its counterpart of the same name in `cpp/fem/boundary/loads.hpp`. Plain frozen values in SI units, vectors
in the axes of the part.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from codesign._core import fem as _core
from codesign.fem.model import TetMesh, Where, resolve, vector

__all__ = [  # what codesign.fem offers of this module
    "Acceleration",
    "AffineTraction",
    "BearingLoad",
    "BodyForce",
    "Disc",
    "Force",
    "Load",
    "LoadCase",
    "Plane",
    "Pressure",
    "RemoteMass",
    "Traction",
]


@dataclass(frozen=True)
class Force:
    """A total force [N], spread uniformly over the area of faces, or in equal parts over selected nodes."""

    where: Where
    force: ArrayLike

    def native(self, mesh: TetMesh | None) -> _core.Force:
        """The native value on a mesh."""
        return _core.Force(resolve(mesh, self.where), vector(self.force, "force"))


@dataclass(frozen=True)
class Traction:
    """A force per area [Pa], the same vector everywhere on the faces."""

    where: Where
    traction: ArrayLike

    def native(self, mesh: TetMesh | None) -> _core.Traction:
        """The native value on a mesh."""
        return _core.Traction(resolve(mesh, self.where), vector(self.traction, "traction"))


@dataclass(frozen=True)
class Pressure:
    """Pushes against the outward normal of the faces [Pa]."""

    where: Where
    pressure: float

    def native(self, mesh: TetMesh | None) -> _core.Pressure:
        """The native value on a mesh."""
        return _core.Pressure(resolve(mesh, self.where), float(self.pressure))


@dataclass(frozen=True)
class BearingLoad:
    """A total force [N] by pressure alone, as a pin presses on a bore: p = 2 F / (π r L) cos θ over the pressed half.

    The force has no part along the axis of the bore; the pressure follows the normals, so no axis is asked for.
    """

    where: Where
    force: ArrayLike

    def native(self, mesh: TetMesh | None) -> _core.BearingLoad:
        """The native value on a mesh."""
        return _core.BearingLoad(resolve(mesh, self.where), vector(self.force, "force"))


@dataclass(frozen=True)
class Disc:
    """Points within radius [m] of the line through center [m] along axis."""

    center: ArrayLike
    axis: ArrayLike
    radius: float


@dataclass(frozen=True)
class Plane:
    """Through `point` [m], with a unit normal."""

    point: ArrayLike
    normal: ArrayLike


@dataclass(frozen=True)
class AffineTraction:
    """A traction, affine over the faces, with an exact resultant.

    Args:
        where: the faces.
        force: net force [N], acting at `point` [m].
        moment: net moment about `point` [N m].
        region: limits the load to the part of the faces inside a disc.
        mirror: the faces are one half of the loaded ones, the other half is their mirror image in this plane; force and
            moment are those on both.
    """

    where: Where
    force: ArrayLike
    point: ArrayLike
    moment: ArrayLike = (0.0, 0.0, 0.0)
    region: Disc | None = None
    mirror: Plane | None = None

    def native(self, mesh: TetMesh | None) -> _core.AffineTraction:
        """The native value on a mesh."""
        region = _native_disc(self.region)
        force, point, moment = (vector(getattr(self, n), n) for n in ("force", "point", "moment"))
        mirror = _native_plane(self.mirror)
        return _core.AffineTraction(resolve(mesh, self.where), force, point, moment, region, mirror)


@dataclass(frozen=True)
class Acceleration:
    """A gravity-like field [m/s²]: every volume element is pulled by density times acceleration.

    gradient (3, 3) [1/s²], point [m]: the field is acceleration + gradient (x - point), as the inertia of a part that
    turns is.
    """

    acceleration: ArrayLike
    gradient: ArrayLike = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    point: ArrayLike = (0.0, 0.0, 0.0)

    def native(self, mesh: TetMesh | None) -> _core.Acceleration:  # noqa: ARG002 (the same for every mesh)
        """The native value on a mesh."""
        gradient = np.asarray(self.gradient, dtype=float)
        if gradient.shape != (3, 3):
            raise ValueError(f"gradient must have shape (3, 3), got {gradient.shape}")
        return _core.Acceleration(vector(self.acceleration, "acceleration"), gradient, vector(self.point, "point"))


@dataclass(frozen=True)
class BodyForce:
    """Force per volume [N/m³]: (3,), or (n, 3) at the nodes."""

    force: ArrayLike

    def native(self, mesh: TetMesh | None) -> _core.BodyForce:  # noqa: ARG002 (the same for every mesh)
        """The native value on a mesh."""
        return _core.BodyForce(np.atleast_2d(np.asarray(self.force, dtype=float)))


@dataclass(frozen=True)
class RemoteMass:
    """A rigid body that faces of a part carry, an engine on its seat, say: it moves with their mean rigid motion.

    It stiffens nothing; accelerations pull at it, and it counts in natural frequencies.

    Args:
        where: the faces.
        mass: [kg].
        position: center of mass [m].
        inertia: (3, 3) about the center of mass [kg m²].
        region: limits the faces to their part inside a disc.
        mirror: the faces are one half of those that carry it; mass and inertia are the whole body's.
    """

    where: Where
    mass: float
    position: ArrayLike
    inertia: ArrayLike = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    region: Disc | None = None
    mirror: Plane | None = None

    def native(self, mesh: TetMesh | None) -> _core.RemoteMass:
        """The native value on a mesh."""
        inertia = np.asarray(self.inertia, dtype=float)
        if inertia.shape != (3, 3):
            raise ValueError(f"inertia must have shape (3, 3), got {inertia.shape}")
        place = vector(self.position, "position")
        region, mirror = _native_disc(self.region), _native_plane(self.mirror)
        return _core.RemoteMass(resolve(mesh, self.where), float(self.mass), place, inertia, region, mirror)


Load = Force | Traction | Pressure | BearingLoad | AffineTraction | Acceleration | BodyForce


@dataclass(frozen=True)
class LoadCase:
    """Loads that act together, and the safety factor (yield strength over peak stress) that they ask for."""

    name: str
    loads: Sequence[Load]
    safety_factor_min: float = 1.0
    antisymmetric: bool = False  # of a half model: the other half's load is the mirror image, turned


def native_loads(mesh: TetMesh | None, loads: Sequence[Load]) -> list[Any]:
    """Loads as the native solver takes them."""
    return [load.native(mesh) for load in loads]


def _native_plane(plane: Plane | None) -> _core.Plane | None:
    return None if plane is None else _core.Plane(vector(plane.point, "point"), vector(plane.normal, "normal"))


def _native_disc(disc: Disc | None) -> _core.Disc | None:
    if disc is None:
        return None
    return _core.Disc(vector(disc.center, "center"), vector(disc.axis, "axis"), float(disc.radius))
