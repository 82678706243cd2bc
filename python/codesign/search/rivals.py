"""The designs that a lazy evaluation has to beat: the front of what was told so far."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import compress

import numpy as np

from codesign.problem.evaluation import Evaluation
from codesign.problem.pareto import joined, objective_rows
from codesign.problem.protocols import Rival


class Rivals:
    """Feasible designs that no other dominates, by number; grows with what is told."""

    def __init__(self, objectives: Sequence[str]) -> None:
        self._objectives = tuple(objectives)
        self.front: tuple[Rival, ...] = ()
        self._values = np.empty((0, len(self._objectives)))  # of the front

    def add(self, first: int, evaluations: Sequence[Evaluation]) -> None:
        """Takes evaluations into account; `first`: number of the first of them."""
        numbers = [first + i for i, evaluation in enumerate(evaluations) if evaluation.status == "feasible"]
        if not numbers:
            return
        new = objective_rows(evaluations, self._objectives)
        stay, enter = joined(self._values, new)
        if not enter.any():
            return
        both = [*self.front, *zip(numbers, map(tuple, new.tolist()), strict=True)]
        self.front = tuple(compress(both, [*stay, *enter]))
        self._values = np.vstack([self._values[stay], new[enter]])
