"""Mesh of `codesign stress`: edge length, curved facets, the places as faces of the mesh."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from codesign import fem
from codesign._core.fem import MAX_QUESTIONS, TIME_LIMIT
from codesign.errors import MeshError
from codesign.fem.selections import Labeled, Place, label_surface

COARSE = 20_000  # triangles: a surface with more is no coarse tessellation
FACET_DISTANCE = 0.06  # of sides of elements to the surface, relative to their size, as in fem.tetrahedralize


class Mesher:
    """Makes meshes of one size; the limits of work and time cover all attempts at a part.

    An attempt that may be followed by another one gets half of the work that is left.
    """

    def __init__(
        self,
        size: float | fem.SizeField,
        simplify: bool = True,
        *,
        max_questions: int = MAX_QUESTIONS,
        time_limit: float = TIME_LIMIT,
    ) -> None:
        self._size = size
        self._options: dict[str, Any] = {} if simplify else {"simplify": 0.0}
        self._questions = max_questions
        self._limit, self._seconds = time_limit, 0.0

    def __call__(self, surface: fem.SurfaceMesh, *, last: bool) -> fem.TetMesh:
        """Raises: MeshError; MeshLimitError, which no other attempt may follow if `is_spent`."""
        questions = self._questions if last else self._questions // 2
        self._questions -= questions
        begun = time.thread_time()
        try:
            return fem.tetrahedralize(
                surface,
                self._size,
                max_questions=questions,
                time_limit=self._limit - self._seconds,
                **self._options,
            )
        finally:
            self._seconds += time.thread_time() - begun

    @property
    def is_spent(self) -> bool:
        """Whether the time of all attempts is used up."""
        return self._seconds >= self._limit


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
    mesher = Mesher(size, simplify)
    if not smooth:
        return *_mesh_either(mesher, named.surface, lambda: surface, named, places), None
    curved, report = fem.smooth_surface(named.surface)
    try:
        meshed = _mesh_either(mesher, curved, lambda: fem.smooth_surface(surface)[0], named, places, last=False)
        return *meshed, _smoothing(report)
    except MeshError as error:
        if mesher.is_spent:
            raise
        reason = f"the curved surface cannot be meshed ({error}): facets taken literally"
        unused = {"facets": 0, "max_distance": 0.0, "volume_change": 0.0, "left": report.facets, "reason": reason}
        return *_mesh_either(mesher, named.surface, lambda: surface, named, places), unused


def _mesh_either(
    mesher: Mesher,
    labeled: fem.SurfaceMesh,
    plain: Callable[[], fem.SurfaceMesh],
    named: Labeled,
    places: Sequence[Place],
    *,
    last: bool = True,
) -> tuple[fem.TetMesh, Labeled]:
    """The mesh and the places on it, with exact borders unless they are too ragged for the edge length.

    plain: makes the surface without the places' borders, which is rarely needed. last: no other surface will be tried.
    """
    try:
        return mesher(labeled, last=False), named
    except MeshError as error:
        if mesher.is_spent:
            raise
        mesh = mesher(plain(), last=last)
        return mesh, replace(named, selections=[place.on_mesh() for place in places], ragged=str(error))
