"""Meshes of generated parts at default settings: topology, volume, displacement against a refined mesh.

    python benchmarks/robustness/generated_meshes.py --parts 300 --out generated.jsonl
    python benchmarks/robustness/generated_meshes.py --table generated.jsonl

Writes a line of JSON for each part as it goes and skips those that the file has already. The part is clamped at x = 0
and pushed down on its top faces. The refined mesh has all edge lengths times 0.6, which is 4.6 times the elements;
parts whose refined mesh would be too large have none (`refined` is null).
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path
from typing import Any

import numpy as np
from generated_parts import GeneratedPart, generate

from codesign import fem
from codesign.errors import CodesignError

STEEL = fem.Material("steel", 210e9, 0.3, 250e6, 7850.0)
FINER = 0.6  # edge lengths of the refined mesh, relative
MOST_REFINED = 220_000  # elements of a refined mesh that are solved
TOLERANCE = 0.03  # of the displacement


def genus_of(triangles: np.ndarray) -> tuple[int, int, int]:
    """Closed pieces, total genus and edges without exactly two triangles, counted apart from the mesher."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    points, t = np.unique(triangles, return_inverse=True)
    t = t.reshape(-1, 3)
    edges = np.sort(np.vstack([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]]), axis=1)
    edges, uses = np.unique(edges, axis=0, return_counts=True)
    graph = coo_matrix((np.ones(len(edges)), edges.T), shape=(len(points), len(points)))
    pieces, _ = connected_components(graph, directed=False)
    euler = len(points) - len(edges) + len(t)
    return int(pieces), (2 * int(pieces) - euler) // 2, int((uses != 2).sum())


def displacement(mesh: fem.TetMesh) -> float:
    """Largest one [m] under 100 N, clamped at the smallest x."""
    lower, upper = mesh.nodes.min(axis=0), mesh.nodes.max(axis=0)
    thin = 1e-9 + 1e-6 * np.linalg.norm(upper - lower)
    held = fem.faces_in_box(lower - thin, [lower[0] + thin, upper[1] + thin, upper[2] + thin])
    pushed = fem.faces_with_normal([0.0, 0.0, 1.0])
    result = fem.solve_static(mesh, STEEL, [fem.Support(held)], [fem.Force(pushed, [0.0, 0.0, -100.0])])
    return float(result.max_displacement)


def finer(surface: fem.SurfaceMesh) -> fem.TetMesh:
    """The part with all default edge lengths times FINER."""
    return fem.tetrahedralize(surface, fem.default_size(surface).scaled(FINER), time_limit=60.0)


def examine(seed: int) -> dict[str, Any]:
    """One part: what it is, what its mesh is like, and how far its displacement is off."""
    part: GeneratedPart = generate(seed)
    surface = part.surface()
    line: dict[str, Any] = {"seed": seed, "name": part.name, "wall_mm": part.wall, "error": None}
    start = time.process_time()
    try:
        mesh = fem.tetrahedralize(surface)
    except CodesignError as error:
        return line | {"error": str(error), "mesh_s": time.process_time() - start}
    line["mesh_s"] = time.process_time() - start
    wanted, found = genus_of(surface.triangles), genus_of(mesh.boundary[:, :3])
    volume = fem.mass_properties(surface, 1.0).volume
    line |= {
        "same_topology": wanted == found,
        "genus": found[1],
        "pieces": found[0],
        "tetrahedra": len(mesh.tets),
        "refinements": mesh.report.refinements,
        "volume_error": mesh.quality.volume / volume - 1.0,
        "distance_mm": 1e3 * mesh.report.surface_distance,
        "displacement_mm": None,
        "refined": None,
    }
    line["displacement_mm"] = 1e3 * displacement(mesh)
    line["solve_s"] = time.process_time() - start - line["mesh_s"]
    if len(mesh.tets) / FINER**3 <= MOST_REFINED:
        try:
            refined = finer(surface)
            line["refined"] = {"tetrahedra": len(refined.tets), "displacement_mm": 1e3 * displacement(refined)}
        except CodesignError as error:
            line["refined"] = {"error": str(error)}
    return line


def summary(lines: list[dict[str, Any]]) -> str:
    """A table of the whole run."""
    meshed = [line for line in lines if line["error"] is None]
    off = [
        abs(line["displacement_mm"] / line["refined"]["displacement_mm"] - 1.0)
        for line in meshed
        if line["refined"] and "error" not in line["refined"]
    ]
    rows = {
        "parts": len(lines),
        "refused": len(lines) - len(meshed),
        "refused without a place": sum("near (" not in (line["error"] or "near (") for line in lines),
        "other topology": sum(not line["same_topology"] for line in meshed),
        "refined to keep it": sum(line["refinements"] > 0 for line in meshed),
        "largest volume error": f"{100 * max(abs(line['volume_error']) for line in meshed):.3f} %",
        "compared with a refined mesh": len(off),
        f"displacement more than {100 * TOLERANCE:.0f} % off": sum(x > TOLERANCE for x in off),
        "largest difference": f"{100 * max(off):.2f} %" if off else "-",
        "median elements": int(np.median([line["tetrahedra"] for line in meshed])),
        "most elements": max(line["tetrahedra"] for line in meshed),
        "meshing, mean": f"{np.mean([line['mesh_s'] for line in lines]):.2f} s",
        "meshing, longest": f"{max(line['mesh_s'] for line in lines):.1f} s",
    }
    return "\n".join(f"| {name} | {value} |" for name, value in rows.items())


def read_lines(file: Path) -> list[dict[str, Any]]:
    """What a run has written so far."""
    return [json.loads(text) for text in file.read_text().splitlines()] if file.exists() else []


def main() -> None:
    """Runs the parts that the file lacks, then prints the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--parts", type=int, default=300)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--out", type=Path, default=Path("generated.jsonl"))
    parser.add_argument("--table", type=Path)
    options = parser.parse_args()
    if options.table is None:
        done = {line["seed"] for line in read_lines(options.out)}
        for seed in range(options.first, options.first + options.parts):
            if seed in done:
                continue
            with options.out.open("a") as file:
                file.write(json.dumps(examine(seed)) + "\n")
    print(summary(read_lines(options.table or options.out)))


if __name__ == "__main__":
    main()
