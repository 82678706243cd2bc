"""A flight as JSON: objective families and tracking figures."""

from __future__ import annotations

import math
from collections.abc import Callable
from operator import attrgetter
from typing import Any

from codesign import dynamics as dyn
from codesign.chain.saturation import saturation
from codesign.problem.quantities import FAMILY
from codesign.study.config import StudyConfig
from codesign.study.flight_config import FlightConfig

# Numbers of a flight in its document, SI units, None where they are not finite: name -> function of the log with its
# histories. An objective or a constraint names them by path, `flight.max_torque`.
FLIGHT_NUMBERS: dict[str, Callable[[dyn.FlightLog], float]] = {
    name: attrgetter(name)
    for name in ("max_com_error", "max_attitude_error", "min_thrust", "max_thrust", "max_torque", "min_clearance")
}
SHORTEST_MISS = 1e-6  # of a flight that was lost in its last sample


def objective_families(log: dyn.FlightLog) -> dict[str, dict[str, float]]:
    """All objective families of a flight; a number that is not finite is left out."""
    families = {}
    for family in ("rms", "script", "paper"):
        values = getattr(log, family)
        named = {name: getattr(values, name) for name in FAMILY}
        families[family] = {name: value for name, value in named.items() if math.isfinite(value)}
    return families


def flight_document(trajectory: str, log: dyn.FlightLog, flight: FlightConfig, seconds: float) -> dict[str, Any]:
    """Tracking figures of a flight for JSON, SI units; None for a number that is not finite.

    flight: its settings; missed_share is the part of the whole duration that a lost flight did not last.
    seconds: processor time.
    """
    document: dict[str, Any] = {"trajectory": trajectory, "duration": (log.samples - 1) * log.step}
    for name, number in FLIGHT_NUMBERS.items():
        value = number(log)
        document[name] = value if math.isfinite(value) else None
    document["saturation"] = saturation(log, flight)
    document["ground_touched"] = bool(log.ground_touched)
    document["qp_failures"] = log.qp_failures
    document["completed"] = log.completed
    document["missed_share"] = 0.0
    if not document["completed"]:
        document["missed_share"] = max(1.0 - (log.failure_time or 0.0) / flight.duration_s, SHORTEST_MISS)
        document["failure_time"] = log.failure_time
        document["failure_reason"] = log.failure_reason
    document["seconds"] = seconds
    return document


def objective_parts(log: dyn.FlightLog, family: str, config: StudyConfig) -> dict[str, float]:
    """What the members of an objective family are made of: momenta, and each joint group that counts."""
    parts = getattr(log, f"{family}_parts")
    groups = [group.name for group in config.flown.joint_groups if group.velocity_weight > 0]
    named = {
        "linear_momentum": parts.linear_momentum,
        "angular_momentum": parts.angular_momentum,
        **dict(zip(groups, parts.joint_velocity, strict=True)),
    }
    return {name: value for name, value in named.items() if math.isfinite(value)}
