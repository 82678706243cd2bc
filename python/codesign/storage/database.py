"""A run's file as SQLite sees it: its format, its making, its lock and its errors."""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
import socket
import sqlite3
import time
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import IO, Any

from codesign.errors import StoreError

DATABASE = "run.sqlite"
LOCK = "run.lock"
APPLICATION_ID = 0x636F6473  # "cods": tells stores from other SQLite files
VERSION = 3
EVALUATIONS = """
CREATE TABLE evaluations (
  id INTEGER PRIMARY KEY,
  number INTEGER UNIQUE,            -- order in which the search asked for it, from 0; NULL: asked for by a person
  generation INTEGER,
  grid TEXT NOT NULL,               -- JSON list of grid indices, in the order of the study's variables
  trajectory TEXT NOT NULL DEFAULT '',  -- '': the study's own
  study_hash TEXT NOT NULL,
  status TEXT NOT NULL CHECK (status IN ('queued', 'running', 'feasible', 'infeasible', 'skipped', 'failed')),
  reason TEXT,
  design TEXT NOT NULL,             -- JSON objects from here on, as in Evaluation
  objectives TEXT, objective_families TEXT, constraints TEXT, violations TEXT, margins TEXT,
  parts TEXT, flight TEXT, seconds TEXT, provenance TEXT,
  cached INTEGER NOT NULL DEFAULT 0, worker TEXT, wall_seconds REAL, finished TEXT,
  UNIQUE (grid, trajectory, study_hash)
);
"""
COLUMNS = (
    "id, number, generation, grid, trajectory, study_hash, status, reason, design, objectives, objective_families, "
    "constraints, violations, margins, parts, flight, seconds, provenance, cached, worker, wall_seconds, finished"
)
SCHEMA = f"""
CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT NOT NULL);
{EVALUATIONS}
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
MIGRATIONS = {  # version -> script that makes it version + 1
    1: "ALTER TABLE evaluations ADD COLUMN margins TEXT; UPDATE evaluations SET margins = '{}';",
    2: f"ALTER TABLE evaluations RENAME TO old; {EVALUATIONS} INSERT INTO evaluations ({COLUMNS}) SELECT {COLUMNS} "
    "FROM old; DROP TABLE old;",
}


def now() -> str:
    """Time stamp of rows and sessions (UTC, ISO 8601)."""
    return time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime())


def existing(out: str | Path) -> Path:
    """The file of the run in folder `out`; raises StoreError if there is none."""
    path = Path(out) / DATABASE
    try:
        found = path.is_file()
    except OSError as error:
        raise StoreError(f"{path}: cannot be read: {error.strerror}") from error
    if not found:
        raise StoreError(f"{out}: no run here (no file {DATABASE})")
    return path


def lock_folder(out: Path) -> IO[bytes]:
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


def write_new(path: Path, meta: Mapping[str, Any]) -> None:
    """The database of a run without rows."""
    with contextlib.closing(sqlite3.connect(path, isolation_level=None)) as connection:
        stamp = f"PRAGMA application_id = {APPLICATION_ID}; PRAGMA user_version = {VERSION};"
        connection.executescript(f"BEGIN; {SCHEMA} {stamp} COMMIT;")
        rows = [(key, json.dumps(value, allow_nan=False)) for key, value in meta.items()]
        connection.executemany("INSERT INTO meta (key, value) VALUES (?, ?)", rows)


def connect_to_read(path: Path, mode: str) -> sqlite3.Connection:
    """A database that can be read, opened as SQLite's URI parameters say. Raises: sqlite3.Error: it cannot."""
    connection = sqlite3.connect(f"{path.resolve().as_uri()}?{mode}", uri=True, isolation_level=None)
    try:
        connection.execute("SELECT count(*) FROM sqlite_schema")
    except BaseException:
        connection.close()
        raise
    return connection


@contextlib.contextmanager
def guard(path: Path) -> Iterator[None]:
    """Turns SQLite's errors into StoreError."""
    try:
        yield
    except (sqlite3.Error, sqlite3.Warning) as error:
        raise StoreError(f"{path}: {error}") from error
