"""Where and with what a search runs: kept with the run, compared when it is continued."""

from __future__ import annotations

import importlib
import os
import platform
import socket
from collections.abc import Mapping
from importlib import metadata
from pathlib import Path
from typing import Any

from codesign import __version__
from codesign.errors import StoreError
from codesign.problem.identity import Identity
from codesign.problem.protocols import Problem
from codesign.search.registry import search_address
from codesign.study.fingerprint import files_hash
from codesign.study.imports import PACKAGE, imports_of, version_of_import

SEARCH_PACKAGES = ("numpy", "scipy", "pymoo")
SEARCH = Path(__file__).parent


def search_identity(algorithm: str) -> Identity:
    """What decides which designs a search asks for, besides its settings: libraries, and code of other packages.

    Searches of this package count by what they do: a continued run must ask for the stored designs in their order.
    """
    module = importlib.import_module(search_address(algorithm).partition(":")[0])
    file = Path(str(module.__file__))
    imports = imports_of({module.__name__: file}, known=lambda f: f.is_relative_to(PACKAGE) and f.parent != SEARCH)
    foreign = {name: f for name, f in imports.files.items() if not f.is_relative_to(PACKAGE)}
    libraries = {name: version_of_import(name) for name in sorted(imports.libraries)}
    return Identity({"code of the search": files_hash(foreign)} if foreign else {}, libraries)


def check_search(stored: Mapping[str, Any] | None, algorithm: str, run: Path) -> None:
    """Refuses to continue a search with other code or packages than it was begun with. Raises: StoreError."""
    now = search_identity(algorithm)
    if stored is not None and Identity.from_document(stored) != now:
        raise StoreError(
            f"{run}: continued by another program its search would go other ways "
            f"({Identity.from_document(stored).differences(now)}): use the versions that the run was started with, or "
            "start a new run"
        )


def session_provenance(study: Problem) -> dict[str, Any]:
    """Where and with what a session runs."""
    return {
        "version": __version__,
        "study_hash": study.hash,
        "host": socket.gethostname(),
        "pid": os.getpid(),
        "machine": platform.platform(),
        "processors": os.cpu_count(),
        "python": platform.python_version(),
        "packages": {name: metadata.version(name) for name in SEARCH_PACKAGES} | dict(study.identity.libraries),
    }
