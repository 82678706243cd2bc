"""Error estimate of the peak stress against the true error, on designs spread over the grid; tables of docs/fem.md.

python benchmarks/fem/stress_error.py [--every 1] [--factor 1.0] [--random 40]

True error: difference from the fine mesh with half its edge length around the peak. factor: on the analyzed edge
lengths. random: so many designs of each part's grid (Sobol' points) instead, and how large their errors are.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import replace

import numpy as np
from scipy.stats import qmc

import codesign
from codesign import _core, fem
from codesign.chain.chain import stress_settings
from codesign.errors import GeometryError
from codesign.parts.load_case import StressSettings
from codesign.parts.part import Part
from codesign.studies.ironcub.bracket import JetpackBracket
from codesign.studies.ironcub.forearm import ForearmJetSupport

BRACKETS = [
    (1, 48),
    (10, 100),
    (15, 42),
    (25, 80),
    (33, 40),
    (40, 60),
    (60, 60),
    (79, 100),
]  # angle [deg], distance [mm]
FOREARMS = [
    (80, 50),
    (80, 108),
    (88, 50),
    (94, 130),
    (100, 150),
    (110, 50),
    (120, 100),
    (120, 150),
]  # offset, length [mm]
MEGA = 1e6


def reference(part: Part, settings: StressSettings) -> _core.PartAnalysis:
    """On the fine mesh, halved around the peak whatever its estimate."""
    case = part.stress_case(replace(settings, accuracy="fine"))  # type: ignore[attr-defined]
    case.tolerance, case.max_refinements = 1e-9, 1
    return _core.analyze_part(case)


def row(part: Part, settings: StressSettings, factor: float) -> tuple[float, bool]:
    """Prints one design; its true relative error, and whether that lies inside the estimate."""
    start = time.process_time()
    case = part.stress_case(settings)  # type: ignore[attr-defined]
    sources = [fem.SizeSource(s.points, factor * s.size, s.growth, s.radius) for s in case.size.sources]
    case.size = fem.SizeField(case.size.base, sources)
    analyzed = _core.analyze_part(case)
    seconds = time.process_time() - start
    result, exact = analyzed.result, reference(part, settings).result
    deviation = result.peak_stress / exact.peak_stress - 1.0
    estimate = result.stress_error / result.peak_stress
    holds = abs(result.peak_stress - exact.peak_stress) <= result.stress_error
    values = "×".join(f"{value:g}" for value in part.parameters.values())
    print(
        f"| {part.name} {values} | {result.peak_stress / MEGA:.2f} | {exact.peak_stress / MEGA:.2f} "
        f"| {100 * deviation:+.1f} % | {100 * estimate:.1f} % | {'yes' if holds else 'NO'} "
        f"| {100 * exact.stress_error / exact.peak_stress:.1f} % | {seconds:.2f} |",
        flush=True,
    )
    return deviation, holds


def random_designs(kind: type[Part], grid: list[np.ndarray], count: int) -> list[tuple[float, float]]:
    """Sobol' points on the grid of a part's two parameters, those that are no part left out."""
    found: list[tuple[float, float]] = []
    for point in qmc.Sobol(2, seed=1).random(4 * count):
        theta = tuple(float(values[int(t * len(values))]) for values, t in zip(grid, point, strict=True))
        try:
            kind(*theta)  # type: ignore[call-arg]
        except GeometryError:
            continue
        found.append(theta)  # type: ignore[arg-type]
    return found[:count]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--factor", type=float, default=1.0)
    parser.add_argument("--random", type=int, default=0)
    options = parser.parse_args()
    study = codesign.load_study("ironcub_paper")
    values = {v.name: np.array([v.value(i) for i in range(v.levels)], dtype=float) for v in study.space.variables}
    print("| part | peak, MPa | reference | true error | estimate | inside | estimate of the reference | CPU s |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    for kind, name, designs, grid in (
        (JetpackBracket, "jetpack_bracket", BRACKETS, ("angle", "distance")),
        (ForearmJetSupport, "forearm_support", FOREARMS, ("offset", "length")),
    ):
        settings = stress_settings(study.config, name)
        chosen = designs[:: options.every]
        if options.random:
            chosen = random_designs(kind, [values[variable] for variable in grid], options.random)
        rows = [row(kind(*theta), settings, options.factor) for theta in chosen]
        errors = 100 * np.abs([deviation for deviation, _ in rows])
        print(
            f"| {name}: {sum(holds for _, holds in rows)} of {len(rows)} inside "
            f"| | | median {np.median(errors):.2f} %, largest {errors.max():.2f} % | | | | |",
            flush=True,
        )


if __name__ == "__main__":
    main()
