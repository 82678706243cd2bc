"""Share of a long run's hypervolume that shorter runs of the same study reach, by number of evaluations.

  codesign optimize --population 25 --generations 40 --seed 1 --out runs/paper
  codesign optimize --algorithm surrogate --evaluations 200 --seed 1 --out runs/short
  python benchmarks/optimizer/against_run.py runs/paper runs/short

In two boxes from the best values of the long run's front: to its worst values and a tenth of its range (tight), and to
the componentwise worse of that and of the median of the designs that the long run started with (wide).
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from surrogate_share import MARGIN, volume

from codesign.problem.pareto import objective_rows
from codesign.storage.runs import load_run


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("reference", type=Path)
    parser.add_argument("runs", type=Path, nargs="+")
    parser.add_argument("--evaluations", type=int, nargs="+", default=[50, 100, 150, 200])
    given = parser.parse_args()
    reference = load_run(given.reference)
    front = objective_rows((record.evaluation for record in reference.front), reference.objectives)
    start = objective_rows(reference.evaluations[: reference.settings["population"]], reference.objectives)
    tight = front.max(axis=0) + MARGIN * np.ptp(front, axis=0)
    boxes = {"tight": tight, "wide": np.maximum(tight, np.median(start, axis=0))}
    print("run | box   | " + " | ".join(f"{n:>7d}" for n in given.evaluations))
    for out in (given.reference, *given.runs):
        run = load_run(out)
        for name, corner in boxes.items():
            whole = volume(front, front.min(axis=0), corner)
            shares = [
                volume(objective_rows(run.evaluations[:n], run.objectives), front.min(axis=0), corner) / whole
                for n in given.evaluations
            ]
            print(f"{out.name} | {name:5s} | " + " | ".join(f"{share:7.2%}" for share in shares))


if __name__ == "__main__":
    main()
