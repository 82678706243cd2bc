"""Flights as JSON: objective families and tracking figures. Several are one flight under paired disturbances."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from operator import attrgetter
from typing import Any

import numpy as np

from codesign import dynamics as dyn
from codesign.chain.saturation import saturation
from codesign.problem.quantities import FAMILY
from codesign.study.config import StudyConfig
from codesign.study.flight_config import FlightConfig

# Numbers of a flight in its document, SI units, None where they are not finite: name -> function of the log with its
# histories. An objective or a constraint names them by path, `flight.max_torque`. Of several flights, the worst.
FLIGHT_NUMBERS: dict[str, Callable[[dyn.FlightLog], float]] = {
    name: attrgetter(name)
    for name in (
        "max_com_error",
        "max_attitude_error",
        "min_thrust",
        "max_thrust",
        "max_torque",
        "min_clearance",
        "fuel_burnt",
    )
} | {
    "tracking": attrgetter("measures.com_error_rms"),
    "tracking_attitude": attrgetter("measures.attitude_error_rms"),
    "tracking_pose": attrgetter("measures.pose_error_rms"),
    "final_com_error": attrgetter("measures.final_com_error"),
    "mechanical_energy": attrgetter("measures.mechanical_energy"),
    "positive_energy": attrgetter("measures.positive_energy"),
    "fuel": lambda log: log.measures.fuel or math.nan,  # a study that does not say what its jets burn has none
    "thrust_impulse": attrgetter("measures.thrust_impulse"),
    "hover_margin": attrgetter("measures.hover_margin"),
}
SMALLEST_IS_WORST = ("min_thrust", "min_clearance", "hover_margin")
JOINT_PEAKS = ("peak_torque", "peak_speed", "peak_power")  # of every joint [N m, rad/s, W]
SHORTEST_MISS = 1e-6  # of a flight that was lost in its last sample


def objective_families(logs: Sequence[dyn.FlightLog]) -> dict[str, dict[str, float]]:
    """All objective families, means over the flights; a number that is not finite is left out."""
    families = {}
    for family in ("rms", "script", "paper"):
        named = {name: math.fsum(getattr(getattr(log, family), name) for log in logs) / len(logs) for name in FAMILY}
        families[family] = {name: value for name, value in named.items() if math.isfinite(value)}
    return families


def flight_document(
    trajectory: str,
    logs: Sequence[dyn.FlightLog],
    flight: FlightConfig,
    seconds: float,
    seeds: Sequence[int] = (),
    wanted: float | None = None,
) -> dict[str, Any]:
    """Tracking figures for JSON, SI units; None for a number that is not finite.

    Args:
        logs: the flight, once for every seed of its disturbances: each number is the worst of them, saturation that of
            the first lost one, if any.
        flight: its settings; missed_share is the part of the whole duration that a lost flight did not last.
        seconds: processor time.   seeds: of the logs, where there are several.
        wanted: duration of the whole flight [s], where the trajectory has its own.
    """
    whole = wanted or flight.duration_s
    lasted = [whole if log.completed else log.failure_time or 0.0 for log in logs]
    first = logs[lasted.index(min(lasted))]  # that was lost, if any
    document: dict[str, Any] = {"trajectory": trajectory, "duration": max(first.samples - 1, 0) * first.step}
    for name, number in FLIGHT_NUMBERS.items():
        worst = min if name in SMALLEST_IS_WORST else max
        values = [number(log) for log in logs]
        document[name] = worst(values) if all(map(math.isfinite, values)) else None
    document["saturation"] = saturation(first, flight)
    document["joints"] = joint_peaks(logs, [joint for group in flight.joint_groups for joint in group.joints])
    document["ground_touched"] = any(log.ground_touched for log in logs)
    document["qp_failures"] = sum(log.qp_failures for log in logs)
    document["completed"] = first.completed
    document["missed_share"] = 0.0
    if not document["completed"]:
        document["missed_share"] = max(1.0 - (first.failure_time or 0.0) / whole, SHORTEST_MISS)
        document["failure_time"] = first.failure_time
        document["failure_reason"] = first.failure_reason
    if len(logs) > 1:
        document["seeds"] = [_seed_document(seed, log) for seed, log in zip(seeds, logs, strict=True)]
    document["seconds"] = seconds
    return document


def _seed_document(seed: int, log: dyn.FlightLog) -> dict[str, Any]:
    """What one of several flights gave."""
    return {
        "seed": seed,
        "completed": log.completed,
        "max_thrust": log.max_thrust,
        "max_attitude_error": log.max_attitude_error,
        "rms": objective_families([log])["rms"],
    }


def joint_peaks(logs: Sequence[dyn.FlightLog], joints: Sequence[str]) -> dict[str, dict[str, float]]:
    """Joint -> its largest torque [N m], speed [rad/s] and power [W]; joints: names in the logs' order."""
    peaks = {name: np.max([getattr(log.measures, name) for log in logs], axis=0) for name in JOINT_PEAKS}
    return {joint: {name: float(values[i]) for name, values in peaks.items()} for i, joint in enumerate(joints)}


def objective_parts(log: dyn.FlightLog, family: str, config: StudyConfig) -> dict[str, float]:
    """What the members of an objective family are made of: momenta, and each joint group that counts."""
    if not log.samples:
        return {}
    parts = getattr(log, f"{family}_parts")
    groups = [group.name for group in config.flown.joint_groups if group.velocity_weight > 0]
    named = {
        "linear_momentum": parts.linear_momentum,
        "angular_momentum": parts.angular_momentum,
        **dict(zip(groups, parts.joint_velocity, strict=True)),
    }
    return {name: value for name, value in named.items() if math.isfinite(value)}
