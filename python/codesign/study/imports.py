"""What modules import, read from their source: own files and libraries, those that functions import included."""

from __future__ import annotations

import ast
import contextlib
import functools
import importlib.util
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path

from codesign.study.user_modules import PREFIX, module_file

PACKAGE = Path(__file__).parents[1]


@dataclass(frozen=True)
class Imports:
    """files: of `modules` and of all own code that they import, by module name. libraries: import names."""

    files: dict[str, Path]
    libraries: frozenset[str]


def imports_of(modules: Mapping[str, Path], known: Callable[[Path], bool] = lambda _: False) -> Imports:
    """Follows the imports of modules through everything that is not the standard library or installed.

    Args:
        modules: their files by name.
        known: tells files that need not be listed and followed.
    """
    own = {name.partition(".")[0] for name in modules} | {"codesign"}
    waiting = dict(modules)
    files: dict[str, Path] = {}
    libraries = set()
    while waiting:
        module, file = waiting.popitem()
        files[module] = file
        for name in imported_names(module, file):
            top = name.partition(".")[0]
            if top in sys.stdlib_module_names:
                continue
            if top in own or not is_installed(top):
                found = _source(name)
                if found is not None and name not in files and not known(found):
                    waiting[name] = found
            else:
                libraries.add(top)
    return Imports(dict(sorted(files.items())), frozenset(libraries))


def imported_names(module: str, file: Path) -> Iterator[str]:
    """Absolute names that a source file imports: modules, and members of modules, which may be modules themselves."""
    package = module if file.name == "__init__.py" else module.rpartition(".")[0]
    for node in _executed(ast.parse(file.read_bytes(), str(file))):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield from _with_parents(_beside(module, alias.name))
        elif isinstance(node, ast.ImportFrom):
            if node.level:
                above = package.split(".")[: len(package.split(".")) - node.level + 1]
                base = ".".join([*above, *filter(None, [node.module])])
            else:
                base = _beside(module, node.module or "")
            yield from _with_parents(base)
            yield from (f"{base}.{alias.name}" for alias in node.names)


def _executed(node: ast.AST) -> Iterator[ast.AST]:
    """A node and all below it, but for what only type checkers read."""
    yield node
    for child in ast.iter_child_nodes(node):
        if not (isinstance(child, ast.If) and "TYPE_CHECKING" in ast.unparse(child.test)):
            yield from _executed(child)


def _with_parents(name: str) -> Iterator[str]:
    parts = name.split(".")
    yield from (".".join(parts[: n + 1]) for n in range(len(parts)))


def _beside(module: str, name: str) -> str:
    """The absolute name of what a module of a study's folder calls `name`."""
    package = module.partition(".")[0]
    if package.startswith(PREFIX) and module_file(Path(sys.modules[package].__path__[0]), name.partition(".")[0]):
        return f"{package}.{name}"
    return name


def _source(name: str) -> Path | None:
    """Source file of a module by its absolute name, without importing it; None if it has none."""
    top, _, rest = name.partition(".")
    if top.startswith(PREFIX):
        return module_file(Path(sys.modules[top].__path__[0]), rest) if rest else None
    if top == "codesign":
        return module_file(PACKAGE, rest) if rest else PACKAGE / "__init__.py"
    spec = importlib.util.find_spec(top)
    if spec is None or spec.origin is None or not spec.origin.endswith(".py"):
        return None
    if not rest:
        return Path(spec.origin)
    return module_file(Path(spec.origin).parent, rest) if spec.submodule_search_locations else None


@functools.cache
def is_installed(top: str) -> bool:
    """Whether a top-level module belongs to an installed distribution (has a version), rather than being own code."""
    spec = importlib.util.find_spec(top)
    where = [] if spec is None else [spec.origin or "", *(spec.submodule_search_locations or ())]
    return any({"site-packages", "dist-packages"} & set(Path(place).parts) for place in where)


@functools.cache
def version_of_import(top: str) -> str:
    """Version of the distribution that provides a top-level module; 'unknown' if none says so."""
    with contextlib.suppress(metadata.PackageNotFoundError):
        return metadata.version(top)
    for name in _distributions().get(top, ()):
        with contextlib.suppress(metadata.PackageNotFoundError):
            return metadata.version(name)
    return "unknown"


@functools.cache
def _distributions() -> dict[str, list[str]]:
    """Distributions by module; reads the file lists of all that are installed, a third of a second."""
    return dict(metadata.packages_distributions())
