"""Studies that extend another: a study.toml that states only what it does differently."""

from __future__ import annotations

import copy
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from codesign.errors import StudyError
from codesign.study.config import RawStudy

EXTENDS, WITHOUT = "extends", "without"


def extended(
    raw: RawStudy, path: Path, find: Callable[[str, Path], Path], read: Callable[[Path], RawStudy]
) -> RawStudy:
    """A parsed study.toml with everything that it takes over from the study it extends.

    Tables are merged key by key. Lists of tables that all have a name are merged by it, entries of a new name come
    last. All other values replace those taken over; what `without` names is not taken over.

    Args:
        raw: as read from the file at path. find: the file that `extends` names. read: the document in a file.
    Raises: StudyError: the chain of studies ends where it began, or there is nothing to leave out.
    """
    chain = {path: raw}
    while isinstance(name := raw.get(EXTENDS), str):
        path = find(name, path)
        if path in chain:
            raise StudyError(f"{path}: {EXTENDS}: studies extend each other in a circle")
        chain[path] = raw = read(path)
    merged: RawStudy = {}
    for path, own in reversed(chain.items()):
        for place in own.get(WITHOUT, []) if merged else []:
            if not _leave_out(merged, place):
                raise StudyError(f"{path}: {WITHOUT}: {place!r}: the extended study has no such key")
        merged = _merged(merged, copy.deepcopy(own))
    return merged


def _merged(base: Any, own: Any) -> Any:
    if isinstance(base, dict) and isinstance(own, dict):
        return base | {key: _merged(base[key], value) if key in base else value for key, value in own.items()}
    if _named(base) and _named(own):
        merged = {entry["name"]: entry for entry in base}
        for entry in own:
            merged[entry["name"]] = _merged(merged.get(entry["name"], {}), entry)
        return list(merged.values())
    return own


def _named(value: Any) -> bool:
    """Whether a value is a list of tables with different names."""
    if not isinstance(value, list) or not value:
        return False
    names = [entry.get("name") if isinstance(entry, dict) else None for entry in value]
    return all(isinstance(name, str) for name in names) and len(set(names)) == len(names)


def _leave_out(document: RawStudy, place: str) -> bool:
    """Removes what a dotted path names; entries of lists by their name. False: nothing is there."""
    *folders, last = place.split(".")
    target: Any = document
    for folder in folders:
        if isinstance(target, list) and _named(target):
            target = {entry["name"]: entry for entry in target}
        target = target.get(folder) if isinstance(target, Mapping) else None
    if not isinstance(target, dict) or last not in target:
        return False
    del target[last]
    return True
