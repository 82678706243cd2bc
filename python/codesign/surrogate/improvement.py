"""What a design is worth before it is evaluated: the expected gain over a front, for independent normal predictions.

Up to three objectives: expected hypervolume improvement in closed form (with one objective: expected improvement), as a
sum over boxes (Yang, Emmerich, Deutz, Bäck: Efficient computation of expected hypervolume improvement using box
decomposition algorithms, J. Global Optimization 75, 2019). More objectives: expected improvement of an augmented
Chebyshev distance with given weights (Knowles: ParEGO, IEEE Trans. Evol. Computation 10, 2006) by a fixed sample.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
import numpy.typing as npt
from scipy.special import ndtr, ndtri

from codesign.surrogate.boxes import Boxes

Array = npt.NDArray[np.float64]

SUM_SHARE = 0.05  # of the sum of the weighted objectives in the Chebyshev distance
SAMPLES = 128  # points of the sample
DENSITY = 1.0 / np.sqrt(2.0 * np.pi)


class Improvement(Protocol):
    """Expected gain of designs."""

    def of(self, mean: Array, deviation: Array) -> Array:
        """(m,) gains of m designs with (m, objectives) predictions."""


class HypervolumeImprovement:
    """Expected growth of the hypervolume that a front (n, objectives) dominates below a reference point."""

    def __init__(self, front: Array, reference: Array) -> None:
        boxes = Boxes.beside(front, reference)
        corners = np.vstack([boxes.lower, boxes.upper])
        self._bounds, self._lower, self._upper = [], [], []
        for column in corners.T:  # boxes share their bounds: each is looked at once
            bounds, place = np.unique(column, return_inverse=True)
            self._bounds.append(bounds)
            self._lower.append(place[: len(boxes.lower)])
            self._upper.append(place[len(boxes.lower) :])

    def of(self, mean: Array, deviation: Array) -> Array:
        """(m,) expected growth."""
        product = np.ones((len(mean), len(self._lower[0])))
        for j, (bounds, lower, upper) in enumerate(zip(self._bounds, self._lower, self._upper, strict=True)):
            below = expected_shortfall(bounds, mean[:, j, None], deviation[:, j, None])
            product *= below[:, upper] - below[:, lower]
        growth: Array = product.sum(axis=1)
        return growth


class ChebyshevImprovement:
    """Expected decrease of the least augmented Chebyshev distance of a front (n, objectives) from its best values."""

    def __init__(self, front: Array, weights: Array, rng: np.random.Generator) -> None:
        from scipy.stats import qmc

        self._weights, self._ideal = weights, front.min(axis=0)
        unit = qmc.Sobol(front.shape[1], scramble=True, rng=rng).random(SAMPLES)
        self._normal = ndtri(np.clip(unit, 1e-12, 1.0 - 1e-12))
        self._best = float(self._distance(front).min())

    def of(self, mean: Array, deviation: Array) -> Array:
        """(m,) expected decrease."""
        total = np.zeros(len(mean))
        for sample in self._normal:
            total += np.maximum(self._best - self._distance(mean + deviation * sample), 0.0)
        return total / len(self._normal)

    def _distance(self, values: Array) -> Array:
        weighted = self._weights * (values - self._ideal)
        distance: Array = weighted.max(axis=1) + SUM_SHARE * weighted.sum(axis=1)
        return distance


def expected_shortfall(bound: Array, mean: Array, deviation: Array) -> Array:
    """(m,) E max(bound - y, 0) of normal y; 0 for the bound -inf."""
    finite = np.isfinite(bound)
    away = (np.where(finite, bound, 0.0) - mean) / deviation
    value = deviation * (away * ndtr(away) + DENSITY * np.exp(-0.5 * away**2))
    return np.where(finite, value, 0.0)
