"""Identity of a study's results: a hash of everything that decides them."""

from __future__ import annotations

import functools
import hashlib
import json
import sys
from collections.abc import Iterable
from pathlib import Path

from codesign.study.config import DECIDING_SECTIONS, RawStudy

PACKAGE = Path(__file__).parents[1]
DECIDING_WINGS = ("geometry", "fem", "parts", "robot", "problem", "study", "chain")


def study_hash(raw: RawStudy, path: Path, code: str) -> str:
    """Hash of everything that decides a result: deciding sections, robot, code."""
    digest = hashlib.sha256()
    digest.update(json.dumps({k: raw.get(k) for k in DECIDING_SECTIONS}, sort_keys=True).encode())
    digest.update((path.parent / raw["robot"]["urdf"]).read_bytes())
    digest.update(code.encode())
    return digest.hexdigest()[:16]


def code_hash(modules: Iterable[str]) -> str:
    """Hash of the sources of the study's own modules and of the engine."""
    digest = hashlib.sha256()
    for module in sorted(modules):
        digest.update(Path(str(sys.modules[module].__file__)).read_bytes())
    digest.update(engine_hash().encode())
    return digest.hexdigest()[:16]


@functools.cache
def engine_hash() -> str:
    """Hash of the code that turns a design into numbers: compiled core, modules beside the wings, DECIDING_WINGS."""
    from codesign import _core

    files = [Path(str(_core.__file__)), *sorted(PACKAGE.glob("*.py"))]
    for wing in DECIDING_WINGS:
        files += sorted((PACKAGE / wing).rglob("*.py"))
    digest = hashlib.sha256()
    for file in files:
        digest.update(file.name.encode() + file.read_bytes())
    return digest.hexdigest()[:16]
