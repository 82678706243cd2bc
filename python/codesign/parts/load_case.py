"""Stress of a part: from its shape, supports and loads to one native case, and from the native result to numbers."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from codesign import _core, fem
from codesign.errors import ModelError, StudyError
from codesign.fem.model import native_loads, native_supports
from codesign.fem.static import Exclusion
from codesign.names import nearest
from codesign.units import MEBIBYTE

if TYPE_CHECKING:
    from codesign.parts.part import Part


Vector = NDArray[np.float64]

EDGE_SHARE, FINE_EDGE_SHARE = 0.35, 0.2  # of the mean wall thickness
MAX_REFINEMENTS = 3  # halvings of the edge length around the peak
LEAST_MEAN_NORMAL = 0.1  # length of a face's mean unit normal: 1 for a plane, 0.64 for a half bore, 0 for a whole one


@dataclass(frozen=True, slots=True)
class PressedFace:
    """A total force [N] that presses on a named face, uniformly over its area, against its outward normal."""

    face: str
    force: float

    def along(self, direction: ArrayLike) -> Vector:
        """(3,) the force [N] on a face that is pressed in a (unit) direction, part axes."""
        return self.force * np.asarray(direction, dtype=float)


@dataclass(frozen=True, slots=True)
class PushedFace:
    """A total force (3,) [N] in part axes on a named face, uniformly over its area."""

    face: str
    force: tuple[float, float, float]

    def along(self, direction: ArrayLike) -> Vector:  # noqa: ARG002 (this load has its own)
        """(3,) the force [N], part axes."""
        return np.asarray(self.force, dtype=float)


PartLoad = PressedFace | PushedFace | fem.Load


@dataclass(frozen=True, slots=True)
class CaseSettings:
    """Loads of a part that act together. safety_factor_min: what they ask for, None: what the study asks for."""

    name: str
    loads: tuple[PartLoad, ...]
    safety_factor_min: float | None = None


@dataclass(frozen=True, slots=True)
class StressSettings:
    """How a part's stress is computed; the same for all parts of a study but for supports and load cases.

    geometry: "simplified" or "full" (see the part). load, support: variant names that a part may offer.
    accuracy: "optimization" or "fine" mesh; "converged": the fine one, refined around the peak until its estimated
    error and its change are within the tolerance. exclusion, exclusion_distance [m]: where the peak stress is not read,
    as in `fem.StaticSystem`. edge_length: [m] of the elements of a part without its own size field; None: from its mean
    wall thickness; "fine" ones are shorter in proportion. tolerance: wanted relative error of the peak stress. modes,
    buckling: how many natural frequencies and buckling factors are wanted. memory_limit: [bytes] for the matrices and
    factors of one analysis; it decides between factor and iteration.
    """

    material: fem.Material
    supports: Sequence[str]
    cases: Sequence[CaseSettings]
    geometry: Literal["simplified", "full"] = "simplified"
    load: str = "uniform"
    support: str = "published"
    accuracy: Literal["optimization", "fine", "converged"] = "optimization"
    exclusion: Exclusion = "local"
    exclusion_distance: float | None = None
    edge_length: float | None = None
    tolerance: float = 0.05
    memory_limit: float = 1400 * MEBIBYTE
    modes: int = 0
    buckling: int = 0

    @property
    def segments(self) -> int:
        """Chords on a full circle of the surface that is meshed; fine meshes would find the edges of coarse ones."""
        return 48 if self.accuracy == "optimization" else 128


def part_case(part: Part, settings: StressSettings) -> _core.PartCase:
    """The native case of a part: its own `stress_case` if it has one, else named faces on a uniform mesh."""
    own = getattr(part, "stress_case", None)
    return own(settings) if own is not None else default_case(part, settings)


def default_case(part: Part, settings: StressSettings) -> _core.PartCase:
    """Clamped and pressed faces by name; edge length as asked for, else from the mean wall thickness."""
    surface = part.fem_surface(settings.geometry, settings.segments)
    edge_length = _edge_length(part, surface, settings)
    cases = load_cases(settings, lambda load: face_force(surface, load, part.name))
    return native_case(settings, surface, fem.default_size(surface, edge_length), [clamp(*settings.supports)], cases)


def _edge_length(part: Part, surface: fem.SurfaceMesh, settings: StressSettings) -> float:
    """Of the elements [m]; the peak's own size is found by refining."""
    share = FINE_EDGE_SHARE if settings.accuracy == "fine" else EDGE_SHARE
    if settings.edge_length is not None:
        return settings.edge_length * (share / EDGE_SHARE)
    corners = surface.points[surface.triangles]
    areas = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    thickness = 2.0 * part.mass_properties().volume / areas.sum()
    return float(thickness * share)


def load_cases(settings: StressSettings, on_face: Callable[[PressedFace | PushedFace], fem.Load]) -> list[fem.LoadCase]:
    """The load cases of a part as the solver takes them. on_face: what a total force on a face means for the part."""
    return [
        fem.LoadCase(
            case.name,
            [on_face(load) if isinstance(load, PressedFace | PushedFace) else load for load in case.loads],
            1.0 if case.safety_factor_min is None else case.safety_factor_min,
        )
        for case in settings.cases
    ]


def face_force(surface: fem.SurfaceMesh, load: PressedFace | PushedFace, part: str) -> fem.Force:
    """The total force of a load on a named face of a part's surface. Raises: StudyError (no such face), ModelError."""
    if load.face not in surface.face_names:
        raise StudyError(f"{part}: no face {load.face!r}; {nearest(load.face, filter(None, surface.face_names))}")
    if isinstance(load, PressedFace):
        try:
            force = load.along(pressing_direction(surface, load.face))
        except ModelError as error:
            raise ModelError(f"{part}: pressing_n on {error}") from None
    else:
        force = load.along(())
    if not force.any():
        raise ModelError(f"{part}: the force on face {load.face!r} is zero")
    return fem.Force(load.face, force)


def pressing_direction(surface: fem.SurfaceMesh, face: str) -> Vector:
    """(3,) unit vector against the mean outward normal of a named face.

    Raises: ModelError: its normals cancel, as those of a whole bore do.
    """
    corners = surface.points[surface.triangles[np.asarray(surface.face) == surface.face_names.index(face)]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    direction = -normals.sum(axis=0)
    length = float(np.linalg.norm(direction))
    share = length / float(np.linalg.norm(normals, axis=1).sum())
    if share < LEAST_MEAN_NORMAL:
        raise ModelError(
            f"face {face!r}: its normals cancel (their mean has the length {share:.2g}), so there is no direction to "
            "press in; give the force as a vector, force_n = [x, y, z]"
        )
    return np.asarray(direction / length)


def clamp(*faces: str) -> fem.Support:
    """Named faces fixed in all directions."""
    return fem.Support(fem.select_names(*faces))


def native_case(
    settings: StressSettings,
    surface: fem.SurfaceMesh,
    size: fem.SizeField,
    supports: Sequence[fem.Support],
    cases: Sequence[fem.LoadCase],
    *,
    copies: int = 1,
    facet_angle_deg: float = 25.0,
) -> _core.PartCase:
    """What `codesign._core.evaluate` meshes and solves.

    copies: 2 for one half of a symmetric part; work and stress_50 then refer to the whole part.
    """
    static = _core.fem.StaticSettings()
    static.exclusion = getattr(_core.fem.ExclusionRule, settings.exclusion)
    static.exclusion_distance = settings.exclusion_distance
    static.copies = copies
    static.memory_limit = settings.memory_limit
    case = _core.PartCase(
        surface=surface,
        size=size,
        material=settings.material,
        supports=native_supports(None, supports),
        cases=[_core.LoadCase(case.name, native_loads(None, case.loads), case.safety_factor_min) for case in cases],
        settings=static,
        facet_angle_deg=facet_angle_deg,
        tolerance=settings.tolerance,
        max_refinements=MAX_REFINEMENTS if settings.accuracy == "converged" else 0,
    )
    case.modes = settings.modes
    case.buckling = settings.buckling
    return case


def part_document(mass: Any, analysis: _core.PartAnalysis) -> dict[str, Any]:
    """Numbers of one part for JSON, SI units: those of the load case that governs, and the strength in every case.

    `buckling_factor` is None if the load cannot buckle the part, `safety_factor` if it does not stress it.
    """
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
        **strength_document(result),
        "load_case": analysis.case_names[analysis.governing],
        "cases": {
            name: strength_document(each) | {"max_displacement": each.max_displacement, "work": each.work}
            for name, each in zip(analysis.case_names, analysis.results, strict=True)
        },
        "tolerance_reached": analysis.converged,
        **optional,
        "max_displacement": result.max_displacement,
        "work": result.work,
        "nodes": len(analysis.mesh.nodes),
        "tetrahedra": len(analysis.mesh.tets),
        "seconds": {"mesh": analysis.mesh_seconds, "solve": analysis.solve_seconds},
    }


def strength_document(result: fem.StaticResult) -> dict[str, Any]:
    """What decides the safety factor, for JSON, SI units.

    `safety_factor` is None if nothing is stressed, `left_out` (the largest stress that the exclusion leaves out) if it
    leaves out nothing. `peak_resolved` is False if the estimated error exceeds half of the peak.
    """
    hidden = result.left_out
    left_out = {
        "stress": hidden.stress,
        "position": [float(x) for x in hidden.position],
        "border_distance": hidden.border_distance,
    }
    return {
        "safety_factor": result.safety_factor if math.isfinite(result.safety_factor) else None,
        "peak_stress": result.peak_stress,
        "peak_position": [float(x) for x in result.peak_position],
        "peak_resolved": result.peak_resolved,
        "stress_50": result.stress_50,
        "stress_error": result.stress_error,
        "left_out": left_out if hidden.stress > 0.0 else None,
    }


@dataclass(frozen=True, slots=True)
class Confirmation:
    """A part as the optimization analyses it beside the part as it is made; documents as of `part_document`.

    confirmed: full geometry, fine mesh, refined around the peak; `tolerance_reached` says whether that was enough.
    """

    analyzed: dict[str, Any]
    confirmed: dict[str, Any]


def confirm(part: Part, settings: StressSettings) -> Confirmation:
    """Analyses a part with the given settings, and its full geometry on a fine mesh until the tolerance is reached.

    Raises: MeshError, SolverError, GeometryError.
    """
    mass = part.mass_properties()
    full = replace(settings, geometry="full", accuracy="converged")
    analyzed, confirmed = (
        part_document(mass, _core.analyze_part(part_case(part, chosen))) for chosen in (settings, full)
    )
    return Confirmation(analyzed, confirmed)
