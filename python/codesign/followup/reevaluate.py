"""Chosen designs of a run on other trajectories, stored beside the search's rows."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Unpack

from codesign.execution.pool import Executor, Task
from codesign.problem.design_space import DesignValue
from codesign.problem.protocols import PartCache, Problem
from codesign.search.base import Grid
from codesign.search.driver import WAIT, checked
from codesign.search.optimization import Resources, cache_path, make_executor, stored_study
from codesign.search.progress import Progress
from codesign.storage.cache import open_cache
from codesign.storage.designs import keep_evaluation, known_evaluation
from codesign.storage.records import Record
from codesign.storage.runs import load_run
from codesign.storage.store import RunStore


def revisit(
    out: str | Path,
    trajectories: Sequence[str],
    designs: Sequence[Mapping[str, DesignValue]] | None = None,
    *,
    study: Problem | None = None,
    again: bool = False,
    **resources: Unpack[Resources],
) -> list[Record]:
    """Evaluates designs of a run on other trajectories; what the run knows already is not evaluated again.

    Args:
        out: the run's folder.
        trajectories: names of the study's trajectories.
        designs: any designs of the study; None: the run's Pareto front.
        again: whether those that failed before are tried once more.

    Returns: a record a design and trajectory, in that order.
    Raises: as `optimize.resume`.
    """
    if designs is None:
        grids = [record.grid for record in load_run(out).front]
    with RunStore.open(out) as store:
        problem = stored_study(store, study)
        if designs is not None:
            grids = [problem.space.indices(design) for design in designs]
        pairs = list(dict.fromkeys((grid, trajectory) for grid in grids for trajectory in trajectories))
        if again:
            store.retry(pairs)
        known = {(record.grid, record.trajectory) for record in store.records()}
        missing = [pair for pair in pairs if pair not in known]
        if missing:
            path = cache_path(problem, resources)
            with open_cache(path, problem.identity.program) as cache:
                missing = _take_known(problem, store, missing, cache)
                if missing:
                    executor = make_executor(problem, resources, path, len(missing))
                    try:
                        _evaluate(problem, store, missing, executor, cache, resources)
                    finally:
                        executor.close()
        found = {(record.grid, record.trajectory): record for record in store.records()}
        return [found[pair] for pair in pairs]


def _take_known(
    study: Problem, store: RunStore, pairs: list[tuple[Grid, str]], cache: PartCache | None
) -> list[tuple[Grid, str]]:
    """Stores what the cache knows; returns the other pairs."""
    missing = []
    for grid, trajectory in pairs:
        known = known_evaluation(study, grid, cache, trajectory)
        if known is None:
            missing.append((grid, trajectory))
            continue
        store.enqueue([(None, None, grid, study.space.from_indices(grid).to_dict())], study.hash, trajectory)
        store.finish(Record(None, None, grid, trajectory, known, cached=True))
    return missing


def _evaluate(
    study: Problem,
    store: RunStore,
    pairs: list[tuple[Grid, str]],
    executor: Executor,
    cache: PartCache | None,
    resources: Resources,
) -> None:
    designs = [study.space.from_indices(grid).to_dict() for grid, _ in pairs]
    for (grid, trajectory), design in zip(pairs, designs, strict=True):
        store.enqueue([(None, None, grid, design)], study.hash, trajectory)
    queue = [Task(n, designs[n], trajectory) for n, (_, trajectory) in enumerate(pairs)]
    counts: Counter[str] = Counter()
    began, running, notify = time.monotonic(), 0, resources.get("progress")
    while queue or running:
        while queue and executor.free() > 0:
            executor.submit(queue.pop(executor.choose(queue)))
            running += 1
        for outcome in executor.collect(WAIT):
            grid, trajectory = pairs[outcome.task.number]
            evaluation = checked(outcome.evaluation, study.objectives)
            store.finish(Record(None, None, grid, trajectory, evaluation, False, outcome.worker, outcome.seconds))
            keep_evaluation(study, grid, evaluation, cache, trajectory)
            counts[evaluation.status] += 1
            running -= 1
        if notify is not None:
            statuses = (counts["feasible"], counts["infeasible"], counts["failed"])
            notify(Progress(*statuses, running, len(pairs), counts.total(), time.monotonic() - began))
