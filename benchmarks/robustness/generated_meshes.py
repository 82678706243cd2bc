"""Meshes of generated parts at default settings: topology, volume, displacement against a refined mesh.

    python benchmarks/robustness/generated_meshes.py --parts 300 --out generated.jsonl
    python benchmarks/robustness/generated_meshes.py --kind plates --parts 60 --out plates.jsonl
    python benchmarks/robustness/generated_meshes.py --kind series --out series.jsonl
    python benchmarks/robustness/generated_meshes.py --table generated.jsonl
    python benchmarks/robustness/generated_meshes.py --seeds 106,191,207 --most 0 --out generated.jsonl
    python benchmarks/robustness/generated_meshes.py --reference earlier.jsonl --out generated.jsonl

Writes a line of JSON for each part as it goes and skips what the file has already. A part is clamped at x = 0 and
pushed down on its top faces. After all parts have their mesh, displacements are compared with those of refined meshes,
the smallest first: all edge lengths times 0.6, or less until there are at least four times the elements; at most about
`--most` of them, so that parts with large meshes have no comparison (1100000 compares all, in hours). `--seeds` runs
only these, again if known. `--reference` is a log of an earlier revision: where its refined mesh has at least four
times the elements of today's mesh, its displacement is taken; parts and their names are those of the same scripts.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np
from generated_parts import GeneratedPart, generate
from thin_parts import ROUND, series, thin_plate

from codesign import fem
from codesign.errors import CodesignError

STEEL = fem.Material("steel", 210e9, 0.3, 250e6, 7850.0)
FINER = 0.6  # edge lengths of the refined mesh, relative
TIMES = 4.0  # its elements, at least
MEMORY = 12e9  # bytes that the solution of a refined mesh may take
Part = Callable[[], GeneratedPart]
Line = dict[str, Any]


def components(joins: np.ndarray, count: int) -> int:
    """Groups of `count` items that pairs (n, 2) join."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    graph = coo_matrix((np.ones(len(joins)), joins.T), shape=(count, count))
    return int(connected_components(graph, directed=False)[0])


def surface_topology(triangles: np.ndarray) -> tuple[int, int]:
    """Closed pieces and Euler characteristic of a surface."""
    points, t = np.unique(triangles, return_inverse=True)
    edges = np.unique(np.sort(t.reshape(-1, 3)[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0)
    return components(edges, len(points)), len(points) - len(edges) + len(triangles)


def solid_topology(tets: np.ndarray) -> tuple[int, int]:
    """Closed pieces and Euler characteristic of the boundary of tetrahedra (n, 4), counted apart from the mesher.

    Twice the characteristic of the solid, in which points and edges count once for each group of tetrahedra about them
    that hang together by sides: where the boundary touches itself, the solid does not.
    """
    count, sides = len(tets), np.array([[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]])
    order = np.argsort(tets, axis=1)
    tets = np.take_along_axis(tets, order, axis=1)
    all_sides = tets[:, sides].reshape(-1, 3)
    unique, which, uses = np.unique(all_sides, axis=0, return_inverse=True, return_counts=True)
    by_side = np.argsort(which.ravel(), kind="stable")
    first = np.concatenate([[0], np.cumsum(uses)[:-1]])[uses == 2]
    one, other = by_side[first], by_side[first + 1]  # the same side of two tetrahedra, its points in the same order
    pairs = np.array([(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)])
    number = {tuple(pair): k for k, pair in enumerate(pairs)}
    edges = np.array([[number[(s[0], s[1])], number[(s[0], s[2])], number[(s[1], s[2])]] for s in sides.tolist()])

    def joined(of_side: np.ndarray, each: int) -> int:
        ends = [each * (x // 4)[:, None] + of_side[x % 4] for x in (one, other)]
        return components(np.stack(ends, axis=-1).reshape(-1, 2), each * count)

    euler = joined(sides, 4) - joined(edges, 6) + len(unique) - count
    return surface_topology(all_sides[uses[which.ravel()] == 1])[0], 2 * euler


def displacement(mesh: fem.TetMesh) -> float:
    """Largest one [m] under 100 N, clamped at the smallest x."""
    lower, upper = mesh.nodes.min(axis=0), mesh.nodes.max(axis=0)
    thin = 1e-9 + 1e-6 * np.linalg.norm(upper - lower)
    held = fem.faces_in_box(lower - thin, [lower[0] + thin, upper[1] + thin, upper[2] + thin])
    pushed = fem.faces_with_normal([0.0, 0.0, 1.0])
    load = fem.Force(pushed, [0.0, 0.0, -100.0])
    result = fem.solve_static(mesh, STEEL, [fem.Support(held)], [load], memory_limit=MEMORY)
    return float(result.max_displacement)


def examine(part: GeneratedPart) -> Line:
    """What a part is, and what its mesh is like."""
    surface = part.surface()
    line: Line = {"name": part.name, "wall_mm": part.wall, "error": None, "refined": None}
    start = time.process_time()
    try:
        mesh = fem.tetrahedralize(surface)
    except CodesignError as error:
        return line | {"error": str(error), "mesh_s": time.process_time() - start}
    line["mesh_s"] = time.process_time() - start
    wanted, found = surface_topology(surface.triangles), solid_topology(mesh.tets[:, :4])
    volume = fem.mass_properties(surface, 1.0).volume
    return line | {
        "same_topology": wanted == found,
        "genus": found[0] - found[1] // 2,
        "pieces": found[0],
        "tetrahedra": len(mesh.tets),
        "refinements": mesh.report.refinements,
        "small_faults": mesh.report.small_faults,
        "volume_error": mesh.quality.volume / volume - 1.0,
        "distance_mm": 1e3 * mesh.report.surface_distance,
    }


def refined_mesh(surface: fem.SurfaceMesh, size: fem.SizeField, tetrahedra: int) -> fem.TetMesh:
    """With at least TIMES as many elements."""
    scale = FINER
    while len((mesh := fem.tetrahedralize(surface, size.scaled(scale))).tets) < TIMES * tetrahedra:
        scale *= 0.97 * (len(mesh.tets) / tetrahedra / TIMES) ** (1.0 / 3.0)
    return mesh


def compare(part: GeneratedPart, known: Line | None = None) -> Line:
    """Displacements at default settings and with the refined mesh, or a `known` one if it has enough elements."""
    surface = part.surface()
    size = fem.default_size(surface)
    coarse = fem.tetrahedralize(surface, size)
    line: Line = {"tetrahedra": len(coarse.tets), "displacement_mm": 1e3 * displacement(coarse)}
    if known and known.get("tetrahedra", 0) >= TIMES * len(coarse.tets):
        return line | {"refined": known | {"earlier": True}}
    try:
        mesh = refined_mesh(surface, size, len(coarse.tets))
        refined = {"tetrahedra": len(mesh.tets), "displacement_mm": 1e3 * displacement(mesh)}
    except CodesignError as error:
        refined = {"error": str(error)}
    return line | {"refined": refined}


def is_compared(line: Line) -> bool:
    """Whether a refined mesh has enough elements, or was refused."""
    refined = line["refined"]
    return refined is not None and refined.get("tetrahedra", np.inf) >= TIMES * line["tetrahedra"]


def differences(lines: list[Line]) -> dict[str, float]:
    """Displacement relative to that of the refined mesh, less one, by part."""
    return {
        line["part"]: line["displacement_mm"] / line["refined"]["displacement_mm"] - 1.0
        for line in lines
        if "displacement_mm" in (line["refined"] or {}) and is_compared(line)
    }


def off_volume(line: Line) -> bool:
    """Whether a volume is off by more than 0.2 %, or 0.5 % where the part has round features."""
    return bool(abs(line["volume_error"]) > (5e-3 if any(word in line["name"] for word in ROUND) else 2e-3))


def summary(lines: list[Line]) -> str:
    """A table of the whole run, then the parts that stand out."""
    meshed = [line for line in lines if line["error"] is None]
    off = differences(meshed)
    largest = max(off, key=lambda part: abs(off[part]), default=None)
    times = [line["refined"]["tetrahedra"] / line["tetrahedra"] for line in meshed if line["part"] in off]
    rows = {
        "parts": len(lines),
        "refused": len(lines) - len(meshed),
        "refused without a place": sum("near (" not in (line["error"] or "near (") for line in lines),
        "other topology": sum(not line["same_topology"] for line in meshed),
        "with small faults": sum(line["small_faults"] > 0 for line in meshed),
        "refined to keep it": sum(line["refinements"] > 0 for line in meshed),
        "largest volume error": f"{100 * max(abs(line['volume_error']) for line in meshed):.3f} %",
        "volume off (0.2 %; round 0.5 %)": sum(map(off_volume, meshed)),
        "compared with a refined mesh": len(off),
        "its elements, relative": f"{min(times):.1f} to {max(times):.1f}" if times else "-",
        "displacement more than 1, 2, 3 % off": ", ".join(
            str(sum(abs(x) > limit for x in off.values())) for limit in (0.01, 0.02, 0.03)
        ),
        "largest difference": f"{100 * off[largest]:+.2f} % ({largest})" if largest else "-",
        "median elements": int(np.median([line["tetrahedra"] for line in meshed])),
        "most elements": max(line["tetrahedra"] for line in meshed),
        "meshing, CPU, mean": f"{np.mean([line['mesh_s'] for line in lines]):.2f} s",
        "meshing, CPU, longest": f"{max(line['mesh_s'] for line in lines):.1f} s",
    }
    odd = [
        f"{line['part']}: {line['name']}: {line['error'] or (line['refined'] or {}).get('error') or line}"
        for line in lines
        if line["error"]
        or not line["same_topology"]
        or off_volume(line)
        or "error" in (line.get("refined") or {})
        or abs(off.get(line["part"], 0.0)) > 0.02
    ]
    return "\n".join([f"| {name} | {value} |" for name, value in rows.items()] + odd)


def read_lines(file: Path) -> dict[str, Line]:
    """What a run has written so far, by part; a later line completes an earlier one."""
    lines: dict[str, Line] = {}
    for text in file.read_text().splitlines() if file.exists() else []:
        line = json.loads(text)
        lines[line["part"]] = lines.get(line["part"], {"refined": None}) | line
    return lines


def parts_of(kind: str, seeds: Iterable[int]) -> dict[str, Part]:
    """The parts of a kind by their name in the file."""
    if kind == "series":
        return {part.name: lambda part=part: part for part in series()}  # type: ignore[misc]
    make = {"generated": generate, "plates": thin_plate}[kind]
    return {f"seed {seed}": lambda seed=seed: make(seed) for seed in seeds}  # type: ignore[misc]


def run(parts: dict[str, Part], out: Path, most: int, again: bool, earlier: dict[str, Line]) -> None:
    """Meshes of the parts that the file lacks, or of all `again`, then refined ones, the smallest first.

    Refined meshes of `earlier` lines are used where they are fine enough, whatever their size.
    """

    def write(part: str, line: Line) -> None:
        with out.open("a") as file:
            file.write(json.dumps({"part": part} | line) + "\n")

    for part, make in parts.items():
        if again or part not in read_lines(out):
            write(part, examine(make()))
    meshed = [line for part, line in read_lines(out).items() if part in parts and line["error"] is None]
    for line in sorted(meshed, key=lambda line: line["tetrahedra"]):
        known = earlier.get(line["part"], {}).get("refined") or {}
        small = line["tetrahedra"] / FINER**3 <= most
        if not is_compared(line) and (small or known.get("tetrahedra", 0) >= TIMES * line["tetrahedra"]):
            write(line["part"], compare(parts[line["part"]](), known))


def main() -> None:
    """Runs the parts that the file lacks, then prints the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kind", choices=("generated", "plates", "series"), default="generated")
    parser.add_argument("--parts", type=int, default=300)
    parser.add_argument("--seeds", help="numbers with commas: these instead, again if known")
    parser.add_argument("--most", type=int, default=220_000, help="elements of a refined mesh that is solved")
    parser.add_argument("--reference", type=Path, help="log of an earlier revision: its refined meshes, if fine enough")
    parser.add_argument("--out", type=Path, default=Path("generated.jsonl"))
    parser.add_argument("--table", type=Path)
    options = parser.parse_args()
    if options.table is None:
        seeds = map(int, options.seeds.split(",")) if options.seeds else range(options.parts)
        earlier = read_lines(options.reference) if options.reference else {}
        run(parts_of(options.kind, seeds), options.out, options.most, options.seeds is not None, earlier)
    print(summary(list(read_lines(options.table or options.out).values())))


if __name__ == "__main__":
    main()
