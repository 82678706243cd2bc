"""The run's file: what goes in comes out; foreign, newer, broken, full and read-only files are refused unharmed."""

import ctypes
import json
import os
import resource
import shlex
import shutil
import sqlite3
import subprocess
import sys
from pathlib import Path

import pytest

from codesign.errors import StoreError
from codesign.problem.evaluation import Evaluation
from codesign.search.optimization import optimize, resume
from codesign.storage.cache import SqliteCache
from codesign.storage.database import DATABASE, VERSION
from codesign.storage.records import Generation, Record
from codesign.storage.runs import load_run
from codesign.storage.store import RunStore
from fake_study import study

EVALUATION = Evaluation(
    design={"a": 1, "b": 0.1 + 0.2},
    status="infeasible",
    objectives={"momentum": 1e-300, "thrust": 656.8429278434196},
    objective_families={"rms": {"momentum": 5e-324}},
    constraints={"safety_factor": 0.5},
    violations={"safety_factor": 0.1},
    parts={"bracket": {"com": [0.1, 0.2, 0.3], "seconds": {"mesh": 0.5}}},
    flight={"trajectory": "envelope", "reason": "Überschlag"},
    seconds={"total": 1.5},
    provenance={"version": "0"},
)


def new_store(out: Path) -> RunStore:
    return RunStore.create(out, {"study": {"name": "x"}})


def test_rows_round_trip_exactly(tmp_path) -> None:
    record = Record(0, 0, (3, 1, 4), "", EVALUATION, True, "pid 1", 0.25)
    other = Record(None, None, (3, 1, 4), "hover", EVALUATION)
    state = Generation(0, 1, 0, 1, 0, None, (0,))
    with new_store(tmp_path) as store:
        store.enqueue([(0, 0, (3, 1, 4), EVALUATION.design)], "hash")
        store.enqueue([(None, None, (3, 1, 4), EVALUATION.design)], "hash", "hover")
        store.finish(record)
        store.finish(other)
        store.add_generation(state)
    with RunStore.read(tmp_path) as store:
        assert store.records() == [record, other]
        assert store.generations() == [state]
        assert store.meta == {"study": {"name": "x"}}


def test_identity_ignores_times_places_and_versions() -> None:
    document = json.loads(EVALUATION.to_json())
    document["parts"]["bracket"]["seconds"]["mesh"] = 99.0
    document["seconds"], document["provenance"] = {}, {}
    other = Record(0, 0, (1,), "", Evaluation.from_dict(document), True, "elsewhere", 9.0)
    same = Record(0, 0, (1,), "", EVALUATION).identity()
    assert same == other.identity()
    document["parts"]["bracket"]["com"][0] += 1e-16
    assert same != Record(0, 0, (1,), "", Evaluation.from_dict(document)).identity()


def test_a_row_is_finished_once(tmp_path) -> None:
    with new_store(tmp_path) as store:
        store.enqueue([(0, 0, (1,), EVALUATION.design)], "hash")
        store.finish(Record(0, 0, (1,), "", EVALUATION))
        with pytest.raises(StoreError, match="no unfinished row"):
            store.finish(Record(0, 0, (1,), "", EVALUATION))
        with pytest.raises(StoreError, match="no unfinished row"):
            store.finish(Record(1, 0, (2,), "", EVALUATION))


def test_failed_transaction_leaves_nothing(tmp_path) -> None:
    with new_store(tmp_path) as store:
        with pytest.raises(RuntimeError), store.transaction():
            store.enqueue([(0, 0, (1,), {})], "hash")
            raise RuntimeError
        assert store.counts() == {}


def test_not_a_number_is_refused(tmp_path) -> None:
    with new_store(tmp_path) as store:
        store.enqueue([(0, 0, (1,), {})], "hash")
        with pytest.raises(ValueError, match="JSON"):
            store.finish(Record(0, 0, (1,), "", Evaluation({}, "feasible", objectives={"x": float("nan")})))


def test_a_run_of_the_first_format_is_brought_up_to_date_when_it_is_read(tmp_path) -> None:
    run = optimize(study(), out=tmp_path / "run", cache=None, generations=2)
    old = sqlite3.connect(tmp_path / "run" / DATABASE)
    old.executescript("ALTER TABLE evaluations DROP COLUMN margins; PRAGMA user_version = 1;")
    old.close()
    again = load_run(tmp_path / "run")
    assert [record.evaluation.objectives for record in again.records] == [e.objectives for e in run.evaluations]
    assert {len(record.evaluation.margins) for record in again.records} == {0}
    assert [record.identity() | {"margins": {}} for record in run.records] == [r.identity() for r in again.records]
    with RunStore.open(tmp_path / "run") as store:  # statuses that the first format did not know are taken
        store._execute("UPDATE evaluations SET status = 'skipped' WHERE number = 0")


def test_missing_foreign_newer_and_broken_files_are_refused(tmp_path, monkeypatch) -> None:
    with pytest.raises(StoreError, match="no run here"):
        RunStore.open(tmp_path)
    with pytest.raises(StoreError, match="no run here"):
        load_run(tmp_path / "nowhere")
    with new_store(tmp_path / "newer") as store:
        store._execute(f"PRAGMA user_version = {VERSION + 1}")
    foreign = tmp_path / "foreign"
    foreign.mkdir()
    sqlite3.connect(foreign / DATABASE).execute("CREATE TABLE t (x)").connection.close()
    broken = tmp_path / "broken"
    broken.mkdir()
    (broken / DATABASE).write_bytes(b"not a database at all" * 1000)
    messages = {"newer": "newer codesign", "foreign": "not a run of codesign", "broken": "not a database"}
    opened, connect = [], sqlite3.connect
    monkeypatch.setattr(sqlite3, "connect", lambda *a, **k: opened.append(connect(*a, **k)) or opened[-1])
    for name, message in messages.items():
        before = (tmp_path / name / DATABASE).read_bytes()
        for open_store in (RunStore.open, RunStore.read):
            with pytest.raises(StoreError, match=message):
                open_store(tmp_path / name)
        assert (tmp_path / name / DATABASE).read_bytes() == before
    (tmp_path / "cache").write_bytes(b"not a database at all" * 1000)
    assert SqliteCache(tmp_path / "cache").get("key") is None
    assert len(opened) >= 7
    for connection in opened:
        with pytest.raises(sqlite3.ProgrammingError, match="closed"):
            connection.execute("SELECT 1")


def test_failed_creation_leaves_no_file(tmp_path) -> None:
    with pytest.raises(ValueError, match="JSON"):
        RunStore.create(tmp_path / "run", {"x": float("nan")})
    assert [path.name for path in (tmp_path / "run").iterdir()] == ["run.lock"]
    new_store(tmp_path / "run").close()


def test_read_only_run_can_be_read_but_not_written(tmp_path) -> None:
    """In a process without the right to override permissions, as root has it."""
    optimize(study(), out=tmp_path / "run", cache=None, generations=1)
    before = (tmp_path / "run" / DATABASE).read_bytes()
    script = (
        "import sys; from codesign.storage.runs import load_run; from codesign.search.optimization import resume\n"
        "from codesign.errors import StoreError\n"
        "print(len(load_run(sys.argv[1]).records))\n"
        "try: resume(sys.argv[1])\n"
        "except StoreError as error: print(error)\n"
    )
    (tmp_path / "run").chmod(0o555)
    for path in (tmp_path / "run").iterdir():
        path.chmod(0o444)
    try:
        process = run_script(script, tmp_path / "run", prepare=drop_override)
    finally:
        (tmp_path / "run").chmod(0o755)
    rows, error = process.stdout.splitlines()
    assert rows == "8"
    assert "cannot be written: Permission denied" in error
    assert (tmp_path / "run" / DATABASE).read_bytes() == before


def test_full_disk_stops_the_run_clearly_and_resume_goes_on(tmp_path) -> None:
    """The file may not grow past a limit, as on a full disk; later the limit is gone."""
    whole = optimize(study(seconds=0.001), out=tmp_path / "whole", cache=None, generations=12)
    script = (
        "import sys; from codesign.search.optimization import optimize; from fake_study import study\n"
        "from codesign.errors import StoreError\n"
        "try: optimize(study(seconds=0.001), out=sys.argv[1], cache=None, generations=12)\n"
        "except StoreError as error: print(error)\n"
    )

    def limit_files() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (60_000, 60_000))

    process = run_script(script, tmp_path / "run", prepare=limit_files)
    assert str(tmp_path / "run" / DATABASE) in process.stdout
    interrupted = load_run(tmp_path / "run")
    assert 0 < len(interrupted.records) < 96
    run = resume(tmp_path / "run")
    assert [r.identity() for r in run.records] == [r.identity() for r in whole.records]


def may_mount() -> bool:
    """Whether this user may mount a small disk; not so in many containers."""
    command = ["unshare", "-rm", "mount", "-t", "tmpfs", "none", "/mnt"]
    return shutil.which("unshare") is not None and subprocess.run(command, capture_output=True).returncode == 0


# How a disk gets full and has room again: a small one, and, where none may be mounted, SQLite's own limit.
DISKS = {
    "pages": (
        "connect = sqlite3.connect\n"
        "class Small(sqlite3.Connection):\n"
        "    def __init__(self, *a, **k):\n"
        "        super().__init__(*a, **k); self.execute('PRAGMA max_page_count = 12')\n"
        "sqlite3.connect = lambda *a, **k: connect(*a, **k, factory=Small)\n",
        "sqlite3.connect = connect\n",
    ),
    "tmpfs": ("", "subprocess.run(['mount', '-o', 'remount,size=50m', folder], check=True)\n"),
}


@pytest.mark.parametrize("disk", ["pages", "tmpfs"] if may_mount() else ["pages"])
def test_a_run_goes_on_when_a_full_disk_has_room_again(tmp_path, disk) -> None:
    full, room = DISKS[disk]
    folder = tmp_path / "disk"
    folder.mkdir()
    script = (
        "import sqlite3, subprocess, sys; from codesign.search.optimization import optimize, resume\n"
        "from fake_study import study\n"
        "from codesign.errors import StoreError\n"
        f"folder = {str(folder)!r}\n{full}"
        "try: optimize(study(seconds=0.001), out=f'{folder}/run', cache=f'{folder}/cache', generations=12)\n"
        f"except StoreError as error: print(error)\n{room}"
        "run = resume(f'{folder}/run')\n"
        "whole = optimize(study(seconds=0.001), out=sys.argv[1], cache=None, generations=12)\n"
        "print([r.identity() for r in run.records] == [r.identity() for r in whole.records])\n"
    )
    (tmp_path / "script.py").write_text(script)
    run = f"{sys.executable} {tmp_path}/script.py {tmp_path}/whole"
    if disk == "tmpfs":
        run = shlex.join(["unshare", "-rm", "sh", "-c", f"mount -t tmpfs -o size=300k none {folder} && {run}"])
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    process = subprocess.run(["sh", "-c", run], env=environment, capture_output=True, text=True, check=False)
    error, identical = process.stdout.splitlines() or ["", process.stderr]
    assert "full" in error
    assert identical == "True"


def run_script(script: str, argument: Path, prepare) -> subprocess.CompletedProcess:
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    command = [sys.executable, "-c", script, str(argument)]
    return subprocess.run(
        command, env=environment, preexec_fn=prepare, stdout=subprocess.PIPE, text=True, check=True, timeout=120
    )


def drop_override() -> None:
    """Takes CAP_DAC_OVERRIDE (1) and CAP_DAC_READ_SEARCH (2) from what the next program may have (prctl 24)."""
    libc = ctypes.CDLL(None)
    libc.prctl(24, 1)
    libc.prctl(24, 2)
