"""The surface handed to the mesher: metres, every triangle on a named face."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from codesign.geometry.profile import Vector
from codesign.geometry.solid import Solid
from codesign.geometry.tessellate import Indices
from codesign.units import MILLIMETRE


@dataclass(frozen=True)
class SurfaceMesh:
    """Closed, outward-oriented triangles: points (n, 3) m; triangles (m, 3); face (m,) into face_names."""

    points: Vector
    triangles: Indices
    face: Indices
    face_names: Sequence[str]


def surface_mesh(solid: Solid) -> SurfaceMesh:
    """Surface of a solid in metres; analytic faces of equal name become one face, unnamed ones share the name ""."""
    names = ("", *solid.names)
    index = np.array([names.index(name) if name in names else 0 for name in solid.face_names])
    return SurfaceMesh(solid.points * MILLIMETRE, solid.triangles, index[solid.face], names)
