"""TOML documents to checked configurations, with the place of what is wrong and the nearest known name."""

from __future__ import annotations

import copy
import functools
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import msgspec
import msgspec.inspect as kinds

from codesign.errors import StudyError
from codesign.names import closest, nearest
from codesign.parts.materials import find_known
from codesign.study.config import DECIDING_SECTIONS, MaterialConfig, RawStudy, StudyConfig

MOST_PROBLEMS = 50  # that are told at once
LARGEST_NUMBER = 1e100  # beyond it squares overflow; NaN is refused by the same comparison
FIXED_TABLES = ("variables", "objectives")  # what a variable may not set although results depend on it
UNKNOWN_KEY = re.compile(r"Object contains unknown field `(.*)`")
WRONG_TYPE = re.compile(r"Expected `(.*)`, got `str`")
MISSING_KEY = re.compile(r"Object missing required field `(.*)`")
STEP = re.compile(r"\.?([^.\[\]]+)|\[(\d+|\.\.\.)\]")  # of a place as msgspec writes it: `a.b[0].c[...]`


def convert(raw: RawStudy, path: Path) -> StudyConfig:
    """The configuration of a parsed study.toml. Raises: StudyError with file, key, value and reason."""
    for key, number in numbers(raw):
        if not abs(number) <= LARGEST_NUMBER:
            raise StudyError(f"{path}: {key}: {_shown(number)} is not a finite number")
    try:
        config = msgspec.convert(raw, StudyConfig)
    except msgspec.ValidationError as error:
        raise StudyError(f"{path}: {_explained(raw, error)}") from error
    return _with_known_materials(config)


def _with_known_materials(config: StudyConfig) -> StudyConfig:
    """The configuration with the materials that its parts name and [materials] does not give."""
    named = {part.material: find_known(part.material) for part in config.parts if part.material not in config.materials}
    known = {
        name: MaterialConfig(**{key: getattr(material, key) for key in MaterialConfig.__struct_fields__})
        for name, material in named.items()
        if material is not None
    }
    return msgspec.structs.replace(config, materials=config.materials | known) if known else config


@dataclass(frozen=True, slots=True)
class Readable:
    """What can be read of a study file. problems: keys that are unknown, missing or of a wrong type.

    raw: the rest of the file, None if nothing can be made of it. lost: names of keys and entries that had to be left
    out with what they held: what refers to them cannot be judged.
    """

    problems: list[str]
    raw: RawStudy | None
    lost: set[str]


def readable(raw: RawStudy) -> Readable:
    """All wrong keys: what is refused is left out, or a quoted number unquoted, and the rest read again."""
    raw, found, removed, lost = copy.deepcopy(raw), list[str](), set[str](), set[str]()
    for _ in range(MOST_PROBLEMS):
        try:
            msgspec.convert(raw, StudyConfig)
        except msgspec.ValidationError as error:
            reason, _, location = str(error).partition(" - at `$")
            steps = _steps(raw, location.rstrip("`"), str(error))
            unknown, missing = UNKNOWN_KEY.fullmatch(reason), MISSING_KEY.fullmatch(reason)
            of_whole = not unknown and not missing and not reason.startswith(("Expected", "Invalid"))
            follows = of_whole and any(place.startswith(f"{_written(steps)}.") for place in removed)
            if not follows and (missing is None or _written([*steps, missing[1]]) not in removed):
                found.append(_explained(raw, error))
            if missing is not None and not steps:
                return Readable(found, None, lost)  # of the whole file, which is read last
            *above, last = [*steps, unknown[1]] if unknown else steps
            if not unknown and (number := _quoted_number(_at(raw, steps), reason)) is not None:
                _at(raw, above)[last] = number
                continue
            removed.add(_written([*above, last]))
            if not unknown:
                lost |= _names(last, _at(raw, steps))
            del _at(raw, above)[last]
        else:
            return Readable(found, raw, lost)
    return Readable(found, None, lost)


def _quoted_number(value: Any, reason: str) -> float | None:
    """The number that a text in place of one says."""
    wrong = WRONG_TYPE.fullmatch(reason)
    if wrong is None or not {"int", "float"} & set(wrong[1].split(" | ")):
        return None
    try:
        number = float(value)
    except ValueError:
        return None
    return int(number) if number.is_integer() else number


def _names(key: str | int, value: Any) -> set[str]:
    """What others may call an entry by: its key or its name."""
    return {str(name) for name in (key, value.get("name") if isinstance(value, dict) else None) if name}


def numbers(node: Any) -> Iterator[tuple[str, float]]:
    """All numbers of a document with their places."""
    for place, value in leaves(node):
        if isinstance(value, int | float) and not isinstance(value, bool):
            yield place, value


def _explained(raw: RawStudy, error: msgspec.ValidationError) -> str:
    """`key: reason` of a refusal by msgspec."""
    reason, _, location = str(error).partition(" - at `$")
    steps = _steps(raw, location.rstrip("`"), str(error))
    place, node = _written(steps), _at(raw, steps)
    kind = _kind(steps)
    if found := UNKNOWN_KEY.fullmatch(reason):
        reason = f"unknown key {found[1]!r}; {nearest(found[1], _keys(kind))}"
    elif found := MISSING_KEY.fullmatch(reason):
        known = _keys(kind)
        near = closest(found[1], [key for key in node if key not in known])
        reason = f"the key {found[1]!r} is missing" + (f"; is {near!r} meant to be it?" if near else "")
    elif (found := WRONG_TYPE.fullmatch(reason)) and {"int", "float"} & set(found[1].split(" | ")):
        reason = f"{_shown(node)} is a text; write the number without quotes"
    elif reason.startswith("Invalid enum value"):
        reason = f"{_shown(node)} is not possible; {nearest(str(node), _choices(kind))}"
    else:
        reason = f"{_shown(node)}: {reason[:1].lower()}{reason[1:]}"
    return f"{place or 'top level'}: {reason}"


def _shown(value: Any) -> str:
    text = repr(value) if not isinstance(value, bool) else str(value).lower()
    return text if len(text) <= 40 else f"{text[:37]}..."


def _steps(raw: RawStudy, location: str, message: str) -> list[str | int]:
    """Keys and indices of a place. msgspec writes entries of a table as `[...]`: found by leaving out the others."""
    steps: list[str | int] = []
    for key, index in STEP.findall(location):
        if index != "...":
            steps.append(int(index) if index else key)
            continue
        for name in _at(raw, steps):
            reduced = copy.deepcopy(raw)
            table = _at(reduced, steps)
            for other in [other for other in table if other != name]:
                del table[other]
            if _refusal(reduced) == message:
                steps.append(name)
                break
    return steps


def _refusal(raw: RawStudy) -> str:
    try:
        msgspec.convert(raw, StudyConfig)
    except msgspec.ValidationError as error:
        return str(error)
    return ""


def _at(raw: Any, steps: Iterable[str | int]) -> Any:
    for step in steps:
        raw = raw[step]
    return raw


def _written(steps: Iterable[str | int]) -> str:
    return "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in steps).lstrip(".")


@functools.cache
def _whole() -> kinds.Type:
    return kinds.type_info(StudyConfig)


def _kind(steps: Iterable[str | int]) -> kinds.Type:
    """The type that the configuration has at a place."""
    kind: kinds.Type = _whole()
    for step in steps:
        kind = _without_none(kind)
        if isinstance(kind, kinds.StructType):
            kind = next(field.type for field in kind.fields if field.encode_name == step)
        elif isinstance(kind, kinds.DictType):
            kind = kind.value_type
        elif isinstance(kind, kinds.TupleType):
            kind = kind.item_types[int(step)]
        elif isinstance(kind, kinds.CollectionType):
            kind = kind.item_type
    return _without_none(kind)


def _without_none(kind: kinds.Type) -> kinds.Type:
    if isinstance(kind, kinds.UnionType):
        some = [other for other in kind.types if not isinstance(other, kinds.NoneType)]
        return some[0] if len(some) == 1 else kind
    return kind


def _keys(kind: kinds.Type) -> list[str]:
    return [field.encode_name for field in kind.fields] if isinstance(kind, kinds.StructType) else []


def _choices(kind: kinds.Type) -> list[str]:
    return [str(value) for value in kind.values] if isinstance(kind, kinds.LiteralType) else []


def replace_value(raw: RawStudy, dotted: str, value: float | str | bool, path: Path) -> None:
    """Sets raw["a"]["b"] for "a.b"; entries of a list by index or, of tables, by their name.

    The place must exist, decide results and hold a value of the same kind: number, text, true or false.
    Raises: StudyError, with the nearest place.
    """
    kind = _value_kind(value)

    def refuse(reason: str) -> StudyError:
        near = closest(dotted, filter(_settable, _dotted_places(raw, kind)))
        hint = f"did you mean {near!r}?" if near else f"name a {kind} of this file, `table.key` or `table.0.key`"
        return StudyError(f"{path}: sets = {dotted!r}: {reason}; {hint}")

    *parents, last = dotted.split(".")
    node: Any = raw
    try:
        for key in parents:
            node = node[_list_index(node, key)] if isinstance(node, list) else node[key]
        index = _list_index(node, last) if isinstance(node, list) else last
        old = node[index]
    except (KeyError, IndexError, ValueError, TypeError):
        raise refuse(f"no such {kind} in the study") from None
    if _value_kind(old) != kind:
        raise refuse(f"not a {kind}")
    if not _settable(dotted):
        raise refuse("does not enter an evaluation")
    whole = kind == "number" and isinstance(old, int) and float(value).is_integer()
    node[index] = int(value) if whole else value


def leaves(node: Any, place: str = "") -> Iterator[tuple[str, Any]]:
    """All values of a document that are no tables or lists, with their places."""
    if isinstance(node, dict):
        for key, child in node.items():
            yield from leaves(child, f"{place}.{key}" if place else key)
    elif isinstance(node, list):
        for index, child in enumerate(node):
            yield from leaves(child, f"{place}[{index}]")
    else:
        yield place, node


def _dotted_places(node: Any, kind: str, above: tuple[str, ...] = ()) -> Iterator[str]:
    """Dotted paths to all values of a kind; entries of lists by index and by name."""
    children: Iterable[tuple[str, Any]] = ()
    if isinstance(node, dict):
        children = ((key, child) for key, child in node.items() if "." not in key)
    elif isinstance(node, list):
        named = [(child["name"], child) for child in node if isinstance(child, dict) and "name" in child]
        children = [*((str(index), child) for index, child in enumerate(node)), *named]
    elif _value_kind(node) == kind:
        yield ".".join(above)
    for key, child in children:
        yield from _dotted_places(child, kind, (*above, key))


def _list_index(node: list[Any], key: str) -> int:
    """Raises: ValueError if no table of the list has the name."""
    if key.isdecimal():
        return int(key)
    return [child.get("name") if isinstance(child, dict) else None for child in node].index(key)


def _value_kind(value: Any) -> str:
    if isinstance(value, bool):
        return "true or false"
    return "number" if isinstance(value, int | float) else "text" if isinstance(value, str) else ""


def _settable(dotted: str) -> bool:
    section = dotted.partition(".")[0]
    return section in DECIDING_SECTIONS and section not in FIXED_TABLES
