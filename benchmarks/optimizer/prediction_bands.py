"""How many later designs of a run lie in the bands that a model of its first designs predicts.

  python benchmarks/optimizer/prediction_bands.py runs/paper --first 50 100 200

Prints, for models of the first n designs of the run: coverage of the 50 and 90 % bands for the next n designs and, by
leaving out each of the first, for these themselves; all objectives pooled; and the median error over the spread.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from codesign.storage.runs import load_run
from codesign.surrogate.what_if import WhatIf


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=Path)
    parser.add_argument("--first", type=int, nargs="+", default=[50, 100, 200])
    given = parser.parse_args()
    run = load_run(given.run)
    print("first | later: 50 % | 90 % | median error | left out: 90 %")
    for count in given.first:
        records = run.search_records
        known = [record.evaluation for record in records[:count]]
        models = WhatIf.of(run.space, known, [], run.objectives, ())
        if models is None:
            print(f"{count:5d} | too few designs with objectives")
            continue
        spread = {name: np.std([e.objectives[name] for e in known if e.objectives]) for name in run.objectives}
        inside: list[list[bool]] = []
        errors = []
        for record in records[count : 2 * count]:
            if record.evaluation.objectives and models.inside(record.grid):
                for name, prediction in models.predict(record.grid).items():
                    value = record.evaluation.objectives[name]
                    inside.append([low <= value <= high for low, high in prediction.bands])
                    errors.append(abs(value - prediction.mean) / spread[name])
        half, most = np.mean(inside, axis=0)
        left_out = np.mean([number.quality.coverage for number in models.numbers])
        print(f"{count:5d} | {half:11.2f} | {most:.2f} | {np.median(errors):12.2%} | {left_out:.2f}")


if __name__ == "__main__":
    main()
