"""Mass properties of a closed triangle mesh, and of the true curved solid by extrapolation over two resolutions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from codesign.geometry.profile import Vector
from codesign.geometry.tessellate import Indices
from codesign.units import MILLIMETRE


@dataclass(frozen=True, slots=True)
class MassProperties:
    """mass [kg]; com (3,) [m] in the part frame; inertia (3, 3) [kg m²] about the com, part axes; volume [m³]."""

    mass: float
    com: Vector
    inertia: Vector
    volume: float

    def mirrored(self, axis: str) -> MassProperties:
        """Those of the mirror image in the plane through the origin normal to "x", "y" or "z"."""
        signs = np.where(np.arange(3) == "xyz".index(axis), -1.0, 1.0)
        return MassProperties(self.mass, self.com * signs, self.inertia * np.outer(signs, signs), self.volume)

    @property
    def principal_moments(self) -> Vector:
        """(3,) principal moments of inertia [kg m²], ascending."""
        return np.linalg.eigvalsh(self.inertia).astype(np.float64)


def volume_moments(points: Vector, triangles: Indices) -> Vector:
    """(10,) integrals of 1, x, y, z, xx, yy, zz, xy, yz, zx over the volume inside a closed mesh, about the origin.

    Sum over the tetrahedra between the origin and each triangle: with corners a, b, c and s = a + b + c,
    the integral of x_i x_j is det(a, b, c) / 120 * (a_i a_j + b_i b_j + c_i c_j + s_i s_j).
    """
    a, b, c = (points[triangles[:, k]] for k in range(3))
    determinant = np.einsum("ij,ij->i", a, np.cross(b, c))
    s = a + b + c
    second = sum(np.einsum("n,ni,nj->ij", determinant, v, v) for v in (a, b, c, s)) / 120.0
    i, j = [0, 1, 2, 0, 1, 2], [0, 1, 2, 1, 2, 0]
    return np.concatenate(([determinant.sum() / 6.0], determinant @ s / 24.0, second[i, j]))


def extrapolate(coarse: Vector, fine: Vector) -> Vector:
    """Value for infinitely many segments from two meshes, the fine one with twice as many chords on every arc.

    A chord polygon misses an area of order 1/n² beside its arc, so the leading error cancels in (4 fine - coarse) / 3.
    """
    return (4.0 * fine - coarse) / 3.0


def mass_properties(moments: Vector, density: float) -> MassProperties:
    """Mass properties from volume moments in mm (see `volume_moments`) and a density [kg/m³]."""
    volume = float(moments[0]) * MILLIMETRE**3
    com = moments[1:4] / moments[0] * MILLIMETRE
    xx, yy, zz, xy, yz, zx = moments[4:] * MILLIMETRE**5 * density
    second = np.array([[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]])
    mass = volume * density
    about_com = second - mass * np.outer(com, com)
    return MassProperties(mass, com, np.trace(about_com) * np.eye(3) - about_com, volume)
