"""Gains of the momentum controller from wanted bandwidths, and back. The law is in docs/control.md.

Linearized about a hover, with thrusts that follow, the errors of position and of each principal attitude obey

    x‴ + (1 + K_D) ẍ + (K_P + K_D + 1/K_O) ẋ + K_P x = 0
    θ‴ + (1 + c₀/I) θ̈ + (1 + c₁)/I θ̇ + c₀/I² θ = 0

with the moment of inertia I in kg m². Both are written here as (s + pole)(s² + 2 damping frequency s + frequency²).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class LinearGains:
    """Gains of the position, SI: proportional K_P, derivative K_D, momentum K_O (its inverse acts on the momentum)."""

    proportional: float
    derivative: float
    momentum: float

    @property
    def poles(self) -> NDArray[np.complex128]:
        """(3,) roots of the error of the position [1/s]."""
        slope = self.proportional + self.derivative + 1.0 / self.momentum
        return np.roots([1.0, 1.0 + self.derivative, slope, self.proportional]).astype(complex)


@dataclass(frozen=True, slots=True)
class AttitudeGains:
    """Gains of the attitude, SI: proportional c₀, derivative c₁."""

    proportional: float
    derivative: float

    def poles(self, inertia: float) -> NDArray[np.complex128]:
        """(3,) roots of the error of the attitude about an axis of the moment of inertia [kg m²] [1/s]."""
        c0, c1 = self.proportional, self.derivative
        return np.roots([1.0, 1.0 + c0 / inertia, (1.0 + c1) / inertia, c0 / inertia**2]).astype(complex)


def linear_gains(frequency: float, damping: float = 1.0, pole: float = 0.5) -> LinearGains:
    """Gains that give the position a pair of poles and a slow one.

    Args:
        frequency, damping: of the pair [rad/s]. pole: the slow one [rad/s]; the law needs one slower than 1 rad/s.
    Raises: ValueError: no positive gains do that.
    """
    _require_positive(frequency=frequency, damping=damping, pole=pole)
    derivative = pole + 2.0 * damping * frequency - 1.0
    inverse = (1.0 - pole) * (1.0 - 2.0 * damping * frequency + frequency**2)
    if derivative < 0.0 or inverse <= 0.0:
        raise ValueError(
            f"no gains give poles of {frequency:g} rad/s (damping {damping:g}) and {pole:g} rad/s: "
            "the law has one pole below 1 rad/s, and pole + 2 damping frequency is at least 1 rad/s"
        )
    return LinearGains(pole * frequency**2, derivative, 1.0 / inverse)


def attitude_gains(inertia: float, pole: float, damping: float = 0.8) -> AttitudeGains:
    """Gains that give the attitude a fast pole, as fast as thrusts and control step allow, and a damped pair.

    The law has two gains for three poles: the frequency of the pair follows, near 1/√inertia.

    Args:
        inertia: moment of inertia about the axis [kg m²]. pole: the fast one [rad/s], above 1. damping: of the pair.
    Raises: ValueError: a number is out of range, or no positive gains do that.
    """
    _require_positive(inertia=inertia, pole=pole - 1.0, damping=damping)
    frequency = (damping + math.sqrt(damping**2 + inertia * pole * (pole - 1.0))) / (inertia * pole)
    derivative = inertia * (frequency**2 + 2.0 * damping * frequency * pole) - 1.0
    if derivative < 0.0:
        raise ValueError(f"no gains give an inertia of {inertia:g} kg m² poles of {pole:g} rad/s, damping {damping:g}")
    return AttitudeGains(inertia * (pole + 2.0 * damping * frequency - 1.0), derivative)


def _require_positive(**values: float) -> None:
    for name, value in values.items():
        if not (math.isfinite(value) and value > 0.0):
            raise ValueError(f"{name} must be positive" if name != "pole" else "the pole is too slow")
