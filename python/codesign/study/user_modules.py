"""Modules beside a study file, imported as a package of their own.

They import each other as a script imports what lies beside it (`import helpers`) or relatively (`from . import
helpers`). No name of theirs is visible outside, so two studies may each have a `helpers.py`.
"""

from __future__ import annotations

import builtins
import hashlib
import importlib
import sys
from collections.abc import Callable, Mapping, Sequence
from importlib.machinery import ModuleSpec, SourceFileLoader
from importlib.util import spec_from_file_location
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any

PREFIX = "codesign_study_"

_loaded: dict[str, tuple[Path, bytes]] = {}  # module -> its file, and the source that it was made from


def module_file(folder: Path, name: str) -> Path | None:
    """File of the module or package `name` (dotted) in a folder, or None."""
    base = folder.joinpath(*name.split("."))
    for file in (base / "__init__.py", base.parent / f"{base.name}.py"):
        if file.is_file():
            return file
    return None


def import_beside(folder: Path, name: str) -> ModuleType:
    """The module `name` (dotted) in a study's folder; made anew if a module of the folder has been edited."""
    package = PREFIX + hashlib.sha256(str(folder).encode()).hexdigest()[:12]
    if any(_edited(module) for module in sys.modules if module.startswith(f"{package}.")):
        for module in [module for module in sys.modules if module.startswith(package)]:
            del sys.modules[module]
    if package not in sys.modules:
        root = ModuleType(package)
        root.__path__ = [str(folder)]
        sys.modules[package] = root
    if StudyFinder not in sys.meta_path:
        sys.meta_path.insert(0, StudyFinder)
    return importlib.import_module(f"{package}.{name}")


def _edited(module: str) -> bool:
    if module not in _loaded:
        return False
    file, source = _loaded[module]
    return not file.is_file() or file.read_bytes() != source


class StudyFinder:
    """Finds modules of the packages that `import_beside` makes."""

    @classmethod
    def find_spec(
        cls,
        fullname: str,
        path: Sequence[str] | None = None,
        target: ModuleType | None = None,  # noqa: ARG003 - of the interface
    ) -> ModuleSpec | None:
        """As importlib.abc.MetaPathFinder.find_spec."""
        if not fullname.startswith(PREFIX) or path is None:
            return None
        for entry in path:
            file = module_file(Path(entry), fullname.rpartition(".")[2])
            if file is not None:
                inside = [str(file.parent)] if file.name == "__init__.py" else None
                loader = StudyLoader(fullname, str(file))
                return spec_from_file_location(fullname, file, loader=loader, submodule_search_locations=inside)
        return None


class StudyLoader(SourceFileLoader):
    """Loads from source, without a bytecode file, a module whose imports look beside the study file first."""

    def get_code(self, fullname: str) -> CodeType:
        """The compiled source."""
        source = self.get_data(self.path)
        _loaded[fullname] = (Path(self.path), source)
        return self.source_to_code(source, self.path)

    def exec_module(self, module: ModuleType) -> None:
        """Runs the module."""
        package = module.__name__.partition(".")[0]
        folder = Path(sys.modules[package].__path__[0])
        module.__dict__["__builtins__"] = vars(builtins) | {"__import__": _import_function(package, folder)}
        super().exec_module(module)


def _import_function(package: str, folder: Path) -> Callable[..., Any]:
    """`__import__` that knows the modules in a folder as members of `package`."""

    def import_(
        name: str,
        globals: Mapping[str, object] | None = None,
        locals: Mapping[str, object] | None = None,
        fromlist: Sequence[str] | None = (),
        level: int = 0,
    ) -> ModuleType:
        top = name.partition(".")[0]
        if level == 0 and module_file(folder, top) is not None:
            if fromlist:
                return builtins.__import__(f"{package}.{name}", globals, locals, fromlist, 0)
            importlib.import_module(f"{package}.{name}")
            return sys.modules[f"{package}.{top}"]
        return builtins.__import__(name, globals, locals, fromlist or (), level)

    return import_
