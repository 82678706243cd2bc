"""Evolutionary searches of pymoo on the integer grid; the only file that sees pymoo's algorithms.

Designs are ranked by constraint domination on the sum of violations; objectives of infeasible designs are handed over
as NaN, so no ranking can depend on them, and failed designs are not handed over at all.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from codesign.errors import ExecutionError
from codesign.problem.design_space import DesignSpace
from codesign.problem.evaluation import Evaluation
from codesign.search.base import Grid
from codesign.search.registry import SearchKind
from codesign.search.sampling import UnseenPoints, start_population

if TYPE_CHECKING:
    from codesign.search.settings import Settings

Maker = Callable[["Settings", int, dict[str, Any]], Any]  # settings, number of objectives, arguments of all


@dataclass(frozen=True, slots=True)
class EvolutionOptions:
    """Own settings of the evolutionary searches.

    eta: distribution index of crossover and mutation: the larger, the closer children are to their parents.
    """

    eta: float = 15.0


class Evolution:
    """An evolutionary algorithm that never asks for a design twice.

    When mating finds no new design in pymoo's 100 attempts, random designs never asked for fill the batch, so a small
    grid ends up evaluated whole.
    """

    def __init__(
        self,
        maker: Maker,
        space: DesignSpace,
        objectives: Sequence[str],
        settings: Settings,
        options: EvolutionOptions,
    ) -> None:
        from pymoo.core.problem import Problem
        from pymoo.core.termination import NoTermination

        self._objectives = tuple(objectives)
        self._taken: set[Grid] = set()
        self._size = math.prod(space.levels)
        self._filler = UnseenPoints(space.levels, np.random.default_rng([settings.seed, 1]), self._taken)
        self._started = False
        self._start = start_population(space, settings)
        top = np.asarray(space.levels, dtype=float) - 1.0
        problem = Problem(n_var=len(top), n_obj=len(self._objectives), n_ieq_constr=1, xl=0.0 * top, xu=top)
        common = _common(settings, options, np.array(self._start, dtype=float), self._taken)
        self._algorithm = maker(settings, len(self._objectives), common)
        self._algorithm.setup(problem, termination=NoTermination())

    def ask(self, count: int) -> list[Grid]:
        """The start population first (whatever `count`), then `count` offspring of the present population."""
        if not self._started:
            self._started = True
            self._taken.update(self._start)
            return list(self._start)
        if len(self._taken) >= self._size:
            return []
        algorithm = self._algorithm
        if algorithm.pop is None or len(algorithm.pop) == 0:
            return self._filler.draw(count)
        algorithm.n_offsprings = count
        offspring = algorithm.mating.do(
            algorithm.problem, algorithm.pop, count, algorithm=algorithm, random_state=algorithm.random_state
        )
        grids = [_grid(individual.X) for individual in offspring]
        self._taken.update(grids)
        return grids + self._filler.draw(count - len(grids))

    def tell(self, grids: Sequence[Grid], evaluations: Sequence[Evaluation]) -> None:
        """Ranks the designs that did not fail among the survivors."""
        from pymoo.core.population import Population

        ranked = [(g, e) for g, e in zip(grids, evaluations, strict=True) if e.status != "failed"]
        if not ranked:
            return
        infills = Population.new("X", np.array([grid for grid, _ in ranked], dtype=float))
        for individual, (_, evaluation) in zip(infills, ranked, strict=True):
            individual.F = self._values(evaluation)
            individual.G = np.array([0.0 if evaluation.status == "feasible" else evaluation.total_violation])
            individual.evaluated = {"F", "G"}
        if not self._algorithm.is_initialized:
            self._algorithm.infill()
        self._algorithm.advance(infills=infills)

    def population(self) -> list[Grid]:
        """The survivors."""
        return [] if self._algorithm.pop is None else [_grid(individual.X) for individual in self._algorithm.pop]

    def _values(self, evaluation: Evaluation) -> npt.NDArray[np.float64]:
        if evaluation.status == "infeasible":
            return np.full(len(self._objectives), np.nan)
        return np.array([evaluation.objectives[name] for name in self._objectives])


def _common(
    settings: Settings, options: EvolutionOptions, start: npt.NDArray[np.float64], taken: set[Grid]
) -> dict[str, Any]:
    """Arguments of every algorithm: pymoo's words."""
    from pymoo.core.duplicate import DuplicateElimination
    from pymoo.operators.crossover.sbx import SBX
    from pymoo.operators.mutation.pm import PM
    from pymoo.operators.repair.rounding import RoundingRepair

    class NeverTwice(DuplicateElimination):  # type: ignore[misc]
        """Removes individuals asked for before, in this batch or in any."""

        def do(self, pop: Any, *others: Any, **_: Any) -> Any:
            here = {_grid(individual.X) for other in others for individual in other}
            fresh = []
            for i, individual in enumerate(pop):
                grid = _grid(individual.X)
                if grid not in taken and grid not in here:
                    here.add(grid)
                    fresh.append(i)
            return pop[fresh]

    return {
        "pop_size": settings.population,
        "seed": settings.seed,
        "sampling": start,
        "crossover": SBX(prob=settings.crossover_probability, eta=options.eta),
        "mutation": PM(prob=1.0, prob_var=settings.mutation_probability, eta=options.eta),
        "repair": RoundingRepair(),
        "eliminate_duplicates": NeverTwice(),
    }


def _nsga2(_settings: Settings, _n_objectives: int, common: dict[str, Any]) -> Any:
    from pymoo.algorithms.moo import nsga2

    return nsga2.NSGA2(**common)


def _nsga3(settings: Settings, n_objectives: int, common: dict[str, Any]) -> Any:
    from pymoo.algorithms.moo import nsga3
    from pymoo.operators.selection.tournament import TournamentSelection

    # pymoo's own comparison draws from an unseeded generator when two violations are equal
    selection = TournamentSelection(func_comp=_less_violation_else_random)
    return nsga3.NSGA3(_directions(n_objectives, settings.population), **common, selection=selection)


def _smsemoa(_settings: Settings, _n_objectives: int, common: dict[str, Any]) -> Any:
    from pymoo.algorithms.moo import sms

    return sms.SMSEMOA(**common, normalize=False)  # else it normalizes with infeasible designs' objectives


def _agemoea(settings: Settings, _n_objectives: int, common: dict[str, Any]) -> Any:
    try:
        from pymoo.algorithms.moo import age, age2
    except Exception as error:  # what pymoo raises
        raise ExecutionError(
            f"algorithm {settings.algorithm} needs the package numba (pip install 'codesign[age]'): {error}"
        ) from error
    return (age.AGEMOEA if settings.algorithm == "agemoea" else age2.AGEMOEA2)(**common)


def _less_violation_else_random(pop: Any, P: npt.NDArray[np.int_], random_state: Any, **_: Any) -> npt.NDArray[np.int_]:
    violation = pop.get("CV")[:, 0][P]
    coin = random_state.integers(0, 2, size=len(P))
    winner = np.where(violation[:, 0] == violation[:, 1], coin, violation.argmin(axis=1))
    winners: npt.NDArray[np.int_] = P[np.arange(len(P)), winner]
    return winners[:, None]


def _directions(n_objectives: int, population: int) -> Any:
    """Das-Dennis reference directions: as many as fit into the population."""
    from pymoo.util.ref_dirs import get_reference_directions

    partitions = 1
    while math.comb(n_objectives + partitions, partitions + 1) <= population and n_objectives > 1:
        partitions += 1
    return get_reference_directions("das-dennis", n_objectives, n_partitions=partitions)


def _grid(values: npt.NDArray[Any]) -> Grid:
    return tuple(int(v) for v in values)


def _kind(maker: Maker) -> SearchKind:
    return SearchKind(
        lambda space, objectives, settings, options: Evolution(maker, space, objectives, settings, options),
        options=EvolutionOptions,
    )


NSGA2, NSGA3, SMSEMOA = _kind(_nsga2), _kind(_nsga3), _kind(_smsemoa)
AGEMOEA = AGEMOEA2 = _kind(_agemoea)
