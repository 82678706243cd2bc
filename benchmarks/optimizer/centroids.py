"""Search over representatives of clusters of bodies, as in the authors' follow-up work, against the search of the grid.

    python benchmarks/optimizer/centroids.py --samples 5000 --clusters 40 --flights 100 --seeds 5 --out runs/centroids

Bodies of `ironcub_whole` are drawn by Sobol' points over its eight lengths and angles and built without flight. Their
features (mass, center of mass, inertia, places and directions of the jets, all at the initial posture) are scaled to
unit variance and clustered by k-means; the body nearest to each center represents its cluster. One search then varies
the number of the representative (ordered along the first principal component) and the eight weights; the other the 16
variables of the grid. Both are NSGA-II with the same population, budget and seed, and start with the Original or, among
representatives, with the nearest to it under the published weights. Strength is not computed: it is no objective, and
its limit is far from every body.

Samples and evaluations are kept in --out; a run that was stopped goes on. Needs scikit-learn.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.stats import qmc
from sklearn.cluster import KMeans

from codesign import dynamics as dyn
from codesign import load_study
from codesign.chain.study import Study
from codesign.problem.design_space import DesignSpace, Variable
from codesign.problem.evaluation import Evaluation
from codesign.problem.pareto import Hypervolume, non_dominated, objective_rows
from codesign.search.sampling import grid_points
from codesign.search.settings import Settings

STUDY = "ironcub_whole"
CLUSTER = "representative"
Values = dict[str, float | str]


def body_names(study: Study) -> list[str]:
    """Variables of the body: those that set no weight."""
    return [v.name for v in study.space.variables if not study.config.variables[v.name].sets]


def features(study: Study, body: Values) -> np.ndarray:
    """Mass, center of mass, inertia about it, and origin and axis of every jet, at the initial posture."""
    flight = study.config.flown
    joints = [name for group in flight.joint_groups for name in group.joints]
    angles = np.array([angle for group in flight.joint_groups for angle in group.initial_rad])
    model = dyn.load_urdf(study.build_robot(dict(study.baseline) | body), joints=joints)
    inertia = dyn.locked_inertia(model, np.eye(4), angles)
    jets = [dyn.frame_pose(model, np.eye(4), angles, frame) for frame in flight.jets.frames]
    com = dyn.center_of_mass(model, np.eye(4), angles)
    numbers = [inertia[:1, 0], com, inertia[-3:, -3:][np.triu_indices(3)]]
    return np.concatenate([*numbers, *(np.concatenate([pose[:3, 3], pose[:3, 2]]) for pose in jets)])


def sampled(study: Study, count: int, file: Path) -> tuple[list[Values], np.ndarray]:
    """Bodies and their features (count, f); read from the file as far as it goes."""
    space = DesignSpace(tuple(v for v in study.space.variables if v.name in body_names(study)))
    unit = qmc.Sobol(len(space.levels), seed=0).random(1 << int(np.ceil(np.log2(count))))
    bodies = [space.from_indices(grid).to_dict() for grid in grid_points(unit, space.levels)[:count]]
    rows = [json.loads(line) for line in file.read_text().splitlines()] if file.exists() else []
    with file.open("a") as kept:
        for body in bodies[len(rows) :]:
            rows.append(features(study, body).tolist())
            kept.write(json.dumps(rows[-1]) + "\n")
            kept.flush()
    return bodies, np.array(rows[:count])


def representatives(study: Study, bodies: list[Values], rows: np.ndarray, count: int, seed: int) -> tuple[list, int]:
    """Bodies nearest to the centers of clusters, along the first principal component; place of the Original's."""
    mean, scale = rows.mean(axis=0), np.where(np.ptp(rows, axis=0) > 1e-9, rows.std(axis=0), 1.0)
    scaled = (rows - mean) / scale
    centers = KMeans(count, n_init=4, random_state=seed).fit(scaled).cluster_centers_
    first = np.linalg.svd(scaled, full_matrices=False)[2][0]
    centers = centers[np.argsort(centers @ first)]
    nearest = [int(np.linalg.norm(scaled - center, axis=1).argmin()) for center in centers]
    original = {name: study.baseline[name] for name in body_names(study)}
    here = (features(study, original) - mean) / scale
    return [bodies[i] for i in nearest], int(np.linalg.norm(scaled[nearest] - here, axis=1).argmin())


def flown(study: Study, design: Values) -> Evaluation:
    """An evaluation without strength: what misses no other limit counts as feasible."""
    found = study.evaluate_lazily(design, [(-1, (0.0,) * len(study.objectives))])
    return replace(found, status="feasible", reason=None) if found.status == "skipped" else found


class Log:
    """Evaluations of one search, in order, kept in a file."""

    def __init__(self, file: Path) -> None:
        self.file = file
        self.rows = [json.loads(line) for line in file.read_text().splitlines()] if file.exists() else []

    def get(self, number: int, grid: Sequence[int], compute: Callable[[], Evaluation]) -> Evaluation:
        """The evaluation of the search's n-th design."""
        if number < len(self.rows):
            assert self.rows[number]["grid"] == list(grid), f"{self.file}: is of another search"
            return Evaluation.from_dict(self.rows[number]["evaluation"])
        evaluation = compute()
        self.rows.append({"grid": list(grid), "evaluation": evaluation.to_dict()})
        with self.file.open("a") as kept:
            kept.write(json.dumps(self.rows[-1]) + "\n")
        return evaluation


def search(
    space: DesignSpace, start: Values, whole: Callable[[Values], Values], study: Study, budget: dict[str, int], log: Log
) -> list[Evaluation]:
    """NSGA-II over a space whose designs `whole` turns into those of the study."""
    breeding = {name: getattr(study.optimizer, name) for name in ("crossover_probability", "mutation_probability")}
    settings = Settings(first=(space.indices(start),), **budget, **breeding)
    asked, evaluations = settings.search(space, study.objectives), []
    while len(evaluations) < budget["evaluations"]:
        grids = asked.ask(min(budget["population"], budget["evaluations"] - len(evaluations)))
        told = [
            log.get(len(evaluations) + k, grid, lambda g=grid: flown(study, whole(space.from_indices(g).to_dict())))
            for k, grid in enumerate(grids)
        ]
        asked.tell(grids, told)
        evaluations += told
    return evaluations


def main() -> None:
    """Prints a line a seed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name, default in (("samples", 5000), ("clusters", 40), ("flights", 100), ("population", 20), ("seeds", 5)):
        parser.add_argument(f"--{name}", type=int, default=default)
    parser.add_argument("--out", type=Path, default=Path("runs/centroids"))
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    study = load_study(STUDY)
    bodies, rows = sampled(study, given.samples, given.out / "bodies.jsonl")
    weights = tuple(v for v in study.space.variables if v.name not in body_names(study))
    space = DesignSpace((Variable(CLUSTER, 0, given.clusters - 1, 1), *weights))
    found: dict[tuple[str, int], list[Evaluation]] = {}
    for seed in range(1, given.seeds + 1):
        budget = {"population": given.population, "evaluations": given.flights, "seed": seed}
        chosen, nearest = representatives(study, bodies, rows, given.clusters, seed)
        start = {CLUSTER: nearest, **{v.name: study.baseline[v.name] for v in weights}}
        spaces = {
            "grid": (study.space, dict(study.baseline), lambda values: values),
            "centroids": (space, start, lambda v, c=chosen: c[int(v[CLUSTER])] | {w.name: v[w.name] for w in weights}),
        }
        for name, (over, first, whole) in spaces.items():
            log = Log(given.out / f"{name}-{seed}.jsonl")
            found[name, seed] = search(over, first, whole, study, budget, log)
    values = {key: objective_rows(evaluations, study.objectives) for key, evaluations in found.items()}
    fronts = {key: rows[non_dominated(rows)] for key, rows in values.items()}
    box = Hypervolume(np.vstack(list(fronts.values())))
    print("seed | search    | feasible | hypervolume | lowest " + " | ".join(study.objectives))
    for (name, seed), front in sorted(fronts.items(), key=lambda item: (item[0][1], item[0][0])):
        lowest = " | ".join(f"{x:.4f}" for x in front.min(axis=0)) if len(front) else "none"
        print(f"{seed:4d} | {name:9s} | {len(values[name, seed]):8d} | {box.of(front):11.4f} | {lowest}")
    for name in ("grid", "centroids"):
        volumes = [box.of(fronts[name, seed]) for seed in range(1, given.seeds + 1)]
        print(f"{name}: mean hypervolume {np.mean(volumes):.4f}, from {min(volumes):.4f} to {max(volumes):.4f}")


if __name__ == "__main__":
    main()
