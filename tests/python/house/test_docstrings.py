"""Public functions that take or return numbers say what they are: units, shapes."""

import ast
import importlib
import inspect
import re
import types
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import codesign

WINGS = ("", "geometry", "fem", "parts", "study", "report", "dynamics", "transforms")
ARRAYS = re.compile(r"NDArray|ArrayLike|Vector\b|Matrix|\bArray\b|Points")
NUMBERS = re.compile(r"NDArray|ArrayLike|Vector|Matrix|\bfloat\b")
# A unit in brackets, a shape, or a word for a number without unit.
UNITS = "m|mm|N|Pa|kg|rad|s|deg|SI|Hz|units?|factors?|share|relative|degrees|ratio|any shape"
MEANING = re.compile(rf"\[[^\]]+\]|\((\w+|\.\.\.)(, \w+)*,?( \d)?\)|\b({UNITS})\b|_deg\b")


def exported(wing: str) -> Iterator[tuple[str, Any]]:
    """Public classes and functions of a wing."""
    module = importlib.import_module(f"codesign.{wing}".rstrip("."))
    names = getattr(module, "__all__", None) or [n for n in vars(module) if not n.startswith("_")]
    for name in names:
        value = getattr(module, name)
        if callable(value) and str(getattr(value, "__module__", "")).startswith("codesign"):
            yield name, value


def members(cls: type) -> Iterator[tuple[str, Any]]:
    for name, value in vars(cls).items():
        if not name.startswith("_"):
            if isinstance(value, property):
                yield name, value.fget
            elif isinstance(value, classmethod | staticmethod | types.FunctionType):
                yield name, getattr(value, "__func__", value)


def silent(wing: str) -> list[str]:
    """Python callables with numbers in their annotations and no word of what these are."""
    found = []
    for name, value in exported(wing):
        if value.__module__.startswith("codesign._core"):
            continue
        own = [(f"{name}.{member}", f) for member, f in members(value)] if inspect.isclass(value) else []
        for where, function in [(name, value), *own]:
            text, doc = str(getattr(function, "__annotations__", "")), inspect.getdoc(function) or ""
            if not doc or (NUMBERS.search(text) and not MEANING.search(doc)):
                found.append(where)
    return found


def silent_native(wing: str) -> list[str]:
    """Compiled functions without a sentence; attributes that neither they nor their class explain."""
    found = []
    for name, value in exported(wing):
        if not value.__module__.startswith("codesign._core"):
            continue
        doc = value.__doc__ or ""
        if not inspect.isclass(value):
            if "\n\n" not in doc.strip():  # only the signature
                found.append(name)
            continue
        enumeration = hasattr(value, "__members__")
        for member, attribute in vars(value).items():
            if member.startswith("_") or enumeration or re.search(rf"\b{re.escape(member)}\b", doc):
                continue
            text = attribute.__doc__ or ""
            if isinstance(attribute, property) and not text:
                found.append(f"{name}.{member}")
    return found


def silent_arrays(file: Path) -> Iterator[str]:
    """Public functions of a module, exported or not, with arrays whose shape or unit no docstring tells."""
    tree = ast.parse(file.read_text(encoding="utf-8"))
    for scope in (tree, *(node for node in tree.body if isinstance(node, ast.ClassDef))):
        if isinstance(scope, ast.ClassDef) and "Protocol" in map(ast.unparse, scope.bases):
            continue
        for function in scope.body:
            if isinstance(function, ast.FunctionDef) and not function.name.startswith("_"):
                hints = [a.annotation for a in (*function.args.args, *function.args.kwonlyargs)] + [function.returns]
                text = " ".join(ast.unparse(hint) for hint in hints if hint is not None)
                if ARRAYS.search(text) and not MEANING.search(ast.get_docstring(function) or ""):
                    yield f"{file.name}:{function.lineno}: {function.name}"


def test_arrays_have_shapes_or_units() -> None:
    package = Path(codesign.__file__).parent
    files = [f for f in sorted(package.rglob("*.py")) if "studies" not in f.parts]
    assert [where for file in files for where in silent_arrays(file)] == []


@pytest.mark.parametrize("wing", WINGS)
def test_numbers_have_units_or_shapes(wing: str) -> None:
    assert silent(wing) == []


@pytest.mark.parametrize("wing", ["fem", "dynamics"])
def test_native_numbers_are_explained(wing: str) -> None:
    assert silent_native(wing) == []
