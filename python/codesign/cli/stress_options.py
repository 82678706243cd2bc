"""Options of `codesign stress`: selections, loads and materials from text."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, cast, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from codesign import fem
from codesign.errors import CodesignError, ModelError
from codesign.fem.selections import Box, Facing, Holes, NamedFace, Near, Place
from codesign.parts.materials import named_material
from codesign.units import GIGA, MEGA

SMALLEST, LARGEST = 1e-30, 1e30  # magnitude of a number: squares and products of a few stay in range


class StressInputError(CodesignError, ValueError):
    """An option of `codesign stress` that cannot be used; the message names it and says why."""


def parse_selection(text: str, scale: float) -> Place:
    """A place on the part; coordinates and radii in units of `scale` meters.

    `near:x,y,z`, `box:x0,y0,z0,x1,y1,z1`, `normal:nx,ny,nz[:degrees]`, `face:NAME` (of a STEP file, or its number), or
    `hole:r=RADIUS` (all round holes of that radius, no fillets).

    Raises: StressInputError.
    """
    kind, _, rest = text.strip().partition(":")
    if kind == "near":
        x, y, z = _numbers(rest, 3, text)
        return Near((x * scale, y * scale, z * scale))
    if kind == "box":
        corners = np.array(_numbers(rest, 6, text)).reshape(2, 3) * scale
        return Box(tuple(corners.min(axis=0)), tuple(corners.max(axis=0)))
    if kind == "normal":
        direction, _, angle = rest.partition(":")
        x, y, z = _numbers(direction, 3, text)
        if not (x or y or z):
            raise StressInputError(f"selection {text!r}: the direction is zero")
        if angle and not 0.0 <= _numbers(angle, 1, text)[0] <= 180.0:
            raise StressInputError(f"selection {text!r}: the angle must be between 0 and 180 degrees")
        return Facing((x, y, z), _numbers(angle, 1, text)[0] if angle else 1.0)
    if kind == "face" and rest.strip():
        name = rest.strip()
        return NamedFace(f"face {name}" if name.isdecimal() else name)
    if kind == "hole" and rest.strip().startswith("r="):
        (radius,) = _numbers(rest.strip().removeprefix("r="), 1, text)
        if radius <= 0.0:
            raise StressInputError(f"selection {text!r}: the radius must be positive")
        return Holes(radius * scale)
    raise StressInputError(
        f"selection {text!r}: expected near:x,y,z, box:x0,y0,z0,x1,y1,z1, normal:nx,ny,nz[:degrees], face:NAME or "
        "hole:r=RADIUS"
    )


LoadKind = Literal["force", "traction", "pressure", "bearing", "moment"]
KINDS = get_args(LoadKind)


@dataclass(frozen=True)
class AskedLoad:
    """A load on a place as it was asked for, SI units: force, traction, pressure (one value), bearing force, moment."""

    kind: LoadKind
    values: tuple[float, ...]

    def on(self, where: fem.Selection) -> fem.Load:
        """The load on a selection."""
        if self.kind == "pressure":
            return fem.Pressure(where, self.values[0])
        if self.kind == "bearing":
            return fem.BearingLoad(where, self.values)
        if self.kind == "moment":
            return fem.AffineTraction(where, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), self.values)
        return fem.Force(where, self.values) if self.kind == "force" else fem.Traction(where, self.values)

    def resultant(self, area: float, normal: ArrayLike) -> NDArray[np.float64]:
        """(3,) total force [N] on a place of an area [m²] and a mean unit outward normal (3,), shorter if it bends."""
        values = np.asarray(self.values, dtype=float)
        if self.kind == "pressure":
            return np.asarray(-values[0] * area * np.asarray(normal, dtype=float))
        if self.kind == "moment":
            return np.zeros(3)
        return values if self.kind in ("force", "bearing") else values * area

    def words(self) -> str:
        """For notes in files."""
        unit, factor = {"force": ("N", 1.0), "bearing": ("N", 1.0), "moment": ("N m", 1.0)}.get(
            self.kind, ("MPa", MEGA)
        )
        numbers = ", ".join(f"{value / factor:g}" for value in self.values)
        return f"{self.kind} {numbers if len(self.values) == 1 else f'({numbers})'} {unit}"


def parse_load(text: str, scale: float) -> tuple[Place, AskedLoad]:
    """A load spread over a selection.

    `SEL: fx fy fz` (total force in N), `SEL: traction tx ty tz` (MPa), `SEL: pressure p` (MPa, against the normal),
    `SEL: bearing fx fy fz` (N, by the pressure of a pin on a bore) or `SEL: moment mx my mz` (N m).

    Raises: StressInputError.
    """
    where, _, load = text.rpartition(":")
    words = load.replace(",", " ").split()
    kind = words.pop(0) if words and words[0].isalpha() else "force"
    if not words or ":" not in where or kind not in KINDS:
        raise StressInputError(
            f"load {text!r}: expected 'SELECTION: fx fy fz' (N), or pressure p, traction tx ty tz (MPa), bearing fx "
            "fy fz (N), moment mx my mz (N m) after the colon"
        )
    values = _numbers(",".join(words), 1 if kind == "pressure" else 3, text)
    if not any(values):
        raise StressInputError(f"load {text!r}: the {kind} is zero")
    factor = MEGA if kind in ("traction", "pressure") else 1.0
    return parse_selection(where, scale), AskedLoad(cast("LoadKind", kind), tuple(factor * value for value in values))


def parse_support(text: str, scale: float) -> tuple[Place, str]:
    """A place that is held, and the directions: `SEL` holds all three, `SEL: xz` two (a roller, a plane of symmetry).

    Raises: StressInputError.
    """
    where, _, axes = (part.strip() for part in text.rpartition(":"))
    if ":" in where and axes:
        if set(axes) <= set("xyz") and len(set(axes)) == len(axes):
            return parse_selection(where, scale), axes
        if axes.isalpha() and not where.startswith("face:"):
            raise StressInputError(f"support {text!r}: {axes!r} is no set of directions, such as x, yz or xyz")
    return parse_selection(text, scale), "xyz"


def parse_acceleration(text: str) -> tuple[float, ...]:
    """`ax ay az` in m/s². Raises: StressInputError."""
    values = _numbers(",".join(text.replace(",", " ").split()), 3, text)
    if not any(values):
        raise StressInputError(f"acceleration {text!r}: is zero")
    return values


def find_material(text: str) -> fem.Material:
    """A name of `codesign.parts.materials`, or `E_GPa,nu,yield_MPa[,kg/m3]`.

    Raises: StressInputError.
    """
    if "," not in text:
        try:
            return named_material(text)
        except ModelError as error:
            raise StressInputError(f"{error}; or give E_GPa,nu,yield_MPa[,density_kg_m3]") from None
    modulus, ratio, strength, density = (*_numbers(text, 4 if text.count(",") == 3 else 3, text), 0.0)[:4]
    if strength <= 0.0:
        raise StressInputError(f"material {text!r}: the yield strength must be positive")
    try:
        return fem.Material("custom", modulus * GIGA, ratio, density, strength * MEGA)
    except ValueError as error:
        raise StressInputError(f"material {text!r}: {error}") from None


def _numbers(text: str, count: int, whole: str) -> tuple[float, ...]:
    try:
        values = tuple(float(part) for part in text.split(","))
    except ValueError:
        values = ()
    if any(value and not SMALLEST <= abs(value) <= LARGEST for value in values if math.isfinite(value)):
        raise StressInputError(f"{whole!r}: numbers must be between {SMALLEST:g} and {LARGEST:g}, or zero")
    if len(values) != count or not all(math.isfinite(value) for value in values):
        wanted = "a finite number" if count == 1 else f"{count} finite numbers"
        raise StressInputError(f"{whole!r}: expected {wanted}, found {text.strip()!r}")
    return values
