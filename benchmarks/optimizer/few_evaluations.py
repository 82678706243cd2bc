"""Searches of a study with few evaluations, against the front of one long run of it.

  codesign optimize STUDY --population 25 --generations 40 --seed 1 --out runs/paper
  python benchmarks/optimizer/few_evaluations.py STUDY runs/paper --seeds 5

Runs every algorithm with every seed (kept under --out; a second call goes on where the first one was stopped) and
prints, for each budget, median and least over the seeds of the hypervolume found over that of the long run's front.
Boxes: from the best values of that front to its worst ones and a tenth of its range (tight), to the componentwise worse
of that and of the median of all designs that the long run flew (wide), and of those that it started with (start).
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from surrogate_share import MARGIN, volume

from codesign.problem.pareto import objective_rows
from codesign.search.optimization import load_problem, optimize, resume
from codesign.storage.database import DATABASE
from codesign.storage.runs import Run, load_run

LAZY = {"surrogate", "random"}  # no proposal of these depends on numbers that are left out


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("study")
    parser.add_argument("reference", type=Path)
    parser.add_argument("--algorithms", nargs="+", default=["surrogate", "nsga2", "random"])
    parser.add_argument("--population", type=int, default=25)
    parser.add_argument("--evaluations", type=int, nargs="+", default=[50, 100, 150, 200])
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--out", type=Path, default=Path("runs/few"))
    given = parser.parse_args()
    reference = load_run(given.reference)
    front = objective_rows((record.evaluation for record in reference.front), reference.objectives)
    for name, corner in corners(reference, front).items():
        print(f"{name:5s}: {front.min(axis=0)} to {corner}")
    print("algorithm | box   | " + " | ".join(f"{n:>13d}" for n in given.evaluations))
    for algorithm in given.algorithms:
        runs = [run_of(given, algorithm, seed) for seed in range(1, given.seeds + 1)]
        for name, corner in corners(reference, front).items():
            whole = volume(front, front.min(axis=0), corner)
            found = np.array(
                [
                    [
                        volume(objective_rows(run.evaluations[:n], run.objectives), front.min(axis=0), corner)
                        for run in runs
                    ]
                    for n in given.evaluations
                ]
            )
            cells = [f"{np.median(row):6.1%}/{min(row):6.1%}" for row in found / whole]
            print(f"{algorithm:9s} | {name:5s} | " + " | ".join(cells), flush=True)


def corners(reference: Run, front: np.ndarray) -> dict[str, np.ndarray]:
    """Where each box ends."""
    flown = objective_rows(reference.evaluations, reference.objectives)
    start = objective_rows(reference.evaluations[: reference.settings["population"]], reference.objectives)
    tight = front.max(axis=0) + MARGIN * np.ptp(front, axis=0)
    return {
        "tight": tight,
        "wide": np.maximum(tight, np.median(flown, axis=0)),
        "start": np.maximum(tight, np.median(start, axis=0)),
    }


def run_of(given: argparse.Namespace, algorithm: str, seed: int) -> Run:
    """The run, from its folder if it is there."""
    out = given.out / f"{algorithm}-{seed}"
    if (out / DATABASE).exists():
        return resume(out, workers=given.workers)
    return optimize(
        load_problem(given.study),
        out=out,
        algorithm=algorithm,
        population=given.population,
        evaluations=max(given.evaluations),
        seed=seed,
        workers=given.workers,
        cache=given.out / "cache.sqlite",
        lazy=algorithm in LAZY,
    )


if __name__ == "__main__":
    main()
