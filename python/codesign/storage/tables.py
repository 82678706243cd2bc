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
    return list(_rows(run, _names(run)))


def export(run: Run, path: str | Path) -> Path:
    """Writes all rows to a `.csv` or `.parquet` file (replaced as a whole, never left half-written).

    CSV floats are written so that they read back exactly. Raises: StoreError if it cannot be written.
    """
    path = Path(path)
    writers: dict[str, Callable[[Run, Path], None]] = {".csv": _write_csv, ".parquet": _write_parquet}
    if path.suffix not in writers:
        raise StoreError(f"{path}: a table is written as .csv or .parquet")
    try:
        with replacing(path) as beside:
            writers[path.suffix](run, beside)
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


def _names(run: Run) -> list[str]:
    """Names of all columns, in the order of their first appearance."""
    return list(dict.fromkeys(name for record in run.records for name in _flat(record)))


def _rows(run: Run, names: list[str]) -> Iterator[dict[str, Any]]:
    """The rows one by one: all of them at once take several times the memory of the run."""
    for record in run.records:
        row = _flat(record)
        yield {name: row.get(name) for name in names}


def _write_csv(run: Run, path: Path) -> None:
    names = _names(run)
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, names)
        writer.writeheader()
        writer.writerows(_rows(run, names))


def _write_parquet(run: Run, path: Path) -> None:
    try:
        import pyarrow
        from pyarrow import parquet
    except ImportError as error:
        raise StoreError("Parquet needs the package pyarrow: pip install 'codesign[analysis]'") from error
    columns: dict[str, list[Any]] = {name: [] for name in _names(run)}
    for row in _rows(run, list(columns)):
        for name, value in row.items():
            columns[name].append(value)
    parquet.write_table(pyarrow.table({name: _column(values) for name, values in columns.items()}), path)


def _column(values: list[Any]) -> list[Any]:
    """Values of one type: whole numbers among fractions become fractions, mixtures become JSON text."""
    kinds = {type(value) for value in values if value is not None}
    if kinds <= {int, float} and float in kinds:
        return [None if value is None else float(value) for value in values]
    if len(kinds) > 1:
        return [None if value is None else json.dumps(value) for value in values]
    return values
