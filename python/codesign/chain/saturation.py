"""How much of their limits the actuators and joints of a flight used, and which of them explains a loss."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from codesign import dynamics as dyn
from codesign.study.flight_config import FlightConfig
from codesign.units import DEGREE

NEAR = 0.01  # share of a range that counts as its end
OFTEN = 0.2  # share of the flight at a limit from which the limit is named
BUSY = 0.5  # mean thrust rate over its limit from which the gains are named

# In the order of asking: number of the flight, share from which it explains a loss, what it says.
EXPLANATIONS = (
    ("thrust_rate_share", BUSY, "the mean thrust rate is {share:.0%} of its limit: the gains are too high for the "
     "thrusters; `codesign tune` flies others"),
    ("thrust_at_most", OFTEN, "a thruster gave its largest thrust in {share:.0%} of the samples: they are too weak"),
    ("thrust_at_least", OFTEN, "a thruster gave its least thrust in {share:.0%} of the samples: they are badly "
     "balanced, or too strong"),
    ("torque_at_limit", OFTEN, "a joint torque was at its limit in {share:.0%} of the samples"),
    ("joint_at_limit", OFTEN, "a joint was at the end of its range in {share:.0%} of the samples"),
)  # fmt: skip


def saturation(log: dyn.FlightLog, flight: FlightConfig) -> dict[str, float]:
    """Shares from 0 to 1 of a flight; 0 for what robot or controller do not have.

    thrust_rate_share: mean commanded thrust rate over its limit. thrust_at_most, thrust_at_least, torque_at_limit,
    joint_at_limit: samples in which any of them is within 1 % of its range of that end; joints only where the study
    gives ranges, and not those that start at an end: straight knees rest there.
    """
    jets, limits = flight.jets, flight.limits
    count = len(jets.frames)
    least, most, rate = (
        np.broadcast_to(value, count).astype(float)
        for value in (jets.min_thrust_n, jets.max_thrust_n, jets.max_thrust_rate_n_s)
    )
    scales = np.array([group.range_scale for group in flight.joint_groups for _ in group.joints])
    unlimited = [(-np.inf, np.inf)]
    ranges = np.array(
        [r for group in flight.joint_groups for r in group.ranges_deg or unlimited * len(group.joints)]
    ).reshape(-1, 2)
    ranges *= DEGREE
    low, high = ranges[:, 0] * scales, ranges[:, 1] * scales
    near_thrust, near_joint = NEAR * (most - least), np.where(np.isfinite(high - low), NEAR * (high - low), 0.0)
    torque = np.inf if limits is None else limits.torque_n_m
    with np.errstate(invalid="ignore"):  # the last sample of a lost flight may not be finite
        joint_at_end = (log.joint_positions >= high - near_joint) | (log.joint_positions <= low + near_joint)
        return {
            "thrust_rate_share": _mean(np.abs(log.thrust_rate_command) / rate),
            "thrust_at_most": _any(log.thrust >= most - near_thrust),
            "thrust_at_least": _any(log.thrust <= least + near_thrust),
            "torque_at_limit": _any(np.abs(log.torque) >= (1.0 - NEAR) * torque),
            "joint_at_limit": _any(joint_at_end & ~joint_at_end[:1]),
        }


def explanation(shares: Mapping[str, Any]) -> str | None:
    """What of it explains a lost flight; None if nothing was near its limits for long."""
    for name, least, words in EXPLANATIONS:
        if shares.get(name, 0.0) >= least:
            return words.format(share=shares[name])
    return None


def _any(at_end: NDArray[np.bool_]) -> float:
    """Share of the samples (rows) in which any is at its end."""
    return float(at_end.any(axis=1).mean()) if at_end.size else 0.0


def _mean(values: NDArray[np.float64]) -> float:
    finite = values[np.isfinite(values)]
    return float(finite.mean()) if finite.size else 0.0
