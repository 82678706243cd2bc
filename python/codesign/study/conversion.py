"""TOML documents to checked configurations, with the place of what is wrong."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import msgspec

from codesign.errors import StudyError
from codesign.study.config import MaterialConfig, RawStudy, StudyConfig, TrajectoryConfig, VariableConfig


def convert(raw: RawStudy, path: Path) -> StudyConfig:
    """The configuration of a parsed study.toml. Raises: StudyError with file, key and reason."""
    try:
        return msgspec.convert(raw, StudyConfig)
    except msgspec.ValidationError as error:
        reason, _, location = str(error).partition(" - at `$")
        key = _named_key(raw, location.rstrip("`").lstrip(".")) or "top level"
        raise StudyError(f"{path}: {key}: {reason}") from error


def _named_key(raw: RawStudy, location: str) -> str:
    """The location of a wrong value with the name of the table entry that msgspec writes as `[...]`."""
    table, placeholder, rest = location.partition("[...]")
    entry_type = {"variables": VariableConfig, "materials": MaterialConfig, "trajectories": TrajectoryConfig}.get(table)
    if not placeholder or entry_type is None:
        return location
    for name, entry in raw[table].items():
        try:
            msgspec.convert(entry, entry_type)
        except msgspec.ValidationError:
            return f"{table}.{name}{rest}"
    return location


def replace_number(raw: RawStudy, dotted: str, value: float, path: Path) -> None:
    """Sets raw["a"]["b"] for "a.b"; list items by index. The place must exist and hold a number."""
    *parents, last = dotted.split(".")
    node: Any = raw
    try:
        for key in parents:
            node = node[int(key)] if isinstance(node, list) else node[key]
        index = int(last) if isinstance(node, list) else last
        old = node[index]
    except (KeyError, IndexError, ValueError, TypeError):
        raise StudyError(f"{path}: sets = {dotted!r}: no such number in the study") from None
    if isinstance(old, bool) or not isinstance(old, int | float):
        raise StudyError(f"{path}: sets = {dotted!r}: not a number")
    node[index] = value
