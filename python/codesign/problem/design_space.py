"""Design variables on an integer grid, and designs: named values in the study's units."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from decimal import Decimal

from codesign.errors import DesignError
from codesign.names import nearest

GRID_TOLERANCE = 1e-9  # of a step: how far a value may lie from its grid point (round-off of user input)


DesignValue = float | str  # a number, or the name of a choice


def value_text(value: DesignValue) -> str:
    """A design value as people write it, exact: `30` for 30.0, `1.2`, `ti-6al-4v`."""
    if isinstance(value, str):
        return value
    return str(int(value)) if float(value).is_integer() else repr(float(value))


@dataclass(frozen=True, slots=True)
class Variable:
    """One design variable: `minimum + k * step` for k = 0 … levels - 1, in `unit`.

    values: what it takes instead of the even grid, numbers or names of choices; k is the position in the list. Minimum
    and maximum are then those of the numbers; of names, the first and the last position. See `listed`.
    """

    name: str
    minimum: float
    maximum: float
    step: float
    unit: str = ""
    values: tuple[DesignValue, ...] = ()

    @classmethod
    def listed(cls, name: str, values: Sequence[DesignValue], unit: str = "") -> Variable:
        """A variable that takes the values of a list: all numbers, or all names."""
        numbers = [value for value in values if not isinstance(value, str)] or list(range(len(values)))
        return cls(name, float(min(numbers)), float(max(numbers)), 1.0, unit, tuple(values))

    @property
    def named(self) -> bool:
        """Whether the values are names of choices."""
        return bool(self.values) and isinstance(self.values[0], str)

    @property
    def levels(self) -> int:
        """Number of grid values."""
        return len(self.values) or round((self.maximum - self.minimum) / self.step) + 1

    def value(self, index: int) -> DesignValue:
        """Grid value number `index`, as decimal as minimum and step; raises DesignError outside 0 … levels - 1."""
        if not 0 <= index < self.levels:
            raise DesignError(f"{self.name}: grid index {index} outside 0 … {self.levels - 1}")
        if self.values:
            return self.values[index]
        return float(Decimal(repr(self.minimum)) + index * Decimal(repr(self.step)))

    def every(self, stride: int) -> Variable:
        """The variable with every `stride`-th value only."""
        if self.values:
            return Variable.listed(self.name, self.values[::stride], self.unit)
        return replace(self, step=float(stride * Decimal(repr(self.step))))

    def position(self, value: DesignValue) -> float:
        """Where a value lies between minimum and maximum: a number itself, a name by its place in the list."""
        return float(self.values.index(value)) if isinstance(value, str) else float(value)

    def bounds_text(self) -> tuple[str, str]:
        """Smallest and largest value, or first and last name."""
        if self.named:
            return str(self.values[0]), str(self.values[-1])
        return value_text(self.minimum), value_text(self.maximum)

    def __str__(self) -> str:
        """All values in short: `40 … 100 by 2 mm`, `12, 16, 20 mm`."""
        unit = f" {self.unit}" if self.unit else ""
        if self.values:
            return ", ".join(map(value_text, self.values)) + unit
        low, high = self.bounds_text()
        return f"{low} … {high} by {value_text(self.step)}{unit}"

    def index(self, value: DesignValue) -> int:
        """Grid index of `value`; raises DesignError if it is out of bounds or off the grid (never rounded silently)."""
        if self.named:
            return self._index_of_name(value)
        try:
            number = float(value)
        except (TypeError, ValueError):
            raise DesignError(f"{self.name} = {value!r}: design values must be numbers") from None
        if not math.isfinite(number):
            raise DesignError(f"{self.name}: {number!r} is not a finite number")
        return self._index_in_list(number) if self.values else self._index_on_grid(number)

    def _index_of_name(self, value: DesignValue) -> int:
        """Of a choice; a name that looks like a number may have been read as one."""
        names = [str(name) for name in self.values]
        for index, name in enumerate(names):
            if name == value or (not isinstance(value, str) and _as_number(name) == value):
                return index
        raise DesignError(f"{self.name} = {value_text(value)}: no such choice; {nearest(str(value), names)}")

    def _index_in_list(self, value: float) -> int:
        numbers = [float(number) for number in self.values]
        index = min(range(len(numbers)), key=lambda i: abs(numbers[i] - value))
        if abs(numbers[index] - value) > GRID_TOLERANCE * max(1.0, abs(value)):
            unit = f" {self.unit}" if self.unit else ""
            raise DesignError(f"{self.name} = {value_text(value)}{unit}: not in the list {self}")
        return index

    def _index_on_grid(self, value: float) -> int:
        unit = f" {self.unit}" if self.unit else ""
        position = (value - self.minimum) / self.step
        if not -GRID_TOLERANCE <= position <= self.levels - 1 + GRID_TOLERANCE:
            raise DesignError(
                f"{self.name} = {value_text(value)}{unit}: outside "
                f"{value_text(self.minimum)} … {value_text(self.maximum)}{unit}"
            )
        index = round(position)
        if abs(position - index) > GRID_TOLERANCE:
            below, above = self.value(math.floor(position)), self.value(math.ceil(position))
            raise DesignError(
                f"{self.name} = {value_text(value)}{unit}: off the grid of step {value_text(self.step)}{unit}; "
                f"nearest values {value_text(below)} and {value_text(above)}"
            )
        return index


def _as_number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None


@dataclass(frozen=True, slots=True)
class Design(Mapping[str, DesignValue]):
    """Named design values in the study's units (deg, mm), names of choices; an immutable mapping."""

    names: tuple[str, ...]
    values_: tuple[DesignValue, ...]

    def __getitem__(self, name: str) -> DesignValue:
        try:
            return self.values_[self.names.index(name)]
        except ValueError:
            raise KeyError(name) from None

    def __iter__(self) -> Iterator[str]:
        return iter(self.names)

    def __len__(self) -> int:
        return len(self.names)

    def to_dict(self) -> dict[str, DesignValue]:
        """Plain dictionary; whole numbers as int, so that they print as the user wrote them."""
        return {n: int(v) if not isinstance(v, str) and float(v).is_integer() else v for n, v in self.items()}

    def __str__(self) -> str:
        return ", ".join(f"{n}={value_text(v)}" for n, v in self.items())


@dataclass(frozen=True, slots=True)
class DesignSpace:
    """The design variables of a study, in order; converts between names, values and grid indices."""

    variables: tuple[Variable, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """Variable names in order."""
        return tuple(v.name for v in self.variables)

    @property
    def levels(self) -> tuple[int, ...]:
        """Number of grid values of each variable."""
        return tuple(v.levels for v in self.variables)

    def design(self, theta: Mapping[str, DesignValue] | Sequence[DesignValue]) -> Design:
        """Checked design from named values or from values in variable order.

        Raises: DesignError for an unknown or missing name, a value out of bounds or off the grid.
        """
        return self.from_indices(self.indices(theta))

    def indices(self, theta: Mapping[str, DesignValue] | Sequence[DesignValue]) -> tuple[int, ...]:
        """Grid indices of a design given by names or in variable order; the same errors as `design`."""
        if isinstance(theta, Mapping):
            unknown = [name for name in theta if name not in self.names]
            if unknown:
                raise DesignError(f"unknown design variable {unknown[0]!r}; {nearest(unknown[0], self.names)}")
            missing = [name for name in self.names if name not in theta]
            if missing:
                raise DesignError(f"no value for design variable {missing[0]!r}")
            values = [theta[name] for name in self.names]
        else:
            values = list(theta)
            if len(values) != len(self.variables):
                raise DesignError(f"{len(values)} values for {len(self.variables)} variables ({', '.join(self.names)})")
        return tuple(v.index(x) for v, x in zip(self.variables, values, strict=True))

    def from_indices(self, indices: Sequence[int]) -> Design:
        """Design at grid indices (one for each variable)."""
        return Design(self.names, tuple(v.value(int(i)) for v, i in zip(self.variables, indices, strict=True)))
