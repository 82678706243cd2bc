"""Evolutionary searches of pymoo on the integer grid; the only file that sees pymoo's algorithms.

Designs are ranked by constraint domination on the sum of violations; objectives of infeasible designs are handed over
as NaN, so no ranking can depend on them, and failed designs are not handed over at all.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from codesign.errors import ExecutionError
from codesign.problem.design_space import DesignSpace
from codesign.problem.evaluation import Evaluation
from codesign.search.base import Grid, Unseen

ALGORITHMS = ("nsga2", "nsga3", "agemoea", "agemoea2", "smsemoa")
ETA = 15.0  # distribution index of crossover and mutation: the larger, the closer children are to their parents


@dataclass(frozen=True, slots=True)
class EvolutionSettings:
    """What decides an evolutionary search, besides what it is told."""

    algorithm: str = "nsga2"
    population: int = 25
    crossover_probability: float = 0.9  # that two parents are crossed
    mutation_probability: float = 0.25  # of each variable
    seed: int = 1


class Evolution:
    """An evolutionary algorithm that never asks for a design twice.

    When mating finds no new design in pymoo's 100 attempts, random designs never asked for fill the batch, so a small
    grid ends up evaluated whole.
    """

    def __init__(
        self, space: DesignSpace, objectives: Sequence[str], settings: EvolutionSettings, start: Sequence[Grid]
    ):
        from pymoo.core.problem import Problem
        from pymoo.core.termination import NoTermination

        if settings.algorithm not in ALGORITHMS:
            raise ValueError(f"algorithm = {settings.algorithm!r}: one of {', '.join(ALGORITHMS)}, random")
        self._objectives = tuple(objectives)
        self._taken: set[Grid] = set()
        self._size = math.prod(space.levels)
        self._filler = Unseen(space.levels, np.random.default_rng([settings.seed, 1]), self._taken)
        self._started = False
        self._start = list(start)
        top = np.asarray(space.levels, dtype=float) - 1.0
        problem = Problem(n_var=len(top), n_obj=len(self._objectives), n_ieq_constr=1, xl=0.0 * top, xu=top)
        self._algorithm = _algorithm(settings, len(self._objectives), np.array(self._start, dtype=float), self._taken)
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


def _algorithm(settings: EvolutionSettings, n_objectives: int, start: npt.NDArray[np.float64], taken: set[Grid]) -> Any:
    from pymoo.core.duplicate import DuplicateElimination
    from pymoo.operators.crossover.sbx import SBX
    from pymoo.operators.mutation.pm import PM
    from pymoo.operators.repair.rounding import RoundingRepair

    class NeverTwice(DuplicateElimination):  # type: ignore[misc]
        """Removes individuals asked for before, in this batch or in any."""

        def do(self, pop: Any, *others: Any, **_: Any) -> Any:
            known = set(taken).union(*({_grid(individual.X) for individual in other} for other in others))
            fresh = []
            for i, individual in enumerate(pop):
                grid = _grid(individual.X)
                if grid not in known:
                    known.add(grid)
                    fresh.append(i)
            return pop[fresh]

    common = {
        "pop_size": settings.population,
        "seed": settings.seed,
        "sampling": start,
        "crossover": SBX(prob=settings.crossover_probability, eta=ETA),
        "mutation": PM(prob=1.0, prob_var=settings.mutation_probability, eta=ETA),
        "repair": RoundingRepair(),
        "eliminate_duplicates": NeverTwice(),
    }
    return _construct(settings, n_objectives, common)


def _construct(settings: EvolutionSettings, n_objectives: int, common: dict[str, Any]) -> Any:
    name = settings.algorithm
    if name == "nsga2":
        from pymoo.algorithms.moo.nsga2 import NSGA2

        return NSGA2(**common)
    if name == "smsemoa":
        from pymoo.algorithms.moo.sms import SMSEMOA

        return SMSEMOA(**common, normalize=False)  # else it normalises with infeasible designs' objectives
    if name in ("agemoea", "agemoea2"):
        try:
            from pymoo.algorithms.moo.age import AGEMOEA
            from pymoo.algorithms.moo.age2 import AGEMOEA2
        except Exception as error:  # what pymoo raises
            raise ExecutionError(f"algorithm {name} needs the package numba: pip install numba") from error
        return (AGEMOEA if name == "agemoea" else AGEMOEA2)(**common)
    from pymoo.algorithms.moo.nsga3 import NSGA3
    from pymoo.operators.selection.tournament import TournamentSelection

    # pymoo's own comparison draws from an unseeded generator when two violations are equal
    selection = TournamentSelection(func_comp=_less_violation_else_random)
    return NSGA3(_directions(n_objectives, settings.population), **common, selection=selection)


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
