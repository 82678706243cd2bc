"""What `geometry.tidy` does for parts whose mesher collapses tiny edges as well: table of a decision.

    python benchmarks/tidied_surfaces.py [--designs 8]

Each part of Sobol' designs of the shipped study is analyzed from its surface as tidied and as the booleans leave it.
The second ones show what the mesher's own simplification makes of the same flaws.
"""

from __future__ import annotations

import argparse
import time
from typing import Any
from unittest import mock

import numpy as np

import codesign
from codesign import _core
from codesign.chain.chain import stress_settings
from codesign.geometry.solid import Solid
from codesign.parts.load_case import part_case
from codesign.search.sampling import start_points


def lowest_height(surface: _core.fem.SurfaceMesh) -> float:
    """Smallest height of a triangle [m]."""
    a, b, c = (surface.points[surface.triangles[:, k]] for k in range(3))
    longest = np.max([np.linalg.norm(side, axis=1) for side in (b - a, c - b, a - c)], axis=0)
    return float(np.min(np.linalg.norm(np.cross(b - a, c - a), axis=1) / longest))


def row(part: Any, settings: Any) -> tuple[float, int, int, float, float]:
    """Lowest triangle [mm], edges that the mesher collapses, elements, safety factor, CPU seconds."""
    start = time.process_time()
    case = part_case(part, settings)
    analysis = _core.analyze_part(case)
    seconds = time.process_time() - start
    report = analysis.mesh.report
    height, elements = lowest_height(case.surface) * 1e3, len(analysis.mesh.tets)
    return height, report.collapsed, elements, analysis.result.safety_factor, seconds


def main() -> None:
    """One row per part and design, both ways."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--designs", type=int, default=8)
    arguments = parser.parse_args()
    study = codesign.load_study("ironcub_paper")
    print("| part | lowest triangle, mm | edges collapsed by the mesher | elements | safety factor | CPU, s |")
    print("| --- | --- | --- | --- | --- | --- |")
    for grid in start_points(study.space, arguments.designs, "sobol", 1):
        for name, part in study.build_parts(study.space.from_indices(grid)).items():
            settings = stress_settings(study.config, name)
            tidied = row(part, settings)
            with mock.patch.object(Solid, "tidied", lambda solid: solid):
                raw = row(part, settings)
            cells = (f"{ours:.6g} / {bare:.6g}" for ours, bare in zip(tidied, raw, strict=True))
            print(f"| {name} | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main()
