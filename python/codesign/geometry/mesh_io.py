"""Triangle meshes in files."""

from __future__ import annotations

import os

import numpy as np

from codesign.geometry.files import replacing
from codesign.geometry.solid import Solid

_STL_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def write_stl(solid: Solid, path: str | os.PathLike[str], title: str = "") -> None:
    """Binary STL in mm. `title` goes into the 80-byte header."""
    corners = solid.points[solid.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    records = np.zeros(len(corners), dtype=_STL_TRIANGLE)
    records["normal"] = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    records["corners"] = corners
    header = f"codesign {title} [mm]".encode("ascii", "replace")[:80].ljust(80)
    with replacing(path) as temporary:
        temporary.write_bytes(header + np.uint32(len(records)).tobytes() + records.tobytes())
