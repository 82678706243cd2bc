"""Own number of the study: how fast an arm swings with its motor. See `[constraints.limits]` of study.toml."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

MOTOR_MASS = 0.11  # kg, with its propeller; as in robot.toml
CASE, FORCE = "thrust", 12.0  # load case that gives the stiffness; its force [N]
BEAM_SHARE = 33.0 / 140.0  # of a cantilever's own mass that counts at its tip (Rayleigh's quotient)


def with_motor(document: Mapping[str, Any]) -> float:
    """First natural frequency [Hz] of an arm with the motor on its end, by Rayleigh's quotient."""
    arm = document["parts"]["arm"]
    stiffness = FORCE / arm["cases"][CASE]["max_displacement"]
    return math.sqrt(stiffness / (MOTOR_MASS + BEAM_SHARE * arm["mass"])) / (2.0 * math.pi)
