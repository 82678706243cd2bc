"""Own number of the study: the power that its propellers take. See `[objectives]` of study.toml."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

AIR_DENSITY = 1.225  # kg/m³
FIGURE_OF_MERIT = 0.6  # ideal power over that of a small propeller
ROTORS = 6
HUB_RADIUS, GAP = 0.08, 0.02  # m: axis to the arms' mounts, as in robot.toml; between the tips of neighbors


def propeller_diameter(arm_length: float) -> float:
    """The largest [m] with which neighbors keep their distance, of an arm length [m]: six arms make equal triangles."""
    return HUB_RADIUS + arm_length - GAP


def power_in_watts(document: Mapping[str, Any]) -> float:
    """Of all propellers at the mean thrust of the flight: T √(T / (2 ρ A)) each, over the figure of merit."""
    flight = document["flight"]
    thrust = flight["thrust_impulse"] / flight["duration"] / ROTORS
    disk = math.pi / 4.0 * propeller_diameter(1e-3 * document["design"]["length"]) ** 2
    return ROTORS * float(thrust) * math.sqrt(thrust / (2.0 * AIR_DENSITY * disk)) / FIGURE_OF_MERIT
