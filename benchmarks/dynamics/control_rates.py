"""Designs of a run's front at the study's rate of control and at the published 200 Hz: values and ranks.

    python benchmarks/dynamics/control_rates.py runs/ironcub_whole [--most 12]

Flies the original and up to `--most` designs, evenly along the front, at both rates; nothing else is computed.
Ranks: Spearman's coefficient over all of them.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import numpy as np
from scipy.stats import spearmanr

from codesign import load_study
from codesign.chain.chain import fly_design
from codesign.chain.study import Study
from codesign.problem.design_space import Design
from codesign.storage.runs import load_run
from codesign.study.loading import study_from

PUBLISHED = {"throttle_every": 20, "small_steps": 7, "control_steps": 12}


def at_published_rate(study: Study) -> Study:
    """The study with solves at 200 Hz, throttles at 10 Hz."""
    raw = json.loads(json.dumps(study.raw))
    raw["flight"]["step_s"] = 0.005
    raw["flight"]["mpc"] |= PUBLISHED
    return study_from(raw, study.path, Study)


def measured(study: Study, design: Design) -> tuple[float, float]:
    """Tracking [m] and fuel [kg] of a flight; infinite where it is lost."""
    log = fly_design(study, design)
    assert log is not None
    return (log.measures.com_error_rms, log.measures.fuel) if log.completed else (np.inf, np.inf)


def main() -> None:
    """Prints a line a design."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=Path)
    parser.add_argument("--most", type=int, default=12)
    given = parser.parse_args()
    run = load_run(given.run)
    slow = load_study(run.study["source"])
    fast = at_published_rate(slow)
    front = sorted(run.front, key=lambda record: record.evaluation.objectives[run.objectives[0]])
    chosen = np.unique(np.linspace(0, len(front) - 1, given.most).round().astype(int))
    designs = {"original": slow.baseline} | {
        str(front[i].number): slow.space.design(front[i].evaluation.design) for i in chosen
    }
    rows = []
    print("design   | tracking, fuel as searched | at 200 Hz")
    for name, design in designs.items():
        rows.append((*measured(slow, design), *measured(fast, design)))
        print(f"{name:8s} | {rows[-1][0]:.4f}, {rows[-1][1]:.4f} | {rows[-1][2]:.4f}, {rows[-1][3]:.4f}", flush=True)
    table = np.array(rows)
    for k, objective in enumerate(("tracking", "fuel")):
        rank = spearmanr(table[:, k], table[:, k + 2]).statistic
        change = 100.0 * (table[:, k + 2] / table[:, k] - 1.0)
        print(f"{objective}: rank correlation {rank:.2f}, changes {change.min():+.1f} to {change.max():+.1f} %")


if __name__ == "__main__":
    main()
