"""Materials by name: the figures of `materials.toml`, each with its public source."""

from __future__ import annotations

import functools
import tomllib
from pathlib import Path
from typing import Annotated, Literal

import msgspec
from msgspec import Meta, Struct

from codesign import fem
from codesign.errors import ModelError
from codesign.names import nearest
from codesign.units import GIGA, MEGA

MATERIALS_FILE = Path(__file__).with_name("materials.toml")
Positive = Annotated[float, Meta(gt=0)]


class KnownMaterial(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """An isotropic linear elastic material with its source; None: not stated there.

    basis: of the strengths: "typical", or "minimum" of a standard. fatigue_strength_mpa: stress amplitude, fully
    reversed, that smooth specimens stand for fatigue_cycles. ranges: of published figures by key.
    """

    label: str
    kind: Literal["metal", "plastic"]
    basis: Literal["typical", "minimum"] = "typical"
    young_modulus_gpa: Positive
    poisson_ratio: Annotated[float, Meta(gt=-1, lt=0.5)]
    density_kg_m3: Positive
    yield_strength_mpa: Positive
    ultimate_strength_mpa: Positive | None = None
    fatigue_strength_mpa: Positive | None = None
    fatigue_cycles: Positive | None = None
    ranges: dict[str, tuple[Positive, Positive]] = {}
    source: Annotated[str, Meta(min_length=1)]
    note: str = ""
    aliases: tuple[str, ...] = ()


@functools.cache
def known_materials() -> dict[str, KnownMaterial]:
    """All materials by name, without aliases."""
    return msgspec.convert(tomllib.loads(MATERIALS_FILE.read_text(encoding="utf-8")), dict[str, KnownMaterial])


@functools.cache
def _by_any_name() -> dict[str, KnownMaterial]:
    named = known_materials()
    return {**named, **{alias: material for material in named.values() for alias in material.aliases}}


def material_names() -> list[str]:
    """All names that are understood, aliases included."""
    return list(_by_any_name())


def find_known(name: str) -> KnownMaterial | None:
    """The material of a name or alias, or None."""
    return _by_any_name().get(name)


def named_material(name: str) -> fem.Material:
    """The material of a name or alias, SI units. Raises: ModelError with the nearest name."""
    known = find_known(name)
    if known is None:
        raise ModelError(f"no material {name!r}; {nearest(name, material_names())}")
    return fem.Material(
        name,
        young_modulus=known.young_modulus_gpa * GIGA,
        poisson_ratio=known.poisson_ratio,
        density=known.density_kg_m3,
        yield_strength=known.yield_strength_mpa * MEGA,
    )
