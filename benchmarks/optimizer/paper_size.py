"""The paper-size study from an empty cache, then again from the cache it left; where the time goes.

  python benchmarks/optimizer/paper_size.py --workers 2            (25 x 40, seed 1, shipped study)

The paper's chain took 216 s per design: 60 h for 1000. Needs a fresh --out folder.
"""

from __future__ import annotations

import argparse
import time
from collections import Counter
from pathlib import Path

from codesign.problem.pareto import objective_rows
from codesign.search.optimization import load_problem, optimize
from codesign.search.progress import ProgressBar, duration
from codesign.storage.runs import Run

PAPER_SECONDS = 216.0  # a design, "From CAD to URDF: Co-Design of a Jet-Powered Humanoid Robot …", 2024


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--study", default="ironcub_paper")
    parser.add_argument("--population", type=int, default=25)
    parser.add_argument("--generations", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--steady", action="store_true")
    parser.add_argument("--out", type=Path, default=Path("runs/paper-size"))
    given = parser.parse_args()
    study = load_problem(given.study)
    runs = []
    for name in ("empty-cache", "warm-cache"):
        started = time.perf_counter()
        with ProgressBar(name) as bar:
            run = optimize(
                study,
                out=given.out / name,
                population=given.population,
                generations=given.generations,
                seed=given.seed,
                workers=given.workers,
                steady=given.steady,
                cache=given.out / "cache.sqlite",
                progress=bar,
            )
        runs.append(run)
        describe(name, run, time.perf_counter() - started, given.workers)
    first, second = ([record.identity() for record in run.records] for run in runs)
    print(f"identical rows: {first == second}")
    if study.baseline is not None:
        against_baseline(runs[0], study)


def describe(name: str, run: Run, wall: float, workers: int) -> None:
    count = len(run.records)
    print(
        f"\n{name}: {count} designs in {duration(wall)} ({wall:.1f} s), {PAPER_SECONDS * count / wall:.0f} x the paper"
    )
    print(f"  statuses {run.counts}; front {len(run.front)}; hypervolume {run.hypervolume}")
    print(f"  designs from the cache: {sum(record.cached for record in run.records)}")
    busy = sum(record.wall_seconds for record in run.records)
    print(f"  evaluations {busy:.0f} s = {busy / (workers * wall):.0%} of {workers} workers' time")
    stages: Counter[str] = Counter()
    for record in run.records:
        if not record.cached:
            stages.update({k: v for k, v in record.evaluation.seconds.items() if k != "total"})
    print("  where: " + ", ".join(f"{stage} {seconds:.0f} s" for stage, seconds in stages.most_common()))


def against_baseline(run: Run, study: object) -> None:
    baseline = study.evaluate(study.baseline)  # type: ignore[attr-defined]
    names = run.objectives
    print(f"\nbaseline {baseline.status}: " + ", ".join(f"{name} {baseline.objectives[name]:.6g}" for name in names))
    own = [baseline.objectives[name] for name in names]
    front = objective_rows((record.evaluation for record in run.front), names)
    better = (front <= own).all(axis=1) & (front < own).any(axis=1)
    print(f"front designs that dominate it: {int(better.sum())} of {len(front)}")
    for name, column, value in zip(names, front.T, own, strict=True):
        print(f"  best {name} {column.min():.6g} ({column.min() / value - 1:+.1%})")


if __name__ == "__main__":
    main()
