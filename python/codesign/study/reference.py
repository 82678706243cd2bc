"""What a study.toml may hold, read off the configuration's classes: a JSON Schema for editors, a page for people."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from typing import Any

import msgspec
import msgspec.inspect as kinds

from codesign.study.config import StudyConfig
from codesign.study.meanings import MEANINGS

SCHEMA_FILE = "study.schema.json"  # beside a new study; its first line names it
UNITS = {
    "_n_m_per_rad_s": "N·m·s/rad", "_kg_per_n_s": "kg/(N·s)", "_kg_m2": "kg·m²", "_m2": "m²", "_kg": "kg",
    "_n_m_per_n": "N·m/N", "_per_rad": "1/rad", "_per_n": "1/N", "_kg_m3": "kg/m³", "_gpa": "GPa", "_mpa": "MPa",
    "_m_s2": "m/s²", "_n_m_s": "N·m/s", "_n_m": "N·m", "_n_s": "N/s", "_deg_s": "°/s", "_rad_s": "rad/s", "_m_s": "m/s",
    "_mm": "mm", "_deg": "°", "_rad": "rad", "_hz": "Hz", "_mib": "MiB", "_percent": "%", "_n": "N", "_s": "s",
    "_m": "m",
}  # fmt: skip


def study_schema() -> dict[str, Any]:
    """JSON Schema (2020-12) of a study file, with what the classes say of every key."""
    (schema,), definitions = msgspec.json.schema_components([StudyConfig], ref_template="#/$defs/{name}")
    for table in tables():
        definition = definitions[table.cls.__name__]
        definition["description"] = _paragraphs(table.cls)[0]
        for field in table.fields:
            if meaning := meanings(table).get(field.encode_name):
                definition["properties"][field.encode_name]["description"] = meaning
    head = {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "study.toml of codesign"}
    return head | schema | {"$defs": definitions}


def tables() -> list[kinds.StructType]:
    """All tables of a study file, each once, from the outside in."""
    found: dict[type, kinds.StructType] = {}
    for table in _tables(kinds.type_info(StudyConfig)):
        found.setdefault(table.cls, table)
    return list(found.values())


def _tables(kind: kinds.Type) -> Iterator[kinds.StructType]:
    if isinstance(kind, kinds.StructType):
        yield kind
        for field in kind.fields:
            yield from _tables(field.type)
    elif isinstance(kind, kinds.UnionType):
        for other in kind.types:
            yield from _tables(other)
    elif isinstance(kind, kinds.DictType):
        yield from _tables(kind.value_type)
    elif isinstance(kind, kinds.CollectionType):
        yield from _tables(kind.item_type)


def meanings(table: kinds.StructType) -> dict[str, str]:
    """What the class's text says of each key: `key: …`, up to the next one; `a, b: …` is of both. Else `MEANINGS`."""
    text = " ".join(_paragraphs(table.cls)[1:])
    keys = sorted((field.encode_name for field in table.fields), key=len, reverse=True)
    named = "|".join(map(re.escape, keys))
    heads = list(re.finditer(rf"(?:^|(?<=[.;] ))((?:{named})(?:, (?:{named}))*): ", text))
    ends = [head.start() for head in heads[1:]] + [len(text)]
    found: dict[str, str] = {}
    for head, end in zip(heads, ends, strict=False):
        said = text[head.end() : end].strip().rstrip(";")
        for key in head[1].split(", "):
            found[key] = said
    return MEANINGS.get(table.cls.__name__, {}) | found


def unit(key: str) -> str:
    """The unit that a key's name says."""
    return next((text for ending, text in UNITS.items() if key.endswith(ending)), "")


def reference_page() -> str:
    """Markdown: every table of a study file with its keys, their types, units, defaults and meanings."""
    lines = [
        "# The study file",
        "",
        "Every table and key of `study.toml`. Unknown keys are refused; `codesign check STUDY` tells all mistakes.",
        "`codesign schema` prints the same as JSON Schema, which editors complete and check against.",
        "",
        "This page is written by `python scripts/study_reference.py` from `codesign.study.config`.",
    ]
    places = _places(kinds.type_info(StudyConfig), "")
    for table in tables():
        lines += ["", f"## {places[table.cls]}", "", *(f"{text}\n" for text in _paragraphs(table.cls))]
        lines += ["| key | type | unit | default | meaning |", "| --- | --- | --- | --- | --- |"]
        known = meanings(table)
        for field in table.fields:
            key = field.encode_name
            lines.append(f"| `{key}` | {_type(field.type)} | {unit(key)} | {_default(field)} | {known.get(key, '')} |")
    return "\n".join(lines) + "\n"


def _places(kind: kinds.Type, place: str) -> dict[type, str]:
    """How each table is headed in a file: `[flight.jets]`, `[[parts]]`, `[materials.NAME]`."""
    if isinstance(kind, kinds.UnionType):
        return {key: value for other in kind.types for key, value in _places(other, place).items()}
    if isinstance(kind, kinds.DictType):
        return _places(kind.value_type, f"{place}.NAME")
    if isinstance(kind, kinds.CollectionType):
        return _places(kind.item_type, f"{place}[]")
    if not isinstance(kind, kinds.StructType):
        return {}
    path = place.removesuffix("[]").replace("[]", "")
    found = {kind.cls: (f"`[[{path}]]`" if place.endswith("[]") else f"`[{path}]`") if place else "Top level"}
    for field in kind.fields:
        inner = f"{place}.{field.encode_name}" if place else field.encode_name
        found = _places(field.type, inner) | found
    return found


def _type(kind: kinds.Type) -> str:
    """A type in words."""
    if isinstance(kind, kinds.UnionType):
        return " or ".join(_type(other) for other in kind.types if not isinstance(other, kinds.NoneType))
    if isinstance(kind, kinds.StructType):
        return "table"
    if isinstance(kind, kinds.DictType):
        return f"table of {_plural(_type(kind.value_type))}"
    if isinstance(kind, kinds.TupleType):
        return f"{len(kind.item_types)} {_plural(_type(kind.item_types[0]))}"
    if isinstance(kind, kinds.CollectionType):
        return f"list of {_plural(_type(kind.item_type))}"
    if isinstance(kind, kinds.LiteralType):
        return ", ".join(f'`"{value}"`' for value in kind.values)
    if isinstance(kind, kinds.FloatType | kinds.IntType):
        return ("whole number" if isinstance(kind, kinds.IntType) else "number") + _range(kind)
    return {"StrType": "text", "BoolType": "true or false"}.get(type(kind).__name__, "any")


def _plural(text: str) -> str:
    word, rest = re.match(r"(number|text|table|list|whole number)?(.*)", text, re.DOTALL).groups()  # type: ignore[union-attr]
    return f"{word}s{rest}" if word else text


def _range(kind: kinds.FloatType | kinds.IntType) -> str:
    bounds = ((">", kind.gt), ("≥", kind.ge), ("<", kind.lt), ("≤", kind.le))
    return "".join(f" {sign} {bound:g}" for sign, bound in bounds if bound is not None)


def _default(field: kinds.Field) -> str:
    if field.required:
        return "required"
    value = field.default_factory() if field.default is msgspec.NODEFAULT else field.default
    if value is None or isinstance(value, msgspec.Struct):
        return "none" if value is None else "its own"
    return f"`{msgspec.json.encode(value).decode()}`"


def _paragraphs(cls: type) -> list[str]:
    text = inspect.cleandoc(cls.__doc__ or "")
    return [" ".join(paragraph.split()) for paragraph in text.split("\n\n")]
