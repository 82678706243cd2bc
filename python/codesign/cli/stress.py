"""`codesign stress`: the safety factor of any closed surface."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from codesign import fem
from codesign.errors import CodesignError, MeshError
from codesign.fem.selections import Box, Facing, Near, Place, label_surface
from codesign.units import GIGA, MEGA, MILLIMETRE

ELEMENTS_WANTED = 30_000  # of the default edge length, at most
COARSE = 20_000  # triangles: a surface with more is no coarse tessellation
FACET_DISTANCE = 0.06  # of sides of elements to the surface, relative to their size, as in fem.tetrahedralize
WALLS = 2.5  # elements across the mean wall, of the default edge length

# Typical catalogue values; ergal (aluminium 7075-T6) as in the shipped study.
MATERIALS = {
    "ergal": fem.Material("ergal", 71.7 * GIGA, 0.3, 2810.0, 462.0 * MEGA),
    "aluminium_6061_t6": fem.Material("aluminium_6061_t6", 68.9 * GIGA, 0.33, 2700.0, 276.0 * MEGA),
    "steel_s235": fem.Material("steel_s235", 210.0 * GIGA, 0.3, 7850.0, 235.0 * MEGA),
    "titanium_ti6al4v": fem.Material("titanium_ti6al4v", 113.8 * GIGA, 0.342, 4430.0, 880.0 * MEGA),
}


class StressInputError(CodesignError, ValueError):
    """An option of `codesign stress` that cannot be used; the message names it and says why."""


def parse_selection(text: str, scale: float) -> Place:
    """`near:x,y,z`, `box:x0,y0,z0,x1,y1,z1` or `normal:nx,ny,nz[:degrees]`; coordinates in units of `scale` metres.

    Raises: StressInputError.
    """
    kind, _, rest = text.strip().partition(":")
    if kind == "near":
        x, y, z = _numbers(rest, 3, text)
        return Near((x * scale, y * scale, z * scale))
    if kind == "box":
        corners = np.array(_numbers(rest, 6, text)).reshape(2, 3) * scale
        return Box(tuple(corners.min(axis=0)), tuple(corners.max(axis=0)))
    if kind == "normal":
        direction, _, angle = rest.partition(":")
        x, y, z = _numbers(direction, 3, text)
        if not (x or y or z):
            raise StressInputError(f"selection {text!r}: the direction is zero")
        return Facing((x, y, z), _numbers(angle, 1, text)[0] if angle else 1.0)
    raise StressInputError(
        f"selection {text!r}: expected near:x,y,z, box:x0,y0,z0,x1,y1,z1 or normal:nx,ny,nz[:degrees]"
    )


def parse_load(text: str, scale: float) -> tuple[Place, tuple[float, ...]]:
    """`SEL: fx fy fz`, the total force in newton, spread over the selection's area.

    Raises: StressInputError.
    """
    where, colon, force = text.rpartition(":")
    if not colon:
        raise StressInputError(f"load {text!r}: expected 'SELECTION: fx fy fz'")
    values = _numbers(",".join(force.replace(",", " ").split()), 3, text)
    if not any(values):
        raise StressInputError(f"load {text!r}: the force is zero")
    return parse_selection(where, scale), values


def find_material(text: str) -> fem.Material:
    """A name of MATERIALS, or `E_GPa,nu,yield_MPa[,kg/m3]`.

    Raises: StressInputError.
    """
    if text in MATERIALS:
        return MATERIALS[text]
    if "," not in text:
        raise StressInputError(
            f"material {text!r}: there are {', '.join(MATERIALS)}; or give E_GPa,nu,yield_MPa[,density_kg_m3]"
        )
    modulus, ratio, strength, density = (*_numbers(text, 4 if text.count(",") == 3 else 3, text), 0.0)[:4]
    if strength <= 0.0:
        raise StressInputError(f"material {text!r}: the yield strength must be positive")
    try:
        return fem.Material("custom", modulus * GIGA, ratio, density, strength * MEGA)
    except ValueError as error:
        raise StressInputError(f"material {text!r}: {error}") from None


def default_edge_length(surface: fem.SurfaceMesh) -> float:
    """Edge length [m] from the mean wall thickness, 2 · volume / area, limited by the number of elements."""
    volume = fem.mass_properties(surface, 1.0).volume
    a, b, c = (surface.points[surface.triangles[:, k]] for k in range(3))
    area = 0.5 * float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())
    return max(2.0 * volume / area / WALLS, math.cbrt(8.0 * volume / ELEMENTS_WANTED))


def default_exclusion(surface: fem.SurfaceMesh) -> float:
    """Exclusion distance [m]: 3 mm, or a tenth of the extent of a part smaller than 30 mm."""
    extent = float(np.linalg.norm(np.ptp(surface.points, axis=0)))
    return min(3.0 * MILLIMETRE, 0.1 * extent)


def stress_document(
    path: Path,
    scale: float,
    material: fem.Material,
    fix: Sequence[str],
    load: Sequence[str],
    edge_length_mm: float | None = None,
    vtu: Path | None = None,
    png: Path | None = None,
    exclusion_mm: float | None = None,
    smooth: bool = False,
) -> dict[str, Any]:
    """Meshes, solves and gives the JSON document of `codesign stress`; SI units.

    Args:
        path: STL file. scale: metres per unit of the file, also of the selections' coordinates.
        fix: selections held in all directions. load: texts `SEL: fx fy fz`.
        edge_length_mm: of the elements; from the wall thickness if absent. vtu, png: the stress field, a picture of it.
        exclusion_mm: the peak stress is read farther than this from clamps and from borders of loaded faces; 3 mm, or a
            tenth of a small part's extent, if absent.
        smooth: take the file for a tessellation of curved faces and curve its facets back before meshing.

    Raises: MeshError, SolverError, StressInputError.
    """
    if not fix or not load:
        raise StressInputError("--fix and --load: at least one of each is needed")
    for name, value in (("--edge-length", edge_length_mm), ("--exclusion", exclusion_mm), ("--scale", scale)):
        if value is not None and not (math.isfinite(value) and value > 0.0):
            raise StressInputError(f"{name}: a positive number is needed")
    held = [parse_selection(text, scale) for text in fix]
    pushed = [parse_load(text, scale) for text in load]
    start = time.perf_counter()
    surface = fem.load_surface(path, scale)
    size = default_edge_length(surface) if edge_length_mm is None else edge_length_mm * MILLIMETRE
    exclusion = default_exclusion(surface) if exclusion_mm is None else exclusion_mm * MILLIMETRE
    mesh, places, smoothing = _mesh(surface, [*held, *(place for place, _ in pushed)], size, smooth)
    supports = [fem.Support(place) for place in places[: len(held)]]
    loads = [fem.Force(place, force) for place, (_, force) in zip(places[len(held) :], pushed, strict=True)]
    meshed = time.perf_counter()
    try:
        result = fem.solve_static(mesh, material, supports, loads, exclusion_distance=exclusion)
    except ValueError as error:
        raise StressInputError(str(error)) from None
    solved = time.perf_counter()
    if vtu is not None:
        from codesign.cli.design import write_vtu

        write_vtu(mesh, result, vtu)
    if png is not None:
        from codesign.report.compute import stress_field
        from codesign.report.figures.solids import write_stress_picture

        title = f"{path.stem}: safety factor {result.safety_factor:.3g}"
        write_stress_picture(stress_field(mesh, result), title, png)
    quality, report = mesh.quality, mesh.report
    return {
        "file": str(path),
        "material": material.name,
        "safety_factor": result.safety_factor,
        "peak_stress": result.peak_stress,
        "peak_position": [float(x) for x in result.peak_position],
        "stress_50": result.stress_50,
        "stress_error": result.stress_error,
        "max_displacement": result.max_displacement,
        "work": result.work,
        "applied_force": [float(x) for x in np.array([force for _, force in pushed]).sum(axis=0)],
        "reaction_force": [float(x) for x in np.asarray(result.reactions).sum(axis=0)],
        "mass": quality.volume * material.density if material.density > 0.0 else None,
        "volume": quality.volume,
        "edge_length": size,
        "exclusion_distance": exclusion,
        "nodes": len(mesh.nodes),
        "tetrahedra": len(mesh.tets),
        "mesh": {
            "min_dihedral_deg": quality.min_dihedral_deg,
            "collapsed_edges": report.collapsed,
            "collapse_distance": report.collapse_distance,
            "peeled": report.peeled,
        },
        "smoothing": smoothing,
        "facets_literal": None if smooth else literal_facets(surface, size),
        "seconds": {"mesh": meshed - start, "solve": solved - meshed},
    }


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


def _mesh(
    surface: fem.SurfaceMesh, places: Sequence[Place], size: float, smooth: bool
) -> tuple[fem.TetMesh, list[fem.Selection], dict[str, Any] | None]:
    """The mesh, the places on it, and the smoothing; the facets themselves if their smooth surface cannot be meshed.

    Places are looked up on the facets of the file; the pieces of a facet belong to its place.
    """
    labelled, selections = label_surface(surface, places)
    if not smooth:
        return *_mesh_either(labelled, lambda: surface, selections, places, size), None
    curved, report = fem.smooth_surface(labelled)
    try:
        return *_mesh_either(curved, lambda: fem.smooth_surface(surface)[0], selections, places, size), _smoothing(
            report
        )
    except MeshError as error:
        reason = f"the curved surface cannot be meshed ({error}): facets taken literally"
        unused = {"facets": 0, "max_distance": 0.0, "volume_change": 0.0, "left": report.facets, "reason": reason}
        return *_mesh_either(labelled, lambda: surface, selections, places, size), unused


def _mesh_either(
    labelled: fem.SurfaceMesh,
    plain: Callable[[], fem.SurfaceMesh],
    selections: list[fem.Selection],
    places: Sequence[Place],
    size: float,
) -> tuple[fem.TetMesh, list[fem.Selection]]:
    """The mesh and the places on it, with exact borders unless they are too ragged for the edge length.

    plain: makes the surface without the places' borders, which is rarely needed.
    """
    try:
        return fem.tetrahedralize(labelled, size), selections
    except MeshError:
        return fem.tetrahedralize(plain(), size), [place.on_mesh() for place in places]


def _numbers(text: str, count: int, whole: str) -> tuple[float, ...]:
    try:
        values = tuple(float(part) for part in text.split(","))
    except ValueError:
        values = ()
    if len(values) != count or not all(math.isfinite(value) for value in values):
        raise StressInputError(f"{whole!r}: expected {count} numbers, found {text.strip()!r}")
    return values
