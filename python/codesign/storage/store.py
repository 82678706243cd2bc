"""A run's results in one SQLite file: a row a design, written by one process, never damaged by its end.

The file `run.sqlite` is in WAL mode: a stored row survives the end of the process, however it ends, and a power cut if
a checkpoint came after it (each generation makes one); no power cut damages the file. `run.lock` holds the writer's
lock, which the kernel releases when the process ends.
"""

from __future__ import annotations

import contextlib
import dataclasses
import fcntl
import json
import os
import socket
import sqlite3
import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

from codesign.errors import StoreError
from codesign.files import replacing
from codesign.problem.evaluation import Evaluation

DATABASE = "run.sqlite"
LOCK = "run.lock"
APPLICATION_ID = 0x636F6473  # "cods": tells our files from other SQLite files
VERSION = 1
SCHEMA = """
CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT NOT NULL);
CREATE TABLE evaluations (
  id INTEGER PRIMARY KEY,
  number INTEGER UNIQUE,            -- order in which the search asked for it, from 0; NULL: asked for by a person
  generation INTEGER,
  grid TEXT NOT NULL,               -- JSON list of grid indices, in the order of the study's variables
  trajectory TEXT NOT NULL DEFAULT '',  -- '': the study's own
  study_hash TEXT NOT NULL,
  status TEXT NOT NULL CHECK (status IN ('queued', 'running', 'feasible', 'infeasible', 'failed')),
  reason TEXT,
  design TEXT NOT NULL,             -- JSON objects from here on, as in Evaluation
  objectives TEXT, objective_families TEXT, constraints TEXT, violations TEXT,
  parts TEXT, flight TEXT, seconds TEXT, provenance TEXT,
  cached INTEGER NOT NULL DEFAULT 0, worker TEXT, wall_seconds REAL, finished TEXT,
  UNIQUE (grid, trajectory, study_hash)
);
CREATE TABLE generations (
  generation INTEGER PRIMARY KEY,
  told INTEGER NOT NULL,            -- designs ranked or failed so far
  feasible INTEGER NOT NULL, infeasible INTEGER NOT NULL, failed INTEGER NOT NULL,
  hypervolume REAL,                 -- of all feasible designs so far; NULL before the first
  population TEXT NOT NULL          -- JSON list of numbers: the survivors, in the algorithm's order
);
CREATE TABLE sessions (
  id INTEGER PRIMARY KEY, started TEXT NOT NULL, ended TEXT, outcome TEXT, seconds REAL NOT NULL DEFAULT 0,
  provenance TEXT NOT NULL          -- JSON: host, pid, versions, workers
);
"""
MIGRATIONS: dict[int, str] = {}  # version -> script that makes it version + 1
UNFINISHED_ROW = "grid = ? AND trajectory = ? AND status IN ('queued', 'running')"
JSON_FIELDS = (
    "objectives",
    "objective_families",
    "constraints",
    "violations",
    "parts",
    "flight",
    "seconds",
    "provenance",
)

Grid = tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Record:
    """A finished row."""

    number: int | None
    generation: int | None
    grid: Grid
    trajectory: str
    evaluation: Evaluation
    cached: bool = False
    worker: str = ""
    wall_seconds: float = 0.0

    def identity(self) -> dict[str, Any]:
        """What must be equal in two runs of the same study: everything but times, places and versions."""
        document = _without_seconds(self.evaluation.to_dict())
        del document["provenance"]
        return {"number": self.number, "grid": self.grid, "trajectory": self.trajectory, **document}


@dataclass(frozen=True, slots=True)
class Generation:
    """State after a generation's results were told to the search."""

    generation: int
    told: int
    feasible: int
    infeasible: int
    failed: int
    hypervolume: float | None
    population: tuple[int, ...]


class RunStore:
    """The results of one run. Made by `create`, `open` (writing) or `read`; close it, or use it in a `with` block."""

    def __init__(self, path: Path, connection: sqlite3.Connection, lock: IO[bytes] | None) -> None:
        self.path, self._connection, self._lock = path, connection, lock
        self.meta: dict[str, Any] = {}

    @classmethod
    def create(cls, out: str | Path, meta: Mapping[str, Any]) -> RunStore:
        """A new run in folder `out` with its settings `meta` (JSON values), open for writing.

        Raises: StoreError if `out` holds a run already, or cannot be written.
        """
        out = Path(out)
        try:
            out.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise StoreError(f"{out}: cannot be made: {error.strerror}") from error
        lock = _lock(out)
        try:
            path = out / DATABASE
            if path.exists():
                raise StoreError(f"{out} holds a run already: continue it with resume, or choose another folder")
            with _guard(path), replacing(path) as beside:
                _write_new(beside, meta)
        except BaseException as error:
            lock.close()
            if isinstance(error, OSError):
                raise StoreError(f"{out}: cannot be written: {error.strerror}") from error
            raise
        return cls._connect(path, lock)

    @classmethod
    def open(cls, out: str | Path) -> RunStore:
        """An existing run, open for writing; rows that a dead writer left as running are queued again.

        Raises: StoreError if there is none, another process writes it, or it is not ours or newer than this program.
        """
        path = _existing(out)
        store = cls._connect(path, _lock(path.parent))
        with store.transaction():
            store._execute("UPDATE evaluations SET status = 'queued' WHERE status = 'running'")
        return store

    @classmethod
    def read(cls, out: str | Path) -> RunStore:
        """An existing run for reading only, also while another process writes it, also from a read-only place."""
        path = _existing(out)
        errors = []
        for mode in ("mode=ro", "mode=ro&immutable=1"):
            if "immutable" in mode and path.with_name(DATABASE + "-wal").exists():
                continue
            try:
                connection = sqlite3.connect(f"{path.resolve().as_uri()}?{mode}", uri=True, isolation_level=None)
                connection.execute("SELECT count(*) FROM sqlite_schema")
            except sqlite3.Error as error:
                errors.append(str(error))
                continue
            return cls(path, connection, None)._checked()
        raise StoreError(f"{path}: cannot be read: {'; '.join(errors)}")

    @classmethod
    def _connect(cls, path: Path, lock: IO[bytes]) -> RunStore:
        try:
            with _guard(path):
                connection = sqlite3.connect(path, isolation_level=None, timeout=30.0)
        except StoreError:
            lock.close()
            raise
        return cls(path, connection, lock)._checked()

    def _checked(self) -> RunStore:
        """Itself, if the file is one of ours; closed otherwise. A foreign file is not changed."""
        try:
            self._check_version()
            if self._lock is not None:
                self._execute("PRAGMA journal_mode = WAL")
                self._execute("PRAGMA synchronous = NORMAL")
        except BaseException:
            self.close()
            raise
        return self

    def _check_version(self) -> None:
        (application,) = self._execute("PRAGMA application_id").fetchone()
        (version,) = self._execute("PRAGMA user_version").fetchone()
        if application != APPLICATION_ID:
            raise StoreError(f"{self.path}: is not a run of codesign")
        if version > VERSION:
            raise StoreError(f"{self.path}: written by a newer codesign (format {version}, this one reads {VERSION})")
        if version < VERSION and self._lock is None:
            raise StoreError(f"{self.path}: format {version} is older than {VERSION}; `codesign resume` updates it")
        while version < VERSION:
            with _guard(self.path):
                step = f"BEGIN IMMEDIATE; {MIGRATIONS[version]} PRAGMA user_version = {version + 1}; COMMIT;"
                self._connection.executescript(step)
            version += 1
        self.meta = {key: json.loads(value) for key, value in self._execute("SELECT key, value FROM meta")}

    def __enter__(self) -> RunStore:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Ends the use of the file and releases the writer's lock."""
        with contextlib.suppress(sqlite3.Error):
            self._connection.close()
        if self._lock is not None:
            self._lock.close()

    def _execute(self, statement: str, values: Sequence[Any] = ()) -> sqlite3.Cursor:
        with _guard(self.path):
            return self._connection.execute(statement, values)

    @contextlib.contextmanager
    def transaction(self) -> Iterator[None]:
        """Everything inside is stored together, or not at all."""
        self._execute("BEGIN IMMEDIATE")
        try:
            yield
            self._execute("COMMIT")
        except BaseException:
            with contextlib.suppress(sqlite3.Error):
                self._connection.execute("ROLLBACK")
            raise

    def checkpoint(self) -> None:
        """Brings everything stored so far to the disk."""
        self._execute("PRAGMA wal_checkpoint(PASSIVE)").fetchall()

    def set_meta(self, key: str, value: Any) -> None:
        """Stores a JSON value of the run."""
        self._execute("INSERT OR REPLACE INTO meta (key, value) VALUES (?, ?)", (key, json.dumps(value)))
        self.meta[key] = value

    def enqueue(
        self,
        rows: Iterable[tuple[int | None, int | None, Grid, dict[str, float]]],
        study_hash: str,
        trajectory: str = "",
    ) -> None:
        """Adds rows (number, generation, grid indices, design) to evaluate.

        Those that exist keep their state; one without a number gets the given one.
        """
        with _guard(self.path):
            self._connection.executemany(
                "INSERT INTO evaluations (number, generation, grid, trajectory, study_hash, status, design) "
                "VALUES (?, ?, ?, ?, ?, 'queued', ?) ON CONFLICT (grid, trajectory, study_hash) DO UPDATE "
                "SET number = excluded.number, generation = excluded.generation WHERE evaluations.number IS NULL",
                [(n, g, _grid_key(grid), trajectory, study_hash, json.dumps(design)) for n, g, grid, design in rows],
            )

    def mark(self, grids: Iterable[Grid], status: str, trajectory: str = "") -> None:
        """Sets unfinished rows to `queued` or `running`."""
        with _guard(self.path):
            self._connection.executemany(
                f"UPDATE evaluations SET status = ? WHERE {UNFINISHED_ROW}",
                [(status, _grid_key(grid), trajectory) for grid in grids],
            )

    def finish(self, record: Record) -> None:
        """Stores the result of an enqueued row."""
        evaluation = record.evaluation
        values: dict[str, Any] = {name: json.dumps(getattr(evaluation, name), allow_nan=False) for name in JSON_FIELDS}
        values |= {"status": evaluation.status, "reason": evaluation.reason, "cached": int(record.cached)}
        values |= {"worker": record.worker, "wall_seconds": record.wall_seconds, "finished": now()}
        names = ", ".join(f"{name} = ?" for name in values)
        cursor = self._execute(
            f"UPDATE evaluations SET {names} WHERE {UNFINISHED_ROW}",
            [*values.values(), _grid_key(record.grid), record.trajectory],
        )
        if cursor.rowcount != 1:
            raise StoreError(f"{self.path}: no unfinished row for the design {evaluation.design}")

    def records(self) -> list[Record]:
        """All finished rows: the search's in the order it asked for them, then the others."""
        columns = ("number", "generation", "grid", "trajectory", "cached", "worker", "wall_seconds")
        fields = ("design", "status", "reason", *JSON_FIELDS)
        statement = (
            f"SELECT {', '.join(columns + fields)} FROM evaluations WHERE status NOT IN ('queued', 'running') "
            "ORDER BY number IS NULL, number, id"
        )
        records = []
        for row in self._execute(statement):
            values = dict(zip(columns + fields, row, strict=True))
            document = {name: json.loads(values[name]) for name in ("design", *JSON_FIELDS)}
            evaluation = Evaluation(status=values["status"], reason=values["reason"], **document)
            grid = tuple(json.loads(values["grid"]))
            cached, wall = bool(values["cached"]), values["wall_seconds"] or 0.0
            worker = values["worker"] or ""
            place = (values["number"], values["generation"], grid, values["trajectory"])
            records.append(Record(*place, evaluation, cached, worker, wall))
        return records

    def asked(self) -> int:
        """How many designs the search has asked for, finished or not."""
        (count,) = self._execute("SELECT count(number) FROM evaluations").fetchone()
        return int(count)

    def counts(self) -> dict[str, int]:
        """Number of rows by status."""
        return dict(self._execute("SELECT status, count(*) FROM evaluations GROUP BY status ORDER BY status"))

    def add_generation(self, generation: Generation) -> None:
        """Stores the state after a generation; the same one again changes nothing."""
        g = generation
        values = (g.generation, g.told, g.feasible, g.infeasible, g.failed, g.hypervolume, json.dumps(g.population))
        self._execute("INSERT OR REPLACE INTO generations VALUES (?, ?, ?, ?, ?, ?, ?)", values)

    def generations(self) -> list[Generation]:
        """The states after each generation."""
        names = [field.name for field in dataclasses.fields(Generation)]
        rows = self._execute(f"SELECT {', '.join(names)} FROM generations ORDER BY generation")
        states = (dict(zip(names, row, strict=True)) for row in rows)
        return [Generation(**state | {"population": tuple(json.loads(state["population"]))}) for state in states]

    def start_session(self, provenance: Mapping[str, Any]) -> int:
        """Records that this process works on the run; returns the session's number."""
        cursor = self._execute(
            "INSERT INTO sessions (started, provenance) VALUES (?, ?)", (now(), json.dumps(dict(provenance)))
        )
        assert cursor.lastrowid is not None
        return cursor.lastrowid

    def update_session(self, session: int, seconds: float, outcome: str | None = None) -> None:
        """Records a session's wall time so far and, at its end, how it ended."""
        ended = now() if outcome is not None else None
        self._execute(
            "UPDATE sessions SET seconds = ?, outcome = ?, ended = ? WHERE id = ?", (seconds, outcome, ended, session)
        )

    def sessions(self) -> list[dict[str, Any]]:
        """Who worked on the run, when and how it ended."""
        rows = self._execute("SELECT id, started, ended, outcome, seconds, provenance FROM sessions ORDER BY id")
        names = ("id", "started", "ended", "outcome", "seconds")
        return [dict(zip(names, row[:5], strict=True)) | {"provenance": json.loads(row[5])} for row in rows]


def now() -> str:
    """Time stamp of rows and sessions (UTC, ISO 8601)."""
    return time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime())


def _existing(out: str | Path) -> Path:
    path = Path(out) / DATABASE
    try:
        found = path.is_file()
    except OSError as error:
        raise StoreError(f"{path}: cannot be read: {error.strerror}") from error
    if not found:
        raise StoreError(f"{out}: no run here (no file {DATABASE})")
    return path


def _lock(out: Path) -> IO[bytes]:
    """The writer's lock of a run's folder; raises StoreError naming the process that holds it."""
    path = out / LOCK
    try:
        lock = path.open("a+b", buffering=0)
    except OSError as error:
        raise StoreError(f"{path}: cannot be written: {error.strerror}") from error
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        lock.seek(0)
        holder = (lock.read() or b"").decode().strip() or "another process"
        lock.close()
        raise StoreError(f"{out}: this run is being written by {holder}") from error
    with contextlib.suppress(OSError):  # full disk: the lock holds without the text
        lock.truncate(0)
        lock.write(f"process {os.getpid()} on {socket.gethostname()} since {now()}\n".encode())
    return lock


def _write_new(path: Path, meta: Mapping[str, Any]) -> None:
    """The database of a run without rows."""
    with contextlib.closing(sqlite3.connect(path, isolation_level=None)) as connection:
        stamp = f"PRAGMA application_id = {APPLICATION_ID}; PRAGMA user_version = {VERSION};"
        connection.executescript(f"BEGIN; {SCHEMA} {stamp} COMMIT;")
        rows = [(key, json.dumps(value, allow_nan=False)) for key, value in meta.items()]
        connection.executemany("INSERT INTO meta (key, value) VALUES (?, ?)", rows)


@contextlib.contextmanager
def _guard(path: Path) -> Iterator[None]:
    """Turns SQLite's errors into StoreError."""
    try:
        yield
    except (sqlite3.Error, sqlite3.Warning) as error:
        raise StoreError(f"{path}: {error}") from error


def _grid_key(grid: Grid) -> str:
    return json.dumps([int(index) for index in grid], separators=(",", ":"))


def _without_seconds(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _without_seconds(entry) for key, entry in value.items() if key != "seconds"}
    return value
