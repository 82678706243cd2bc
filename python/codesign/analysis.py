"""Stress of a part: from its shape, supports and loads to one native case, and from the native result to numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from codesign import _core, fem

if TYPE_CHECKING:
    from codesign.geometry.part import Part


@dataclass(frozen=True, slots=True)
class PressedFace:
    """A total force [N] that presses on a named face, uniformly over its area, against its outward normal."""

    face: str
    force: float


@dataclass(frozen=True, slots=True)
class StressSettings:
    """How a part's stress is computed; the same for all parts of a study but for supports and loads.

    geometry: "simplified" or "full" (see the part). load, support: variant names that a part may offer.
    accuracy: "optimisation" or "fine" mesh. exclusion_distance: [m] from clamps and from borders of loaded faces within
    which the peak stress is not read. tolerance: wanted relative error of the peak stress.
    """

    material: fem.Material
    supports: Sequence[str]
    loads: Sequence[PressedFace]
    geometry: Literal["simplified", "full"] = "simplified"
    load: str = "uniform"
    support: str = "published"
    accuracy: Literal["optimisation", "fine"] = "optimisation"
    exclusion_distance: float = 3e-3
    tolerance: float = 0.05


def part_case(part: Part, settings: StressSettings) -> _core.PartCase:
    """The native case of a part: its own `stress_case` if it has one, else named faces on a uniform mesh."""
    own = getattr(part, "stress_case", None)
    return own(settings) if own is not None else default_case(part, settings)


def default_case(part: Part, settings: StressSettings) -> _core.PartCase:
    """Clamped and pressed faces by name; edge length from the part's volume and area (its mean wall thickness)."""
    surface = part.fem_surface(settings.geometry)
    properties = part.mass_properties()
    corners = surface.points[surface.triangles]
    areas = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    thickness = 2.0 * properties.volume / areas.sum()
    edge_length = thickness * (0.35 if settings.accuracy == "optimisation" else 0.2)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    loads = []
    for load in settings.loads:
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
    return _core.PartCase(
        surface=surface,
        size=size,
        material=settings.material,
        supports=list(supports),
        loads=list(loads),
        settings=static,
        facet_angle_deg=facet_angle_deg,
    )


def part_document(mass: Any, analysis: _core.PartAnalysis) -> dict[str, Any]:
    """Numbers of one part for JSON, SI units."""
    result = analysis.result
    return {
        "mass": float(mass.mass),
        "com": [float(x) for x in mass.com],
        "inertia": [[float(x) for x in row] for row in mass.inertia],
        "safety_factor": result.safety_factor,
        "peak_stress": result.peak_stress,
        "stress_50": result.stress_50,
        "stress_error": result.stress_error,
        "max_displacement": result.max_displacement,
        "work": result.work,
        "peak_position": [float(x) for x in result.peak_position],
        "nodes": len(analysis.mesh.nodes),
        "tetrahedra": len(analysis.mesh.tets),
        "seconds": {"mesh": analysis.mesh_seconds, "solve": analysis.solve_seconds},
    }
