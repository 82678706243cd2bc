"""Stress of a part: from its shape, supports and loads to one native case, and from the native result to numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from codesign import _core, fem
from codesign.errors import StudyError
from codesign.names import nearest

if TYPE_CHECKING:
    from codesign.parts.part import Part


MAX_REFINEMENTS = 3  # halvings of the edge length around the peak


@dataclass(frozen=True, slots=True)
class PressedFace:
    """A total force [N] that presses on a named face, uniformly over its area, against its outward normal."""

    face: str
    force: float


@dataclass(frozen=True, slots=True)
class StressSettings:
    """How a part's stress is computed; the same for all parts of a study but for supports and loads.

    geometry: "simplified" or "full" (see the part). load, support: variant names that a part may offer.
    accuracy: "optimisation" or "fine" mesh; "converged": the fine one, refined around the peak until its estimated
    error and its change are within the tolerance. exclusion_distance: [m] from clamps and from borders of loaded faces
    within which the peak stress is not read. tolerance: wanted relative error of the peak stress. modes, buckling: how
    many natural frequencies and buckling factors are wanted.
    """

    material: fem.Material
    supports: Sequence[str]
    loads: Sequence[PressedFace]
    geometry: Literal["simplified", "full"] = "simplified"
    load: str = "uniform"
    support: str = "published"
    accuracy: Literal["optimisation", "fine", "converged"] = "optimisation"
    exclusion_distance: float = 3e-3
    tolerance: float = 0.05
    modes: int = 0
    buckling: int = 0

    @property
    def segments(self) -> int:
        """Chords on a full circle of the surface that is meshed; fine meshes would find the edges of coarse ones."""
        return 48 if self.accuracy == "optimisation" else 128


def part_case(part: Part, settings: StressSettings) -> _core.PartCase:
    """The native case of a part: its own `stress_case` if it has one, else named faces on a uniform mesh."""
    own = getattr(part, "stress_case", None)
    return own(settings) if own is not None else default_case(part, settings)


def default_case(part: Part, settings: StressSettings) -> _core.PartCase:
    """Clamped and pressed faces by name; edge length from the part's volume and area (its mean wall thickness)."""
    surface = part.fem_surface(settings.geometry, settings.segments)
    properties = part.mass_properties()
    corners = surface.points[surface.triangles]
    areas = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    thickness = 2.0 * properties.volume / areas.sum()
    edge_length = thickness * (0.2 if settings.accuracy == "fine" else 0.35)  # the peak's own size is found by refining
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    loads = []
    for load in settings.loads:
        if load.face not in surface.face_names:
            raise StudyError(
                f"{part.name}: no face {load.face!r}; {nearest(load.face, filter(None, surface.face_names))}"
            )
        on_face = surface.face == surface.face_names.index(load.face)
        direction = -normals[on_face].sum(axis=0)
        force = load.force * direction / np.linalg.norm(direction)
        loads.append(_core.fem.Force(_core.fem.Selection(faces=[load.face]), force))
    return native_case(settings, surface, fem.SizeField(edge_length), [clamp(*settings.supports)], loads)


def clamp(*faces: str) -> _core.fem.Support:
    """Named faces fixed in all directions."""
    return _core.fem.Support(_core.fem.Selection(faces=list(faces)))


def native_case(
    settings: StressSettings,
    surface: fem.SurfaceMesh,
    size: fem.SizeField,
    supports: Sequence[_core.fem.Support],
    loads: Sequence[_core.fem.Force | _core.fem.AffineTraction],
    *,
    copies: int = 1,
    facet_angle_deg: float = 25.0,
) -> _core.PartCase:
    """What `codesign._core.evaluate` meshes and solves.

    copies: 2 for one half of a symmetric part; work and stress_50 then refer to the whole part.
    """
    static = _core.fem.StaticSettings()
    static.exclusion_distance = settings.exclusion_distance
    static.copies = copies
    case = _core.PartCase(
        surface=surface,
        size=size,
        material=settings.material,
        supports=list(supports),
        loads=list(loads),
        settings=static,
        facet_angle_deg=facet_angle_deg,
        tolerance=settings.tolerance,
        max_refinements=MAX_REFINEMENTS if settings.accuracy == "converged" else 0,
    )
    case.modes = settings.modes
    case.buckling = settings.buckling
    return case


def part_document(mass: Any, analysis: _core.PartAnalysis) -> dict[str, Any]:
    """Numbers of one part for JSON, SI units; `buckling_factor` is None if the load cannot buckle the part."""
    result = analysis.result
    optional: dict[str, Any] = {}
    if analysis.refinements:
        optional = {"refinements": analysis.refinements, "change": analysis.change}
    if len(analysis.frequencies):
        optional["first_frequency"] = float(analysis.frequencies[0])
        optional["frequencies"] = [float(f) for f in analysis.frequencies]
    if len(analysis.buckling_factors):
        lowest = float(analysis.buckling_factors[0])
        optional["buckling_factor"] = lowest if math.isfinite(lowest) else None
    return {
        "mass": float(mass.mass),
        "com": [float(x) for x in mass.com],
        "inertia": [[float(x) for x in row] for row in mass.inertia],
        "safety_factor": result.safety_factor,
        "peak_stress": result.peak_stress,
        "stress_50": result.stress_50,
        "stress_error": result.stress_error,
        "tolerance_reached": analysis.converged,
        **optional,
        "max_displacement": result.max_displacement,
        "work": result.work,
        "peak_position": [float(x) for x in result.peak_position],
        "nodes": len(analysis.mesh.nodes),
        "tetrahedra": len(analysis.mesh.tets),
        "seconds": {"mesh": analysis.mesh_seconds, "solve": analysis.solve_seconds},
    }


@dataclass(frozen=True, slots=True)
class Confirmation:
    """A part as the optimisation analyses it beside the part as it is made; documents as of `part_document`.

    confirmed: full geometry, fine mesh, refined around the peak; `tolerance_reached` says whether that was enough.
    """

    analysed: dict[str, Any]
    confirmed: dict[str, Any]

    @property
    def deviation(self) -> float:
        """Of the analysed safety factor from the confirmed one, relative."""
        return float(self.analysed["safety_factor"] / self.confirmed["safety_factor"] - 1.0)


def confirm(part: Part, settings: StressSettings) -> Confirmation:
    """Analyses a part with the given settings, and its full geometry on a fine mesh until the tolerance is reached.

    Raises: MeshError, SolverError, GeometryError.
    """
    mass = part.mass_properties()
    full = replace(settings, geometry="full", accuracy="converged")
    analysed, confirmed = (
        part_document(mass, _core.analyse_part(part_case(part, chosen))) for chosen in (settings, full)
    )
    return Confirmation(analysed, confirmed)
