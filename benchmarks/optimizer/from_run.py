"""A stand-in made from a run's evaluated designs: as smooth and as broken as the real study, evaluated in no time.

Objectives (logarithms where all are positive) and margins of constraints are thin-plate splines through the designs
that have them, over the unit box of the grid. A design is lost where the linear interpolant of 1 (has objectives) and 0
(has none) is below one half, and where a variable is beyond all designs that have objectives: nothing is known there.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
from scipy.interpolate import RBFInterpolator

from codesign.problem.evaluation import Evaluation
from codesign.problem.pareto import non_dominated
from codesign.storage.runs import Run, load_run
from codesign.surrogate.outputs import has_objectives, margins

Array = npt.NDArray[np.float64]
FACTOR = "safety_factor"
PART = 50_000  # cells interpolated at a time


@dataclass(frozen=True)
class Values:
    """Of n cells. objectives: (n, objectives). margins: (n, constraints). flown: (n,)."""

    objectives: Array
    margins: Array
    flown: npt.NDArray[np.bool_]

    @property
    def feasible(self) -> npt.NDArray[np.bool_]:
        """(n,) flown, and every constraint holds."""
        return self.flown & (self.margins >= 0.0).all(axis=1)


class RunStandIn:
    """A problem whose numbers are interpolated from those of a run.

    least: the least safety factor, instead of the study's; a larger one cuts off a part of the front.
    """

    def __init__(self, out: Path, least: float | None = None) -> None:
        run = load_run(out)
        self.space, self.objectives = run.space, run.objectives
        evaluations = run.evaluations
        self._top = np.array(self.space.levels) - 1.0
        points = np.array([record.grid for record in run.search_records]) / self._top
        flown = np.array([has_objectives(evaluation, self.objectives) for evaluation in evaluations])
        table = np.array([[e.objectives[name] for name in self.objectives] for e in np.array(evaluations)[flown]])
        self._log = (table > 0.0).all(axis=0)
        self._spline = _spline(points[flown], np.where(self._log, np.log(np.abs(table)), table))
        self._lowest, self._highest = points[flown].min(axis=0), points[flown].max(axis=0)
        labels = flown[:, None].astype(float)
        self._label = RBFInterpolator(points, labels, kernel="linear") if not flown.all() else None
        self._margins, self.constraints = self._margin_splines(run, points, least)
        self._values = [spline.d for spline in self._margins]

    def _margin_splines(
        self, run: Run, points: Array, least: float | None
    ) -> tuple[list[RBFInterpolator], tuple[str, ...]]:
        splines, names = [], []
        known = {key: found for key, found in margins(run.evaluations).items() if found[1].max() > 0.0}  # no labels
        if least is not None:
            factors = [evaluation.constraints.get(FACTOR) for evaluation in run.evaluations]
            rows = np.flatnonzero([factor is not None for factor in factors])
            known[FACTOR] = rows, np.array([factors[row] for row in rows], dtype=float) / least - 1.0
        for key, (rows, values) in known.items():
            splines.append(_spline(points[rows], values[:, None]))
            names.append(key)
        return splines, tuple(names)

    def values(self, grids: npt.NDArray[np.int_]) -> Values:
        """Numbers of (n, variables) cells."""
        unit = np.asarray(grids) / self._top
        found = self._spline(unit)
        flown = ((unit >= self._lowest) & (unit <= self._highest)).all(axis=1)
        if self._label is not None:
            flown &= self._label(unit)[:, 0] >= 0.5
        kept = [spline(unit) for spline in self._margins]
        return Values(
            np.where(self._log, np.exp(found), found), np.hstack(kept) if kept else np.ones((len(unit), 1)), flown
        )

    def evaluate(self, grid: Sequence[int]) -> Evaluation:
        """One design."""
        values = self.values(np.array([grid]))
        kept = dict(zip(self.constraints, map(float, values.margins[0]), strict=False))
        lost = not values.flown[0]
        violations = {key: max(0.0, -margin) for key, margin in kept.items()} | {"lost": float(lost)}
        return Evaluation(
            design=self.space.from_indices(grid).to_dict(),
            status="feasible" if values.feasible[0] else "infeasible",
            objectives={} if lost else dict(zip(self.objectives, map(float, values.objectives[0]), strict=True)),
            violations=violations,
            margins=kept | {"lost": -float(lost)},
        )

    def typical(self, cells: int = 2000) -> Array:
        """(objectives,) medians of the flown designs among random cells, always the same."""
        grids = np.random.default_rng(0).integers(0, self.space.levels, (cells, len(self.space.levels)))
        values = self.values(grids)
        median: Array = np.median(values.objectives[values.flown], axis=0)
        return median

    def true_front(self, kept_in: Path) -> Array:
        """(n, objectives) front of all cells; kept in a file, since a large grid takes minutes."""
        deciding = (self.constraints, self._spline.d, self._lowest, self._highest, *self._values)
        name = hashlib.sha256(b"".join(np.asarray(part).tobytes() for part in deciding)).hexdigest()[:12]
        file = kept_in / f"front-{name}.npy"
        if file.exists():
            found: Array = np.load(file)
            return found
        front = np.empty((0, len(self.objectives)))
        size = int(np.prod(self.space.levels))
        for first in range(0, size, PART):
            cells = np.unravel_index(np.arange(first, min(first + PART, size)), self.space.levels)
            values = self.values(np.stack(cells, axis=1))
            both = np.vstack([front, _undominated(values.objectives[values.feasible], front)])
            front = both[non_dominated(both)]
        kept_in.mkdir(parents=True, exist_ok=True)
        np.save(file, front)
        return front


def _undominated(values: Array, front: Array) -> Array:
    """Those that no design of the front dominates, first by a few good ones to be quick."""
    kept = values
    for row in front:
        kept = kept[(kept < row).any(axis=1)]
    for row in kept[np.argsort((kept / np.abs(kept).mean(axis=0)).sum(axis=1))[:50]] if len(kept) else ():
        kept = kept[(kept < row).any(axis=1) | (kept == row).all(axis=1)]
    return kept


def _spline(points: Array, values: Array) -> RBFInterpolator:
    return RBFInterpolator(points, values, kernel="thin_plate_spline")
