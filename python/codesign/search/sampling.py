"""Grid points that need no results: start populations, random and listed designs, sub-grids."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from codesign.errors import DesignError
from codesign.problem.design_space import DesignSpace
from codesign.problem.evaluation import Evaluation
from codesign.search.base import Grid
from codesign.search.registry import SearchKind

if TYPE_CHECKING:
    from codesign.search.settings import Settings

STARTS = ("sobol", "sobol-plain", "random")


class FixedDesigns:
    """A fixed sequence of grid points, each once: an exhaustive sweep, a sample for a sensitivity analysis."""

    def __init__(self, grids: Iterator[Grid] | Sequence[Grid]) -> None:
        self._grids = iter(dict.fromkeys(grids)) if isinstance(grids, Sequence) else iter(grids)

    def ask(self, count: int) -> list[Grid]:
        """The next `count` points."""
        return list(itertools.islice(self._grids, count))

    def tell(self, grids: Sequence[Grid], evaluations: Sequence[Evaluation]) -> None:
        """Nothing is learnt."""

    def population(self) -> list[Grid]:
        """Empty."""
        return []


class UnseenPoints:
    """Uniformly random grid points without repetition.

    `taken` is shared with the caller: points in it are never given, points given are added.
    """

    def __init__(self, levels: Sequence[int], rng: np.random.Generator, taken: set[Grid]) -> None:
        self._levels, self._rng, self._taken = tuple(levels), rng, taken
        self._size = math.prod(self._levels)

    def draw(self, count: int) -> list[Grid]:
        """`count` new points, or all that are left."""
        drawn: list[Grid] = []
        while len(drawn) < count and len(self._taken) < self._size:
            if self._size - len(self._taken) < 0.05 * self._size:  # rejection would take too long
                if self._size > 10_000_000:
                    break
                left = [grid for grid in itertools.product(*map(range, self._levels)) if grid not in self._taken]
                chosen = self._rng.permutation(len(left))[: count - len(drawn)]
                candidates = [left[int(i)] for i in chosen]
            else:
                candidates = [tuple(int(i) for i in self._rng.integers(0, self._levels))]
            for grid in candidates:
                if grid not in self._taken:
                    self._taken.add(grid)
                    drawn.append(grid)
        return drawn


class RandomSearch:
    """Random designs without repetition: what any optimizer has to beat."""

    def __init__(self, space: DesignSpace, seed: int) -> None:
        self._unseen = UnseenPoints(space.levels, np.random.default_rng(seed), set())

    def ask(self, count: int) -> list[Grid]:
        """Random points."""
        return self._unseen.draw(count)

    def tell(self, grids: Sequence[Grid], evaluations: Sequence[Evaluation]) -> None:
        """Nothing is learnt."""

    def population(self) -> list[Grid]:
        """Empty."""
        return []


RANDOM = SearchKind(lambda space, _objectives, settings, _options: RandomSearch(space, settings.seed), learns=False)
LISTED = SearchKind(lambda _space, _objectives, settings, _options: FixedDesigns(settings.listed), learns=False)


def grid_points(unit: npt.NDArray[np.float64], levels: Sequence[int]) -> list[Grid]:
    """Grid points of numbers in [0, 1): floor(u * levels), (n, variables) -> n tuples."""
    top = np.asarray(levels) - 1
    indices = np.minimum(np.floor(unit * np.asarray(levels)).astype(int), top)
    return [tuple(int(i) for i in row) for row in indices]


def start_points(space: DesignSpace, count: int, start: str, seed: int) -> list[Grid]:
    """The `count` different grid points that a search starts from (all of the grid if it is smaller).

    `sobol`: Sobol' points scrambled by the seed (Owen). `sobol-plain`: unscrambled, the same for every seed, without
    the center point, as in the paper's start population. `random`: independent uniform points. Points that fall on one
    grid value are taken once, and the sequence goes on.
    """
    if start not in STARTS:
        raise ValueError(f"start = {start!r}: one of {', '.join(STARTS)}")
    levels = space.levels
    count = min(count, math.prod(levels))
    rng = np.random.default_rng(seed)
    found: dict[Grid, None] = {}
    if start != "random":
        from scipy.stats import qmc

        sobol = qmc.Sobol(len(levels), scramble=start == "sobol", rng=rng)
        blocks = 0
        while len(found) < count and blocks < 16:  # a grid with few levels may need far more points than it has
            unit = sobol.random(1 << math.ceil(math.log2(max(2, count))))
            if start == "sobol-plain" and blocks == 0:
                unit = np.delete(unit, 1, axis=0)
            found |= dict.fromkeys(grid_points(unit, levels))
            blocks += 1
    points = list(found)[:count]
    return points + UnseenPoints(levels, rng, set(points)).draw(count - len(points))


def start_population(space: DesignSpace, settings: Settings) -> list[Grid]:
    """The designs that a search begins with: the given first ones, then start points up to the population's size."""
    first = list(dict.fromkeys(settings.first))
    drawn = start_points(space, settings.population, settings.start, settings.seed)
    start = [*first, *(grid for grid in drawn if grid not in first)]
    return start[: max(settings.population, len(first))]


def sub_grid(space: DesignSpace, counts: Sequence[int]) -> list[Grid]:
    """All points of the sub-grid with `counts[i]` values of variable i, evenly spread from first to last.

    Raises: DesignError if a count is below 1 or above the variable's levels.
    """
    if len(counts) != len(space.variables):
        raise DesignError(f"{len(counts)} counts for {len(space.variables)} variables ({', '.join(space.names)})")
    axes = []
    for variable, count in zip(space.variables, counts, strict=True):
        if not 1 <= count <= variable.levels:
            raise DesignError(f"{variable.name}: {count} values asked for, 1 … {variable.levels} possible")
        axes.append([round(i) for i in np.linspace(0, variable.levels - 1, count)])
    return list(itertools.product(*axes))
