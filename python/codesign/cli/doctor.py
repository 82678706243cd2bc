"""What this installation consists of: versions, BLAS, cores, and what is missing."""

from __future__ import annotations

import importlib.metadata
import os
import platform
from typing import Any

import threadpoolctl

import codesign

REQUIRED = ("numpy", "scipy", "msgspec", "trimesh", "manifold3d", "yourdfpy", "pymoo", "meshio", "matplotlib", "plotly")
OPTIONAL = {
    "cadquery-ocp-novtk": "STEP export",
    "viser": "codesign view",
    "distributed": "--cluster",
    "SALib": "sensitivity analysis",
    "pyarrow": "Parquet export",
}


def version_of(package: str) -> str | None:
    """Installed version of a distribution, or None."""
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return None


def diagnose() -> dict[str, Any]:
    """Versions of the product and its libraries, BLAS of the compiled core, cores, and what is missing."""
    missing = [name for name in REQUIRED if version_of(name) is None]
    try:
        from codesign import _core

        libraries = _core.library_versions()
    except ImportError as error:
        libraries = {}
        missing.append(f"codesign._core ({error})")
    blas = [
        f"{pool['internal_api']} {pool.get('version')} ({pool.get('architecture', '?')}, {pool['num_threads']} threads)"
        for pool in threadpoolctl.threadpool_info()
        if pool["user_api"] == "blas"
    ]
    return {
        "codesign": codesign.__version__,
        "python": platform.python_version(),
        "platform": platform.platform(),
        "cores": len(os.sched_getaffinity(0)),
        "libraries": libraries,
        "packages": {name: version_of(name) for name in (*REQUIRED, *OPTIONAL)},
        "blas": blas,
        "missing": missing,
        "optional_missing": [f"{name} ({use})" for name, use in OPTIONAL.items() if version_of(name) is None],
    }
