"""`codesign materials`: the materials that are known by name."""

from __future__ import annotations

from typing import Any

import msgspec
from rich.table import Table

from codesign.cli.console import out
from codesign.errors import ModelError
from codesign.names import nearest
from codesign.parts.materials import KnownMaterial, find_known, known_materials, material_names

MISSING = "-"
WORDS = {
    "label": "",
    "kind": "kind",
    "basis": "strengths are",
    "young_modulus_gpa": "Young's modulus [GPa]",
    "poisson_ratio": "Poisson's ratio",
    "density_kg_m3": "density [kg/m³]",
    "yield_strength_mpa": "yield strength [MPa]",
    "ultimate_strength_mpa": "ultimate strength [MPa]",
    "fatigue_strength_mpa": "fatigue strength [MPa]",
    "fatigue_cycles": "for load cycles",
    "source": "source",
    "note": "note",
    "aliases": "also called",
}


def material_documents(name: str | None) -> dict[str, dict[str, Any]]:
    """Figures of one material, or of all, by name; units in the keys. Raises: ModelError with the nearest name."""
    if name is None:
        return {key: msgspec.to_builtins(material) for key, material in known_materials().items()}
    found = find_known(name)
    if found is None:
        raise ModelError(f"no material {name!r}; {nearest(name, material_names())}")
    return {name: msgspec.to_builtins(found)}


def print_materials(name: str | None) -> None:
    """A table of all materials, or everything that is known of one. Raises: ModelError with the nearest name."""
    documents = material_documents(name)
    if name is None:
        _print_table(known_materials())
        return
    table = Table(show_header=False, box=None, pad_edge=False)
    for key, words in WORDS.items():
        value = documents[name][key]
        if value not in (None, "", (), []):
            spread = documents[name]["ranges"].get(key)
            told = f" (published: {_span(spread)})" if spread else ""
            table.add_row(words or name, _text(value) + told)
    out.print(table)


def _print_table(materials: dict[str, KnownMaterial]) -> None:
    columns = ("material", "E", "ν", "ρ", "yield", "ultimate", "fatigue")
    table = Table(box=None, pad_edge=False)
    for column in columns:
        table.add_column(column, justify="left" if column == columns[0] else "right")
    for name, m in materials.items():
        numbers = (
            m.young_modulus_gpa, m.poisson_ratio, m.density_kg_m3, m.yield_strength_mpa, m.ultimate_strength_mpa,
            m.fatigue_strength_mpa,
        )  # fmt: skip
        table.add_row(name, *map(_text, numbers))
    out.print(table)
    out.print("E in GPa, ρ in kg/m³, strengths in MPa. codesign materials NAME: source, ranges, notes of one.")


def _text(value: Any) -> str:
    if isinstance(value, list | tuple):
        return ", ".join(value)
    return MISSING if value is None else f"{value:g}" if isinstance(value, float | int) else str(value)


def _span(span: Any) -> str:
    return MISSING if span is None else f"{span[0]:g} to {span[1]:g}"
