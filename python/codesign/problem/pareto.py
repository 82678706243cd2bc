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

    Of equal rows all are kept.
    """
    keep = np.ones(len(values), dtype=bool)
    for i, row in enumerate(values):
        if keep[i]:
            dominated = (row <= values).all(axis=1) & (row < values).any(axis=1)
            keep &= ~dominated
    return keep


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

    def of(self, values: npt.NDArray[np.float64]) -> float:
        """Hypervolume of (n, objectives) values; those beyond the reference point add nothing."""
        from pymoo.indicators.hv import Hypervolume as Indicator

        inside = values[(values < self.reference).all(axis=1)]
        if not len(inside):
            return 0.0
        scaled = np.unique((inside - self.reference) / self.scale, axis=0)
        front = scaled[non_dominated(scaled)]
        return float(Indicator(ref_point=np.zeros(front.shape[1]))(front))


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
        values = objective_rows(evaluations, self._names)
        if len(values):
            if self._hypervolume is None:
                self._hypervolume = Hypervolume(values)
            both = np.vstack([self._front, values])
            self._front = both[non_dominated(both)]
        return None if self._hypervolume is None else self._hypervolume.of(self._front)
