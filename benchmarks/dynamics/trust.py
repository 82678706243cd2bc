"""What a study's flights depend on: steps of the loops, start, draws of the unknown, time.

  python benchmarks/dynamics/trust.py steps --designs 28     # ranks of designs, and their front, at half of all steps
  python benchmarks/dynamics/trust.py seeds --seeds 20 --design 15 42 80 108 --design 4 40 98 118
  python benchmarks/dynamics/trust.py hold --designs 6       # torques held for 8 ms against a torque loop of 1 ms
  python benchmarks/dynamics/trust.py time --repeats 5       # CPU of a flight over that of the study as published

Designs of `steps`: published ones and Sobol points; of each the flights under its seeds, calm and at half steps.
The share is that of the squared momentum errors before 2 s. With `--log FILE` designs flown before are not flown again.
"""

from __future__ import annotations

import argparse
import json
import statistics
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import qmc, spearmanr

import codesign
from codesign import dynamics as dyn
from codesign.chain.flight import find_trajectory, flight_settings, joint_names
from codesign.problem.pareto import non_dominated

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

Change = Callable[[dyn.FlightSettings], None]


def pool(count: int) -> list[tuple[int, ...]]:
    """Designs on the grid: published ones, then Sobol points of the region that keeps the clearances."""
    points = qmc.scale(qmc.Sobol(4, seed=7).random(32), LOWEST, HIGHEST)
    drawn = [(round(a), *(2 * round(x / 2) for x in rest)) for a, *rest in points]
    return (PUBLISHED + drawn)[:count]


def prepared(
    study: codesign.Study, theta: Sequence[int], change: Change | None = None
) -> tuple[dyn.Model, dyn.FlightSettings]:
    """Robot and settings of the study's flight of a design."""
    config = study.configured(study.space.design(list(theta)))
    settings = flight_settings(config.flown, find_trajectory(config, config.flown.trajectory))
    if change is not None:
        change(settings)
    return dyn.load_urdf(study.build_robot(list(theta)), joints=joint_names(config.flown)), settings


def fly(
    study: codesign.Study, theta: Sequence[int], seeds: Sequence[int], change: Change | None = None
) -> list[dyn.FlightLog]:
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


def calm(settings: dyn.FlightSettings) -> None:
    settings.disturbances = dyn.Disturbances()


def calm_and_halved(settings: dyn.FlightSettings) -> None:
    calm(settings)
    halve(settings)


Figures = dict[str, Any]


def figures(study: codesign.Study, theta: Sequence[int], seeds: Sequence[int]) -> Figures:
    """Objectives of a design, calm and disturbed, at the study's steps and at half of them; `share` of each flight."""
    logs = fly(study, theta, seeds)
    return {
        "calm": objectives(fly(study, theta, seeds[:1], calm)),
        "calm, halved": objectives(fly(study, theta, seeds[:1], calm_and_halved)),
        "disturbed": objectives(logs),
        "disturbed, halved": objectives(fly(study, theta, seeds, halve)),
        "share": [early_share(log) for log in logs],
        "thrust": [log.max_thrust for log in logs],
    }


def steps(study: codesign.Study, count: int, draws: int, file: Path | None) -> None:
    """Objectives at the study's steps against half of them, calm and disturbed."""
    seeds = (study.config.flown.seeds or [0])[:draws]
    known: dict[str, Figures] = json.loads(file.read_text()) if file and file.exists() else {}
    found = []
    for theta in pool(count):
        key = f"{study.config.name} {theta} {seeds}"
        if key not in known:
            known[key] = figures(study, theta, seeds)
            if file:
                file.write_text(json.dumps(known))
        found.append(known[key])
    for kind in ("calm", "disturbed"):
        compare(kind, *(np.array([row[key] for row in found]) for key in (kind, f"{kind}, halved")))
    shares, thrusts = ([value for row in found for value in row[key]] for key in ("share", "thrust"))
    print(f"share of squared momentum error before {BEGINNING:g} s: largest {max(shares):.1%} of {len(shares)} flights")
    print(f"largest thrust: {max(thrusts):.1f} N")


def hold(study: codesign.Study, count: int) -> None:
    """Joint velocity under torques held for the 8 ms of one loop, against a torque loop of 1 ms; calm, no delays."""

    def rates(updates: int) -> Change:
        def change(settings: dyn.FlightSettings) -> None:
            calm(settings)
            settings.delays = dyn.Delays()
            settings.step, settings.torque_updates, settings.substeps = 0.008, updates, 8 // updates

        return change

    for theta in pool(count):
        held, fast = (objectives(fly(study, theta, [0], rates(updates)))[1] for updates in (1, 8))
        print(f"{theta}: joint velocity {held:.4f} held, {fast:.4f} at 1 ms, {held / fast - 1.0:+.1%}", flush=True)


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


def seeds(study: codesign.Study, designs: Sequence[Sequence[int]], count: int) -> None:
    """How many draws of the unknown each design survives."""
    for theta in designs:
        logs = fly(study, theta, range(100, 100 + count))
        flown = [log for log in logs if log.completed]
        largest = max((log.max_thrust for log in flown), default=np.nan)
        fuel = max((log.fuel_burnt for log in flown), default=np.nan)
        print(f"{tuple(theta)}: {len(flown)} of {count} fly, largest thrust {largest:.1f} N, fuel {fuel:.2f} kg")


def times(study: codesign.Study, repeats: int) -> None:
    """CPU time of one flight over that of the study as published, alternating in one process; median of the ratios."""
    published = prepared(codesign.load_study("ironcub_paper"), PUBLISHED[0])
    own = prepared(study, PUBLISHED[0])
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
    parser.add_argument("--draws", type=int, default=3, help="of the study's seeds, in `steps`")
    parser.add_argument("--log", type=Path, help="file of the designs flown so far, in `steps`")
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--design", type=int, nargs="+", action="append", default=[])
    asked = parser.parse_args()
    study = codesign.load_study(asked.study)
    if asked.what == "steps":
        steps(study, asked.designs, asked.draws, asked.log)
    elif asked.what == "seeds":
        seeds(study, asked.design or PUBLISHED[:1], asked.seeds)
    elif asked.what == "hold":
        hold(study, asked.designs)
    else:
        times(study, asked.repeats)


if __name__ == "__main__":
    main()
