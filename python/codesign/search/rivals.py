"""The designs that a lazy evaluation has to beat: the front of what was told so far."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from codesign.problem.evaluation import Evaluation
from codesign.problem.pareto import non_dominated, objective_rows
from codesign.problem.protocols import Rival


class Rivals:
    """Feasible designs that no other dominates, by number; grows with what is told."""

    def __init__(self, objectives: Sequence[str]) -> None:
        self._objectives = tuple(objectives)
        self.front: tuple[Rival, ...] = ()

    def add(self, first: int, evaluations: Sequence[Evaluation]) -> None:
        """Takes evaluations into account; `first`: number of the first of them."""
        numbers = [first + i for i, evaluation in enumerate(evaluations) if evaluation.status == "feasible"]
        if not numbers:
            return
        new = objective_rows(evaluations, self._objectives).tolist()
        both = [*self.front, *zip(numbers, map(tuple, new), strict=True)]
        keep = non_dominated(np.array([values for _, values in both]))
        self.front = tuple(rival for rival, kept in zip(both, keep, strict=True) if kept)
