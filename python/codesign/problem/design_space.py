"""Design variables on an integer grid, and designs: named values in the study's units."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from decimal import Decimal

import numpy as np

from codesign.errors import DesignError
from codesign.names import nearest

GRID_TOLERANCE = 1e-9  # of a step: how far a value may lie from its grid point (round-off of user input)


def value_text(value: float) -> str:
    """A design value as people write it, exact: `30` for 30.0, `1.2`."""
    return str(int(value)) if float(value).is_integer() else repr(float(value))


@dataclass(frozen=True, slots=True)
class Variable:
    """One design variable: `minimum + k * step` for k = 0 … levels - 1, in `unit`."""

    name: str
    minimum: float
    maximum: float
    step: float
    unit: str = ""

    @property
    def levels(self) -> int:
        """Number of grid values."""
        return round((self.maximum - self.minimum) / self.step) + 1

    def value(self, index: int) -> float:
        """Grid value number `index`, as decimal as minimum and step; raises DesignError outside 0 … levels - 1."""
        if not 0 <= index < self.levels:
            raise DesignError(f"{self.name}: grid index {index} outside 0 … {self.levels - 1}")
        return float(Decimal(repr(self.minimum)) + index * Decimal(repr(self.step)))

    def every(self, stride: int) -> Variable:
        """The variable with every `stride`-th value only."""
        return replace(self, step=float(stride * Decimal(repr(self.step))))

    def index(self, value: float) -> int:
        """Grid index of `value`; raises DesignError if it is out of bounds or off the grid (never rounded silently)."""
        unit = f" {self.unit}" if self.unit else ""
        if not np.isfinite(value):
            raise DesignError(f"{self.name}: {value!r} is not a finite number")
        position = (value - self.minimum) / self.step
        if not -GRID_TOLERANCE <= position <= self.levels - 1 + GRID_TOLERANCE:
            raise DesignError(
                f"{self.name} = {value_text(value)}{unit}: outside "
                f"{value_text(self.minimum)} … {value_text(self.maximum)}{unit}"
            )
        index = round(position)
        if abs(position - index) > GRID_TOLERANCE:
            below, above = self.value(int(np.floor(position))), self.value(int(np.ceil(position)))
            raise DesignError(
                f"{self.name} = {value_text(value)}{unit}: off the grid of step {value_text(self.step)}{unit}; "
                f"nearest values {value_text(below)} and {value_text(above)}"
            )
        return index


@dataclass(frozen=True, slots=True)
class Design(Mapping[str, float]):
    """Named design values in the study's units (deg, mm); an immutable mapping."""

    names: tuple[str, ...]
    values_: tuple[float, ...]

    def __getitem__(self, name: str) -> float:
        try:
            return self.values_[self.names.index(name)]
        except ValueError:
            raise KeyError(name) from None

    def __iter__(self) -> Iterator[str]:
        return iter(self.names)

    def __len__(self) -> int:
        return len(self.names)

    def to_dict(self) -> dict[str, float]:
        """Plain dictionary; whole numbers as int, so that they print as the user wrote them."""
        return {n: int(v) if float(v).is_integer() else v for n, v in self.items()}

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

    def design(self, theta: Mapping[str, float] | Sequence[float]) -> Design:
        """Checked design from named values or from values in variable order.

        Raises: DesignError for an unknown or missing name, a value out of bounds or off the grid.
        """
        return self.from_indices(self.indices(theta))

    def indices(self, theta: Mapping[str, float] | Sequence[float]) -> tuple[int, ...]:
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
        try:
            return tuple(v.index(float(x)) for v, x in zip(self.variables, values, strict=True))
        except (TypeError, ValueError) as error:
            if isinstance(error, DesignError):
                raise
            raise DesignError(f"design values must be numbers: {error}") from error

    def from_indices(self, indices: Sequence[int]) -> Design:
        """Design at grid indices (one for each variable)."""
        return Design(self.names, tuple(v.value(int(i)) for v, i in zip(self.variables, indices, strict=True)))
