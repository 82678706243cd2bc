"""Runs that end early: killed, interrupted, out of disk; resumed to the same rows as an uninterrupted run."""

import json
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from codesign.errors import StoreError, StudyError
from codesign.search.optimization import optimize, resume
from codesign.storage.database import DATABASE
from codesign.storage.runs import load_run
from codesign.storage.store import RunStore
from fake_study import FakeStudy, study

SCRIPT = """
import signal; signal.signal(signal.SIGINT, signal.default_int_handler)  # shells start background jobs without it
import json, sys
from fake_study import FakeStudy
from codesign.search.optimization import optimize, resume
out, source, settings = sys.argv[1:]
if (__import__("pathlib").Path(out) / "run.sqlite").exists():
    resume(out, workers=2)
else:
    optimize(FakeStudy(source), out=out, workers=2, cache=None, **json.loads(settings))
"""


def start(fake: FakeStudy, out: Path, **settings) -> subprocess.Popen:
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    arguments = [str(out), fake.source, json.dumps(settings)]
    return subprocess.Popen([sys.executable, "-c", SCRIPT, *arguments], env=environment, start_new_session=True)


def rows(out: Path) -> list[dict]:
    return [record.identity() for record in load_run(out).search_records]


def finished_rows(out: Path) -> int:
    try:
        with RunStore.read(out) as store:
            return sum(n for status, n in store.counts().items() if status not in ("queued", "running"))
    except StoreError:
        return 0


def wait_for_rows(out: Path, count: int, process: subprocess.Popen) -> None:
    while finished_rows(out) < count and process.poll() is None:
        time.sleep(0.02)


@pytest.mark.parametrize("steady", [False, True])
def test_killed_run_resumes_to_the_same_rows(tmp_path, steady: bool) -> None:
    fake = study(seconds=0.02)
    whole = optimize(fake, out=tmp_path / "whole", cache=None, generations=6, steady=steady)
    rng = random.Random(1)
    out = tmp_path / "killed"
    for kill_at in (3, 20, 33):
        process = start(fake, out, generations=6, steady=steady)
        wait_for_rows(out, kill_at, process)
        time.sleep(rng.uniform(0.0, 0.05))
        process.kill()
        process.wait()
    assert 33 <= finished_rows(out) < 48
    resumed = resume(out)
    assert rows(out) == [record.identity() for record in whole.search_records]
    assert resumed.generations == whole.generations
    assert len(resumed.sessions) == 4
    assert resumed.finished


@pytest.mark.slow
def test_twenty_random_kills(tmp_path) -> None:
    """Killed anywhere: while starting, making the file, storing, breeding."""
    settings = {"generations": 30}
    fake = study(seconds=0.1)
    whole = optimize(study(seconds=0.0, hash=fake.hash), out=tmp_path / "whole", cache=None, workers=2, **settings)
    rng = random.Random(7)
    out = tmp_path / "killed"
    done = []
    for _ in range(20):
        process = start(fake, out, **settings)
        if rng.random() < 0.7:
            wait_for_rows(out, finished_rows(out) + 1, process)
        time.sleep(rng.uniform(0.0, 0.8))
        process.kill()
        assert process.wait() == -signal.SIGKILL
        done.append(finished_rows(out))
    assert done == sorted(done)
    assert 0 < done[-1] < 240
    resumed = resume(out)
    assert rows(out) == [record.identity() for record in whole.search_records]
    assert resumed.generations == whole.generations
    with RunStore.read(out) as store:
        assert store._execute("PRAGMA integrity_check").fetchone() == ("ok",)


def test_workers_die_with_a_killed_parent(tmp_path) -> None:
    fake = study(seconds=0.0, faults={"0,0,0": "native loop"}, log=str(tmp_path / "log"))
    process = start(fake, tmp_path / "run", generations=1, first=[{"a": 0.0, "b": 0.0, "c": 0.0}])
    while not ((tmp_path / "log").exists() and "0,0,0" in (tmp_path / "log").read_text()):
        time.sleep(0.02)
    workers = children(process.pid)
    assert workers
    process.kill()
    process.wait()
    deadline = time.monotonic() + 20.0
    while any(alive(pid) for pid in workers) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert not any(alive(pid) for pid in workers)


def test_interrupt_stores_what_is_finished_and_stops_workers(tmp_path) -> None:
    fake = study(seconds=0.05)
    process = start(fake, tmp_path / "run", generations=20)
    wait_for_rows(tmp_path / "run", 10, process)
    workers = children(process.pid)
    process.send_signal(signal.SIGINT)
    assert process.wait(20.0) != 0
    assert not any(alive(pid) for pid in workers)
    run = load_run(tmp_path / "run")
    assert run.sessions[-1]["outcome"] == "interrupted"
    assert run.counts.get("running", 0) == 0
    assert run.counts["queued"] > 0
    assert not run.finished


def test_second_writer_is_refused_and_readers_are_not(tmp_path) -> None:
    fake = study(seconds=0.05)
    process = start(fake, tmp_path / "run", generations=20)
    wait_for_rows(tmp_path / "run", 1, process)
    with pytest.raises(StoreError, match=f"being written by process {process.pid} on"):
        resume(tmp_path / "run")
    assert load_run(tmp_path / "run").records
    process.kill()
    process.wait()
    with RunStore.open(tmp_path / "run") as store:
        assert store.counts().get("running", 0) == 0


def test_resume_of_a_finished_run_changes_nothing(tmp_path) -> None:
    run = optimize(study(), out=tmp_path / "run", cache=None)
    again = resume(tmp_path / "run")
    assert again.records == run.records
    assert again.generations == run.generations


def test_larger_budget_continues_a_finished_run(tmp_path) -> None:
    short = optimize(study(), out=tmp_path / "short", cache=None, generations=3)
    whole = optimize(study(), out=tmp_path / "whole", cache=None, generations=6)
    longer = resume(tmp_path / "short", evaluations=48)
    assert len(short.records) == 24
    assert rows(tmp_path / "short") == rows(tmp_path / "whole")
    assert longer.generations == whole.generations


def test_resume_refuses_a_changed_study(tmp_path) -> None:
    optimize(study(hash="one"), out=tmp_path / "run", cache=None, generations=1)
    with pytest.raises(StudyError, match="changed"):
        resume(tmp_path / "run", study=study(hash="two"))


def test_new_run_in_the_folder_of_another_is_refused(tmp_path) -> None:
    run = optimize(study(), out=tmp_path / "run", cache=None, generations=1)
    with pytest.raises(StoreError, match="holds a run already"):
        optimize(study(), out=tmp_path / "run", cache=None, generations=1)
    assert load_run(tmp_path / "run").records == run.records
    assert (tmp_path / "run" / DATABASE).exists()


def children(pid: int) -> list[int]:
    found = []
    for folder in Path("/proc").iterdir():
        if folder.name.isdigit():
            try:
                fields = (folder / "stat").read_text().rpartition(")")[2].split()
            except OSError:
                continue
            if int(fields[1]) == pid:
                found.append(int(folder.name))
    return found


def alive(pid: int) -> bool:
    try:
        return (Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split())[0] != "Z"
    except OSError:
        return False
