"""Time and memory of one static solution against the number of unknowns; plot docs/figures/fem_scaling.png.

python benchmarks/fem/scaling.py [largest number of unknowns, 300000 if omitted]

The forearm support (50, 88) with ever smaller elements; CPU seconds, one thread, mesh given.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import codesign
from codesign import _core, fem
from codesign.chain.chain import stress_settings
from codesign.studies.ironcub.forearm import ForearmJetSupport

FIGURE = Path(__file__).parents[2] / "docs" / "figures" / "fem_scaling.png"
SCALES = (2.2, 1.1, 0.7, 0.5, 0.4, 0.33, 0.28)


def scaled(size: fem.SizeField, scale: float) -> fem.SizeField:
    """All edge lengths times `scale`."""
    sources = [fem.SizeSource(s.points, scale * s.size, s.growth, s.radius) for s in size.sources]
    return fem.SizeField(scale * size.base, sources)


def solve(case: _core.PartCase, mesh: fem.TetMesh, solver: str) -> tuple[float, _core.fem.StaticResult]:
    """CPU seconds from the mesh to stress."""
    settings = case.settings
    settings.solver = getattr(_core.fem.LinearSolver, solver)
    start = time.process_time()
    result = _core.fem.StaticSystem(mesh, case.material, case.supports, settings).solve(case.cases[0].loads)
    return time.process_time() - start, result


def main() -> None:
    largest = int(sys.argv[1]) if len(sys.argv) > 1 else 300_000
    part = ForearmJetSupport(88, 50)
    case = part.stress_case(stress_settings(codesign.load_study("ironcub_paper").config, part.name))
    print("| unknowns | tetrahedra | mesh CPU s | direct, CPU s | iterative | iterations | difference | automatic |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    unknowns: list[int] = []
    whole: list[float] = []  # mesh and automatic solution
    seconds: dict[str, list[float]] = {"direct": [], "iterative": [], "automatic": []}
    for scale in SCALES:
        start = time.process_time()
        mesh = fem.tetrahedralize(case.surface, scaled(case.size, scale), facet_angle_deg=20.0)
        meshed = time.process_time() - start
        results = {}
        for solver, times in seconds.items():
            spent, results[solver] = solve(case, mesh, solver)
            times.append(spent)
        whole.append(meshed + seconds["automatic"][-1])
        direct, iterative = results["direct"], results["iterative"]
        difference = np.abs(direct.displacement - iterative.displacement).max() / direct.max_displacement
        unknowns.append(direct.equations)
        print(
            f"| {direct.equations} | {len(mesh.tets)} | {meshed:.2f} | {seconds['direct'][-1]:.2f} "
            f"| {seconds['iterative'][-1]:.2f} | {iterative.iterations} | {difference:.0e} "
            f"| {seconds['automatic'][-1]:.2f}, {'iterative' if results['automatic'].iterations else 'direct'} |",
            flush=True,
        )
        if direct.equations > largest:
            break
    figure = Figure(figsize=(6, 4), layout="constrained")
    axes = figure.add_subplot()
    for solver, times in (*seconds.items(), ("surface to stress", whole)):
        exponent, log_factor = np.polyfit(np.log(unknowns), np.log(times), 1)
        axes.loglog(unknowns, times, "o", label=f"{solver}: exponent {exponent:.2f}")
        axes.loglog(unknowns, np.exp(log_factor) * np.array(unknowns) ** exponent, color="0.7", zorder=0)
        print(f"{solver}: time grows with the power {exponent:.2f} of the unknowns")
    axes.set(xlabel="unknowns", ylabel="CPU seconds")
    axes.legend()
    FIGURE.parent.mkdir(exist_ok=True)
    figure.savefig(FIGURE, dpi=90)


if __name__ == "__main__":
    main()
