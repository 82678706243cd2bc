"""How much of the true front searches find: a sub-grid is swept whole, then searched with a small budget.

  python benchmarks/optimizer/ground_truth.py --study ironcub_paper --counts 14 7 5 6 --evaluations 400 --seeds 5
  python benchmarks/optimizer/ground_truth.py --study ironcub_paper --algorithms surrogate --evaluations 150
  python benchmarks/optimizer/ground_truth.py --study smooth --counts 14 7 5 6            (analytic, a minute)

Prints a line a seed: hypervolume of the front found over that of the true front, and how many of its designs were
found. The box of the hypervolume spans all feasible designs of the sub-grid. The searches take their evaluations from
the cache that the sweep filled.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
from standin import PROBLEMS, standin

from codesign.followup.derived import coarse
from codesign.problem.pareto import Hypervolume, non_dominated, objective_rows
from codesign.search.optimization import load_problem, optimize, resume, sweep
from codesign.search.progress import ProgressBar
from codesign.storage.database import DATABASE


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--study", default="smooth")
    parser.add_argument("--counts", type=int, nargs="+", default=[14, 7, 5, 6])
    parser.add_argument("--algorithms", nargs="+", default=["nsga2", "random"])
    parser.add_argument("--population", type=int, default=25)
    parser.add_argument("--evaluations", type=int, default=400)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--out", type=Path, default=Path("runs/ground-truth"))
    given = parser.parse_args()
    study = coarse(standin(problem=given.study) if given.study in PROBLEMS else load_problem(given.study), given.counts)
    folder = given.out / f"{study.name}-{study.hash}"
    cache = folder / "cache.sqlite"
    with ProgressBar("sweep") as bar:
        if (folder / "sweep" / DATABASE).exists():
            whole = resume(folder / "sweep", workers=given.workers, progress=bar)
        else:
            whole = sweep(study, given.counts, out=folder / "sweep", workers=given.workers, cache=cache, progress=bar)
    everything = objective_rows(whole.evaluations, whole.objectives)
    box, true_front = Hypervolume(everything), everything[non_dominated(everything)]
    best = box.of(true_front)
    print(
        f"{len(whole.evaluations)} designs, {whole.counts}; true front: {len(true_front)}; wall {whole.seconds:.0f} s"
    )
    print("seed | algorithm  | share of hypervolume | front designs found")
    shares: dict[str, list[float]] = {}
    for seed in range(1, given.seeds + 1):
        for algorithm in given.algorithms:
            out = folder / f"{algorithm}-{given.evaluations}-{seed}"
            if (out / DATABASE).exists():
                run = resume(out, workers=given.workers)
            else:
                budget = {"population": given.population, "evaluations": given.evaluations}
                run = optimize(
                    study, out=out, algorithm=algorithm, seed=seed, workers=given.workers, cache=cache, **budget
                )
            found = objective_rows(run.evaluations, run.objectives)
            hits = len({tuple(row) for row in found} & {tuple(row) for row in true_front})
            shares.setdefault(algorithm, []).append(box.of(found) / best)
            print(f"{seed:4d} | {algorithm:10s} | {shares[algorithm][-1]:20.2%} | {hits}", flush=True)
    for algorithm, values in shares.items():
        print(f"{algorithm}: mean {np.mean(values):.2%}, least {min(values):.2%}")


if __name__ == "__main__":
    main()
