"""A run's results in one SQLite file: one row per design, written by one process, whole after a crash of the writer.

The file `run.sqlite` is in WAL mode: a stored row survives the end of the process, however it ends, and a power cut if
a checkpoint came after it (each generation makes one); no power cut damages the file. `run.lock` holds the writer's
lock, which the kernel releases when the process ends.
"""

from __future__ import annotations

import contextlib
import dataclasses
import json
import sqlite3
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import IO, Any

from codesign.errors import StoreError
from codesign.files import replacing
from codesign.problem.design_space import DesignValue
from codesign.problem.evaluation import Evaluation
from codesign.storage.database import (
    APPLICATION_ID,
    DATABASE,
    LOCK,
    MIGRATIONS,
    VERSION,
    connect_to_read,
    existing,
    guard,
    lock_folder,
    now,
    write_new,
)
from codesign.storage.records import Generation, Grid, Record

FINISHED_ROW = "status NOT IN ('queued', 'running')"
DECODED = 256  # rows whose JSON is read at a time
UNFINISHED_ROW = "grid = ? AND trajectory = ? AND status IN ('queued', 'running')"
JSON_FIELDS = (
    "objectives",
    "objective_families",
    "constraints",
    "violations",
    "margins",
    "parts",
    "flight",
    "seconds",
    "provenance",
)


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
        lock = lock_folder(out)
        try:
            path = out / DATABASE
            if path.exists():
                raise StoreError(f"{out} holds a run already: continue it with resume, or choose another folder")
            with guard(path), replacing(path) as beside:
                write_new(beside, meta)
        except BaseException as error:
            lock.close()
            if isinstance(error, OSError):
                raise StoreError(f"{out}: cannot be written: {error.strerror}") from error
            raise
        return cls._connect(path, lock)

    @classmethod
    def open(cls, out: str | Path) -> RunStore:
        """An existing run, open for writing; rows that a dead writer left as running are queued again.

        Raises: StoreError if there is none, another process writes it, or it is no store or one of a newer program.
        """
        path = existing(out)
        store = cls._connect(path, lock_folder(path.parent))
        with store.transaction():
            store._execute("UPDATE evaluations SET status = 'queued' WHERE status = 'running'")
        return store

    @classmethod
    def read(cls, out: str | Path) -> RunStore:
        """An existing run for reading only, also while another process writes it, also from a read-only place.

        A run of an older format is brought up to date first, as by `open`. Raises: StoreError.
        """
        path = existing(out)
        errors = []
        for mode in ("mode=ro", "mode=ro&immutable=1"):
            if "immutable" in mode and path.with_name(DATABASE + "-wal").exists():
                continue
            try:
                store = cls(path, connect_to_read(path, mode), None)
            except sqlite3.Error as error:
                errors.append(str(error))
                continue
            if not store._older():
                return store._checked()
            store.close()
            cls.open(out).close()  # brings its format up to date
            return cls.read(out)
        raise StoreError(f"{path}: cannot be read: {'; '.join(errors)}")

    @classmethod
    def _connect(cls, path: Path, lock: IO[bytes]) -> RunStore:
        try:
            with guard(path):
                connection = sqlite3.connect(path, isolation_level=None, timeout=30.0)
        except StoreError:
            lock.close()
            raise
        return cls(path, connection, lock)._checked()

    def _checked(self) -> RunStore:
        """Itself, if the file is a store; closed otherwise. A foreign file is not changed."""
        try:
            self._check_version()
            if self._lock is not None:
                self._execute("PRAGMA journal_mode = WAL")
                self._execute("PRAGMA synchronous = NORMAL")
        except BaseException:
            self.close()
            raise
        return self

    def _older(self) -> bool:
        """Whether the file is a run of an earlier format; closed if it is none at all."""
        try:
            (application,) = self._execute("PRAGMA application_id").fetchone()
            (version,) = self._execute("PRAGMA user_version").fetchone()
        except BaseException:
            self.close()
            raise
        return bool(application == APPLICATION_ID and version < VERSION)

    def _check_version(self) -> None:
        (application,) = self._execute("PRAGMA application_id").fetchone()
        (version,) = self._execute("PRAGMA user_version").fetchone()
        if application != APPLICATION_ID:
            raise StoreError(f"{self.path}: is not a run of codesign")
        if version > VERSION:
            raise StoreError(f"{self.path}: written by a newer codesign (format {version}, this one reads {VERSION})")
        while version < VERSION:
            with guard(self.path):
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

    def discard(self) -> None:
        """Closes the run and removes its file; its folder too if nothing else is in it."""
        folder = self.path.parent
        with contextlib.suppress(sqlite3.Error):
            self._connection.close()
        for path in (
            self.path,
            *(self.path.with_name(self.path.name + end) for end in ("-wal", "-shm")),
            folder / LOCK,
        ):
            path.unlink(missing_ok=True)
        self.close()
        with contextlib.suppress(OSError):
            folder.rmdir()

    def _execute(self, statement: str, values: Sequence[Any] = ()) -> sqlite3.Cursor:
        with guard(self.path):
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
        rows: Iterable[tuple[int | None, int | None, Grid, dict[str, DesignValue]]],
        study_hash: str,
        trajectory: str = "",
    ) -> None:
        """Adds rows (number, generation, grid indices, design) to evaluate.

        Those that exist keep their state; one without a number gets the given one.
        """
        with guard(self.path):
            self._connection.executemany(
                "INSERT INTO evaluations (number, generation, grid, trajectory, study_hash, status, design) "
                "VALUES (?, ?, ?, ?, ?, 'queued', ?) ON CONFLICT (grid, trajectory, study_hash) DO UPDATE "
                "SET number = excluded.number, generation = excluded.generation WHERE evaluations.number IS NULL",
                [(n, g, _grid_key(grid), trajectory, study_hash, json.dumps(design)) for n, g, grid, design in rows],
            )

    def mark(self, grids: Iterable[Grid], status: str, trajectory: str = "") -> None:
        """Sets unfinished rows to `queued` or `running`."""
        with guard(self.path):
            self._connection.executemany(
                f"UPDATE evaluations SET status = ? WHERE {UNFINISHED_ROW}",
                [(status, _grid_key(grid), trajectory) for grid in grids],
            )

    def retry(self, pairs: Iterable[tuple[Grid, str]]) -> None:
        """Makes failed rows (grid indices, trajectory) that are not the search's unfinished again."""
        with guard(self.path):
            self._connection.executemany(
                "UPDATE evaluations SET status = 'queued' "
                "WHERE grid = ? AND trajectory = ? AND status = 'failed' AND number IS NULL",
                [(_grid_key(grid), trajectory) for grid, trajectory in pairs],
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
        return list(self._finished())

    def known(self) -> dict[Grid, tuple[int | None, str]]:
        """Number and status of the designs that are finished on the study's own trajectory, by grid point."""
        statement = f"SELECT grid, number, status FROM evaluations WHERE {FINISHED_ROW} AND trajectory = ''"
        return {tuple(json.loads(grid)): (number, status) for grid, number, status in self._execute(statement)}

    def evaluation(self, grid: Grid) -> Evaluation:
        """The result of a design that is finished on the study's own trajectory. Raises: StoreError if it is not."""
        for record in self._finished("AND grid = ? AND trajectory = ''", (_grid_key(grid),)):
            return record.evaluation
        raise StoreError(f"{self.path}: no finished row for the design {list(grid)}")

    def _finished(self, which: str = "", values: Sequence[Any] = ()) -> Iterator[Record]:
        columns = ("number", "generation", "trajectory", "cached", "worker", "wall_seconds", "status", "reason")
        documents = ("grid", "design", *JSON_FIELDS)
        rows = self._execute(
            f"SELECT {', '.join(columns + documents)} FROM evaluations WHERE {FINISHED_ROW} {which} "
            "ORDER BY number IS NULL, number, id",
            values,
        )
        while part := rows.fetchmany(DECODED):
            texts = (",".join(row[len(columns) :]) for row in part)
            decoded = json.loads(f"[{','.join(f'[{text}]' for text in texts)}]")  # at once: rows share their keys
            for row, (grid, *fields) in zip(part, decoded, strict=True):
                number, generation, trajectory, cached, worker, wall, status, reason = row[: len(columns)]
                document = dict(zip(documents[1:], fields, strict=True))
                evaluation = Evaluation(status=status, reason=reason, **document)
                place = (number, generation, tuple(grid), trajectory)
                yield Record(*place, evaluation, bool(cached), worker or "", wall or 0.0)

    def asked(self) -> list[Grid]:
        """The designs that the search has asked for, finished or not, in its order."""
        rows = self._execute("SELECT grid FROM evaluations WHERE number IS NOT NULL ORDER BY number")
        return [tuple(json.loads(grid)) for (grid,) in rows]

    def counts(self) -> dict[str, int]:
        """Number of the search's designs by status; further flights of designs, say, are not counted."""
        asked = "SELECT status, count(*) FROM evaluations WHERE number IS NOT NULL GROUP BY status ORDER BY status"
        return dict(self._execute(asked))

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


def _grid_key(grid: Grid) -> str:
    return json.dumps([int(index) for index in grid], separators=(",", ":"))
