"""Evaluations in worker processes that may crash, hang or exhaust memory without affecting the run.

Each evaluation runs in a process of its own group with a wall-clock and a memory limit. What an evaluation does to its
process (exception, signal, endless loop, memory) is a `failed` Evaluation with the reason; what the machine does to it
(killed from outside while starting or working) is retried in a new process.
"""

from __future__ import annotations

import contextlib
import json
import os
import selectors
import signal
import subprocess
import sys
import tempfile
import time
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import TracebackType
from typing import IO, Any, Protocol, Self

from codesign.errors import ExecutionError
from codesign.execution.affinity import LOOK, Groups, Key, best, keys_of
from codesign.execution.worker import LENGTH, write_message
from codesign.problem.design_space import DesignValue
from codesign.problem.evaluation import Evaluation
from codesign.problem.identity import Identity
from codesign.problem.protocols import Problem, Rival
from codesign.units import MEBIBYTE

DEFAULT_LOADER = "codesign.chain.study:load_study"
START_LIMIT = 120.0  # s for a worker to import and load the study
START_ATTEMPTS = 3  # failed starts in a row before the pool gives up
RETRIES = 2  # of one task after its worker was killed from outside
STDERR_TAIL = 4000  # bytes of a dead worker's standard error kept with the failure
STDERR_LIMIT = 1 << 20  # bytes of standard error after which a worker's is emptied
OUTSIDE_SIGNALS = (signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGHUP)
# For glibc: freed memory stays with the worker. Else an analysis faults in its 100 MB page by page, a tenth of its CPU.
KEPT_MEMORY = {"MALLOC_MMAP_MAX_": "0", "MALLOC_TRIM_THRESHOLD_": "2000000000"}
ONE_THREAD = {name: "1" for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "BLIS_NUM_THREADS")}


@dataclass(frozen=True, slots=True)
class StudyRef:
    """How a worker finds the study, and the identity it must have there; groups: what its meshes depend on."""

    source: str
    hash: str
    loader: str = DEFAULT_LOADER
    identity: Identity = field(default=Identity(), compare=False)
    groups: Groups = field(default=(), compare=False)

    @classmethod
    def of(cls, study: Problem) -> StudyRef:
        """Reference to a study object; its attribute `loader`, if any, names another `module:function`.

        `mesh_groups`, if any: for each part the variables whose values name a mesh that workers keep.
        """
        loader, groups = getattr(study, "loader", DEFAULT_LOADER), getattr(study, "mesh_groups", ())
        return cls(study.source, study.hash, loader, study.identity, groups)


@dataclass(frozen=True, slots=True)
class Limits:
    """Limits of one evaluation: wall-clock time [s], memory [MiB] beyond what the loaded study takes; 0: none."""

    time_s: float = 120.0
    memory_mib: int = 4096


@dataclass(frozen=True, slots=True)
class Task:
    """One evaluation to run; rivals: of a lazy one, see `LazyProblem`."""

    number: int
    design: dict[str, DesignValue]
    trajectory: str | None = None
    rivals: tuple[Rival, ...] | None = None

    def message(self) -> dict[str, Any]:
        """As the worker reads it."""
        return {"design": self.design, "trajectory": self.trajectory, "rivals": self.rivals}


@dataclass(frozen=True, slots=True)
class Outcome:
    """A finished task; `seconds` is the wall time in the worker, `worker` says where it ran."""

    task: Task
    evaluation: Evaluation
    seconds: float
    worker: str


class Executor(Protocol):
    """Runs tasks somewhere; used from one thread."""

    def free(self) -> int:
        """How many more tasks can be handed over without queueing them for long."""

    def choose(self, waiting: Sequence[Task]) -> int:
        """Which of some tasks to hand over next; at least one, the longest waiting first."""

    def submit(self, task: Task) -> None:
        """Hands a task over; its outcome comes from `collect`, exactly once."""

    def collect(self, timeout: float) -> list[Outcome]:
        """Outcomes that have arrived; waits up to `timeout` seconds for the first.

        Raises: ExecutionError when evaluations cannot be run at all.
        """

    def close(self) -> None:
        """Stops everything at once; tasks in flight are forgotten."""


@dataclass(slots=True)
class _Worker:
    process: subprocess.Popen[bytes]
    stderr: IO[bytes]
    started: float
    buffer: bytearray = field(default_factory=bytearray)
    ready: bool = False
    task: Task | None = None
    deadline: float = float("inf")
    begun: float = 0.0
    kept: set[Key] = field(default_factory=set)

    @property
    def name(self) -> str:
        return f"pid {self.process.pid}"


def kept_mib(workers: int) -> int:
    """What each of some workers may keep of meshes and factors for later designs [MiB], beside its memory limit.

    A quarter of the machine's memory in all, of one worker 4 GiB at the most.
    """
    machine = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // int(MEBIBYTE)
    return min(4096, machine // (4 * workers))


class LocalPool:
    """Worker processes on this machine, one evaluation at a time each.

    Raises: ExecutionError from `collect` if workers do not start or if the study that they load has another hash.
    """

    def __init__(
        self, study: StudyRef, workers: int = 1, limits: Limits | None = None, cache: str | Path | None = None
    ) -> None:
        if workers < 1:
            raise ValueError(f"workers = {workers}: at least 1 is needed")
        self._study, self._limits, self._cache = study, limits or Limits(), str(cache or "")
        self._kept_mib = kept_mib(workers)
        self._selector = selectors.DefaultSelector()
        self._workers: list[_Worker] = []
        self._waiting: deque[Task] = deque()
        self._outcomes: list[Outcome] = []
        self._attempts: dict[int, int] = {}
        self._failed_starts = 0
        try:
            for _ in range(workers):
                self._start()
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self.close()

    def free(self) -> int:
        """Workers with nothing to do (those still starting included), less the tasks that wait for them."""
        return sum(worker.task is None for worker in self._workers) - len(self._waiting)

    def choose(self, waiting: Sequence[Task]) -> int:
        """The task that fits an idle worker best; none waits until more than LOOK others have gone before."""
        idle = [k for k, worker in enumerate(self._workers) if worker.task is None]
        if not self._study.groups or not idle:
            return 0
        near = [task for task in waiting[:LOOK] if task.number < waiting[0].number + LOOK]
        return best([self._keys(task) for task in near], [worker.kept for worker in self._workers], idle)[0]

    def submit(self, task: Task) -> None:
        """Hands a task to an idle worker, or keeps it for the next one that is."""
        self._waiting.append(task)
        self._dispatch()

    def collect(self, timeout: float) -> list[Outcome]:
        """Outcomes that have arrived; waits up to `timeout` seconds for the first."""
        end = time.monotonic() + timeout
        while not self._outcomes:
            now = time.monotonic()
            next_deadline = min((worker.deadline for worker in self._workers), default=end)
            wait = max(0.0, min(end, next_deadline) - now)
            for key, _ in self._selector.select(wait):
                self._receive(key.data)
            self._watch()
            self._dispatch()
            if time.monotonic() >= end:
                break
        outcomes, self._outcomes = self._outcomes, []
        return outcomes

    def close(self) -> None:
        """Kills every worker with its process group."""
        for worker in self._workers:
            _kill_group(worker.process)
        for worker in self._workers:
            self._bury(worker)
        self._workers = []
        self._waiting.clear()
        self._selector.close()

    def _start(self) -> None:
        environment = KEPT_MEMORY | os.environ | ONE_THREAD
        environment["PYTHONPATH"] = os.pathsep.join(str(Path(entry).resolve()) for entry in sys.path)
        module = "codesign.execution.worker"
        command = [sys.executable, "-P", "-m", module, self._study.loader, self._study.source, self._cache]
        stderr = tempfile.TemporaryFile("a+b")  # noqa: SIM115 - lives as long as the worker
        process = subprocess.Popen(
            [*command, str(self._limits.memory_mib), str(self._kept_mib)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=stderr,
            env=environment,
            start_new_session=True,
        )
        worker = _Worker(process, stderr, started=time.monotonic())
        worker.deadline = worker.started + START_LIMIT
        assert process.stdout is not None
        os.set_blocking(process.stdout.fileno(), False)
        self._selector.register(process.stdout, selectors.EVENT_READ, worker)
        self._workers.append(worker)

    def _dispatch(self) -> None:
        while self._waiting:
            idle = [k for k, worker in enumerate(self._workers) if worker.ready and worker.task is None]
            if not idle:
                return
            task = self._waiting.popleft()
            needed = self._keys(task)
            _, number = best([needed], [worker.kept for worker in self._workers], idle)
            worker = self._workers[number]
            worker.kept |= needed
            worker.task, worker.begun = task, time.monotonic()
            worker.deadline = worker.begun + self._limits.time_s if self._limits.time_s > 0 else float("inf")
            assert worker.process.stdin is not None
            with contextlib.suppress(BrokenPipeError):  # it has died: seen at its end of file
                write_message(worker.process.stdin, task.message())

    def _keys(self, task: Task) -> frozenset[Key]:
        return keys_of(task.design, self._study.groups)

    def _receive(self, worker: _Worker) -> None:
        assert worker.process.stdout is not None
        try:
            data = os.read(worker.process.stdout.fileno(), 1 << 20)
        except BlockingIOError:
            return
        if not data:
            self._died(worker)
            return
        worker.buffer += data
        while len(worker.buffer) >= LENGTH.size:
            end = LENGTH.size + LENGTH.unpack_from(worker.buffer)[0]
            if len(worker.buffer) < end:
                return
            payload = bytes(worker.buffer[LENGTH.size : end])
            del worker.buffer[:end]
            self._answered(worker, payload)

    def _answered(self, worker: _Worker, payload: bytes) -> None:
        message = json.loads(payload)
        if "error" in message:
            raise ExecutionError(f"a worker cannot load the study {self._study.source}: {message['error']}")
        if "ready" in message:
            if message["ready"] != self._study.hash:
                there = Identity.from_document(message["identity"])
                raise ExecutionError(
                    f"the study {self._study.source} is another for the worker {worker.name} than for this run: "
                    f"{self._study.identity.differences(there)}; start again, with the same program everywhere"
                )
            worker.ready, worker.deadline, self._failed_starts = True, float("inf"), 0
            return
        task = worker.task
        assert task is not None
        worker.task, worker.deadline = None, float("inf")
        evaluation = Evaluation.from_dict(message["evaluation"])
        self._finish(task, evaluation, message["seconds"], worker.name)
        if message["exhausted"]:
            self._replace(worker)
        elif worker.stderr.seek(0, os.SEEK_END) > STDERR_LIMIT:
            worker.stderr.truncate(0)

    def _finish(self, task: Task, evaluation: Evaluation, seconds: float, name: str) -> None:
        self._attempts.pop(task.number, None)
        self._outcomes.append(Outcome(task, evaluation, seconds, name))

    def _watch(self) -> None:
        """Ends workers past their deadline."""
        now = time.monotonic()
        for worker in list(self._workers):
            if now >= worker.deadline:
                if worker.task is None:
                    self._died(worker)
                else:
                    self._fail(worker, f"time limit of {self._limits.time_s:g} s exceeded")

    def _fail(self, worker: _Worker, reason: str, provenance: dict[str, Any] | None = None) -> None:
        task = worker.task
        assert task is not None
        worker.task = None
        evaluation = Evaluation.failure(task.design, reason, provenance)
        self._finish(task, evaluation, time.monotonic() - worker.begun, worker.name)
        self._replace(worker)

    def _died(self, worker: _Worker) -> None:
        """A worker has ended, or never became ready: its task fails, or is tried again if the end came from outside."""
        code = _exit_code(worker.process)
        tail = _tail(worker.stderr)
        task = worker.task
        if task is None:
            self._failed_starts += not worker.ready
            if self._failed_starts >= START_ATTEMPTS:
                raise ExecutionError(f"workers do not start ({_describe(code)}): {tail[-500:].strip()}")
            self._replace(worker)
            return
        attempts = self._attempts.get(task.number, 0)
        if code is not None and -code in OUTSIDE_SIGNALS and attempts < RETRIES:
            self._attempts[task.number] = attempts + 1
            worker.task = None
            self._waiting.appendleft(task)
            self._replace(worker)
            return
        again = f", {attempts + 1} times" if attempts else ""
        self._fail(worker, f"the evaluation ended its process: {_describe(code)}{again}", {"stderr": tail})

    def _replace(self, worker: _Worker) -> None:
        self._bury(worker)
        self._workers.remove(worker)
        self._start()

    def _bury(self, worker: _Worker) -> None:
        _kill_group(worker.process)
        assert worker.process.stdout is not None
        assert worker.process.stdin is not None
        with contextlib.suppress(KeyError, ValueError):
            self._selector.unregister(worker.process.stdout)
        worker.process.stdout.close()
        with contextlib.suppress(BrokenPipeError):
            worker.process.stdin.close()
        worker.stderr.close()
        worker.process.wait()


def _kill_group(process: subprocess.Popen[bytes]) -> None:
    """Kills the process group, unless its leader has been waited for (its number may be another's by now)."""
    if process.returncode is None:
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.killpg(process.pid, signal.SIGKILL)


def _exit_code(process: subprocess.Popen[bytes]) -> int | None:
    """Exit code, negative for a signal; None if it lives on. Does not reap: the group keeps its number."""
    for _ in range(100):
        info = os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOHANG | os.WNOWAIT)
        if info is not None:
            return -info.si_status if info.si_code != os.CLD_EXITED else info.si_status
        time.sleep(0.01)
    return None


def _describe(code: int | None) -> str:
    if code is None:
        return "no answer"
    if code < 0:
        return f"{signal.Signals(-code).name} ({signal.strsignal(-code)})"
    return f"exit code {code}"


def _tail(stderr: IO[bytes]) -> str:
    size = stderr.seek(0, os.SEEK_END)
    stderr.seek(max(0, size - STDERR_TAIL))
    return stderr.read().decode(errors="replace")
