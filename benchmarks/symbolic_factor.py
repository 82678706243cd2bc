"""Symbolic factorization of a part's nodes by ours, and of its equations by cholmod_analyze_p; table of a decision.

    cmake --build build/python --target benchmark_symbolic_factor
    python benchmarks/symbolic_factor.py [--program build/python/benchmarks/benchmark_symbolic_factor] [--repeats 7]

The order of the equations is the same for both; the shares refer to the CPU time of the whole analysis of the part:
mesh, order, stiffness, factor, solution, stress. All times are the least of the repeats.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np

import codesign
from codesign import _core
from codesign.chain.chain import stress_settings
from codesign.parts.load_case import part_case

DESIGNS = (
    {"angle": 15, "distance": 42, "offset": 80, "length": 108},
    {"angle": 60, "distance": 60, "offset": 100, "length": 150},
)
BUILT = Path(__file__).resolve().parents[1] / "build/python/benchmarks/benchmark_symbolic_factor"


def write_model(mesh: _core.fem.TetMesh, case: _core.PartCase, path: Path) -> None:
    """Nodes [m], elements and held components (0, 1) of a model as text."""
    fixed = np.zeros((len(mesh.nodes), 3), dtype=int)
    for support in case.supports:
        nodes = _core.fem.selected_nodes(mesh, support.where)
        fixed[nodes] |= np.array(support.fixed, dtype=int)
    with path.open("w") as file:
        file.write(f"{len(mesh.nodes)} {len(mesh.tets)}\n")
        np.savetxt(file, mesh.nodes, "%.17g")
        np.savetxt(file, mesh.tets, "%d")
        np.savetxt(file, fixed, "%d")


def whole(case: _core.PartCase, repeats: int) -> tuple[_core.PartAnalysis, float]:
    """Analysis of a part and its CPU seconds."""
    seconds = []
    for _ in range(repeats):
        start = time.process_time()
        analysis = _core.analyze_part(case)
        seconds.append(time.process_time() - start)
    return analysis, min(seconds)


def main() -> None:
    """One row per part: seconds of both, and what the own one saves of the part's time."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=Path, default=BUILT)
    parser.add_argument("--repeats", type=int, default=7)
    given = parser.parse_args()
    study = codesign.load_study("ironcub_paper")
    print("| part | equations | part, s | analysis, s | factor, s | solve, s | entries | saved | difference |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    for design in DESIGNS:
        for name, part in study.build_parts(design).items():
            case = part_case(part, stress_settings(study.config, name))
            analysis, seconds = whole(case, given.repeats)
            with tempfile.TemporaryDirectory() as folder:
                write_model(analysis.mesh, case, Path(folder) / "model")
                command = [str(given.program), f"{folder}/model", str(given.repeats)]
                row = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout)
            both = [row["ours"], row["cholmod"]]
            totals = [times["analysis"] + times["factor"] + times["solve"] for times in both]
            cells = [" / ".join(f"{times[key]:.4f}" for times in both) for key in ("analysis", "factor", "solve")]
            entries = " / ".join(f"{times['entries'] / 1e6:.2f} M" for times in both)
            print(
                f"| {name} | {row['equations']} | {seconds:.3f} | {' | '.join(cells)} | {entries} "
                f"| {(totals[1] - totals[0]) / seconds:+.1%} | {row['difference']:.1e} |",
                flush=True,
            )


if __name__ == "__main__":
    main()
