"""`codesign stress`: the safety factor of any closed surface."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from codesign import fem
from codesign.cli.stress_mesh import default_edge_length, literal_facets, mesh_places
from codesign.cli.stress_options import StressInputError, parse_load, parse_selection
from codesign.units import MILLIMETRE


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
    mesh, places, smoothing = mesh_places(surface, [*held, *(place for place, _ in pushed)], size, smooth)
    supports = [fem.Support(place) for place in places[: len(held)]]
    loads = [fem.Force(place, force) for place, (_, force) in zip(places[len(held) :], pushed, strict=True)]
    meshed = time.perf_counter()
    try:
        result = fem.solve_static(mesh, material, supports, loads, exclusion_distance=exclusion)
    except ValueError as error:
        raise StressInputError(str(error)) from None
    solved = time.perf_counter()
    if vtu is not None:
        from codesign.fem.vtu import StressModel, write_vtu

        notes = {
            "part": path.name,
            "model": "the surface of the file" + (", facets curved back" if smooth else ""),
            "load_case": f"held: {'; '.join(fix)}; loads [N]: {'; '.join(load)}; selections in units of {scale:g} m",
            "material": material.name,
            "result": f"safety factor {result.safety_factor:.6g}, peak stress {result.peak_stress:.6g} Pa",
        }
        write_vtu(StressModel.of(mesh, result), vtu, notes)
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
