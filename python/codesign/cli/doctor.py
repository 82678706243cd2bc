"""What this installation consists of: versions, BLAS, cores, and what is missing, too old or cannot be loaded."""

from __future__ import annotations

import importlib
import os
import platform
from dataclasses import dataclass
from importlib import metadata
from typing import Any

import threadpoolctl
from packaging.requirements import Requirement

import codesign

# Import names that differ from the package's; a part of it where the whole would load nothing.
MODULES = {"cadquery-ocp-novtk": "OCP.gp", "dask": "distributed", "matplotlib": "matplotlib.backends.backend_agg"}
USES = {
    "view": "codesign view",
    "cluster": "--cluster",
    "analysis": "sensitivity analysis, Parquet export",
    "log": "flights as MCAP",
}


@dataclass(frozen=True, slots=True)
class Package:
    """A package that codesign asks for; version: the installed one, or None; use: what needs it if it is optional."""

    requirement: Requirement
    version: str | None
    use: str | None

    @property
    def name(self) -> str:
        """Of the distribution."""
        return self.requirement.name

    @property
    def too_old(self) -> bool:
        """Whether the version is below the lower bound."""
        return self._outside(">", "=")

    @property
    def too_new(self) -> bool:
        """Whether the version is above the upper bound."""
        return self._outside("<")

    def _outside(self, *starts: str) -> bool:
        specifiers = [s for s in self.requirement.specifier if s.operator.startswith(starts)]
        return self.version is not None and not all(s.contains(self.version, prereleases=True) for s in specifiers)

    def load_error(self) -> str | None:
        """Why it cannot be imported, in one line; None if it can."""
        try:
            importlib.import_module(MODULES.get(self.name, self.name))
        except Exception as error:  # whatever a broken installation raises
            return " ".join(f"{type(error).__name__}: {error}".split())
        return None

    def __str__(self) -> str:
        return f"{self.name} {self.version} ({self.requirement.specifier} needed)"


def packages() -> list[Package]:
    """Packages that the installed codesign asks for; empty if it was not installed as a Python package."""
    try:
        texts = metadata.requires("codesign") or []
    except metadata.PackageNotFoundError:
        return []
    found = []
    for requirement in map(Requirement, texts):
        extras = [extra for extra in USES if _needed_by(requirement, extra)]
        if requirement.marker is None or extras:
            found.append(Package(requirement, version_of(requirement.name), USES[extras[0]] if extras else None))
    return found


def _needed_by(requirement: Requirement, extra: str) -> bool:
    marker = requirement.marker
    return marker is not None and marker.evaluate({"extra": extra}) and not marker.evaluate({"extra": ""})


def version_of(package: str) -> str | None:
    """Installed version of a distribution, or None."""
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return None


def problems(needed: list[Package]) -> dict[str, list[str]]:
    """What keeps codesign, or an installed optional part of it, from working; by kind."""
    installed = [package for package in needed if package.version is not None]
    errors = [(package.name, package.load_error()) for package in installed]
    return {
        "missing": [package.name for package in needed if package.version is None and package.use is None],
        "too old": [str(package) for package in installed if package.too_old],
        "too new": [str(package) for package in installed if package.too_new],
        "cannot be loaded": [f"{name}: {error}" for name, error in errors if error],
    }


def diagnose() -> dict[str, Any]:
    """Versions of the product and its libraries, BLAS of the compiled core, cores, and `problems`."""
    needed = packages()
    libraries: dict[str, str] = {}
    found = problems(needed)
    try:
        from codesign import _core

        libraries = _core.library_versions() | _core.linked_libraries()
    except ImportError as error:
        found["cannot be loaded"].append(f"codesign._core: {error}")
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
        "packages": {package.name: package.version for package in needed},
        "blas": blas,
        "problems": {kind: names for kind, names in found.items() if names},
        "optional, missing": [f"{p.name} ({p.use})" for p in needed if p.version is None and p.use is not None],
    }
