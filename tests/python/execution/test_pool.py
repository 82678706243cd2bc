"""Evaluations that misbehave: each costs one failed result with its reason, and nothing else."""

import os
import signal
import subprocess
import sys
import time

import pytest

from codesign.errors import ExecutionError
from codesign.execution.pool import KEPT_MEMORY, Limits, LocalPool, Outcome, StudyRef, Task
from fake_study import FakeStudy, study


def evaluate(fake: FakeStudy, grids: list[tuple[int, ...]], workers: int = 2, **limits) -> list[Outcome]:
    """Outcomes in the order of the grid points."""
    tasks = [Task(number, fake.space.from_indices(grid).to_dict()) for number, grid in enumerate(grids)]
    outcomes: list[Outcome] = []
    with LocalPool(StudyRef.of(fake), workers, Limits(**limits)) as pool:
        for task in tasks:
            pool.submit(task)
        while len(outcomes) < len(tasks):
            outcomes += pool.collect(30.0)
    return sorted(outcomes, key=lambda outcome: outcome.task.number)


FAULTS = {
    "raise": "RuntimeError: no such luck",
    "exit": "SystemExit: 3",
    "hard exit": "exit code 7",
    "segfault": "SIGSEGV",
    "abort": "SIGABRT",
    "memory": "memory limit of 300 MiB exceeded",
    "killed": "SIGKILL",
    "nan": "ValueError",
}


def test_each_fault_is_one_failed_result_with_its_reason() -> None:
    grids = [(i, 0, 0) for i in range(len(FAULTS))]
    good = [(i, 1, 0) for i in range(4)]
    faults = {",".join(map(str, grid)): fault for grid, fault in zip(grids, FAULTS, strict=True)}
    outcomes = evaluate(study(faults=faults), grids + good, memory_mib=300)
    for outcome, reason in zip(outcomes, FAULTS.values(), strict=False):
        assert outcome.evaluation.status == "failed"
        assert reason in (outcome.evaluation.reason or "")
        assert outcome.evaluation.design == outcome.task.design
    assert [outcome.evaluation.status for outcome in outcomes[len(FAULTS) :]] == ["feasible"] * 4


def test_workers_keep_the_memory_that_evaluations_free() -> None:
    """With their settings, filling 64 MB for the second to tenth time faults no page in.

    Dask leaves a MALLOC_TRIM_THRESHOLD_ of its own in the environment of a process that had a cluster.
    """
    code = (
        "import resource\n"
        "def faults():\n"
        "    before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt\n"
        "    b'x' * 64_000_000\n"
        "    return resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before\n"
        "print(*(faults() for _ in range(10)))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], env=os.environ | KEPT_MEMORY, capture_output=True, text=True, check=True
    )
    assert max(map(int, done.stdout.split()[1:])) < 100  # of 15 625 pages


def test_hanging_evaluations_end_at_the_time_limit() -> None:
    """One computes for ever, one is stuck in native code that holds the interpreter's lock."""
    fake = study(faults={"0,0,0": "loop", "1,0,0": "native loop"})
    outcomes = evaluate(fake, [(0, 0, 0), (1, 0, 0)], time_s=1.0)
    assert [outcome.evaluation.reason for outcome in outcomes] == ["time limit of 1 s exceeded"] * 2


def test_segfault_keeps_the_traceback() -> None:
    (outcome,) = evaluate(study(faults={"0,0,0": "segfault"}), [(0, 0, 0)])
    assert "misbehave" in outcome.evaluation.provenance["stderr"]


def test_noise_on_standard_output_does_not_disturb() -> None:
    (outcome,) = evaluate(study(faults={"0,0,0": "print"}), [(0, 0, 0)])
    assert outcome.evaluation.status == "feasible"


def test_worker_killed_from_outside_is_replaced_and_the_task_repeated() -> None:
    fake = study(seconds=0.4)
    with LocalPool(StudyRef.of(fake), 1, Limits(20.0)) as pool:
        pool.submit(Task(0, fake.space.from_indices((1, 1, 1)).to_dict()))
        while not pool._workers[0].ready:
            pool.collect(0.05)
        pool.collect(0.1)
        os.kill(pool._workers[0].process.pid, signal.SIGKILL)
        outcomes: list[Outcome] = []
        while not outcomes:
            outcomes = pool.collect(30.0)
    assert outcomes[0].evaluation.status == "feasible"


def test_close_leaves_no_process(tmp_path) -> None:
    fake = study(seconds=60.0)
    pool = LocalPool(StudyRef.of(fake), 2)
    for number in range(2):
        pool.submit(Task(number, fake.space.from_indices((number, 0, 0)).to_dict()))
    while not all(worker.ready for worker in pool._workers):
        pool.collect(0.05)
    pids = [worker.process.pid for worker in pool._workers]
    start = time.monotonic()
    pool.close()
    assert time.monotonic() - start < 10.0
    for pid in pids:
        with pytest.raises(ProcessLookupError):
            os.kill(pid, 0)


def test_study_that_does_not_load_is_an_error_not_failed_designs() -> None:
    with (
        LocalPool(StudyRef("not JSON", "h", "fake_study:load")) as pool,
        pytest.raises(ExecutionError, match="cannot load"),
    ):
        pool.collect(30.0)


def test_study_that_changed_is_refused() -> None:
    fake = study()
    with (
        LocalPool(StudyRef(fake.source, "other", fake.loader)) as pool,
        pytest.raises(ExecutionError, match="changed"),
    ):
        pool.collect(30.0)
