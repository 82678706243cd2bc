"""File of `codesign stress`: read, checked, repaired on request, its faces; hints where its units look wrong."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from rich.table import Table

from codesign import fem
from codesign.cli.console import out
from codesign.errors import MeshError
from codesign.fem.holes import holes
from codesign.units import MILLIMETER

SMALLEST = 1e-3  # m: a smaller part is more likely a file in meters
LARGEST = 20.0  # m: a larger part is more likely a file in millimeters
MOST_DISPLACEMENT = 0.1  # of the extent: beyond it, small displacements are no sensible assumption


def load_file(path: Path, scale: float, repair: bool) -> tuple[fem.SurfaceMesh, fem.RepairReport | None]:
    """The solid of an STL or STEP file with faces by angle, and what its repair changed if that was asked for.

    scale: meters per unit of an STL file; STEP files know their unit.

    Raises: MeshError: what is wrong with the file, and whether --repair would help.
    """
    surface = _read(path, scale)
    if repair:
        try:
            repaired, report = fem.repair_surface(surface)
        except MeshError as error:
            raise MeshError(f"{path}: {error}") from None
        return _faces(repaired), report
    try:
        fem.check_surface(surface)
    except MeshError as error:
        raise MeshError(f"{path}: {error}; {_remedy(surface)}") from None
    return _faces(surface), None


def _faces(surface: fem.SurfaceMesh) -> fem.SurfaceMesh:
    """The surface with the faces of its file, or those that its sharp edges make."""
    return surface if any(surface.face_names) else fem.label_by_angle(surface)


def _read(path: Path, scale: float) -> fem.SurfaceMesh:
    try:
        with path.open("rb") as file:
            is_step = file.read(64).lstrip().startswith(b"ISO-10303-21")
    except OSError as error:
        raise MeshError(f"{path}: {error.strerror}") from None
    if is_step:
        from codesign.fem.step import load_step

        return load_step(path).by_face()
    return fem.read_stl(path, scale)


def _remedy(surface: fem.SurfaceMesh) -> str:
    try:
        fem.repair_surface(surface)
    except MeshError:
        return "--repair does not help"
    return "--repair mends it"


def repair_document(report: fem.RepairReport | None) -> dict[str, Any] | None:
    """What the repair changed, SI units; None if it was not asked for."""
    if report is None:
        return None
    return {
        "changed": report.changed,
        "reason": report.reason,
        "tolerance": report.tolerance,
        "largest_shift": report.largest_shift,
        **{
            name: {"before": before, "after": after}
            for name, (before, after) in (
                ("volume", report.volume),
                ("area", report.area),
                ("triangles", report.triangles),
                ("bodies", report.bodies),
            )
        },
        "doubled_facets": report.doubled,
        "flat_facets": report.flat,
        "t_junctions": report.t_junctions,
        "merged_points": report.merged_points,
        "turned_facets": report.turned,
        "turned_shells": report.turned_shells,
        "united_bodies": report.united,
        "simplified": report.simplified,
    }


def describe_repair(repair: dict[str, Any]) -> str:
    """One line for the terminal."""
    if not repair["changed"]:
        return "nothing to repair"
    counted = {
        "doubled_facets": "doubled facets dropped",
        "flat_facets": "flat facets dropped",
        "t_junctions": "T-junctions closed",
        "merged_points": "points merged",
        "turned_facets": "facets turned",
        "turned_shells": "shells turned outward",
        "united_bodies": "bodies united",
    }
    done = [f"{repair[key]} {words}" for key, words in counted.items() if repair[key]]
    if repair["simplified"]:
        done.append("tiny triangles simplified")
    before, after = repair["volume"]["before"], repair["volume"]["after"]
    volume = f"{after * 1e9:.4g} mm³" if before is None else f"{before * 1e9:.4g} → {after * 1e9:.4g} mm³"
    counts = ", ".join(f"{repair[key]['before']} → {repair[key]['after']} {key}" for key in ("triangles", "bodies"))
    area = f"{repair['area']['before'] * 1e6:.4g} → {repair['area']['after'] * 1e6:.4g} mm²"
    shift, tolerance = (repair[key] / MILLIMETER for key in ("largest_shift", "tolerance"))
    moved = f"largest shift {shift:.2g} mm (tolerance {tolerance:.2g})"
    return f"{', '.join(done)}: volume {volume}, area {area}, {counts}, {moved}"


def unit_hints(surface: fem.SurfaceMesh, scale: float, max_displacement: float) -> list[str]:
    """Doubts about the units of a file read with `scale` meters per unit, from size and displacement [m]."""
    box = np.ptp(surface.points, axis=0)
    extent = float(np.linalg.norm(box))
    size = " x ".join(f"{side / MILLIMETER:.3g}" for side in box) + " mm"
    hints = []
    if extent < SMALLEST and scale >= MILLIMETER:
        hints.append(f"the part is only {size}: is the file in meters (--scale {1e3 * scale:g})?")
    elif extent > LARGEST:
        hints.append(f"the part is {size}: is the file in smaller units (--scale {1e-3 * scale:g})?")
    if max_displacement > MOST_DISPLACEMENT * extent:
        share = max_displacement / extent
        times = f"{share:.0f} times" if share >= 2.0 else f"{share:.0%} of"
        hints.append(
            f"the largest displacement is {times} the part, small ones are assumed: check the forces, the material and "
            "the units of the file (--scale)"
        )
    return hints


def face_documents(path: Path) -> list[dict[str, Any]]:
    """One document a face in the file's order, SI units: selection, type, radius, area, center of its triangles.

    type: hole is a hollow cylinder that closes, alone or with others. Raises: MeshError: as `load_step`.
    """
    from codesign.fem.step import load_step

    part = load_step(path)
    surface = part.by_face()
    walls = {surface.face_names[index] for index in holes(surface)}
    a, b, c = (surface.points[surface.triangles[:, k]] for k in range(3))
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    documents = []
    for face in part.faces:
        own = part.triangle_face == face.number - 1
        name = face.name or f"face {face.number}"
        documents.append(
            {
                "selection": f"face:{face.name or face.number}",
                "type": "hole" if name in walls else face.kind,
                "radius": face.radius,
                "area": face.area,
                "center": (areas[own] @ ((a + b + c)[own] / 3.0) / areas[own].sum()).tolist(),
            }
        )
    return documents


def print_faces(documents: list[dict[str, Any]]) -> None:
    """As a table, lengths in mm."""
    table = Table(box=None, pad_edge=False)
    for heading in ("selection", "type", "radius mm", "area mm²", "middle mm"):
        table.add_column(heading, justify="left" if heading in ("selection", "type") else "right")
    for face in documents:
        radius = "" if face["radius"] is None else f"{face['radius'] / MILLIMETER:.4g}"
        x, y, z = (value / MILLIMETER for value in face["center"])
        area = face["area"] / MILLIMETER**2
        table.add_row(face["selection"], face["type"], radius, f"{area:.4g}", f"{x:.2f}, {y:.2f}, {z:.2f}")
    out.print(table)
