"""The surface handed to the mesher: meters, every triangle on a named face."""

from __future__ import annotations

import numpy as np

from codesign.fem import SurfaceMesh as SurfaceMesh
from codesign.geometry.solid import Solid
from codesign.units import MILLIMETER


def surface_mesh(solid: Solid) -> SurfaceMesh:
    """Surface of a solid in meters; analytic faces of equal name become one face, unnamed ones share the name ""."""
    names = ["", *solid.names]
    index = np.array([names.index(name) if name in names else 0 for name in solid.face_names])
    return SurfaceMesh(solid.points * MILLIMETER, solid.triangles, index[solid.face].tolist(), names)
