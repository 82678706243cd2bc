"""Share of the true front that searches find with few evaluations, on a stand-in made from a run.

  codesign optimize --population 25 --generations 40 --seed 1 --out runs/paper
  python benchmarks/optimizer/surrogate_share.py runs/paper --least 13.5

Prints, for every search and budget, median and least over the seeds of the hypervolume found over that of the true
front, in two boxes: tight (reference: worst values of the true front and a tenth of its range) and wide (componentwise
the worse of that and of the median of random designs that fly); and the processor time of the proposals. Searches know
neither. --least: the least safety factor, such that it cuts off a part of the front.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path

import numpy as np
from from_run import Array, RunStandIn
from pymoo.indicators.hv import Hypervolume

from codesign.problem.evaluation import Evaluation
from codesign.problem.pareto import non_dominated, objective_rows
from codesign.search.settings import Settings

MARGIN = 0.1


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=Path)
    parser.add_argument("--least", type=float)
    parser.add_argument("--algorithms", nargs="+", default=["surrogate", "nsga2", "random"])
    parser.add_argument("--options", type=json.loads, default={}, help="of the surrogate search, JSON")
    parser.add_argument("--population", type=int, default=20)
    parser.add_argument("--evaluations", type=int, nargs="+", default=[50, 100, 150, 200])
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--out", type=Path, default=Path("runs/surrogate-share"), help="where the true front is kept")
    given = parser.parse_args()
    problem = RunStandIn(given.run, given.least)
    front = problem.true_front(given.out)
    span = np.ptp(front, axis=0)
    tight = front.max(axis=0) + MARGIN * span
    wide = np.maximum(tight, problem.typical())
    boxes = {"tight": (front.min(axis=0), tight), "wide": (front.min(axis=0), wide)}
    print(f"true front: {len(front)} designs; references: tight {tight}, wide {wide}")
    print("algorithm | box   | " + " | ".join(f"{n:>11d}" for n in given.evaluations) + " | s of CPU")
    for algorithm in given.algorithms:
        results, seconds = [], []
        for seed in range(1, given.seeds + 1):
            began = time.process_time()
            results.append(search(problem, algorithm, seed, given))
            seconds.append(time.process_time() - began)
        for name, (ideal, reference) in boxes.items():
            whole = volume(front, ideal, reference)
            shares = [
                [volume(objective_rows(run[:n], problem.objectives), ideal, reference) / whole for run in results]
                for n in given.evaluations
            ]
            cells = [f"{np.median(values):.3f}/{min(values):.3f}" for values in shares]
            print(f"{algorithm:9s} | {name:5s} | " + " | ".join(cells) + f" | {np.median(seconds):.1f}", flush=True)


def search(problem: RunStandIn, algorithm: str, seed: int, given: argparse.Namespace) -> list[Evaluation]:
    """Evaluations of one search, in its order."""
    budget = max(given.evaluations)
    settings = Settings(
        algorithm=algorithm,
        population=given.population,
        evaluations=budget,
        seed=seed,
        options=given.options if algorithm == "surrogate" else {},
    )
    plan = settings.plan(problem.space, problem.objectives)
    found: list[Evaluation] = []
    while len(found) < budget:
        size = (plan.schedule.batch or plan.schedule.first) if found else plan.schedule.first
        grids = plan.search.ask(min(size, budget - len(found)))
        results = [problem.evaluate(grid) for grid in grids]
        plan.search.tell(grids, results)
        found += results
    return found


def volume(values: Array, ideal: Array, reference: Array) -> float:
    """Hypervolume of (n, objectives) values in a box, in units of the box."""
    inside = values[(values < reference).all(axis=1)]
    if not len(inside):
        return 0.0
    scaled = (inside[non_dominated(inside)] - ideal) / (reference - ideal)
    return float(Hypervolume(ref_point=np.ones(len(ideal)))(scaled))


if __name__ == "__main__":
    main()
