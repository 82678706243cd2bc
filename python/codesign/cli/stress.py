"""`codesign stress`: the safety factor of any closed surface."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from codesign import fem
from codesign.cli.stress_file import load_file, repair_document, unit_hints
from codesign.cli.stress_mesh import literal_facets, mesh_places
from codesign.cli.stress_options import StressInputError, parse_acceleration, parse_load, parse_support
from codesign.cli.stress_places import CaughtPlace, PlacedText, caught_places
from codesign.errors import FileError, ModelError
from codesign.files import check_target
from codesign.parts.strength import strength_document
from codesign.units import MILLIMETER

LEFT_OUT_WARNED = 1.1  # times the peak: a stress left out that is a warning


@dataclass(frozen=True)
class Solved:
    """A part that was meshed and solved. smoothing: how facets were curved back. seconds: wall clock.

    ragged: why the borders of the places are no lines of the mesh; empty if they are.
    """

    surface: fem.SurfaceMesh
    mesh: fem.TetMesh
    places: list[CaughtPlace]
    result: fem.StaticResult
    size: fem.SizeField
    smoothing: dict[str, Any] | None
    seconds: dict[str, float]
    ragged: str


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
    repair: bool = False,
    simplify: bool = True,
    acceleration: str | None = None,
) -> dict[str, Any]:
    """Meshes, solves and gives the JSON document of `codesign stress` (docs/fem.md); SI units.

    Args:
        path: STL file. scale: meters per unit of the file, also of the selections' coordinates.
        fix: selections, held in all directions, or `SEL: xz` in two. load: texts `SEL: fx fy fz`, `SEL: pressure p`,
            `SEL: traction tx ty tz`. acceleration: `ax ay az` [m/s²] of the whole part, as gravity.
        edge_length_mm: of the elements; from the local wall if absent. vtu, png: the stress field, a picture of it.
        exclusion_mm: the peak stress is read farther than this from borders of clamps and from sharp pocket edges that
            border a load; in proportion to the local feature if absent.
        smooth: take the file for a tessellation of curved faces and curve its facets back before meshing.
        repair: of a file that bounds no solid as it is (`fem.repair_surface`). simplify: tiny edges before meshing.

    Raises: MeshError, SolverError, StressInputError; FileError before anything is computed.
    """
    if not fix or not (load or acceleration):
        raise StressInputError("--fix and --load (or --acceleration): at least one of each is needed")
    if acceleration and material.density <= 0.0:
        raise StressInputError("--acceleration: the material needs a density: E_GPa,nu,yield_MPa,density_kg_m3")
    for name, value in (("--edge-length", edge_length_mm), ("--exclusion", exclusion_mm), ("--scale", scale)):
        if value is not None and not (math.isfinite(value) and value > 0.0):
            raise StressInputError(f"{name}: a positive number is needed")
    asked = []
    for text in fix:
        place, axes = parse_support(text, scale)
        asked.append(PlacedText(text.strip(), place, axes=axes))
    for text in load:
        place, what = parse_load(text, scale)
        asked.append(PlacedText(text.rpartition(":")[0].strip(), place, what))
    edge_length = None if edge_length_mm is None else edge_length_mm * MILLIMETER
    exclusion = None if exclusion_mm is None else exclusion_mm * MILLIMETER
    _check_targets(path, vtu, png)
    surface, repaired = load_file(path, scale, repair)
    body = None if acceleration is None else parse_acceleration(acceleration)
    solved = _solve(surface, asked, material, edge_length, exclusion, smooth, simplify, body)
    _write_files(path, material, solved, vtu, png)
    document = _document(path, material, solved, smooth)
    document["repair"] = repair_document(repaired)
    document["warnings"] += unit_hints(surface, scale, solved.result.max_displacement)
    return document


def _check_targets(part: Path, vtu: Path | None, png: Path | None) -> None:
    """Raises: FileError: a file that cannot be written, the part itself, or one file twice."""
    taken = {part.resolve(): "the part itself"}
    for option, target in (("--vtu", vtu), ("--png", png)):
        if target is None:
            continue
        if target.resolve() in taken:
            raise FileError(f"{option} {target}: is {taken[target.resolve()]}; name another file")
        taken[target.resolve()] = f"the file of {option} too"
        check_target(target)


def _solve(
    surface: fem.SurfaceMesh,
    asked: Sequence[PlacedText],
    material: fem.Material,
    edge_length: float | None,
    exclusion: float | None,
    smooth: bool,
    simplify: bool,
    acceleration: tuple[float, ...] | None,
) -> Solved:
    start = time.perf_counter()
    size = fem.default_size(surface) if edge_length is None else fem.SizeField(edge_length)
    mesh, named, smoothing = mesh_places(surface, [placed.place for placed in asked], size, smooth, simplify)
    places = caught_places(asked, named, mesh, size.base)
    supports = [fem.Support(place.selection, place.asked.axes) for place in places if place.asked.load is None]
    loads: list[fem.Load] = [p.asked.load.on(p.selection) for p in places if p.asked.load is not None]
    if acceleration is not None:
        loads.append(fem.Acceleration(acceleration))
    meshed = time.perf_counter()
    try:
        result = fem.solve_static(mesh, material, supports, loads, exclusion_distance=exclusion)
    except ModelError as error:
        raise StressInputError(str(error)) from None
    seconds = {"mesh": meshed - start, "solve": time.perf_counter() - meshed}
    return Solved(surface, mesh, places, result, size, smoothing, seconds, named.ragged)


def _write_files(path: Path, material: fem.Material, solved: Solved, vtu: Path | None, png: Path | None) -> None:
    if vtu is not None:
        from codesign.fem.vtu import StressModel, write_vtu

        result = solved.result
        notes = {
            "part": path.name,
            "model": "the surface of the file" + (", facets curved back" if solved.smoothing else ""),
            "load_case": "; ".join(place.words() for place in solved.places),
            "material": material.name,
            "result": f"safety factor {result.safety_factor:.6g}, peak stress {result.peak_stress:.6g} Pa where "
            "counts_for_peak is 1",
        }
        write_vtu(StressModel.of(solved.mesh, result), vtu, notes)
    if png is not None:
        from codesign.cli.stress_picture import write_stress_picture

        write_stress_picture(solved.mesh, solved.result, solved.places, path.stem, png)


def _document(path: Path, material: fem.Material, solved: Solved, smooth: bool) -> dict[str, Any]:
    result, mesh = solved.result, solved.mesh
    quality, report = mesh.quality, mesh.report
    strength = strength_document(result)
    return {
        "file": str(path),
        "material": material.name,
        **strength,
        "safety_factor_reason": None if strength["safety_factor"] is not None else "the loads do not stress the part",
        "max_displacement": result.max_displacement,
        "work": result.work,
        "applied_force": sum((place.force for place in solved.places), np.zeros(3)).tolist(),
        "reaction_force": [float(x) for x in np.asarray(result.reactions).sum(axis=0)],
        "places": [place.to_dict() for place in solved.places],
        "warnings": _warnings(solved),
        "mass": quality.volume * material.density if material.density > 0.0 else None,
        "volume": quality.volume,
        "edge_length": solved.size.base,
        "smallest_edge_length": solved.size.smallest,
        "exclusion": {"smallest": result.exclusion_smallest, "largest": result.exclusion_largest},
        "nodes": len(mesh.nodes),
        "tetrahedra": len(mesh.tets),
        "mesh": {
            "min_dihedral_deg": quality.min_dihedral_deg,
            "collapsed_edges": report.collapsed,
            "collapse_distance": report.collapse_distance,
            "peeled": report.peeled,
            "refinements": report.refinements,
            "small_faults": report.small_faults,
            "genus": report.genus,
            "surface_distance": report.surface_distance,
        },
        "smoothing": solved.smoothing,
        "facets_literal": None if smooth else literal_facets(solved.surface, solved.size.base),
        "seconds": solved.seconds,
    }


def _warnings(solved: Solved) -> list[str]:
    result = solved.result
    found = [warning for place in solved.places for warning in place.warnings()]
    if solved.ragged:
        found.append(
            f"clamps and loads are made of whole sides of elements, as their borders gave no mesh: {solved.ragged}"
        )
    if faults := solved.mesh.report.small_faults:
        found.append(
            f"the mesh touches itself at {faults} places of at most 0.05 mm, on ledges that no element follows: the "
            "solid keeps the topology of the surface, but stresses on such ledges mean nothing"
        )
    if not result.peak_resolved:
        found.append(
            f"the peak stress is not resolved: its estimated error is {result.stress_error / result.peak_stress:.0%} "
            f"of it; give a smaller --edge-length than {solved.size.smallest / MILLIMETER:.3g} mm"
        )
    if result.peak_at_exclusion:
        found.append(
            f"the peak stress lies {result.border_distance / MILLIMETER:.2g} mm from the rim of a clamp or load, right "
            "beside larger stresses that are left out: how near to the rim it is read sets it, no mesh settles it"
        )
    if result.left_out.stress > LEFT_OUT_WARNED * result.peak_stress > 0.0:
        at = ", ".join(f"{x / MILLIMETER:.2f}" for x in result.left_out.position)
        found.append(
            f"the stress left out is {result.left_out.stress / result.peak_stress:.2g} times the peak, at {at} mm: "
            "beside ideal clamps and at sharp edges stress grows without end under refinement; model the fillet there, "
            "or judge it by hand"
        )
    return found
