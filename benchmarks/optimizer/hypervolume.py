"""NSGA-II (or another algorithm) against random search with the same number of evaluations, several seeds.

  python benchmarks/optimizer/hypervolume.py --study ironcub_paper --population 25 --generations 40 --seeds 5
  python benchmarks/optimizer/hypervolume.py --study smooth            (or rugged, broken: analytic, seconds)

Prints a line a seed: hypervolume of both fronts in one box (front.Hypervolume over all designs of all runs). Runs are
kept in --out and continued if they exist; designs that another run evaluated come from the study's cache.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
from standin import PROBLEMS, standin

from codesign.problem.pareto import Hypervolume, objective_rows
from codesign.problem.protocols import Problem
from codesign.search.optimization import load_problem, optimize, resume
from codesign.storage.database import DATABASE
from codesign.storage.runs import Run


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--study", default="smooth")
    parser.add_argument("--algorithms", nargs="+", default=["nsga2", "random"])
    parser.add_argument("--population", type=int, default=25)
    parser.add_argument("--generations", type=int, default=40)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--steady", action="store_true")
    parser.add_argument("--out", type=Path, default=Path("runs/hypervolume"))
    given = parser.parse_args()
    study: Problem = standin(problem=given.study) if given.study in PROBLEMS else load_problem(given.study)
    runs = {
        (seed, algorithm): one(study, algorithm, seed, given)
        for seed in range(1, given.seeds + 1)
        for algorithm in given.algorithms
    }
    box = Hypervolume(np.vstack([objective_rows(run.evaluations, run.objectives) for run in runs.values()]))
    print("seed | " + " | ".join(f"{name:>10s}" for name in given.algorithms) + "   hypervolume")
    for seed in range(1, given.seeds + 1):
        values = [box.of(front(runs[seed, algorithm])) for algorithm in given.algorithms]
        print(f"{seed:4d} | " + " | ".join(f"{value:10.4f}" for value in values))


def one(study: Problem, algorithm: str, seed: int, given: argparse.Namespace) -> Run:
    out = given.out / f"{study.name}-{study.hash}-{algorithm}-{seed}{'-steady' * given.steady}"
    if (out / DATABASE).exists():
        return resume(out, study=study, workers=given.workers)
    size = {"population": given.population, "generations": given.generations}
    return optimize(study, out=out, algorithm=algorithm, seed=seed, workers=given.workers, steady=given.steady, **size)


def front(run: Run) -> np.ndarray:
    return objective_rows((record.evaluation for record in run.front), run.objectives)


if __name__ == "__main__":
    main()
