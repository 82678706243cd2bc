"""Identity of a study's results: hashes of everything that decides them, versions of libraries that compute them."""

from __future__ import annotations

import functools
import hashlib
import json
import sys
from collections.abc import Iterable, Mapping
from importlib import metadata
from pathlib import Path

from codesign.parts.materials import MATERIALS_FILE
from codesign.problem.identity import Identity
from codesign.study.config import DECIDING_SECTIONS, RawStudy
from codesign.study.imports import PACKAGE, imports_of, version_of_import

DECIDING_WINGS = ("geometry", "fem", "parts", "robot", "problem", "study", "chain")
# Whatever the engine imports, but for OCP, which writes STEP files, and pymoo, which ranks finished evaluations (no
# search is continued with another one, see codesign.search.provenance).
DECIDING_PACKAGES = ("numpy", "scipy", "manifold3d", "msgspec", "rainflow")


def study_identity(raw: RawStudy, path: Path, modules: Iterable[str]) -> Identity:
    """Everything that decides a result of a study.

    Args:
        raw: the parsed study file; path: where it is.
        modules: names of the loaded modules that hold its parts and functions.
    """
    files = {name: Path(str(sys.modules[name].__file__)) for name in modules}
    imports = imports_of(files, known=_belongs_to_engine)
    robot_file = path.parent / raw["robot"]["urdf"] if raw.get("robot") else None
    settings = json.dumps({k: raw.get(k) for k in DECIDING_SECTIONS}, sort_keys=True)
    sources = {
        "study file": _digest([settings.encode()]),
        "robot": _digest([robot_file.read_bytes()] if robot_file else []),
        "code of the parts": files_hash(imports.files),
        "engine": engine_hash(),
    }
    used = {name: version_of_import(name) for name in sorted(imports.libraries)}
    return Identity(sources, used | library_versions())


def part_identity(study: Identity) -> Identity:
    """What decides the numbers of a part besides its own values and settings: all but the study file and the robot."""
    return Identity(
        {name: study.sources[name] for name in ("code of the parts", "engine")},
        study.libraries,
    )


@functools.cache
def engine_hash() -> str:
    """Hash of the code that turns a design into numbers: core, modules beside the wings, DECIDING_WINGS, materials."""
    from codesign import _core

    core, code = Path(str(_core.__file__)).read_bytes(), files_hash(engine_files()).encode()
    return _digest([core, code, MATERIALS_FILE.read_bytes()])


def engine_files() -> dict[str, Path]:
    """Python files of the engine by their path in the package."""
    return {str(file.relative_to(PACKAGE)): file for file in PACKAGE.rglob("*.py") if _belongs_to_engine(file)}


@functools.cache
def library_versions() -> dict[str, str]:
    """Versions of the libraries that every evaluation uses: Python packages, and what the core is linked with."""
    from codesign import _core

    linked: dict[str, str] = _core.linked_libraries()
    return {name: metadata.version(name) for name in DECIDING_PACKAGES} | linked


def files_hash(files: Mapping[str, Path]) -> str:
    """Hash of the content of files and of the names of modules in their package, wherever that lies."""
    ordered = sorted(files.items())
    return _digest(part for name, file in ordered for part in (name.partition(".")[2].encode(), file.read_bytes()))


def _belongs_to_engine(file: Path) -> bool:
    if not file.is_relative_to(PACKAGE):
        return False
    inside = file.relative_to(PACKAGE).parts
    return len(inside) == 1 or inside[0] in DECIDING_WINGS


def _digest(parts: Iterable[bytes]) -> str:
    digest = hashlib.sha256()
    for part in parts:
        digest.update(len(part).to_bytes(8, "big") + part)
    return digest.hexdigest()[:16]
