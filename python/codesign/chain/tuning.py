"""Gains for a study's robot: proposed from mass, inertia and bandwidths, and tried in flights."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np

from codesign import dynamics as dyn
from codesign.chain import chain
from codesign.chain.documents import flight_document, objective_families
from codesign.chain.flight import find_trajectory, flight_settings, joint_names, refusals
from codesign.chain.judge import loss
from codesign.errors import StudyError
from codesign.study.flight_config import GainsConfig
from codesign.study.gains import AttitudeGains, LinearGains, attitude_gains, linear_gains

if TYPE_CHECKING:
    from codesign.problem.design_space import Design
    from codesign.study.study import StudyData

POSITION_FREQUENCIES = (0.8, 1.2, 2.0, 3.5)  # rad/s
ATTITUDE_POLES = (5.0, 10.0, 20.0, 40.0)  # rad/s
STEPS_PER_POLE = 5.0  # control steps in 1/pole at least: a faster pole than that is no longer the law's
CALM = 0.3  # mean thrust rate over its limit up to which gains are recommended
AT_LIMIT = 0.02  # share of samples with a thrust at its end up to which they are


@dataclass(frozen=True, slots=True)
class Trial:
    """Gains and the flight that they gave.

    position, attitude: bandwidths that were asked for [rad/s]; None: the study's own gains. poles: (3,) of the position
    and of the attitude about the axis of the mean moment of inertia, the slowest first [1/s]. flight: its document.
    """

    position: float | None
    attitude: float | None
    gains: GainsConfig
    poles: dict[str, list[complex]]
    flight: dict[str, Any]
    momentum: float | None

    @property
    def completed(self) -> bool:
        """Whether the flight lasted."""
        return bool(self.flight["completed"])

    @property
    def calm(self) -> bool:
        """Whether jets were far from their limits."""
        shares = self.flight["saturation"]
        at_end = max(shares["thrust_at_most"], shares["thrust_at_least"])
        return bool(shares["thrust_rate_share"] <= CALM and at_end <= AT_LIMIT)

    @property
    def outcome(self) -> str:
        """completed, or how the flight was lost."""
        return "completed" if self.completed else loss(self.flight)


def tune(study: StudyData, design: Design, trajectory: str | None = None) -> list[Trial]:
    """Flies the study's own gains, then proposed ones of several bandwidths; on its trajectory unless one is named.

    Raises: StudyError: the study has no flight, or its controller no gains; GeometryError: the parts of the design
    cannot be built.
    """
    config = study.configured(design)
    flight = config.flown
    if flight.gains is None:
        raise StudyError(f"{study.path}: flight.controller {flight.controller!r} has no gains to tune")
    model = dyn.load_urdf(chain.build_robot(study, design).to_text(), joints=joint_names(flight))
    name = trajectory or flight.trajectory
    flown = find_trajectory(config, name)
    start = flight_settings(flight, flown)
    inertia = mean_inertia(model, start)
    candidates: list[tuple[float | None, float | None, GainsConfig]] = [(None, None, flight.gains)]
    candidates += proposals(flight.gains, inertia, flight.step_s)
    trials = []
    for position, attitude, gains in candidates:
        tried = msgspec.structs.replace(flight, gains=gains)
        began = time.process_time()
        with refusals(study.path):
            log = dyn.simulate_flight(model, flight_settings(tried, flown))
        document = flight_document(name, [log], tried, time.process_time() - began)
        momentum = objective_families([log])["rms"].get("momentum")
        trials.append(Trial(position, attitude, gains, poles(gains, inertia), document, momentum))
    return trials


def recommended(trials: list[Trial]) -> Trial | None:
    """Of the completed flights the one with the smallest momentum error, calm ones first; None if all were lost."""
    completed = [trial for trial in trials if trial.completed and trial.momentum is not None]
    return min(completed, key=lambda trial: (not trial.calm, trial.momentum), default=None)


def mean_inertia(model: dyn.Model, settings: dyn.FlightSettings) -> float:
    """Geometric mean of the principal moments of inertia at the start posture [kg m²]."""
    locked = dyn.locked_inertia(model, settings.base_pose, settings.initial_joints)[-3:, -3:]
    return float(np.exp(np.log(np.linalg.eigvalsh(locked)).mean()))


def proposals(own: GainsConfig, inertia: float, step: float) -> list[tuple[float, float, GainsConfig]]:
    """Bandwidths of position and attitude [rad/s], and their gains; joints keep the study's own."""
    found = []
    for attitude in ATTITUDE_POLES:
        if attitude * step * STEPS_PER_POLE > 1.0:
            continue
        turning = attitude_gains(inertia, attitude)
        for position in POSITION_FREQUENCIES:
            moving = linear_gains(position)
            gains = msgspec.structs.replace(
                own,
                linear_proportional=rounded(moving.proportional),
                linear_derivative=rounded(moving.derivative),
                linear_momentum=rounded(moving.momentum),
                attitude_proportional=rounded(turning.proportional),
                attitude_derivative=rounded(turning.derivative),
            )
            found.append((position, attitude, gains))
    return found


def poles(gains: GainsConfig, inertia: float) -> dict[str, list[complex]]:
    """Of position and attitude, the slowest first [1/s]."""
    position = LinearGains(gains.linear_proportional, gains.linear_derivative, gains.linear_momentum).poles
    attitude = AttitudeGains(gains.attitude_proportional, gains.attitude_derivative).poles(inertia)
    return {name: sorted(roots, key=abs) for name, roots in (("position", position), ("attitude", attitude))}


def rounded(value: float) -> float:
    """To four digits, as it is printed, so that what is flown is what can be copied."""
    return float(f"{value:.4g}")
