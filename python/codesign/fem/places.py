"""What a place of a support or a load caught: area, centroid, bend and type of its surface."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from codesign import fem
from codesign._core import fem as _core
from codesign.fem.model import MAX_BEND_DEG, Where, resolve

WIDE_BEND_DEG = 45.0  # a place that bends more may be more than was meant
WIDE_SHARE = 0.5  # of the whole surface
SAME_SHARE = 0.99  # of a place's area on one plane, cylinder, cone or sphere, for that to be its type
MOST_FACES = 20  # of a place that are counted
PLURALS = {kind: f"{kind}s" for kind in ("plane", "cylinder", "cone", "sphere")} | {"free": "free faces"}
MOST_NORMALS = 1500  # looked at in pairs for the bend

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Caught:
    """The surface of a place on a mesh.

    area: [m²]. share: of the part's surface. centroid: (3,) [m]. normal: (3,) mean unit outward normal, shorter where
    the place bends. bend_deg: largest angle between two normals.
    type: plane, cylinder, cone, sphere, or free: another shape; of several faces how many, `2 cylinders`.
    facets: triangles of the file's surface that belong to the place, 0 if it is cut out of larger ones. sides: of
    elements.
    """

    type: str
    area: float
    share: float
    centroid: tuple[float, float, float]
    normal: tuple[float, float, float]
    bend_deg: float
    facets: int
    sides: int

    def to_dict(self) -> dict[str, Any]:
        """For JSON, SI units."""
        return {
            "type": self.type,
            "area": self.area,
            "centroid": list(self.centroid),
            "bend_deg": self.bend_deg,
            "facets": self.facets,
            "sides": self.sides,
        }

    def warnings(self) -> list[str]:
        """What makes one doubt that this is what was meant."""
        found = []
        if self.bend_deg > WIDE_BEND_DEG:
            found.append(f"bends by {self.bend_deg:.0f}°")
        if self.share > WIDE_SHARE:
            found.append(f"is {self.share:.0%} of the whole surface")
        return found


def caught(mesh: fem.TetMesh, where: Where, surface: fem.SurfaceMesh, facets: NDArray[np.bool_]) -> Caught | None:
    """What a selection caught on a mesh; None if it holds no side of an element.

    surface, facets (m,): that the mesh was made from, and the triangles of it that belong to the selection.
    """
    selection = resolve(mesh, where)
    try:
        sides = np.array(_core.selected_triangles(mesh, _core.Selection(selection.faces, selection.triangles)))
    except fem.ModelError:
        return None
    areas, normals, centroids = _flat(mesh.nodes, mesh.boundary)
    own = areas[sides]
    x, y, z = (own @ centroids[sides] / own.sum()).tolist()
    nx, ny, nz = (own @ normals[sides] / own.sum()).tolist()
    looked_at = (surface, np.flatnonzero(facets)) if facets.any() else (_core.boundary_surface(mesh), sides)
    return Caught(
        type=_type(*looked_at),
        area=float(_core.face_area(mesh, sides.tolist())),
        share=float(own.sum() / areas.sum()),
        centroid=(x, y, z),
        normal=(nx, ny, nz),
        bend_deg=_bend(*looked_at),
        facets=int(facets.sum()),
        sides=len(sides),
    )


def _bend(surface: fem.SurfaceMesh, chosen: NDArray[np.integer[Any]]) -> float:
    """Largest angle [deg] between the normals of two of the chosen triangles."""
    kinds = np.unique(np.round(_flat(surface.points, surface.triangles)[1][chosen], 3), axis=0)
    kinds = kinds[:: len(kinds) // MOST_NORMALS + 1]
    kinds = kinds / np.maximum(np.linalg.norm(kinds, axis=1, keepdims=True), 1e-300)
    return float(np.degrees(np.arccos(np.clip((kinds @ kinds.T).min(), -1.0, 1.0)))) if len(kinds) > 1 else 0.0


def _flat(points: Array, triangles: NDArray[np.integer[Any]]) -> tuple[Array, Array, Array]:
    """Areas (n,), unit normals (n, 3) and centroids (n, 3) of flat triangles, by their first three corners."""
    a, b, c = (np.asarray(points)[np.asarray(triangles)[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    lengths = np.linalg.norm(normals, axis=1)
    return 0.5 * lengths, normals / np.maximum(lengths, 1e-300)[:, None], (a + b + c) / 3.0


def _type(surface: fem.SurfaceMesh, chosen: NDArray[np.integer[Any]]) -> str:
    """Type of the face that (nearly) all of the chosen triangles lie on; of several faces how many of which."""
    areas = _flat(surface.points, surface.triangles)[0]
    whole, rest, found = areas[chosen].sum(), chosen, Counter[str]()
    while areas[rest].sum() > (1.0 - SAME_SHARE) * whole:
        if found.total() == MOST_FACES:
            return "many faces"
        patch = _core.smooth_patch(surface, int(rest[np.argmax(areas[rest])]), np.radians(MAX_BEND_DEG))
        found[patch.type] += 1
        rest = rest[~np.isin(rest, patch.triangles)]
    if found.total() == 1:
        return next(iter(found))
    return ", ".join(f"{count} {PLURALS[kind] if count > 1 else kind}" for kind, count in found.items())
