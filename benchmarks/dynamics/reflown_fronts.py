"""Fronts of runs flown again: plant by Runge-Kutta, or control at the published 200 Hz; values, ranks, hypervolumes.

    python benchmarks/dynamics/reflown_fronts.py runs/ironcub_whole runs/ironcub_retuned [--joint-energy 110]

Flies the original and up to `--most` designs of each front, evenly along it, as searched and the other way; no parts
are computed. --joint-energy: fronts of the feasible designs that need no more [J]; --png: both fronts both ways. Ranks:
Spearman's coefficient over the designs of a run. Hypervolume: of a front with the original, in the box that all fronts
and the original span, a tenth wider; share: of the first run's gain over the original.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import spearmanr

from codesign import load_study
from codesign.chain.chain import fly_design
from codesign.chain.study import Study
from codesign.problem.design_space import Design
from codesign.problem.evaluation import Evaluation
from codesign.problem.pareto import Hypervolume, non_dominated, objective_rows
from codesign.report.figures import style
from codesign.storage.runs import Run, load_run
from codesign.study.loading import study_from

WAYS: dict[str, dict[str, Any]] = {
    "runge_kutta": {"servo": {"integrator": "runge_kutta_4"}},
    "200_hz": {"step_s": 0.005, "mpc": {"throttle_every": 20, "small_steps": 7, "control_steps": 12}},
}


def flown_otherwise(study: Study, way: dict[str, Any]) -> Study:
    """The study with other settings of its flight."""
    raw = json.loads(json.dumps(study.raw))
    for key, value in way.items():
        if isinstance(value, dict):
            raw["flight"][key] |= value
        else:
            raw["flight"][key] = value
    return study_from(raw, study.path, Study)


def measured(study: Study, design: Design) -> tuple[float, float]:
    """Tracking [m] and fuel [kg] of a flight; infinite where it is lost."""
    log = fly_design(study, design)
    assert log is not None
    return (log.measures.com_error_rms, log.measures.fuel) if log.completed else (np.inf, np.inf)


def front_of(run: Run, energy: float) -> list[Evaluation]:
    """Best of the feasible designs whose joint energy is at most `energy` [J], by the first objective."""
    calm = [e for e in run.evaluations if e.status == "feasible" and e.flight["mechanical_energy"] <= energy]
    best = non_dominated(objective_rows(calm, run.objectives))
    front = [evaluation for evaluation, kept in zip(calm, best, strict=True) if kept]
    return sorted(front, key=lambda evaluation: evaluation.objectives[run.objectives[0]])


def flown_again(folder: Path, way: dict[str, Any], most: int, energy: float) -> np.ndarray:
    """(n, 2, 2) designs, as searched and otherwise, objectives; the original first. Prints a line a design."""
    run = load_run(folder)
    studies = [load_study(run.study["source"])]
    studies.append(flown_otherwise(studies[0], way))
    front = front_of(run, energy)
    numbers = {tuple(r.evaluation.design.values()): r.number for r in run.search_records}
    chosen = [front[i] for i in np.unique(np.linspace(0, len(front) - 1, most).round().astype(int))]
    designs = {"original": studies[0].baseline} | {
        str(numbers[tuple(e.design.values())]): studies[0].space.design(e.design) for e in chosen
    }
    rows = []
    print(f"{folder.name}: tracking, fuel as searched | otherwise")
    for name, design in designs.items():
        rows.append([measured(study, design) for study in studies])
        print(
            f"{name:8s} | {rows[-1][0][0]:.4f}, {rows[-1][0][1]:.4f} | {rows[-1][1][0]:.4f}, {rows[-1][1][1]:.4f}",
            flush=True,
        )
    return np.array(rows)


def draw(file: Path, names: list[str], tables: list[np.ndarray], how: str) -> None:
    """Fronts as searched (open) and flown otherwise (filled), with the original."""
    from matplotlib.figure import Figure

    with style.style():
        figure = Figure(figsize=(style.COLUMN * 1.35, style.COLUMN * 1.05))
        axes = figure.subplots()
        for name, table, tint, mark in zip(names, tables, style.SERIES, "o^sv", strict=False):
            axes.scatter(
                *table[1:, 0].T, 26, "none", marker=mark, edgecolors=tint, linewidths=0.8, label=f"{name}, as searched"
            )
            axes.scatter(*table[1:, 1].T, 10, tint, marker=mark, linewidths=0, label=f"{name}, {how.replace('_', ' ')}")
        axes.scatter(*tables[0][0, 1], 34, style.ORIGINAL, marker="D", edgecolors="white", label="original")
        axes.set(xlabel="Position error (m)", ylabel="Fuel (kg)")
        figure.legend(loc="outside lower center", ncols=2)
        figure.savefig(file)


def main() -> None:
    """Prints a line a design, then ranks and hypervolumes."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", type=Path, nargs="+")
    parser.add_argument("--most", type=int, default=12)
    parser.add_argument("--how", choices=WAYS, default="runge_kutta")
    parser.add_argument("--joint-energy", type=float, default=np.inf)
    parser.add_argument("--png", type=Path)
    given = parser.parse_args()
    tables = [flown_again(folder, WAYS[given.how], given.most, given.joint_energy) for folder in given.runs]
    for folder, table in zip(given.runs, tables, strict=True):
        for k, objective in enumerate(("tracking", "fuel")):
            rank = spearmanr(table[:, 0, k], table[:, 1, k]).statistic
            change = 100.0 * (table[:, 1, k] / table[:, 0, k] - 1.0)
            print(f"{folder.name}, {objective}: rank {rank:.2f}, changes {change.min():+.1f} to {change.max():+.1f} %")
    for way, name in enumerate(("as searched", given.how)):
        box = Hypervolume(np.vstack([table[np.isfinite(table[:, way]).all(axis=1), way] for table in tables]))
        start = box.of(tables[0][:1, way])
        gains = [box.of(table[:, way]) - start for table in tables]
        text = ", ".join(
            f"{f.name} {g + start:.4f} ({100.0 * g / gains[0]:.0f} %)" for f, g in zip(given.runs, gains, strict=True)
        )
        print(f"hypervolume {name}: original {start:.4f}, {text}")
    if given.png:
        draw(given.png, [folder.name for folder in given.runs], tables, given.how)


if __name__ == "__main__":
    main()
