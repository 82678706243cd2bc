"""What the limits of mesher and solver mean on this machine: work and seconds, memory and modes.

`python benchmarks/robustness/limits.py work`: questions of the mesher, processor seconds and vertices of blocks with
ever smaller elements, and of a step whose outline starts tangentially (0.13 degrees), which the work limit ends.

`python benchmarks/robustness/limits.py tube [EDGE_MM ...]`: a tube of 20 x 1.5 x 260 mm clamped at one end; its first
frequencies beside Timoshenko's beam, processor seconds and peak memory, each in a process of its own.
"""

from __future__ import annotations

import resource
import subprocess
import sys
import time
from itertools import pairwise

import numpy as np

from codesign import fem
from codesign.errors import MeshLimitError

ERGAL = fem.Material("ergal", 71.7e9, 0.33, 2810.0, 462e6)
OUTER, WALL, LENGTH = 20e-3, 1.5e-3, 260e-3  # m
CHORDS = 48
BOX = [(0, 2, 1), (0, 3, 2), (0, 1, 5), (0, 5, 4), (1, 2, 6), (1, 6, 5), (2, 3, 7), (2, 7, 6), (3, 0, 4), (3, 4, 7)]


def block() -> fem.SurfaceMesh:
    """60 x 20 x 5 mm."""
    rim = np.array([(0, 0), (60e-3, 0), (60e-3, 20e-3), (0, 20e-3)])
    points = np.vstack([np.c_[rim, np.full(4, z)] for z in (0.0, 5e-3)])
    return fem.SurfaceMesh(points, np.array([*BOX, (4, 5, 6), (4, 6, 7)]))


def tangential_step() -> fem.SurfaceMesh:
    """The block with a step of 0.3 mm whose outline leaves the edge of the block at 0.13 degrees."""
    away = 60e-3 * np.tan(np.radians(0.13))
    rim = [(0, 0), (60e-3, 0), (60e-3, away), (60e-3, 20e-3), (0, 20e-3)]
    low, top = [rim[0], rim[1], rim[3], rim[4]], [rim[0], *rim[2:]]
    points = [(*p, z) for level, z in ((low, 0.0), (rim, 5e-3), (top, 5.3e-3)) for p in level]
    triangles = [
        (0, 2, 1), (0, 3, 2), (0, 1, 5), (0, 5, 4), (4, 5, 6), (4, 6, 10), (4, 10, 9), (1, 2, 7), (1, 7, 6), (1, 6, 5),
        (6, 7, 11), (6, 11, 10), (2, 3, 8), (2, 8, 7), (7, 8, 12), (7, 12, 11), (3, 0, 4), (3, 4, 8), (8, 4, 9),
        (8, 9, 12), (9, 10, 11), (9, 11, 12),
    ]  # fmt: skip
    return fem.SurfaceMesh(np.array(points), np.array(triangles))


def tube() -> fem.SurfaceMesh:
    """Along x, from 0 to LENGTH; 48 chords."""
    angle = 2.0 * np.pi * np.arange(CHORDS) / CHORDS
    ring = np.c_[np.zeros(CHORDS), np.cos(angle), np.sin(angle)]
    shift = [LENGTH, 0.0, 0.0]
    outer, inner = OUTER / 2 * ring, (OUTER / 2 - WALL) * ring
    rings = [outer, outer + shift, inner + shift, inner]
    triangles = []
    for first, second in pairwise((0, 1, 2, 3, 0)):
        for k in range(CHORDS):
            a, b = first * CHORDS + k, first * CHORDS + (k + 1) % CHORDS
            c, d = second * CHORDS + k, second * CHORDS + (k + 1) % CHORDS
            triangles += [(a, b, d), (a, d, c)]
    return fem.SurfaceMesh(np.vstack(rings), np.array(triangles, dtype=np.int32))


def beam_frequency() -> float:
    """First bending frequency [Hz] of the clamped tube by Euler and Bernoulli, with Timoshenko's first correction."""
    inner = OUTER - 2.0 * WALL
    gyration2 = (OUTER**2 + inner**2) / 16.0
    wave = 1.8751**2 / LENGTH**2 * np.sqrt(gyration2 * ERGAL.young_modulus / ERGAL.density) / (2.0 * np.pi)
    shear = ERGAL.young_modulus / (0.53 * ERGAL.young_modulus / (2.0 * (1.0 + ERGAL.poisson_ratio)))
    return float(wave / np.sqrt(1.0 + 4.648 * gyration2 / LENGTH**2 * (shear + 1.0)))


def print_work() -> None:
    print("| surface | edge, mm | questions | CPU s | microseconds a question | tetrahedra |")
    print("| --- | --- | --- | --- | --- | --- |")
    for name, surface, edges in (("block", block(), (4.0, 2.0, 1.0, 0.6)), ("step", tangential_step(), (4.0,))):
        for edge in edges:
            begun = time.thread_time()
            try:
                mesh = fem.tetrahedralize(surface, edge * 1e-3, time_limit=600.0)
                work, outcome = mesh.report.questions, str(len(mesh.tets))
            except MeshLimitError as error:
                work, outcome = 0, str(error)
            seconds = time.thread_time() - begun
            each = f"{1e6 * seconds / work:.2f}" if work else ""
            print(f"| {name} | {edge:g} | {work or ''} | {seconds:.2f} | {each} | {outcome} |", flush=True)


def print_tube_of(edge_mm: float) -> None:
    begun = time.process_time()
    mesh = fem.tetrahedralize(tube(), edge_mm * 1e-3)
    meshed = time.process_time()
    case = fem.StaticSystem(mesh, ERGAL, [fem.Support(fem.faces_with_normal([-1, 0, 0]))])
    static = case.solve([fem.Force(fem.faces_with_normal([1, 0, 0]), (0.0, 0.0, -100.0))])
    solved = time.process_time()
    frequency = case.natural_frequencies(3).frequency
    ended = time.process_time()
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(
        f"| {edge_mm:g} | {len(mesh.tets)} | {static.equations} | {meshed - begun:.0f} | {solved - meshed:.0f} | "
        f"{ended - solved:.0f} | {peak:.0f} | " + ", ".join(f"{f:.3f}" for f in frequency) + " |",
        flush=True,
    )


def main(arguments: list[str]) -> None:
    if arguments[:1] == ["work"]:
        print_work()
    elif arguments[:1] == ["one"]:
        print_tube_of(float(arguments[1]))
    elif arguments[:1] == ["tube"]:
        print(f"Beam theory: {beam_frequency():.2f} Hz, twice.\n")
        print("| edge, mm | tetrahedra | equations | mesh, CPU s | static | modes | peak, MiB | frequencies, Hz |")
        print("| --- | --- | --- | --- | --- | --- | --- | --- |", flush=True)
        for edge in arguments[1:] or ["2", "1.1", "0.75"]:
            subprocess.run([sys.executable, __file__, "one", edge], check=True)
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main(sys.argv[1:])
