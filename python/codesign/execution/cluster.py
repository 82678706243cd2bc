"""Evaluations on a Dask cluster: `dask.distributed` moves tasks, worker processes as of the pool run them.

Each thread of a Dask worker keeps one worker process of codesign.execution.pool, so limits, crashes and hangs mean the
same as in a local run and never end the Dask worker. Dask runs the tasks of a lost worker again on another.
"""

from __future__ import annotations

import importlib
import os
import queue
import socket
import tempfile
import threading
import time
import uuid
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from codesign.errors import ExecutionError
from codesign.execution.pool import RETRIES, Limits, LocalPool, Outcome, StudyRef, Task
from codesign.problem.evaluation import Evaluation

AHEAD = 1  # tasks kept ready for each Dask thread besides the one that it runs
CONNECT_LIMIT = 30.0  # s to reach the scheduler
RECOUNT = 1.0  # s between looks at how many threads the cluster has
NO_WORKERS_LIMIT = 600.0  # s without any worker before the run gives up


@dataclass(frozen=True, slots=True)
class Job:
    """What all tasks of one run share."""

    run: str
    study: StudyRef
    limits: Limits
    cache: str
    host: str  # of the run: elsewhere the cache is a file of the worker's own machine (SQLite and NFS do not mix)


_pools: dict[tuple[str, int], LocalPool] = {}  # on a Dask worker: (run, thread) -> its worker process


def evaluate_here(job: Job, task: Task) -> tuple[dict[str, Any], float, str]:
    """Runs on a Dask worker: one evaluation in this thread's worker process, which is kept for the next one."""
    key = (job.run, threading.get_ident())
    pool = _pools.get(key)
    if pool is None:
        pool = _pools[key] = LocalPool(job.study, 1, job.limits, local_cache(job.cache, job.host))
    try:
        pool.submit(task)
        while not (outcomes := pool.collect(60.0)):
            pass
    except BaseException:
        _pools.pop(key, pool).close()
        raise
    return outcomes[0].evaluation.to_dict(), outcomes[0].seconds, outcomes[0].worker


def local_cache(cache: str, host: str) -> str:
    """The run's cache file on the run's own machine, else one of the same name in this machine's temporary folder."""
    if not cache or socket.gethostname() == host:
        return cache
    return str(Path(tempfile.gettempdir()) / f"codesign-{os.getuid()}" / Path(cache).name)


def release(run: str) -> None:
    """Runs on a Dask worker: ends the worker processes of a run."""
    for key in [key for key in _pools if key[0] == run]:
        _pools.pop(key).close()


def _local_workers(address: str) -> int:
    """N of local:N, or 0 for a scheduler's address. Raises: ExecutionError: neither."""
    kind, _, rest = address.partition(":")
    if kind != "local":
        if not rest.strip("/"):
            raise ExecutionError(f"cluster {address!r}: expected a scheduler's address tcp://host:port, or local:N")
        return 0
    if not rest.isdecimal() or int(rest) < 1:
        raise ExecutionError(f"cluster {address!r}: expected local:N with N Dask workers, at least one")
    return int(rest)


class DaskExecutor:
    """Evaluations on a Dask cluster; workers may join and leave at any time.

    Args:
        address: a scheduler's address (tcp://host:port), or local:N for N Dask workers on this machine.
        cache: file of the cache on this machine; workers on other machines have their own.

    Raises: ExecutionError if the address makes no sense, dask.distributed is missing or no scheduler answers.
    """

    def __init__(self, study: StudyRef, address: str, limits: Limits, cache: str | Path | None) -> None:
        try:
            distributed: Any = importlib.import_module("distributed")
        except ImportError as error:
            raise ExecutionError("a cluster needs dask[distributed]: pip install 'codesign[cluster]'") from error
        self._job = Job(uuid.uuid4().hex, study, limits, str(cache or ""), socket.gethostname())
        self._arrived: queue.SimpleQueue[tuple[Task, Any]] = queue.SimpleQueue()
        self._futures: dict[int, Any] = {}
        self._attempts: dict[int, int] = {}
        self._threads, self._counted, self._seen = 0, float("-inf"), time.monotonic()
        self._cluster: Any = None
        try:
            if count := _local_workers(address):
                self._cluster = distributed.LocalCluster(n_workers=count, threads_per_worker=1, dashboard_address=None)
            self._client = distributed.Client(self._cluster or address, timeout=CONNECT_LIMIT, set_as_default=False)
        except (OSError, ValueError, TimeoutError) as error:
            raise ExecutionError(f"no Dask cluster at {address}: {error}") from error

    def free(self) -> int:
        """Threads of the cluster, and as many tasks ahead, less what is in flight."""
        now = time.monotonic()
        if now - self._counted > RECOUNT:
            self._threads, self._counted = sum(self._client.nthreads().values()), now
            if self._threads:
                self._seen = now
            elif now - self._seen > NO_WORKERS_LIMIT:
                raise ExecutionError(f"the cluster has had no worker for {NO_WORKERS_LIMIT:g} s")
        return self._threads * (1 + AHEAD) - len(self._futures)

    def choose(self, waiting: Sequence[Task]) -> int:  # noqa: ARG002 - the protocol's
        """The first: where tasks run is the scheduler's business."""
        return 0

    def submit(self, task: Task) -> None:
        """Hands a task to the scheduler; those asked for earlier go first."""
        attempt = self._attempts.setdefault(task.number, 0)
        key = f"codesign-{self._job.run}-{task.number}-{attempt}"
        future = self._client.submit(evaluate_here, self._job, task, key=key, pure=False, priority=-task.number)
        self._futures[task.number] = future
        future.add_done_callback(lambda done, task=task: self._arrived.put((task, done)))

    def collect(self, timeout: float) -> list[Outcome]:
        """Outcomes that have arrived; waits up to `timeout` seconds for the first.

        Raises: ExecutionError if a task's workers were lost again and again, or the scheduler is gone.
        """
        outcomes: list[Outcome] = []
        try:
            while True:
                task, future = self._arrived.get(timeout=0.0 if outcomes else timeout)
                if self._futures.get(task.number) is future and (outcome := self._outcome(task, future)):
                    outcomes.append(outcome)
        except queue.Empty:
            return outcomes

    def _outcome(self, task: Task, future: Any) -> Outcome | None:
        del self._futures[task.number]
        if future.status == "finished":
            document, seconds, worker = future.result()
            self._attempts.pop(task.number, None)
            return Outcome(task, Evaluation.from_dict(document), seconds, worker)
        error = future.exception() if future.status == "error" else None
        self._attempts[task.number] += 1
        if type(error).__name__ == "KilledWorker" and self._attempts[task.number] <= RETRIES:
            self.submit(task)  # the evaluation cannot have killed the Dask worker: it runs in a process of its own
            return None
        raise ExecutionError(f"the cluster cannot evaluate {task.design}: {error or future.status}")

    def close(self) -> None:
        """Cancels what is in flight and leaves the cluster."""
        try:
            self._client.cancel(list(self._futures.values()), force=True)
            if self._cluster is None:
                self._client.run(release, self._job.run, on_error="ignore")
            self._client.close()
        finally:
            if self._cluster is not None:
                self._cluster.close()
