"""Searches over the integer grid: each asks for designs and is told what they gave.

A search is a deterministic function of its settings and of what it was told; it never asks for a design twice. So the
driver can repeat a run from its stored results, and the order in which evaluations finish decides nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol, runtime_checkable

from codesign.problem.evaluation import Evaluation

Grid = tuple[int, ...]


class Search(Protocol):
    """Asks for grid points, is told their evaluations in the order of asking."""

    def ask(self, count: int) -> list[Grid]:
        """Up to `count` grid points never asked for before; fewer only if there are no more."""

    def tell(self, grids: Sequence[Grid], evaluations: Sequence[Evaluation]) -> None:
        """Results of points asked for."""

    def population(self) -> list[Grid]:
        """The survivors, in the search's order; empty for a search without memory."""


@runtime_checkable
class Repeatable(Search, Protocol):
    """A search whose proposals depend on nothing but what was asked and told; resuming need not make them again."""

    def repeat(self, grids: Sequence[Grid]) -> None:
        """Grid points that it asked for before, as if it had just done so."""
