"""Mesh of `codesign stress`: edge length, curved facets, the places as faces of the mesh."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

from codesign import fem
from codesign.errors import MeshError
from codesign.fem.selections import Labeled, Place, label_surface

COARSE = 20_000  # triangles: a surface with more is no coarse tessellation
FACET_DISTANCE = 0.06  # of sides of elements to the surface, relative to their size, as in fem.tetrahedralize


def literal_facets(surface: fem.SurfaceMesh, size: float) -> dict[str, Any] | None:
    """How far a surface that looks like a coarse tessellation is from a smooth one; None if that does not matter.

    It matters beyond the distance that sides of elements of `size` [m] keep to the surface anyway. A fine tessellation
    (more than COARSE triangles) is not looked at.
    """
    if len(surface.triangles) > COARSE:
        return None
    report = fem.smooth_surface(surface)[1]
    return _smoothing(report) if report.max_distance > FACET_DISTANCE * size else None


def _smoothing(report: fem.SmoothReport) -> dict[str, Any]:
    return {
        "facets": report.facets,
        "max_distance": report.max_distance,
        "volume_change": report.volume_change,
        "left": report.left,
        "reason": report.reason,
    }


def mesh_places(
    surface: fem.SurfaceMesh, places: Sequence[Place], size: fem.SizeField, smooth: bool, simplify: bool
) -> tuple[fem.TetMesh, Labeled, dict[str, Any] | None]:
    """The mesh, the places on it, and the smoothing; the facets themselves if their smooth surface cannot be meshed.

    Places are looked up on the facets of the file; the pieces of a facet belong to its place.
    """
    named = label_surface(surface, places)
    if not smooth:
        return *_mesh_either(named.surface, lambda: surface, named, places, size, simplify), None
    curved, report = fem.smooth_surface(named.surface)
    try:
        meshed = _mesh_either(curved, lambda: fem.smooth_surface(surface)[0], named, places, size, simplify)
        return *meshed, _smoothing(report)
    except MeshError as error:
        reason = f"the curved surface cannot be meshed ({error}): facets taken literally"
        unused = {"facets": 0, "max_distance": 0.0, "volume_change": 0.0, "left": report.facets, "reason": reason}
        return *_mesh_either(named.surface, lambda: surface, named, places, size, simplify), unused


def _mesh_either(
    labeled: fem.SurfaceMesh,
    plain: Callable[[], fem.SurfaceMesh],
    named: Labeled,
    places: Sequence[Place],
    size: fem.SizeField,
    simplify: bool,
) -> tuple[fem.TetMesh, Labeled]:
    """The mesh and the places on it, with exact borders unless they are too ragged for the edge length.

    plain: makes the surface without the places' borders, which is rarely needed.
    """
    tetrahedralize = fem.tetrahedralize if simplify else partial(fem.tetrahedralize, simplify=0.0)
    try:
        return tetrahedralize(labeled, size), named
    except MeshError:
        mesh = tetrahedralize(plain(), size)
        return mesh, replace(named, selections=[place.on_mesh() for place in places])
