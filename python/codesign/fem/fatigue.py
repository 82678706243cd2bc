"""Fatigue of a history of stress: rainflow cycles, Basquin's line, Goodman's mean stress, Miner's sum.

Source of the estimate where a material states one point only: Budynas and Nisbett, Shigley's Mechanical Engineering
Design, 6-8: the line through 0.9 of the ultimate strength at 1000 cycles.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import rainflow
from numpy.typing import ArrayLike, NDArray

SHARE_AT_LOW_CYCLES, LOW_CYCLES = 0.9, 1e3


@dataclass(frozen=True, slots=True)
class FatigueStrength:
    """Fully reversed stress amplitude [Pa] that smooth specimens stand for so many cycles; ultimate strength [Pa]."""

    amplitude: float
    cycles: float
    ultimate: float

    def __post_init__(self) -> None:
        if not (0.0 < self.amplitude < SHARE_AT_LOW_CYCLES * self.ultimate and self.cycles > LOW_CYCLES):
            raise ValueError(
                f"fatigue strength {self.amplitude:g} Pa at {self.cycles:g} cycles, ultimate strength "
                f"{self.ultimate:g} Pa: needs 0 < strength < {SHARE_AT_LOW_CYCLES} ultimate, cycles > {LOW_CYCLES:g}"
            )

    @property
    def slope(self) -> float:
        """Exponent b of Basquin's line, amplitude ~ cycles^b; negative."""
        return math.log(self.amplitude / (SHARE_AT_LOW_CYCLES * self.ultimate)) / math.log(self.cycles / LOW_CYCLES)

    def life(self, amplitude: float, mean: float) -> float:
        """Cycles to failure at an amplitude about a mean stress [Pa]; inf without amplitude, 0 beyond the ultimate.

        Goodman's line for tension, no benefit of compression, no endurance limit.
        """
        if amplitude <= 0.0:
            return math.inf
        reserve = 1.0 - max(mean, 0.0) / self.ultimate
        if amplitude >= self.ultimate * reserve:
            return 0.0
        return float(self.cycles * (amplitude / reserve / self.amplitude) ** (1.0 / self.slope))


def von_mises(stress: ArrayLike) -> NDArray[np.float64]:
    """(n,) von Mises stress [Pa] of (n, 6) xx yy zz xy yz zx."""
    xx, yy, zz, xy, yz, zx = np.asarray(stress, dtype=float).T
    squares = 0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3.0 * (xy**2 + yz**2 + zx**2)
    return np.asarray(np.sqrt(squares))


def signed_von_mises(stress: ArrayLike) -> NDArray[np.float64]:
    """(n,) von Mises stress [Pa] of (n, 6) xx yy zz xy yz zx, with the sign of the largest principal stress."""
    xx, yy, zz, xy, yz, zx = np.asarray(stress, dtype=float).T
    tensor = np.array([[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]]).transpose(2, 0, 1)
    principal = np.linalg.eigvalsh(tensor)
    sign = np.where(np.abs(principal[:, 0]) > np.abs(principal[:, 2]), -1.0, 1.0)
    return np.asarray(sign * von_mises(stress))


def damage(history: ArrayLike, strength: FatigueStrength) -> float:
    """Miner's sum of a history (n,) of stress [Pa] that starts and ends unloaded; inf: it breaks at once.

    One over it is how often the history can be repeated.
    """
    series = np.concatenate([[0.0], np.asarray(history, dtype=float), [0.0]])
    total = 0.0
    for size, mean, count, _, _ in rainflow.extract_cycles(series):
        life = strength.life(0.5 * size, mean)
        if life == 0.0:
            return math.inf
        total += count / life
    return total
