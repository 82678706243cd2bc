"""Builds both parts on their whole grids and checks every surface; prints the table kept in docs/parts.md.

python benchmarks/fem/parts_grid.py [every k-th design, 1 if omitted]
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterable
from itertools import product

import numpy as np

from codesign.parts.part import Part
from codesign.parts.surface import SurfaceMesh
from codesign.studies.ironcub.bracket import JetpackBracket
from codesign.studies.ironcub.forearm import ForearmJetSupport

BRACKETS = list(product(range(1, 80), range(40, 101, 2)))  # angle [deg], distance [mm]
FOREARMS = list(product(range(80, 121, 2), range(50, 151, 2)))  # offset, length [mm]


def quality(surface: SurfaceMesh) -> tuple[bool, float, float]:
    """Whether every edge is used once in each direction; shortest edge and smallest triangle height [mm]."""
    triangles = np.asarray(surface.triangles)
    edges = np.concatenate([triangles[:, [k, (k + 1) % 3]] for k in range(3)]).astype(np.int64)
    forward, backward = (np.sort(edges[:, a] * len(surface.points) + edges[:, b]) for a, b in ((0, 1), (1, 0)))
    closed = len(np.unique(forward)) == len(forward) and np.array_equal(forward, backward)
    corners = np.asarray(surface.points)[triangles] * 1e3
    sides = np.roll(corners, -1, axis=1) - corners
    length = np.linalg.norm(sides, axis=2)
    height = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1) / length.max(axis=1)
    return closed, float(length.min()), float(height.min())


def sweep(name: str, designs: Iterable[tuple[float, float]], build: Callable[[float, float], Part]) -> None:
    variants: dict[str, Callable[[Part], SurfaceMesh]] = {
        "as made": lambda part: part.surface(),
        "as analyzed in the optimization": lambda part: part.fem_surface("simplified"),
    }
    for variant, make in variants.items():
        count, seconds, open_, edge, height, slowest = 0, 0.0, 0, np.inf, np.inf, 0.0
        for theta in designs:
            start = time.process_time()
            surface = make(build(*theta))
            spent = time.process_time() - start
            seconds, slowest, count = seconds + spent, max(slowest, spent), count + 1
            closed, shortest, lowest = quality(surface)
            open_, edge, height = open_ + (not closed), min(edge, shortest), min(height, lowest)
        cells = (count, open_, f"{1e3 * seconds / count:.1f} ms", f"{1e3 * slowest:.0f} ms")
        print("|", " | ".join(map(str, (f"{name}, {variant}", *cells, f"{edge:.3f} mm", f"{height:.4f} mm"))), "|")


def main() -> None:
    step = int(sys.argv[1]) if len(sys.argv) > 1 else 1
    titles = ("surface", "designs", "not closed", "CPU time, mean", "slowest", "shortest edge", "lowest height")
    print("|", " | ".join(titles), "|")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    sweep("bracket", BRACKETS[::step], JetpackBracket)
    sweep("forearm support", FOREARMS[::step], ForearmJetSupport)


if __name__ == "__main__":
    main()
