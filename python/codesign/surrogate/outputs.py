"""Numbers of evaluations that models are fitted to: objectives, margins of constraints, labels."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.special import ndtr

from codesign.problem.evaluation import Evaluation
from codesign.surrogate.gaussian_process import GaussianProcess
from codesign.surrogate.likelihood import Hyperparameters

Array = npt.NDArray[np.float64]

CONSTANT = 1e-9  # relative spread below which an output counts as constant: the rest is rounding
LEAST_LABEL_DEVIATION = 0.05  # a label is never that sure


@dataclass(frozen=True, slots=True)
class Scaling:
    """A monotone map of an objective that its tail of bad values does not rule: 0 at the median, 1 worse than best.

    z = (y - median) / (median - best); above the median log(1 + z). Fronts stay what they are.
    """

    median: float
    unit: float

    @classmethod
    def of(cls, values: Array) -> Scaling:
        """That of (n,) values."""
        median = float(np.median(values))
        unit = median - float(values.min())
        return cls(median, unit if unit > CONSTANT * abs(median) else float(values.std()) or 1.0)

    def forward(self, values: Array) -> Array:
        """(n,) scaled values."""
        scaled = (values - self.median) / self.unit
        return np.where(scaled > 0.0, np.log1p(np.maximum(scaled, 0.0)), scaled)

    def back(self, scaled: Array) -> Array:
        """(n,) values of scaled ones."""
        return self.median + self.unit * np.where(scaled > 0.0, np.expm1(np.maximum(scaled, 0.0)), scaled)


@dataclass(frozen=True, slots=True)
class Output:
    """A modeled number: a process, or the one value that all designs have."""

    key: str
    process: GaussianProcess | None
    constant: float = 0.0

    @classmethod
    def of(
        cls,
        key: str,
        inputs: Array,
        values: Array,
        variable: npt.NDArray[np.int_],
        known: Hyperparameters | None = None,
    ) -> Output:
        """The model of (n,) values, n >= 1; arguments as of `GaussianProcess.of`."""
        if np.ptp(values) <= CONSTANT * np.abs(values).max():
            return cls(key, None, float(values[0]))
        return cls(key, GaussianProcess.of(inputs, values, variable, known))

    def predict(self, inputs: Array) -> tuple[Array, Array]:
        """Mean and standard deviation, (m,) each; a constant has no deviation."""
        if self.process is None:
            return np.full(len(inputs), self.constant), np.zeros(len(inputs))
        return self.process.predict(inputs)

    def conditioned(self, inputs: Array) -> Output:
        """The model that also knows its own prediction at a point (columns,)."""
        if self.process is None:
            return self
        return Output(self.key, self.process.conditioned(inputs))


@dataclass(frozen=True, slots=True)
class Condition:
    """Something that a design must fulfill. threshold: the least good value. least_deviation: of a prediction."""

    output: Output
    threshold: float = 0.0
    least_deviation: float = 0.0

    def probability(self, inputs: Array) -> Array:
        """(m,) chance that designs fulfill it."""
        mean, deviation = self.output.predict(inputs)
        if self.output.process is None:
            return np.where(mean >= self.threshold, 1.0, 0.0)
        chance: Array = ndtr((mean - self.threshold) / np.maximum(deviation, self.least_deviation))
        return chance

    def conditioned(self, inputs: Array) -> Condition:
        """As of `Output`, at a point (columns,)."""
        return Condition(self.output.conditioned(inputs), self.threshold, self.least_deviation)


def has_objectives(evaluation: Evaluation, names: Sequence[str]) -> bool:
    """Whether a design has all its objectives: neither failed nor lost."""
    values = [evaluation.objectives.get(name) for name in names]
    return evaluation.status != "failed" and all(value is not None and math.isfinite(value) for value in values)


def margins(evaluations: Sequence[Evaluation]) -> dict[str, tuple[npt.NDArray[np.int_], Array]]:
    """Rows (k,) and margins (k,) of every constraint, for the designs that have a number of it.

    A problem that tells violations only has margins that are never above 0.
    """
    found: dict[str, tuple[list[int], list[float]]] = {}
    for row, evaluation in enumerate(evaluations):
        known = {key: -violation for key, violation in evaluation.violations.items()} | evaluation.margins
        for key, margin in known.items():
            if evaluation.status != "failed" and math.isfinite(margin):
                rows, values = found.setdefault(key, ([], []))
                rows.append(row)
                values.append(margin)
    return {key: (np.array(rows), np.array(values)) for key, (rows, values) in found.items()}
