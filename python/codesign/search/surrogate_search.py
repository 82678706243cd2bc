"""A search with models: Gaussian processes of what was evaluated say which designs are worth evaluating next.

The proposals of a batch are a function of the seed, of the designs asked for so far and of the results told so far.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from codesign.problem.design_space import DesignSpace
from codesign.problem.evaluation import Evaluation
from codesign.problem.pareto import non_dominated, objective_rows
from codesign.search.base import Grid
from codesign.search.candidates import CLIMBERS, Array, Candidates
from codesign.search.prospects import Prospects
from codesign.search.registry import SearchKind
from codesign.search.sampling import UnseenPoints, start_population
from codesign.surrogate.coordinates import Coordinates
from codesign.surrogate.likelihood import Hyperparameters
from codesign.surrogate.models import DesignModels, fit_lengths, fit_models
from codesign.surrogate.threads import one_thread

if TYPE_CHECKING:
    from codesign.search.settings import Settings

KEPT = 1500  # candidates that are looked at again for the second and later proposals of a batch
REFIT_GROWTH = 1.08  # lengths and noise are fitted anew when there are so many times as many results


@dataclass(frozen=True, slots=True)
class SurrogateOptions:
    """Own settings of the surrogate search.

    batch: designs proposed together. wide: every so many proposals, one looks beyond the front's ends.
    """

    batch: int = 4
    wide: int = 4

    def __post_init__(self) -> None:
        for name in ("batch", "wide"):
            if getattr(self, name) < 1:
                raise ValueError(f"options.{name} = {getattr(self, name)}: must be at least 1")


class SurrogateSearch:
    """Proposes designs by expected hypervolume improvement times the chance of being feasible."""

    def __init__(
        self, space: DesignSpace, objectives: Sequence[str], settings: Settings, options: SurrogateOptions
    ) -> None:
        self._objectives, self._options, self._seed = tuple(objectives), options, settings.seed
        self._levels = space.levels
        self._coordinates, self._candidates = Coordinates(space), Candidates(space)
        self._start = start_population(space, settings)
        self._taken: dict[Grid, None] = {}  # in the order of asking
        self._told: dict[Grid, Evaluation] = {}
        self._fitted: tuple[int, dict[str, Hyperparameters]] = (0, {})

    def ask(self, count: int) -> list[Grid]:
        """The start population first (whatever `count`), then proposals."""
        with one_thread():
            grids = self._propose(count) if self._taken else self._start
        self._taken |= dict.fromkeys(grids)
        return list(grids)

    def repeat(self, grids: Sequence[Grid]) -> None:
        """What was proposed before an interruption."""
        self._taken |= dict.fromkeys(grids)

    def tell(self, grids: Sequence[Grid], evaluations: Sequence[Evaluation]) -> None:
        """Results that the next proposals learn from."""
        self._told |= zip(grids, evaluations, strict=True)

    def population(self) -> list[Grid]:
        """The front: feasible designs that no other dominates."""
        feasible = [grid for grid, evaluation in self._told.items() if evaluation.status == "feasible"]
        keep = non_dominated(objective_rows(self._told.values(), self._objectives))
        return [grid for grid, kept in zip(feasible, keep, strict=True) if kept]

    def _propose(self, count: int) -> list[Grid]:
        rng = np.random.default_rng([self._seed, len(self._taken)])
        taken = set(self._taken)
        if not self._told:
            return UnseenPoints(self._levels, rng, taken).draw(count)
        prospects = Prospects.of(self._models(), objective_rows(self._told.values(), self._objectives))
        for grid in self._taken:
            if grid not in self._told:
                prospects = prospects.with_design(grid)
        candidates = self._candidates.draw(self.population(), taken, rng)
        chosen: list[Grid] = []
        while candidates and len(chosen) < count:
            number = len(self._taken) + len(chosen)
            worth = self._worth(prospects, number % self._options.wide == 0, rng)
            order = np.argsort(-worth(candidates), kind="stable")
            best = self._candidates.climb([candidates[i] for i in order[:CLIMBERS]], worth, taken)
            chosen.append(best)
            taken.add(best)
            candidates = [candidates[i] for i in order[:KEPT] if candidates[i] != best]
            prospects = prospects.with_design(best)
        return chosen

    def _worth(self, prospects: Prospects, wide: bool, rng: np.random.Generator) -> Callable[[Sequence[Grid]], Array]:
        improvement = prospects.improvement(wide, rng)
        return lambda grids: prospects.worth(grids, improvement)

    def _models(self) -> DesignModels:
        """Models of all that was told; their lengths and noise are those of fewer results, see `last_refit`."""
        grids, evaluations = list(self._told), list(self._told.values())
        count = last_refit(len(grids))
        if self._fitted[0] != count:
            told = grids[:count], evaluations[:count]
            self._fitted = count, fit_lengths(self._coordinates, *told, self._objectives)
        return fit_models(self._coordinates, grids, evaluations, self._objectives, self._fitted[1])


def last_refit(now: int) -> int:
    """With how many results lengths and noise were fitted last, when there are `now` of them."""
    count = 1
    while (after := max(count + 1, int(count * REFIT_GROWTH))) <= now:
        count = after
    return count


SURROGATE = SearchKind(
    SurrogateSearch, options=SurrogateOptions, batch=lambda options: options.batch, evaluations=200, lazy=True
)
