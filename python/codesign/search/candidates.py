"""Grid points that a model-based search looks at, and the way from good ones to better ones."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Collection, Sequence

import numpy as np
import numpy.typing as npt

from codesign.problem.design_space import DesignSpace
from codesign.search.base import Grid

Array = npt.NDArray[np.float64]
Score = Callable[[Sequence[Grid]], Array]

RANDOM = 4000  # random points of the whole grid
NEAR = 2000  # random neighbors of good designs
REACH = 3  # steps between a design and such a neighbor, in each variable
STRIDES = (1, 2, 4, 8)  # steps of the climb in one variable
CLIMBERS = 5
MOST_CLIMBS = 40
TIE = 1e-9  # relative difference of scores below which the lower grid point is taken


class Candidates:
    """Points of a grid for one search; named variables have no order, so any name is next to any other."""

    def __init__(self, space: DesignSpace) -> None:
        self._levels = np.array(space.levels)
        self._named = np.array([variable.named for variable in space.variables])
        self._size = math.prod(space.levels)

    def draw(self, good: Sequence[Grid], taken: Collection[Grid], rng: np.random.Generator) -> list[Grid]:
        """Different points that are not taken: of the whole grid and around good designs; all of a small grid."""
        if self._size <= RANDOM + NEAR:
            points = itertools.product(*map(range, self._levels))
            return [grid for grid in points if grid not in taken]
        rows = rng.integers(0, self._levels, (RANDOM, len(self._levels)))
        if good:
            rows = np.vstack([rows, self._near(np.array(good), rng)])
        return [grid for grid in dict.fromkeys(map(tuple, rows.tolist())) if grid not in taken]

    def _near(self, good: npt.NDArray[np.int_], rng: np.random.Generator) -> npt.NDArray[np.int_]:
        centers = good[rng.integers(0, len(good), NEAR)]
        moved = centers + rng.integers(-REACH, REACH + 1, centers.shape)
        others = rng.integers(0, self._levels, centers.shape)
        changed = rng.random(centers.shape) < 1.0 / REACH
        return np.where(self._named, np.where(changed, others, centers), np.clip(moved, 0, self._levels - 1))

    def climb(self, starts: Sequence[Grid], score: Score, taken: Collection[Grid]) -> Grid:
        """The best point on the ways up from some points: one variable by STRIDES, or two by one step each."""
        points, heights = list(starts), score(starts)
        for _ in range(MOST_CLIMBS):
            around = [[grid for grid in self._neighbors(point) if grid not in taken] for point in points]
            flat = list(dict.fromkeys(itertools.chain.from_iterable(around)))
            if not flat:
                break
            scores = dict(zip(flat, score(flat), strict=True))
            moved = False
            for i, neighbors in enumerate(around):
                best = max(neighbors, key=scores.__getitem__, default=points[i])
                if scores.get(best, -math.inf) > heights[i] * (1.0 + TIE):
                    points[i], heights[i], moved = best, scores[best], True
            if not moved:
                break
        top = heights.max()
        return min(point for point, height in zip(points, heights, strict=True) if height >= top - TIE * abs(top))

    def _neighbors(self, grid: Grid) -> list[Grid]:
        moves = [self._moves(i, grid[i]) for i in range(len(grid))]
        found = [_with(grid, {i: index}) for i, (far, _) in enumerate(moves) for index in far]
        for i, j in itertools.combinations(range(len(grid)), 2):
            found += [_with(grid, {i: a, j: b}) for a in moves[i][1] for b in moves[j][1]]
        return found

    def _moves(self, variable: int, index: int) -> tuple[list[int], list[int]]:
        """Other indices of a variable: those of a move in it alone, and those of a move in two variables."""
        levels = int(self._levels[variable])
        if self._named[variable]:
            others = [i for i in range(levels) if i != index]
            return others, []
        far = [index + sign * stride for stride in STRIDES for sign in (-1, 1)]
        return [i for i in far if 0 <= i < levels], [i for i in (index - 1, index + 1) if 0 <= i < levels]


def _with(grid: Grid, changes: dict[int, int]) -> Grid:
    return tuple(changes.get(i, index) for i, index in enumerate(grid))
