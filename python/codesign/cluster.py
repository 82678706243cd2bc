"""Evaluations on a Dask cluster: `dask.distributed` moves tasks, our own worker processes run them.

Each thread of a Dask worker keeps one worker process of codesign.execute, so limits, crashes and hangs mean the same as
in a local run and never end the Dask worker. Dask runs the tasks of a lost worker again on another.
"""

from __future__ import annotations

import atexit
import importlib
import queue
import threading
from pathlib import Path
from typing import Any

from codesign.errors import ExecutionError
from codesign.evaluation import Evaluation
from codesign.execute import Limits, LocalPool, Outcome, StudyRef, Task

AHEAD = 1  # tasks kept ready on each Dask thread besides the one that runs
CONNECT_LIMIT = 30.0  # s to reach the scheduler

_pools = threading.local()


def evaluate_here(study: StudyRef, task: Task, limits: Limits, cache: str) -> tuple[dict[str, Any], float, str]:
    """Runs on a Dask worker: one evaluation in this thread's worker process, kept for the next one."""
    key = (study, limits, cache)
    if getattr(_pools, "key", None) != key:
        if hasattr(_pools, "pool"):
            _pools.pool.close()
        _pools.pool, _pools.key = LocalPool(study, 1, limits, cache), key
        atexit.register(_pools.pool.close)
    pool: LocalPool = _pools.pool
    try:
        pool.submit(task)
        while True:
            for outcome in pool.collect(60.0):
                return outcome.evaluation.to_dict(), outcome.seconds, outcome.worker
    except BaseException:
        pool.close()
        del _pools.pool, _pools.key
        raise


class DaskExecutor:
    """Evaluations on a Dask cluster.

    Args:
        address: a scheduler's address (tcp://host:port), or local:N for N Dask workers on this machine.
        cache: file of the cache on each worker's machine.

    Raises: ExecutionError if dask.distributed is missing or the scheduler cannot be reached.
    """

    def __init__(self, study: StudyRef, address: str, limits: Limits, cache: str | Path | None) -> None:
        try:
            distributed: Any = importlib.import_module("distributed")
        except ImportError as error:
            raise ExecutionError("--cluster needs the package dask[distributed]") from error
        self._study, self._limits, self._cache = study, limits, str(cache or "")
        self._outcomes: queue.SimpleQueue[tuple[Task, Any]] = queue.SimpleQueue()
        self._futures: dict[int, Any] = {}
        self._cluster: Any = None
        self._closing = False
        try:
            if address.startswith("local:"):
                count = int(address.removeprefix("local:"))
                self._cluster = distributed.LocalCluster(n_workers=count, threads_per_worker=1, dashboard_address=None)
                self._client = distributed.Client(self._cluster)
            else:
                self._client = distributed.Client(address, timeout=CONNECT_LIMIT, set_as_default=False)
        except (OSError, ValueError, TimeoutError) as error:
            raise ExecutionError(f"no Dask scheduler at {address}: {error}") from error

    @property
    def scheduler_address(self) -> str:
        """Where more workers can join."""
        return str(self._client.scheduler.address)

    def free(self) -> int:
        """Threads of the cluster, and as many tasks ahead, less what is in flight."""
        threads = int(sum(self._client.nthreads().values()))
        return threads * (1 + AHEAD) - len(self._futures)

    def submit(self, task: Task) -> None:
        """Hands a task to the scheduler; earlier tasks first."""
        arguments = (self._study, task, self._limits, self._cache)
        future = self._client.submit(
            evaluate_here,
            *arguments,
            pure=False,
            retries=0,
            priority=-task.number,
            key=f"codesign-{task.number}-{id(self)}",
        )
        self._futures[task.number] = future
        future.add_done_callback(lambda done, task=task: self._outcomes.put((task, done)))

    def collect(self, timeout: float) -> list[Outcome]:
        """Outcomes that have arrived; waits up to `timeout` seconds for the first."""
        arrived: list[tuple[Task, Any]] = []
        try:
            arrived.append(self._outcomes.get(timeout=timeout))
            while True:
                arrived.append(self._outcomes.get_nowait())
        except queue.Empty:
            pass
        return [self._outcome(task, future) for task, future in arrived]

    def _outcome(self, task: Task, future: Any) -> Outcome:
        del self._futures[task.number]
        if future.status != "finished":
            error = future.exception() if future.status == "error" else future.status
            raise ExecutionError(f"the cluster cannot evaluate {task.design}: {error}")
        document, seconds, worker = future.result()
        return Outcome(task, Evaluation.from_dict(document), seconds, worker)

    def close(self) -> None:
        """Cancels what is in flight and leaves the cluster."""
        self._client.cancel(list(self._futures.values()), force=True)
        self._client.close()
        if self._cluster is not None:
            self._cluster.close()
