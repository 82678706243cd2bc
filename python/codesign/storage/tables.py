"""A run's rows as a table for other programs: CSV or Parquet."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

from codesign.errors import StoreError
from codesign.files import replacing
from codesign.storage.records import Record
from codesign.storage.runs import Run


def table(run: Run) -> list[dict[str, Any]]:
    """A flat dictionary a row: design variables by name (in the study's units), all else SI, as `group.name`.

    All rows have the same keys. Vectors and matrices are spread over `name.0`, `name.1`, …; what a row lacks is None.
    """
    rows = [_flat(record) for record in run.records]
    names = list(dict.fromkeys(name for row in rows for name in row))
    return [{name: row.get(name) for name in names} for row in rows]


def export(run: Run, path: str | Path) -> Path:
    """Writes all rows to a `.csv` or `.parquet` file (replaced as a whole, never left half-written).

    CSV floats are written so that they read back exactly. Raises: StoreError if it cannot be written.
    """
    path = Path(path)
    writers: dict[str, Callable[[list[dict[str, Any]], Path], None]] = {".csv": _write_csv, ".parquet": _write_parquet}
    if path.suffix not in writers:
        raise StoreError(f"{path}: a table is written as .csv or .parquet")
    try:
        with replacing(path) as beside:
            writers[path.suffix](table(run), beside)
    except OSError as error:
        raise StoreError(f"{path}: cannot be written: {error.strerror or error}") from error
    return path


def _flat(record: Record) -> dict[str, Any]:
    evaluation = record.evaluation
    row: dict[str, Any] = {"number": record.number, "generation": record.generation, "trajectory": record.trajectory}
    row |= evaluation.design
    row |= {"status": evaluation.status, "reason": evaluation.reason}
    groups = ("objectives", "objective_families", "constraints", "violations", "margins", "parts", "flight", "seconds")
    for group in groups:
        row |= dict(_leaves(group, getattr(evaluation, group)))
    return row | {"cached": record.cached, "worker": record.worker, "wall_seconds": record.wall_seconds}


def _leaves(name: str, value: Any) -> Iterator[tuple[str, Any]]:
    if isinstance(value, Mapping):
        for key, entry in value.items():
            yield from _leaves(f"{name}.{key}", entry)
    elif isinstance(value, list):
        for index, entry in enumerate(value):
            yield from _leaves(f"{name}.{index}", entry)
    else:
        yield name, value


def _write_csv(rows: list[dict[str, Any]], path: Path) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(rows[0]) if rows else [])
        writer.writeheader()
        writer.writerows(rows)


def _write_parquet(rows: list[dict[str, Any]], path: Path) -> None:
    try:
        import pyarrow
        from pyarrow import parquet
    except ImportError as error:
        raise StoreError("Parquet needs the package pyarrow: pip install 'codesign[analysis]'") from error
    columns = {name: _column([row[name] for row in rows]) for name in rows[0]} if rows else {}
    parquet.write_table(pyarrow.table(columns), path)


def _column(values: list[Any]) -> list[Any]:
    """Values of one type: whole numbers among fractions become fractions, mixtures become JSON text."""
    kinds = {type(value) for value in values if value is not None}
    if kinds <= {int, float} and float in kinds:
        return [None if value is None else float(value) for value in values]
    if len(kinds) > 1:
        return [None if value is None else json.dumps(value) for value in values]
    return values
