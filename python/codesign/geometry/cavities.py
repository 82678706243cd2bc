"""Sealed cavities of a solid: closed surfaces inside its own, which enclose a negative volume."""

from __future__ import annotations

from collections.abc import Sequence

import manifold3d
import numpy as np

from codesign.errors import GeometryError

SKIN = 1e-3  # mm; what closes a cavity off is a wall from here on, a slip of the drawing below
_Box = tuple[float, float, float, float, float, float]


def check_cavities(body: manifold3d.Manifold, shells: Sequence[manifold3d.Manifold]) -> None:
    """Refuses a cavity that only a skin separates from the outside or from another cavity.

    body: the solid without its cavities. shells: the surfaces of the cavities as `decompose` gives them, inside out.

    Raises: GeometryError: names the cavity and the thickness of its skin.
    """
    if not shells:
        return
    cavities = [_turned(shell) for shell in shells]
    boxes = [cavity.bounding_box() for cavity in cavities]
    outside = _outside(body)
    for k, (cavity, box) in enumerate(zip(cavities, boxes, strict=True)):
        others = [other for other, near in zip(cavities[:k], boxes[:k], strict=True) if _meet(box, near)]
        gap = min(cavity.min_gap(other, SKIN) for other in (outside, *others))
        if gap < SKIN:
            low, high = (", ".join(f"{x:.4g}" for x in corner) for corner in (box[:3], box[3:]))
            raise GeometryError(
                f"a closed cavity from ({low}) to ({high}) mm has a skin of {gap:.1g} mm: "
                "a pocket that should be open must reach beyond the face it opens"
            )


def _turned(shell: manifold3d.Manifold) -> manifold3d.Manifold:
    """The space that the surface of a cavity encloses, as a solid."""
    mesh = shell.to_mesh64()
    merge = np.arange(len(mesh.vert_properties), dtype=np.uint64)
    merge[mesh.merge_from_vert] = mesh.merge_to_vert
    points = np.array(mesh.vert_properties[:, :3], order="C")  # a copy: the binding takes no read-only array
    return manifold3d.Manifold(manifold3d.Mesh64(points, np.ascontiguousarray(merge[mesh.tri_verts][:, ::-1])))


def _outside(body: manifold3d.Manifold) -> manifold3d.Manifold:
    """What lies around a solid, up to a box: apart from everything inside it, so that gaps can be measured."""
    box = np.array(body.bounding_box())
    margin = 1.0 + np.ptp(box.reshape(2, 3), axis=0)
    around = manifold3d.Manifold.cube(tuple(box[3:] - box[:3] + 2.0 * margin)).translate(tuple(box[:3] - margin))
    return around - body


def _meet(a: _Box, b: _Box) -> bool:
    """Whether two boxes come within SKIN of each other."""
    return all(a[i] < b[i + 3] + SKIN and b[i] < a[i + 3] + SKIN for i in range(3))
