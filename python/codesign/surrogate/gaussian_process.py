"""Gaussian processes: the value of a smooth function between the points where it is known, with its uncertainty.

Rasmussen and Williams, Gaussian Processes for Machine Learning, 2006: prediction (2.25, 2.26), likelihood (5.9),
leave-one-out (5.12).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from scipy.linalg import cho_solve, cholesky, solve_triangular
from scipy.spatial.distance import cdist

from codesign.surrogate.likelihood import Hyperparameters, fit, matern

Array = npt.NDArray[np.float64]

LARGEST_FIT = 300  # points that lengths and noise are fitted to; all points enter predictions
LEAST_VARIANCE = 1e-12  # of the signal's: what rounding leaves of a variance is not below


@dataclass(frozen=True, slots=True)
class Errors:
    """What a process says of each of its points when that point is left out, (n,) each: no refits are needed.

    mean: predicted value. deviation: standard deviation of the prediction, noise included.
    """

    mean: Array
    deviation: Array


@dataclass(frozen=True, slots=True)
class GaussianProcess:
    """A process that knows n points.

    inputs: (n, columns), divided by the columns' lengths. column_lengths: (columns,) these lengths. noise: share of
    the signal's variance. center, scale: of the values. factor: (n, n) lower Cholesky factor of the correlations.
    weights: (n,) solution for the standardized values. variance: of the signal, standardized.
    """

    inputs: Array
    column_lengths: Array
    noise: float
    center: float
    scale: float
    factor: Array
    weights: Array
    variance: float

    @classmethod
    def of(
        cls, inputs: Array, values: Array, variable: npt.NDArray[np.int_], known: Hyperparameters | None = None
    ) -> GaussianProcess:
        """The process through (n, columns) inputs with (n,) values that are not all equal.

        variable: (columns,) number of the variable that a column belongs to; each variable has one length.
        known: lengths and noise; None: fitted.
        """
        center, scale = float(values.mean()), float(values.std())
        standardized = (values - center) / scale
        found = known or fitted(inputs, values, variable)
        lengths = found.lengths[variable]
        scaled = inputs / lengths
        matrix = matern(cdist(scaled, scaled))
        np.fill_diagonal(matrix, 1.0 + found.noise)
        factor = cholesky(matrix, lower=True)
        weights = cho_solve((factor, True), standardized)
        variance = max(float(standardized @ weights) / len(weights), LEAST_VARIANCE)
        return cls(scaled, lengths, found.noise, center, scale, factor, weights, variance)

    def predict(self, inputs: Array) -> tuple[Array, Array]:
        """Mean and standard deviation, (m,) each, of the function itself (without noise) at (m, columns) inputs."""
        correlation = matern(cdist(self.inputs, inputs / self.column_lengths))
        mean = self.center + self.scale * (correlation.T @ self.weights)
        known = np.square(solve_triangular(self.factor, correlation, lower=True, check_finite=False)).sum(axis=0)
        return mean, self.scale * np.sqrt(self.variance * np.maximum(1.0 - known, LEAST_VARIANCE))

    @property
    def noise_deviation(self) -> float:
        """Standard deviation of the noise, in the unit of the values."""
        return float(self.scale * np.sqrt(self.variance * self.noise))

    def conditioned(self, inputs: Array) -> GaussianProcess:
        """The process that also knows the point (columns,), with the value that it predicts there.

        No mean changes, so the new point's weight is 0; deviations get smaller around it.
        """
        scaled = inputs[None, :] / self.column_lengths
        correlation = matern(cdist(self.inputs, scaled))[:, 0]
        row = solve_triangular(self.factor, correlation, lower=True, check_finite=False)
        corner = np.sqrt(max(1.0 + self.noise - float(row @ row), LEAST_VARIANCE))
        count = len(row)
        factor = np.zeros((count + 1, count + 1))
        factor[:count, :count], factor[count, :count], factor[count, count] = self.factor, row, corner
        return replace(
            self, inputs=np.vstack([self.inputs, scaled]), factor=factor, weights=np.append(self.weights, 0.0)
        )

    def left_out(self, values: Array) -> Errors:
        """What it says of each of its own points without that point; values: (n,) those that it was made of."""
        inverse = np.diag(cho_solve((self.factor, True), np.eye(len(self.weights))))
        error = self.scale * self.weights / inverse
        return Errors(values - error, self.scale * np.sqrt(self.variance / inverse))


def fitted(inputs: Array, values: Array, variable: npt.NDArray[np.int_]) -> Hyperparameters:
    """Lengths and noise for (n, columns) inputs with (n,) values; arguments as of `GaussianProcess.of`.

    Of more than LARGEST_FIT points as many are taken, spread evenly over their order.
    """
    if len(values) > LARGEST_FIT:
        chosen = np.linspace(0, len(values) - 1, LARGEST_FIT).round().astype(int)
        inputs, values = inputs[chosen], values[chosen]
    standardized = (values - values.mean()) / (values.std() or 1.0)
    columns = np.square(inputs[:, None, :] - inputs[None, :, :])
    squares = np.stack([columns[:, :, variable == number].sum(axis=2) for number in range(variable.max() + 1)])
    return fit(squares, standardized)
