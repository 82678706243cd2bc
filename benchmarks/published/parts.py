"""Parts against the authors' 401 designs and STL files: prints the tables kept in docs/parts.md.

python benchmarks/published/parts.py [folder of the reference data]
"""

from __future__ import annotations

import csv
import os
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import trimesh

from codesign.parts.part import EXPORT_RESOLUTION, Part
from codesign.studies.ironcub.bracket import JetpackBracket
from codesign.studies.ironcub.forearm import ForearmJetSupport

REPOSITORY = Path(__file__).resolve().parents[2]
MOMENTS = ("ixx", "iyy", "izz")

Row = dict[str, float]


def published_rows(folder: Path) -> Iterator[Row]:
    """Rows with outputs."""
    with (folder / "published" / "designs.csv").open() as file:
        for row in csv.DictReader(file):
            if row["error"] == "0":
                yield {key: float(value) for key, value in row.items() if value}


def deviations(rows: list[Row], kind: str, keys: tuple[str, str], build: Callable[[float, float], Part]) -> np.ndarray:
    """(n, 3): first key, relative deviation of the mass and the largest one of the sorted principal moments."""
    computed: dict[tuple[float, float], tuple[float, np.ndarray]] = {}
    result = []
    for row in rows:
        theta = (row[keys[0]], row[keys[1]])
        if theta not in computed:
            properties = build(*theta).mass_properties()
            computed[theta] = properties.mass, properties.principal_moments * 1e6
        mass, moments = computed[theta]
        published = np.array([row[f"{m}_{kind}_kgmm2"] for m in MOMENTS])
        result.append((theta[0], mass / row[f"mass_{kind}_kg"] - 1.0, np.abs(moments / published - 1.0).max()))
    return np.array(result)


def print_mass_table(rows: list[Row]) -> None:
    bracket, forearm = ("angle_paper_deg", "distance_mm"), ("offset_mm", "length_mm")
    cases = {
        "bracket, slab 15 mm": deviations(rows, "bracket", bracket, JetpackBracket),
        "bracket, slab 14.9994 mm as published": deviations(rows, "bracket", bracket, JetpackBracket.as_published),
        "forearm support, sharp as published": deviations(rows, "forearm", forearm, ForearmJetSupport.as_published),
        "forearm support, with fillets": deviations(rows, "forearm", forearm, ForearmJetSupport),
    }
    print("| part | rows | mass, largest deviation | mass, mean | sorted principal moments, largest |")
    print("| --- | --- | --- | --- | --- |")
    for name, table in cases.items():
        mass = table[:, 1]
        worst = np.abs(mass).max()
        print(f"| {name} | {len(table)} | {worst:.4%} | {mass.mean():+.4%} | {table[:, 2].max():.4%} |")
    print("\n| bracket angle, slab 15 mm | rows | mass, largest deviation | moments, largest |")
    print("| --- | --- | --- | --- |")
    table = cases["bracket, slab 15 mm"]
    for low, high in ((1, 4), (5, 9), (10, 29), (30, 59), (60, 89)):
        band = table[(table[:, 0] >= low) & (table[:, 0] <= high)]
        if len(band):
            print(f"| {low} … {high} | {len(band)} | {np.abs(band[:, 1]).max():.4%} | {band[:, 2].max():.4%} |")
    ratio = [ForearmJetSupport(r["offset_mm"], r["length_mm"]).seat_area * 1e6 / r["area_forearm_mm2"] for r in rows]
    worst = np.abs(np.array(ratio) - 1.0).max()
    print(f"\nLoaded face of the forearm support, {len(ratio)} rows: largest deviation {worst:.1e}")


def largest_distance(points: np.ndarray, part: Part) -> float:
    """Largest distance of points from the surface of a part [mm]."""
    solid = part.solid(EXPORT_RESOLUTION)
    corners = solid.points[solid.triangles]
    worst = 0.0
    for point in points:
        nearest = trimesh.triangles.closest_point(corners, np.broadcast_to(point, (len(corners), 3)))
        worst = max(worst, float(np.linalg.norm(nearest - point, axis=1).min()))
    return worst


def print_shape_table(folder: Path) -> None:
    parts: dict[str, Part] = {
        "optim1_bracket": JetpackBracket.as_published(1, 47.9133),
        "optim3_bracket": JetpackBracket.as_published(1, 47.9133),
        "optim1_l_forearm": ForearmJetSupport.as_published(88, 50),
        "optim3_l_forearm": ForearmJetSupport.as_published(100, 130),
    }
    print("\n| published STL | vertices | largest distance of a vertex from our surface | its volume / exact volume |")
    print("| --- | --- | --- | --- |")
    for name, part in parts.items():
        mesh = trimesh.load(folder / "parts" / f"{name}.stl")
        ratio = mesh.volume / (part.mass_properties().volume * 1e9)
        print(f"| {name} | {len(mesh.vertices)} | {largest_distance(mesh.vertices, part):.4f} mm | {ratio - 1:+.2%} |")


def main() -> None:
    default = Path(os.environ.get("CODESIGN_SHARED", REPOSITORY.parent / "shared")) / "data"
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else default
    if not folder.is_dir():
        sys.exit(f"{folder}: reference data not found (give its folder, or set CODESIGN_SHARED)")
    print_mass_table(list(published_rows(folder)))
    print_shape_table(folder)


if __name__ == "__main__":
    main()
