"""Models of everything that decides a design's worth, fitted to evaluated designs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from codesign.problem.evaluation import Evaluation
from codesign.surrogate.coordinates import Coordinates
from codesign.surrogate.gaussian_process import fitted
from codesign.surrogate.likelihood import Hyperparameters
from codesign.surrogate.outputs import (
    CONSTANT,
    LEAST_LABEL_DEVIATION,
    Condition,
    Output,
    Scaling,
    has_objectives,
    margins,
)

Array = npt.NDArray[np.float64]
Grid = tuple[int, ...]

FLOWN = "has objectives"  # key of the label: 1 for a design that has its objectives, 0 for a lost or failed one
LEAST_FLOWN = 6  # designs with objectives before these are modeled
LABEL_THRESHOLD = 0.5


@dataclass(frozen=True, slots=True)
class Series:
    """What one model is fitted to. rows: of the designs that have the number. label: 1 and 0 instead of a number."""

    rows: npt.NDArray[np.int_]
    values: Array
    label: bool = False

    def same(self, other: Series) -> bool:
        """Whether another one says the same of the same designs."""
        return np.array_equal(self.rows, other.rows) and np.array_equal(self.values, other.values)


@dataclass(frozen=True, slots=True)
class DesignModels:
    """Models of objectives (scaled, see `Scaling`), of the margins of constraints and of having objectives at all.

    coordinates: of the design space. objectives: empty while too few designs have them. conditions: margins and labels.
    """

    coordinates: Coordinates
    objectives: tuple[Output, ...]
    scalings: tuple[Scaling, ...]
    conditions: tuple[Condition, ...]

    def predict(self, inputs: Array) -> tuple[Array, Array]:
        """Means and standard deviations of the scaled objectives, (m, objectives) each, at (m, columns) inputs."""
        predictions = [output.predict(inputs) for output in self.objectives]
        return np.stack([mean for mean, _ in predictions], 1), np.stack([deviation for _, deviation in predictions], 1)

    def feasibility(self, inputs: Array) -> Array:
        """(m,) chance that designs keep all constraints and have objectives, as if these were independent."""
        chance = np.ones(len(inputs))
        for condition in self.conditions:
            chance *= condition.probability(inputs)
        return chance

    def conditioned(self, grid: Grid) -> DesignModels:
        """The models that also know their own predictions at a grid point."""
        inputs = self.coordinates.of([grid])[0]
        return replace(
            self,
            objectives=tuple(output.conditioned(inputs) for output in self.objectives),
            conditions=tuple(condition.conditioned(inputs) for condition in self.conditions),
        )


def series(
    evaluations: Sequence[Evaluation], names: Sequence[str]
) -> tuple[dict[str, Series], tuple[Scaling, ...], dict[str, Series]]:
    """What objectives, their scalings and conditions are fitted to.

    A constraint that holds without any slack or not at all (a count, a share of the flight) is a label. Constant ones
    are left out; a label that says the same of all designs as another one is taken once.
    """
    flown = np.array([has_objectives(evaluation, names) for evaluation in evaluations], dtype=float)
    conditions: dict[str, Series] = {}
    if 0.0 < flown.mean() < 1.0:
        conditions[FLOWN] = Series(np.arange(len(flown)), flown, label=True)
    for key, (rows, values) in margins(evaluations).items():
        label = bool(values.max() <= 0.0 and (values == 0.0).any())
        found = Series(rows, (values >= 0.0).astype(float), label=True) if label else Series(rows, values)
        if not _constant(found.values) and not any(found.same(other) for other in conditions.values()):
            conditions[key] = found
    rows = np.flatnonzero(flown)
    if len(rows) < LEAST_FLOWN:
        return {}, (), conditions
    table = np.array([[evaluations[int(row)].objectives[name] for name in names] for row in rows])
    scalings = tuple(Scaling.of(column) for column in table.T)
    scaled = {name: Series(rows, s.forward(column)) for name, s, column in zip(names, scalings, table.T, strict=True)}
    return scaled, scalings, conditions


def _constant(values: Array) -> bool:
    return bool(np.ptp(values) <= CONSTANT * np.abs(values).max())


def fit_lengths(
    coordinates: Coordinates, grids: Sequence[Grid], evaluations: Sequence[Evaluation], names: Sequence[str]
) -> dict[str, Hyperparameters]:
    """Lengths and noise of every model, by the key of the objective, the constraint or the label."""
    objectives, _, conditions = series(evaluations, names)
    inputs = coordinates.of(grids)
    found = {}
    for group, members in (("objective", objectives), ("condition", conditions)):
        for key, s in members.items():
            if not _constant(s.values):
                found[f"{group} {key}"] = fitted(inputs[s.rows], s.values, coordinates.variable)
    return found


def fit_models(
    coordinates: Coordinates,
    grids: Sequence[Grid],
    evaluations: Sequence[Evaluation],
    names: Sequence[str],
    known: Mapping[str, Hyperparameters] | None = None,
) -> DesignModels:
    """The models of evaluated designs.

    Args:
        coordinates: of the design space. grids, evaluations: the designs. names: keys of the objectives.
        known: lengths and noise of `fit_lengths`, of fewer designs perhaps; what is missing there is fitted.
    """
    objectives, scalings, conditions = series(evaluations, names)
    inputs, variable, known = coordinates.of(grids), coordinates.variable, known or {}

    def output(group: str, key: str, s: Series) -> Output:
        return Output.of(key, inputs[s.rows], s.values, variable, known.get(f"{group} {key}"))

    return DesignModels(
        coordinates,
        tuple(output("objective", key, s) for key, s in objectives.items()),
        scalings,
        tuple(
            Condition(
                output("condition", key, s),
                LABEL_THRESHOLD if s.label else 0.0,
                LEAST_LABEL_DEVIATION if s.label else 0.0,
            )
            for key, s in conditions.items()
        ),
    )
