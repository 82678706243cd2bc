"""Pareto fronts and hypervolume, by constraint domination: only feasible designs count."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
import numpy.typing as npt

from codesign.problem.evaluation import Evaluation
from codesign.problem.protocols import Rival

MARGIN = 0.1  # of the first designs' range: how far the reference point lies beyond their worst values


def objective_rows(evaluations: Iterable[Evaluation], names: Sequence[str]) -> npt.NDArray[np.float64]:
    """(n, objectives) objectives of the feasible evaluations, in order."""
    rows = [[e.objectives[name] for name in names] for e in evaluations if e.status == "feasible"]
    return np.array(rows, dtype=float).reshape(len(rows), len(names))


def non_dominated(values: npt.NDArray[np.float64]) -> npt.NDArray[np.bool_]:
    """(n,) True where no other row of (n, objectives) is at least as good in all and better in one objective.

    Of equal rows all are kept. Rows go by their sum, so that a row meets whatever dominates it before its own turn.
    """
    keep = np.zeros(len(values), dtype=bool)
    waiting = np.lexsort((*values.T[::-1], values.sum(axis=1)))
    rows = values[waiting]
    while len(waiting):
        nowhere_better = (rows[0] <= rows).all(axis=1)
        nowhere_better[0] = True  # of a row with NaN as well
        equal = nowhere_better & (rows[0] == rows).all(axis=1)
        keep[waiting[0]] = keep[waiting[equal]] = True
        waiting, rows = waiting[~nowhere_better], rows[~nowhere_better]
    return keep


def joined(
    front: npt.NDArray[np.float64], new: npt.NDArray[np.float64]
) -> tuple[npt.NDArray[np.bool_], npt.NDArray[np.bool_]]:
    """Which rows of a front (n, objectives) and of new ones (k, objectives) are the front of both: two masks.

    Rows of `front` must not dominate each other. The work is n k, not (n + k)^2.
    """
    enter = non_dominated(new)
    for i in np.flatnonzero(enter):
        enter[i] = not ((front <= new[i]).all(axis=1) & (front < new[i]).any(axis=1)).any()
    stay = np.ones(len(front), dtype=bool)
    for row in new[enter]:
        stay &= ~((row <= front).all(axis=1) & (row < front).any(axis=1))
    return stay, enter


def rival_of(rivals: Iterable[Rival], objectives: Iterable[float]) -> int | None:
    """Number of the first rival that is nowhere worse than a design with these objectives; None if there is none."""
    values = tuple(objectives)
    for number, others in rivals:
        if all(other <= value for other, value in zip(others, values, strict=True)):
            return number
    return None


class Hypervolume:
    """Share of objective space that a set of designs dominates, in a fixed box.

    The box spans from the best to the worst values of the designs it is made from, and is widened on the worst side by
    a tenth. 1 means as good as a design with all best values of those; better designs can exceed 1.
    """

    def __init__(self, values: npt.NDArray[np.float64]) -> None:
        best, worst = values.min(axis=0), values.max(axis=0)
        extent = np.where(worst > best, worst - best, np.maximum(np.abs(worst), 1.0))
        self.reference: npt.NDArray[np.float64] = worst + MARGIN * extent
        self.scale: npt.NDArray[np.float64] = self.reference - best

    def of(self, values: npt.NDArray[np.float64], front: bool = False) -> float:
        """Hypervolume of (n, objectives) values; those beyond the reference point add nothing.

        front: whether it is known that none of them dominates another.
        """
        from pymoo.indicators.hv import Hypervolume as Indicator

        inside = values[(values < self.reference).all(axis=1)]
        if not len(inside):
            return 0.0
        scaled = np.unique((inside - self.reference) / self.scale, axis=0)
        best = scaled if front else scaled[non_dominated(scaled)]
        return float(Indicator(ref_point=np.zeros(best.shape[1]))(best))


class FrontTracker:
    """Non-dominated objective values seen so far and their hypervolume.

    The hypervolume's box is fixed by the feasible designs of the first batch that holds any, the start population as a
    rule, so that values are comparable within a run and between runs with the same start.
    """

    def __init__(self, names: Sequence[str]) -> None:
        self._names = tuple(names)
        self._front = np.empty((0, len(self._names)))
        self._hypervolume: Hypervolume | None = None

    @property
    def best(self) -> float | None:
        """Lowest value of the only objective; None before any design is feasible, and where there are several."""
        return float(self._front.min()) if len(self._names) == 1 and len(self._front) else None

    def add(self, evaluations: Iterable[Evaluation]) -> float | None:
        """Takes a batch of new evaluations into account; returns the hypervolume, None before any is feasible."""
        return self.add_values(objective_rows(evaluations, self._names))

    def add_values(self, values: npt.NDArray[np.float64]) -> float | None:
        """The same for (n, objectives) values of feasible designs."""
        if len(values):
            if self._hypervolume is None:
                self._hypervolume = Hypervolume(values)
            stay, enter = joined(self._front, values)
            self._front = np.vstack([self._front[stay], values[enter]])
        return None if self._hypervolume is None else self._hypervolume.of(self._front, front=True)
