"""How evaluations fill workers: local pool, Dask, generations against steady state.

Measured with evaluations that sleep, so that two cores can stand for many: what is seen is what the search, the store
and the scheduler cost, not the evaluation. Efficiency = time all evaluations take / (workers x wall time of the run).

  python benchmarks/optimizer/scaling.py local          local pool, 1 … 32 workers
  python benchmarks/optimizer/scaling.py dask           Dask, 4 … 64 threads on this machine (one worker process each)
  python benchmarks/optimizer/scaling.py simulate       the barrier alone, by event simulation, up to 512 workers
"""

from __future__ import annotations

import argparse
import heapq
import os
import sys
import tempfile
import time
from collections import deque
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parent))
from standin import StandIn, standin

from codesign.search.optimization import optimize
from codesign.search.plan import Schedule
from codesign.search.sampling import RandomSearch

SPREAD = 0.3  # standard deviation of the evaluation time over its mean


def run(study: StandIn, evaluations: int, population: int, steady: bool, **resources: Any) -> tuple[float, float]:
    """Wall time from the first to the last evaluation's row, and the sum of evaluation times [s]."""
    first: list[float] = []

    def note(progress: Any) -> None:
        if progress.done or progress.running:
            first.append(time.monotonic())

    with tempfile.TemporaryDirectory() as folder:
        result = optimize(
            study, out=Path(folder) / "run", population=population, evaluations=evaluations, steady=steady,
            cache=None, progress=note, **resources,
        )  # fmt: skip
        wall = time.monotonic() - first[0]
        return wall, sum(record.wall_seconds for record in result.records)


def local() -> None:
    print("seconds | workers | generations of 25 | steady state, lag 25   (efficiency, evaluations/s)")
    for seconds, counts in ((0.05, (1, 2, 4, 8)), (1.0, (1, 2, 8, 16)), (4.0, (2, 16))):
        for workers in counts:
            evaluations = max(50, min(400, round(12 * workers / seconds) // 25 * 25))
            cells = []
            for steady in (False, True):
                wall, busy = run(standin(seconds=seconds, spread=SPREAD), evaluations, 25, steady, workers=workers)
                cells.append(f"{busy / (workers * wall):6.1%} {evaluations / wall:7.2f}/s")
            print(f"{seconds:7.2f} | {workers:7d} | {cells[0]:17s} | {cells[1]}", flush=True)


def dask() -> None:
    import distributed

    print("seconds | threads | generations of N | steady state, lag N    (efficiency, evaluations/s; N = 2 x threads)")
    for threads in (4, 16, 64):
        with distributed.LocalCluster(n_workers=2, threads_per_worker=threads // 2, dashboard_address=None) as cluster:
            for seconds in (0.05, 1.0, 4.0):
                population = 2 * threads
                evaluations = population * (4 if seconds < 4 else 2)
                cells = []
                for steady in (False, True):
                    study = standin(seconds=seconds, spread=SPREAD)
                    address = cluster.scheduler_address
                    wall, busy = run(study, evaluations, population, steady, cluster=address)
                    cells.append(f"{busy / (threads * wall):6.1%} {evaluations / wall:7.2f}/s")
                print(f"{seconds:7.2f} | {threads:7d} | {cells[0]:16s} | {cells[1]}", flush=True)


def simulated(study: StandIn, schedule: Schedule, workers: int, evaluations: int, overhead: float) -> float:
    """Efficiency of `workers` when the loop hands out one task each `overhead` seconds and takes no other time."""
    search = RandomSearch(study.space, 1)
    grids = search.ask(evaluations)
    times = [study.duration(study.space.from_indices(grid).to_dict()) for grid in grids]
    asked = told = 0
    batches, waiting, finished = deque[range](), deque[int](), set[int]()
    running: list[tuple[float, int]] = []
    clock = handed = 0.0
    while told < evaluations:
        while (count := min(schedule.count(asked, told), evaluations - asked)) > 0:
            batches.append(range(asked, asked + count))
            waiting += batches[-1]
            asked += count
        if finished.issuperset(batches[0]):
            told += len(batches.popleft())
            continue
        while waiting and len(running) < workers:
            handed = max(handed, clock) + overhead
            number = waiting.popleft()
            heapq.heappush(running, (handed + times[number], number))
        clock, number = heapq.heappop(running)
        finished.add(number)
    return sum(times) / (workers * clock)


def simulate() -> None:
    print("evaluation 4 s; spread of times | workers | generation = workers | 4 x workers | steady, lag = 1.5 x | 4 x")
    for spread in (0.1, SPREAD, 1.0):
        study = standin(seconds=4.0, spread=spread)
        for workers in (2, 8, 32, 128, 512):
            evaluations = 40 * workers
            schedules = (
                Schedule(workers),
                Schedule(4 * workers),
                Schedule(workers, 1, round(1.5 * workers)),
                Schedule(workers, 1, 4 * workers),
            )
            cells = [f"{simulated(study, s, workers, evaluations, 0.0005):6.1%}" for s in schedules]
            print(f"{spread:31.1f} | {workers:7d} | {' | '.join(cells)}", flush=True)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("local", "dask", "simulate"))
    os.environ["PYTHONPATH"] = os.pathsep.join([str(Path(__file__).parent), os.environ.get("PYTHONPATH", "")])
    {"local": local, "dask": dask, "simulate": simulate}[parser.parse_args().what]()
