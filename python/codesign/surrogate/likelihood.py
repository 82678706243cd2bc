"""How well the lengths and the noise of a Gaussian process explain values, with its gradient; and the best of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.linalg import lapack
from scipy.optimize import minimize

Array = npt.NDArray[np.float64]

ROOT5 = np.sqrt(5.0)
LENGTH_BOUNDS = (0.05, 20.0)  # in unit boxes
NOISE_BOUNDS = (1e-6, 1e-1)  # share of the signal's variance
LENGTH_PRIOR = (0.7, 3.0)  # median and factor of a weak log-normal prior
NOISE_PRIOR = (1e-3, 10.0)
STARTS = ((0.7, 1e-3), (0.25, 1e-2))  # length, noise
GRID = 256.0  # steps in a natural logarithm to which results are rounded, so that last digits decide nothing
REFUSED = 1e25  # for a matrix that is not positive definite


@dataclass(frozen=True, slots=True)
class Hyperparameters:
    """Of a process: a length for each variable, in unit boxes; variance of the noise as a share of the signal's."""

    lengths: Array
    noise: float


def matern(distance: Array) -> Array:
    """Matérn correlation of smoothness 5/2 at distances d relative to the length: (1 + z + z²/3) exp(-z), z = √5 d."""
    scaled = ROOT5 * distance
    correlation: Array = (1.0 + scaled + scaled**2 / 3.0) * np.exp(-scaled)
    return correlation


class Likelihood:
    """Negative logarithm of the posterior of log lengths and log noise, constants left out; signal variance profiled.

    squares: (variables, n, n) squared differences of the inputs. values: (n,), mean 0 and variance 1.
    """

    def __init__(self, squares: Array, values: Array) -> None:
        self._squares, self._values = squares, values
        count = len(squares)
        centers = [*[LENGTH_PRIOR[0]] * count, NOISE_PRIOR[0]]
        self._center = np.log(centers)
        self._width = np.log([*[LENGTH_PRIOR[1]] * count, NOISE_PRIOR[1]])

    def __call__(self, logs: Array) -> tuple[float, Array]:
        """Value and gradient at (variables + 1,) logarithms of lengths and noise."""
        weights = np.exp(-2.0 * logs[:-1])
        scaled = ROOT5 * np.sqrt(np.tensordot(weights, self._squares, 1))
        decay = np.exp(-scaled)
        matrix = (1.0 + scaled + scaled**2 / 3.0) * decay
        noise = np.exp(logs[-1])
        np.fill_diagonal(matrix, 1.0 + noise)
        factor, failed = lapack.dpotrf(matrix, lower=1)
        if failed:
            return REFUSED, np.zeros_like(logs)
        half_determinant = np.log(np.diag(factor)).sum()
        inverse = lapack.dpotri(factor, lower=1)[0]
        inverse = np.tril(inverse) + np.tril(inverse, -1).T
        solved = inverse @ self._values
        variance = max(float(self._values @ solved) / len(solved), 1e-300)
        slope = 0.5 * (inverse - np.outer(solved, solved) / variance)
        by_square = slope * (1.0 + scaled) * decay * (5.0 / 3.0)
        gradient = np.array([*(weights * np.einsum("kij,ij->k", self._squares, by_square)), noise * np.trace(slope)])
        off = (logs - self._center) / self._width
        value = 0.5 * len(solved) * np.log(variance) + half_determinant + 0.5 * float(off @ off)
        return float(value), gradient + off / self._width


def fit(squares: Array, values: Array) -> Hyperparameters:
    """The most probable lengths and noise of squares (variables, n, n) and values (n,); a function of these alone."""
    likelihood = Likelihood(squares, values)
    bounds = [tuple(np.log(LENGTH_BOUNDS))] * len(squares) + [tuple(np.log(NOISE_BOUNDS))]
    best: tuple[float, Array] | None = None
    for length, noise in STARTS:
        start = np.log([*[length] * len(squares), noise])
        options = {"maxiter": 60, "ftol": 1e-7}
        found = minimize(likelihood, start, jac=True, method="L-BFGS-B", bounds=bounds, options=options)
        if best is None or found.fun < best[0]:
            best = float(found.fun), found.x
    assert best is not None
    rounded = np.exp(np.round(best[1] * GRID) / GRID)
    return Hyperparameters(rounded[:-1], float(rounded[-1]))
