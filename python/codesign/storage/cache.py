"""Persistent cache of what has been computed before: part analyses and whole evaluations.

A key already contains the hash of everything that decides its value, so an entry is never wrong, only unused; the cache
may be deleted at any time. It can never fail an evaluation: a cache that cannot be read or written is a cache miss.
"""

from __future__ import annotations

import contextlib
import json
import logging
import os
import sqlite3
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from codesign.problem.identity import Identity

logger = logging.getLogger(__name__)

BUSY_TIMEOUT = 30.0  # s to wait for another process's write
SCHEMA = """
CREATE TABLE IF NOT EXISTS entries (key TEXT PRIMARY KEY, value TEXT NOT NULL, stored REAL NOT NULL);
CREATE TABLE IF NOT EXISTS programs (hash TEXT PRIMARY KEY, identity TEXT NOT NULL, used REAL NOT NULL);
"""


class MemoryCache:
    """A cache that lives as long as the object."""

    def __init__(self) -> None:
        self._entries: dict[str, str] = {}

    def get(self, key: str) -> dict[str, Any] | None:
        """The stored value, or None."""
        text = self._entries.get(key)
        return None if text is None else json.loads(text)

    def put(self, key: str, value: dict[str, Any]) -> None:
        """Stores a JSON-compatible value (a copy)."""
        self._entries[key] = json.dumps(value, allow_nan=False)


class SqliteCache:
    """A cache in one SQLite file (WAL), safe to share between processes of one machine; floats round-trip exactly."""

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        self._connection: sqlite3.Connection | None = None
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            self._connection = sqlite3.connect(self.path, timeout=BUSY_TIMEOUT, isolation_level=None)
            self._connection.execute("PRAGMA journal_mode=WAL")
            self._connection.execute("PRAGMA synchronous=NORMAL")  # a power cut may lose entries, not damage the file
            self._connection.executescript(SCHEMA)
        except (OSError, sqlite3.Error) as error:
            self._disable(error)

    def _disable(self, error: Exception) -> None:
        logger.warning("cache %s is not usable, going on without it: %s", self.path, error)
        self.close()

    def get(self, key: str) -> dict[str, Any] | None:
        """The stored value, or None."""
        if self._connection is None:
            return None
        try:
            row = self._connection.execute("SELECT value FROM entries WHERE key = ?", (key,)).fetchone()
            return None if row is None else json.loads(row[0])
        except (sqlite3.Error, ValueError) as error:
            self._disable(error)
            return None

    def put(self, key: str, value: dict[str, Any]) -> None:
        """Stores a JSON-compatible value; raises ValueError for what JSON cannot hold (NaN, infinity)."""
        text = json.dumps(value, allow_nan=False)
        if self._connection is None:
            return
        try:
            self._connection.execute(
                "INSERT OR REPLACE INTO entries (key, value, stored) VALUES (?, ?, ?)", (key, text, time.time())
            )
        except sqlite3.Error as error:
            self._disable(error)

    def register(self, program: Identity) -> None:
        """Notes a program that uses the cache, and says once in what it differs from the one that used it before."""
        if self._connection is None:
            return
        try:
            rows = self._connection.execute("SELECT hash, identity FROM programs ORDER BY used DESC").fetchall()
            self._connection.execute(
                "INSERT OR REPLACE INTO programs (hash, identity, used) VALUES (?, ?, ?)",
                (program.hash, json.dumps(program.document()), time.time()),
            )
        except sqlite3.Error as error:
            self._disable(error)
            return
        if rows and program.hash not in [row[0] for row in rows]:
            before = Identity.from_document(json.loads(rows[0][1]))
            logger.warning(
                "cache %s: results of another program are not used: %s", self.path, before.differences(program)
            )

    def close(self) -> None:
        """Ends the use of the file; later calls find nothing and store nothing."""
        if self._connection is not None:
            self._connection.close()
            self._connection = None


@contextlib.contextmanager
def open_cache(path: str | Path | None, program: Identity) -> Iterator[SqliteCache | None]:
    """The cache in a file, for a program that uses it, in a `with` block; None: no cache."""
    if path is None:
        yield None
        return
    cache = SqliteCache(path)
    try:
        cache.register(program)
        yield cache
    finally:
        cache.close()


def default_cache_path(study_name: str) -> Path:
    """The cache shared by all runs of a study: `$CODESIGN_CACHE`, else the user's cache folder."""
    base = os.environ.get("CODESIGN_CACHE")
    if base is None:
        home = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
        base = str(Path(home) / "codesign")
    return Path(base) / f"{study_name}.sqlite"
