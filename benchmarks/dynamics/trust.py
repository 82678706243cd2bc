"""What a study's flights depend on: steps of the loops, start, draws of the unknown, time.

  python benchmarks/dynamics/trust.py steps --designs 28     # ranks of designs, and their front, at half of all steps
  python benchmarks/dynamics/trust.py seeds --seeds 20 --design 15 42 80 108 --design 4 40 98 118
  python benchmarks/dynamics/trust.py hold --designs 6       # torques held for 8 ms against a torque loop of 1 ms
  python benchmarks/dynamics/trust.py time --repeats 5       # CPU of a flight over that of the study as published
  python benchmarks/dynamics/trust.py steps --study ironcub --run RUN --designs 50   # with designs of that run's front
  python benchmarks/dynamics/trust.py steps --study ironcub --run RUN --feasible     # with all of its feasible designs
  python benchmarks/dynamics/trust.py seeds --study ironcub --run RUN                # of each design on its front

Designs of `steps`: published ones and Sobol points, with --run 29 far-apart ones of its front first; of each the
flights under its seeds, calm, at half steps, and with an explicit Euler method at 1 ms.
The share is that of the squared momentum errors before 2 s. With `--log FILE` designs flown before are not flown again.
"""

from __future__ import annotations

import argparse
import json
import statistics
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import qmc, spearmanr

import codesign
from codesign import dynamics as dyn
from codesign.chain.flight import find_trajectory, flight_settings, joint_names
from codesign.problem.pareto import non_dominated
from codesign.storage.runs import load_run

PUBLISHED = [
    (15, 42, 80, 108),
    (1, 48, 100, 130),
    (1, 48, 88, 50),
    (4, 40, 98, 118),
    (4, 90, 98, 122),
    (30, 62, 116, 112),
]
NAMES = ("momentum", "joint velocity", "thrust")
LOWEST, HIGHEST = (1, 40, 80, 96), (22, 100, 120, 150)
BEGINNING = 2.0  # s
OF_FRONT, FLAT = 29, 14  # designs of a run's front; degrees up to which Sobol points go with them

Theta = Mapping[str, float | str]
Change = Callable[[dyn.FlightSettings], None]


def pool(study: codesign.Study, count: int, run: Path | None = None) -> list[Theta]:
    """Designs on the grid: far apart ones of a run's front, published ones, Sobol points that may keep clearances."""
    points = qmc.scale(qmc.Sobol(4, seed=7).random(32), LOWEST, HIGHEST)
    drawn = [(round(a), *(2 * round(x / 2) for x in rest)) for a, *rest in points]
    chosen = far_apart(run, OF_FRONT) if run else []
    flat = [theta for theta in drawn if theta[0] <= FLAT] if run else drawn
    return [*chosen, *(whole(study, theta) for theta in PUBLISHED + flat)][:count]


def whole(study: codesign.Study, numbers: Sequence[int]) -> Theta:
    """A design by its four lengths; what else the study varies is as in its Original."""
    baseline = study.config.baseline
    return dict(zip((v.name for v in study.space.variables), numbers, strict=False)) | {
        v.name: baseline[v.name] for v in study.space.variables[len(numbers) :]
    }


def feasible(run: Path) -> list[Theta]:
    """All feasible designs of a run."""
    return [evaluation.design for evaluation in load_run(run).evaluations if evaluation.status == "feasible"]


def far_apart(run: Path, count: int) -> list[Theta]:
    """Designs of a run's front, each farthest from those before it in the front's box; the first at its middle."""
    front = [record.evaluation for record in load_run(run).front]
    values = np.array([list((e.objectives or {}).values()) for e in front])
    values = (values - values.min(axis=0)) / (values.max(axis=0) - values.min(axis=0))
    order = [int(np.argmin(np.linalg.norm(values - 0.5, axis=1)))]
    while len(order) < min(count, len(front)):
        nearest = np.linalg.norm(values[:, None] - values[order], axis=2).min(axis=1)
        order.append(int(np.argmax(nearest)))
    return [front[k].design for k in order]


def prepared(study: codesign.Study, theta: Theta, change: Change | None = None) -> tuple[dyn.Model, dyn.FlightSettings]:
    """Robot and settings of the study's flight of a design."""
    design = study.space.design(theta)
    config = study.configured(design)
    settings = flight_settings(config.flown, find_trajectory(config, config.flown.trajectory))
    if change is not None:
        change(settings)
    return dyn.load_urdf(study.build_robot(theta), joints=joint_names(config.flown)), settings


def fly(study: codesign.Study, theta: Theta, seeds: Sequence[int], change: Change | None = None) -> list[dyn.FlightLog]:
    """The study's flight of a design under each seed."""
    return list(dyn.simulate_flights(*prepared(study, theta, change), list(seeds)))


def objectives(logs: Sequence[dyn.FlightLog]) -> list[float]:
    """Means over the flights; NaN if one was lost."""
    if not all(log.completed for log in logs):
        return [np.nan] * 3
    return np.mean([[log.rms.momentum, log.rms.joint_velocity, log.rms.thrust] for log in logs], axis=0).tolist()


def early_share(log: dyn.FlightLog) -> float:
    """Share of the squared momentum errors before two seconds."""
    squares = (log.momentum_error**2).sum(axis=1)
    return float(squares[log.time < BEGINNING].sum() / squares.sum())


def halve(settings: dyn.FlightSettings) -> None:
    settings.step *= 0.5  # the torque and plant steps are fractions of it


def euler(settings: dyn.FlightSettings) -> None:
    settings.integrator, settings.substeps = dyn.Integrator.euler, round(settings.step / settings.torque_updates / 1e-3)


def calm(settings: dyn.FlightSettings) -> None:
    settings.disturbances = dyn.Disturbances()


def calm_and_halved(settings: dyn.FlightSettings) -> None:
    calm(settings)
    halve(settings)


Figures = dict[str, Any]


def figures(study: codesign.Study, theta: Theta, seeds: Sequence[int]) -> Figures:
    """Objectives of a design, calm and disturbed, at the study's steps and at half of them; `share` of each flight."""
    logs = fly(study, theta, seeds)
    return {
        "calm": objectives(fly(study, theta, seeds[:1], calm)),
        "calm, halved": objectives(fly(study, theta, seeds[:1], calm_and_halved)),
        "disturbed": objectives(logs),
        "disturbed, halved": objectives(fly(study, theta, seeds, halve)),
        "disturbed, Euler": objectives(fly(study, theta, seeds, euler)),
        "share": [early_share(log) for log in logs],
        "thrust": [log.max_thrust for log in logs],
    }


def steps(study: codesign.Study, designs: Sequence[Theta], draws: int, file: Path | None) -> None:
    """Objectives at the study's steps against half of them, calm and disturbed."""
    seeds = (study.config.flown.seeds or [0])[:draws]
    known: dict[str, Figures] = json.loads(file.read_text()) if file and file.exists() else {}
    found = []
    for theta in designs:
        key = f"{study.config.name} {tuple(theta.values())} {seeds}"
        if key not in known:
            known[key] = figures(study, theta, seeds)
            if file:
                file.write_text(json.dumps(known))
        found.append(known[key])
    for kind, other in (("calm", "halved"), ("disturbed", "halved"), ("disturbed", "Euler")):
        compare(f"{kind}, {other}", *(np.array([row[key] for row in found]) for key in (kind, f"{kind}, {other}")))
    shares, thrusts = ([value for row in found for value in row[key]] for key in ("share", "thrust"))
    print(f"share of squared momentum error before {BEGINNING:g} s: largest {max(shares):.1%} of {len(shares)} flights")
    print(f"largest thrust: {max(thrusts):.1f} N")


def hold(study: codesign.Study, designs: Sequence[Theta]) -> None:
    """Joint velocity under torques held for the 8 ms of one loop, against a torque loop of 1 ms; calm, no delays."""

    def rates(updates: int) -> Change:
        def change(settings: dyn.FlightSettings) -> None:
            calm(settings)
            settings.delays = dyn.Delays()
            settings.step, settings.torque_updates, settings.substeps = 0.008, updates, 8 // updates

        return change

    for theta in designs:
        held, fast = (objectives(fly(study, theta, [0], rates(updates)))[1] for updates in (1, 8))
        print(
            f"{tuple(theta.values())}: joint velocity {held:.4f} held, {fast:.4f} at 1 ms, {held / fast - 1.0:+.1%}",
            flush=True,
        )


def compare(kind: str, whole: np.ndarray, halved: np.ndarray) -> None:
    """Ranks and changes of the objectives, and the hypervolume that the front at whole steps keeps at half of them."""
    flown = np.isfinite(whole).all(axis=1) & np.isfinite(halved).all(axis=1)
    same = np.isfinite(whole).all(axis=1) == np.isfinite(halved).all(axis=1)
    whole, halved = whole[flown], halved[flown]
    print(f"{kind}: {flown.sum()} of {len(flown)} designs fly, outcome the same for {same.sum()}")
    for i, name in enumerate(NAMES):
        rank = spearmanr(whole[:, i], halved[:, i]).statistic
        change = np.abs(halved[:, i] / whole[:, i] - 1.0)
        print(f"  {name}: Spearman {rank:.4f}, change median {np.median(change):.2%}, largest {change.max():.2%}")
    front, true_front = (np.flatnonzero(non_dominated(values)) for values in (whole, halved))
    least, most = halved.min(axis=0), halved.max(axis=0)
    scaled = (halved - least) / (most - least)
    share = hypervolume(scaled[front]) / hypervolume(scaled[true_front])
    print(
        f"  fronts of {len(front)} and {len(true_front)}, {len(set(front) & set(true_front))} in both, "
        f"hypervolume kept {share:.2%}"
    )


def hypervolume(points: np.ndarray, samples: int = 16) -> float:
    """Of points to be minimized in the unit cube, against 1.1; by a fixed Sobol set of 2^samples points."""
    probes = 1.1 * qmc.Sobol(points.shape[1], seed=0).random_base2(samples)
    dominated = np.zeros(len(probes), dtype=bool)
    for point in points:
        dominated |= (probes >= point).all(axis=1)
    return float(dominated.mean())


def seeds(study: codesign.Study, designs: Sequence[Theta], count: int) -> None:
    """How many draws of the unknown each design survives."""
    for theta in designs:
        logs = fly(study, theta, range(100, 100 + count))
        flown = [log for log in logs if log.completed]
        largest = max((log.max_thrust for log in flown), default=np.nan)
        fuel = max((log.fuel_burnt for log in flown), default=np.nan)
        print(
            f"{tuple(theta.values())}: {len(flown)} of {count} fly, largest thrust {largest:.1f} N, fuel {fuel:.2f} kg",
            flush=True,
        )


def times(study: codesign.Study, repeats: int) -> None:
    """CPU time of one flight over that of the study as published, alternating in one process; median of the ratios."""
    paper = codesign.load_study("ironcub_paper")
    published = prepared(paper, whole(paper, PUBLISHED[0]))
    own = prepared(study, whole(study, PUBLISHED[0]))
    batch = list(study.config.flown.seeds) or [0]
    ratios: dict[str, list[float]] = {"one flight": [], f"a flight of a batch of {len(batch)}": []}
    for _ in range(repeats):
        base = cpu(lambda: dyn.simulate_flights(*published, [0]))
        ratios["one flight"].append(cpu(lambda: dyn.simulate_flights(*own, batch[:1])) / base)
        together = cpu(lambda: dyn.simulate_flights(*own, batch))
        ratios[f"a flight of a batch of {len(batch)}"].append(together / len(batch) / base)
    for name, values in ratios.items():
        print(f"{name}: {statistics.median(values):.2f} times as published ({min(values):.2f} to {max(values):.2f})")


def cpu(work: Callable[[], object]) -> float:
    start = time.process_time()
    work()
    return time.process_time() - start


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["steps", "seeds", "hold", "time"])
    parser.add_argument("--study", default="ironcub_robust")
    parser.add_argument("--designs", type=int, default=28)
    parser.add_argument("--run", type=Path, help="whose front is flown, in `steps` and `seeds`")
    parser.add_argument("--feasible", action="store_true", help="all feasible designs of the run, in `steps`")
    parser.add_argument("--draws", type=int, default=3, help="of the study's seeds, in `steps`")
    parser.add_argument("--log", type=Path, help="file of the designs flown so far, in `steps`")
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--design", type=int, nargs="+", action="append", default=[])
    asked = parser.parse_args()
    study = codesign.load_study(asked.study)
    if asked.what == "steps":
        designs = feasible(asked.run) if asked.feasible else pool(study, asked.designs, asked.run)
        steps(study, designs, asked.draws, asked.log)
    elif asked.what == "seeds":
        named = [whole(study, theta) for theta in asked.design or PUBLISHED[:1]]
        seeds(study, [r.evaluation.design for r in load_run(asked.run).front] if asked.run else named, asked.seeds)
    elif asked.what == "hold":
        hold(study, pool(study, asked.designs))
    else:
        times(study, asked.repeats)


if __name__ == "__main__":
    main()
