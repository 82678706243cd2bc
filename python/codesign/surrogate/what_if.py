"""What a design would probably give: predictions for people, with error bands and how far they can be trusted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.special import ndtri

from codesign.problem.design_space import DesignSpace
from codesign.problem.evaluation import Evaluation
from codesign.surrogate.coordinates import Coordinates
from codesign.surrogate.gaussian_process import GaussianProcess
from codesign.surrogate.outputs import CONSTANT, LEAST_LABEL_DEVIATION, Condition, Output, Scaling, has_objectives
from codesign.surrogate.threads import one_thread

Array = npt.NDArray[np.float64]
Grid = tuple[int, ...]

MOST_POINTS = 300  # designs that models are made of: the front, and others spread evenly over the run
LEAST_POINTS = 20  # designs with a number before it is modeled
MOST_EQUAL = 0.5  # share of the designs that have one and the same value
BANDS = (0.5, 0.9)
LABEL_THRESHOLD = 0.5


@dataclass(frozen=True, slots=True)
class Quality:
    """How well each design is predicted from all others. error: root mean square over the spread of the values.

    explained: share of the variance (R squared). coverage: share of the designs inside their 90 % band.
    """

    error: float
    explained: float
    coverage: float

    @property
    def poor(self) -> bool:
        """Whether predictions should not be relied on."""
        return self.explained < 0.5 or self.coverage < 0.75


@dataclass(frozen=True, slots=True)
class Prediction:
    """Of a number [unit of the evaluation]. bands: lower and upper end for each of BANDS, empty outside the sample."""

    mean: float
    bands: tuple[tuple[float, float], ...]


@dataclass(frozen=True, slots=True)
class NumberModel:
    """Model of one number of the evaluation. rows: of the designs that it is made of. scaling: of objectives."""

    key: str
    rows: npt.NDArray[np.int_]
    process: GaussianProcess
    scaling: Scaling | None
    quality: Quality

    @classmethod
    def of(
        cls,
        key: str,
        rows: npt.NDArray[np.int_],
        values: Array,
        coordinates: Coordinates,
        grids: npt.NDArray[np.int_],
        scaled: bool,
    ) -> NumberModel:
        """The model of (n,) values that are not all equal."""
        scaling = Scaling.of(values) if scaled else None
        fitted_to = scaling.forward(values) if scaling else values
        process = GaussianProcess.of(coordinates.of(grids[rows]), fitted_to, coordinates.variable)
        said = process.left_out(fitted_to)
        inside = np.abs(said.mean - fitted_to) <= _width(BANDS[-1]) * said.deviation
        error = float(np.sqrt(np.mean(np.square(said.mean - fitted_to))) / fitted_to.std())
        return cls(key, rows, process, scaling, Quality(error, 1.0 - error**2, float(inside.mean())))

    def predict(self, inputs: Array, inside: bool) -> Prediction:
        """At (columns,) inputs; the bands hold the noise. inside: whether the sample surrounds the point."""
        mean, deviation = (float(values[0]) for values in self.process.predict(inputs[None]))
        whole = float(np.hypot(deviation, self.process.noise_deviation))
        ends = [(mean - _width(share) * whole, mean + _width(share) * whole) for share in BANDS] if inside else []
        bands = tuple((self._shown(low), self._shown(high)) for low, high in ends)
        return Prediction(self._shown(mean), bands)

    def _shown(self, value: float) -> float:
        return float(self.scaling.back(np.array(value))) if self.scaling else value


@dataclass(frozen=True, slots=True)
class WhatIf:
    """Models of a run's numbers. grids: (n, variables) designs they are made of, `entries` their positions in the run.

    lowest, highest: (variables,) grid indices that the designs span. completed: chance that a design has objectives at
    all; None if all have.
    """

    coordinates: Coordinates
    grids: npt.NDArray[np.int_]
    entries: tuple[int, ...]
    numbers: tuple[NumberModel, ...]
    completed: Condition | None
    lowest: npt.NDArray[np.int_]
    highest: npt.NDArray[np.int_]

    @classmethod
    def of(
        cls,
        space: DesignSpace,
        evaluations: Sequence[Evaluation],
        front: Sequence[int],
        objectives: Sequence[str],
        constraints: Sequence[str],
    ) -> WhatIf | None:
        """Models of these objectives and constraints; None if too few designs have any of them.

        front: positions of the best compromises, which are always among the designs that models are made of.
        """
        with one_thread():
            return cls._of(space, evaluations, chosen(len(evaluations), front), objectives, constraints)

    @classmethod
    def _of(
        cls,
        space: DesignSpace,
        evaluations: Sequence[Evaluation],
        entries: tuple[int, ...],
        objectives: Sequence[str],
        constraints: Sequence[str],
    ) -> WhatIf | None:
        told = [evaluations[i] for i in entries]
        if not told:
            return None
        grids = np.array([space.indices(evaluation.design) for evaluation in told])
        coordinates = Coordinates(space)
        numbers = []
        for key in dict.fromkeys((*objectives, *constraints)):
            rows, values = _values(told, key, key in objectives)
            if len(rows) >= LEAST_POINTS and _varies(values):
                numbers.append(NumberModel.of(key, rows, values, coordinates, grids, key in objectives))
        if not numbers:
            return None
        labels = np.array([has_objectives(evaluation, objectives) for evaluation in told], dtype=float)
        completed = None
        if 0.0 < labels.mean() < 1.0:
            output = Output.of("completed", coordinates.of(grids), labels, coordinates.variable)
            completed = Condition(output, LABEL_THRESHOLD, LEAST_LABEL_DEVIATION)
        spanned = grids[[len(evaluation.objectives) > 0 for evaluation in told]] if labels.any() else grids
        return cls(coordinates, grids, entries, tuple(numbers), completed, spanned.min(axis=0), spanned.max(axis=0))

    def inside(self, grid: Grid) -> bool:
        """Whether every variable is between the smallest and the largest value that has been tried."""
        return bool((self.lowest <= np.array(grid)).all() and (np.array(grid) <= self.highest).all())

    def predict(self, grid: Grid) -> dict[str, Prediction]:
        """Of every number, by key; without bands outside of the sample."""
        inputs = self.coordinates.of([grid])[0]
        return {number.key: number.predict(inputs, self.inside(grid)) for number in self.numbers}

    def completes(self, grid: Grid) -> float:
        """Chance that a design has objectives: neither lost nor failed."""
        return 1.0 if self.completed is None else float(self.completed.probability(self.coordinates.of([grid]))[0])

    def nearest(self, grid: Grid) -> tuple[int, int]:
        """Position in the run of the nearest design that the models know, and how many grid steps away it is."""
        steps = np.abs(self.grids - np.array(grid)).sum(axis=1)
        row = int(steps.argmin())
        return self.entries[row], int(steps[row])


def chosen(count: int, front: Sequence[int]) -> tuple[int, ...]:
    """Positions of at most MOST_POINTS of `count` designs: the front, and others spread evenly."""
    best = set(front)
    others = [i for i in range(count) if i not in best]
    kept = list(front)[:MOST_POINTS]
    room = min(MOST_POINTS - len(kept), len(others))
    spread = [others[int(i)] for i in np.linspace(0, len(others) - 1, room).round()] if room else []
    return tuple(sorted({*kept, *spread}))


def _values(evaluations: Sequence[Evaluation], key: str, objective: bool) -> tuple[npt.NDArray[np.int_], Array]:
    """Rows of the designs that have a number, and the numbers."""
    found = [(e.objectives if objective else e.constraints).get(key) for e in evaluations]
    rows = [i for i, value in enumerate(found) if value is not None and np.isfinite(value)]
    return np.array(rows, dtype=int), np.array([found[i] for i in rows], dtype=float)


def _varies(values: Array) -> bool:
    """Whether values can be modeled as a smooth function: not where most of them are the same one."""
    _, counts = np.unique(values, return_counts=True)
    return bool(counts.max() <= MOST_EQUAL * len(values) and np.ptp(values) > CONSTANT * np.abs(values).max())


def _width(share: float) -> float:
    """Half the width of a band that holds such a share, in standard deviations."""
    return float(ndtri(0.5 + 0.5 * share))
