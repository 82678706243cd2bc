"""The numbers of an evaluation that can be objectives, constraints or watched: one table for the whole project.

Any number of the evaluation's document can be named by its dotted path (`flight.max_torque`, `parts.bracket.mass`); `*`
stands for every entry of a level and needs one of min, max, sum around it: `sum(parts.*.mass)`. The table gives short
names, words and units to those that people ask for.
"""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from codesign.errors import StudyError
from codesign.units import MILLIMETER

REDUCTIONS: dict[str, Callable[[Sequence[float]], float]] = {"min": min, "max": max, "sum": math.fsum}
MINUS = "-"  # before a key: the quantity is maximized, its negative minimized


@dataclass(frozen=True, slots=True)
class Quantity:
    """A number shown to people: its key in an Evaluation, its name in words, its unit, and what it means.

    factor: from the SI value that is stored to `unit`; negative for a number to be maximized, which is stored with a
    minus (its key has one, too) and shown without. path: where the number stands in the document of an evaluation;
    empty for the members of an objective family and for clearances, which the chain puts there under their key.
    """

    key: str
    label: str
    unit: str = ""
    meaning: str = ""
    factor: float = 1.0
    path: str = ""

    @property
    def maximized(self) -> bool:
        """Whether more is better: the number under `key` is then the negative of what is shown."""
        return self.key.startswith(MINUS)

    @property
    def name(self) -> str:
        """What a study calls it: the key without the minus of a maximized number."""
        return self.key.removeprefix(MINUS)

    @property
    def sign(self) -> float:
        """From a shown value to one of which less is better: -1 for a maximized one."""
        return -1.0 if self.maximized else 1.0

    @property
    def title(self) -> str:
        """Label with unit, for axes and column heads."""
        return f"{self.label} ({self.unit})" if self.unit else self.label

    def shown(self, value: float) -> float:
        """A stored value [SI] in `unit`, without the minus that a maximized one is stored with."""
        return self.factor * value

    def text(self, value: float, digits: int = 5) -> str:
        """A stored value [SI] with its unit: `0.8015 mm`."""
        return f"{self.shown(value):.{digits}g} {self.unit}".rstrip()


_TABLE = (
    Quantity(
        "momentum",
        "Momentum error",
        "kg·m/s + kg·m²/s",
        "Root mean square over the flight of the error of the linear momentum (kg·m/s) plus that of the angular "
        "momentum about the center of mass (kg·m²/s), added as numbers.",
    ),
    Quantity(
        "joint_velocity",
        "Joint velocity error",
        "rad/s",
        "Root mean square of the difference between commanded and reached joint velocities, summed over the joint "
        "groups by their weights.",
    ),
    Quantity("thrust", "Thrust", "N", "Sum of all thrusts, averaged over the flight: what flying costs."),
    Quantity("mass", "Mass of the parts", "kg", "Sum over the parts, each counted once.", path="sum(parts.*.mass)"),
    Quantity(
        "safety_factor",
        "Safety factor",
        "",
        "Yield strength over peak stress of the weakest part.",
        path="min(parts.*.safety_factor)",
    ),
    Quantity(
        "first_frequency",
        "First natural frequency",
        "Hz",
        "Lowest frequency of a part on its supports.",
        path="min(parts.*.first_frequency)",
    ),
    Quantity(
        "buckling_factor",
        "Buckling factor",
        "",
        "Multiple of its load at which the first part buckles.",
        path="min(parts.*.buckling_factor)",
    ),
    Quantity(
        "max_displacement",
        "Largest displacement of a part",
        "mm",
        "Under its load.",
        1 / MILLIMETER,
        "max(parts.*.max_displacement)",
    ),
    Quantity(
        "flight_missed_share",
        "Share of the flight missed",
        "",
        "What a lost flight did not last, relative to the whole; 0: completed.",
        path="flight.missed_share",
    ),
    Quantity(
        "qp_failures",
        "Controller failures",
        "",
        "Control steps without a solution.",
        path="flight.qp_failures",
    ),
    Quantity(
        "body_clearance",
        "Body clearance",
        "mm",
        "Smallest gap beside the parts; below 0 they overlap.",
        1 / MILLIMETER,
        "flight.interference.body_clearance",
    ),
    Quantity(
        "plume_clearance",
        "Plume clearance",
        "mm",
        "Smallest gap beside the plumes of jets; below 0 they hit.",
        1 / MILLIMETER,
        "flight.interference.plume_clearance",
    ),
    Quantity(
        "max_com_error",
        "Largest tracking error",
        "m",
        "Of the center of mass, during the flight.",
        path="flight.max_com_error",
    ),
    Quantity("max_torque", "Largest joint torque", "N·m", "During the flight.", path="flight.max_torque"),
    Quantity(
        "max_thrust", "Largest thrust", "N", "Of one jet or propeller, during the flight.", path="flight.max_thrust"
    ),
    Quantity(
        "min_thrust", "Smallest thrust", "N", "Of one jet or propeller, during the flight.", path="flight.min_thrust"
    ),
    Quantity(
        "tracking",
        "Tracking error",
        "m",
        "Root mean square over the flight of the center of mass's distance from its reference.",
        path="flight.tracking",
    ),
    Quantity(
        "tracking_pose",
        "Tracking error of the pose",
        "m",
        "Root mean square over the flight of position and attitude error, a radian counted as a meter.",
        path="flight.tracking_pose",
    ),
    Quantity(
        "mechanical_energy",
        "Joint energy",
        "J",
        "Sum over the joints of the integral of |torque · velocity|: how much the joints are shaken, not what flying "
        "consumes; the jets' fuel is a million times more.",
        path="flight.mechanical_energy",
    ),
    Quantity("fuel", "Fuel", "kg", "Burnt by all jets during the flight.", path="flight.fuel"),
    Quantity(
        "thrust_impulse",
        "Thrust impulse",
        "N·s",
        "Integral of the total thrust; of flights of equal length, fuel in other units.",
        path="flight.thrust_impulse",
    ),
    Quantity(
        "hover_margin",
        "Thrust left in hover",
        "",
        "1 less the largest share of its limit that a thrust needs to hover at the start.",
        path="flight.hover_margin",
    ),
)
QUANTITIES = {quantity.key: quantity for quantity in _TABLE}
BY_PATH = {quantity.path: quantity for quantity in _TABLE if quantity.path}
# Units of own functions by the last words of their name: `power_in_watts` is shown as "Power (W)".
UNIT_WORDS = {
    "amperes": "A", "cubic_meters": "m³", "degrees": "°", "dollars": "$", "euros": "€", "grams": "g", "hertz": "Hz",
    "hours": "h", "hz": "Hz", "joules": "J", "kelvins": "K", "kg": "kg", "kilograms": "kg", "kilowatts": "kW",
    "liters": "l", "megapascals": "MPa", "meters": "m", "meters_per_second": "m/s", "millimeters": "mm",
    "minutes": "min", "mm": "mm", "mpa": "MPa", "newton_meters": "N·m", "newtons": "N", "pascals": "Pa",
    "percent": "%", "radians": "rad", "rpm": "1/min", "seconds": "s", "square_meters": "m²", "volts": "V",
    "watt_hours": "Wh", "watts": "W",
}  # fmt: skip
OF_A_PART = {
    "mass": "mass",
    "safety_factor": "safety factor",
    "first_frequency": "first natural frequency",
    "buckling_factor": "buckling factor",
    "max_displacement": "largest displacement",
}
FAMILY = ("momentum", "joint_velocity", "thrust")  # members of each objective family
UNITLESS_IN = {"script": ("momentum", "joint_velocity"), "paper": ("momentum", "joint_velocity")}


def words(key: str) -> str:
    """A key as words: `jetpack_bracket` -> `Jetpack bracket`, `parts.rod.mass` -> `Parts: rod: mass`."""
    text = key.replace("_", " ").replace(".", ": ").strip()
    return text[:1].upper() + text[1:]


def quantity(key: str, family: str = "rms") -> Quantity:
    """What the table says of a key, a short name or a path; another path is its own label.

    So is an own function's name, `module:power_in_watts`; words after `_in_` are its unit. A leading minus gives the
    quantity to be maximized. family: the objective family, which decides the unit.
    """
    if key.startswith(MINUS):
        positive = quantity(key[1:], family)
        return replace(positive, key=key, factor=-positive.factor, meaning=f"Maximized. {positive.meaning}", path="")
    known = QUANTITIES.get(key) or _by_path(key) or _of_a_part(key) or _own(key)
    if key in FAMILY and family != "rms":
        unit = "" if key in UNITLESS_IN.get(family, ()) else known.unit
        return replace(known, unit=unit, meaning=known.meaning if key == "thrust" else "")
    return known


def _by_path(key: str) -> Quantity | None:
    """The table's quantity at a path, under the path as its key: `flight.tracking` is `tracking`."""
    known = BY_PATH.get(key)
    return None if known is None else replace(known, key=key)


def _own(key: str) -> Quantity:
    """A number that only the study knows."""
    name = key.rpartition(":")[2]
    base, _, unit = name.rpartition("_in_")
    known = base and ":" in key and unit in UNIT_WORDS
    return Quantity(key, words(base if known else name), UNIT_WORDS[unit] if known else "", path=key)


def _of_a_part(key: str) -> Quantity | None:
    """What is known of a number that the table has of all parts: `parts.arm.cases.landing.safety_factor`."""
    found = re.fullmatch(r"parts\.([^.*]+)(?:\.cases\.([^.*]+))?\.(\w+)", key)
    if found is None or found[3] not in OF_A_PART:
        return None
    case = f", load case {found[2].replace('_', ' ')}" if found[2] else ""
    of_all = QUANTITIES[found[3]]
    label = f"{words(found[1])}{case}: {OF_A_PART[found[3]]}"
    return Quantity(key, label, of_all.unit, factor=of_all.factor, path=key)


def read(document: Mapping[str, Any], path: str) -> float | None:
    """The number at a path of an evaluation's document; None where it has none (a part that cannot buckle, say).

    Raises: StudyError if the path does not exist, with the nearest one that does.
    """
    call = re.fullmatch(r"(min|max|sum)\((.+)\)", path)
    steps = (call[2] if call else path).split(".")
    values = list(_values(document, steps, path))
    if call is None:
        if "*" in steps:
            raise StudyError(f"{path!r}: a path with * needs min(…), max(…) or sum(…) around it")
        return values[0]
    numbers = [value for value in values if value is not None]
    return float(REDUCTIONS[call[1]](numbers)) if numbers else None


def _values(node: Any, steps: Sequence[str], path: str) -> Iterator[float | None]:
    if not steps:
        if node is not None and (isinstance(node, bool) or not isinstance(node, int | float)):
            raise StudyError(f"{path!r}: is not a number of the evaluation")
        yield None if node is None or not math.isfinite(node) else float(node)
        return
    children = node if isinstance(node, Mapping) else dict(enumerate(node)) if isinstance(node, list | tuple) else {}
    if steps[0] == "*":
        for child in children.values():
            yield from _values(child, steps[1:], path)
        return
    named = {str(name): child for name, child in children.items()}
    if steps[0] not in named:
        near = difflib.get_close_matches(steps[0], named, n=1)
        hint = f"nearest is {near[0]!r}" if near else f"there are {', '.join(named) or 'no numbers'}"
        raise StudyError(f"{path!r}: the evaluation has no {steps[0]!r} there; {hint}")
    yield from _values(named[steps[0]], steps[1:], path)
