"""The judge: from the numbers of an evaluation to objectives, constraints and a verdict. Computes no physics."""

from __future__ import annotations

import math
import traceback
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from codesign.chain.saturation import explanation
from codesign.errors import StudyError
from codesign.problem.evaluation import Status
from codesign.problem.quantities import FAMILY, MINUS, Quantity, quantity, read
from codesign.study.config import StudyConfig
from codesign.units import MILLIMETER

CLEARANCE_SCALE = 0.01  # m: a clearance this much too small counts as much as a safety factor of zero
LIMITS = "constraints.limits"
MINIMA_KEYS = {
    "safety_factor": "safety_factor_min",
    "first_frequency": "first_frequency_min_hz",
    "buckling_factor": "buckling_factor_min",
}
FLIGHT_MISSED = "flight_missed_share"  # of two lost designs the one that flew longer violates less

Functions = Mapping[str, Callable[[Mapping[str, Any]], float]]
Document = Mapping[str, Any]  # design, parts, flight, objective_families: as in `Evaluation`


@dataclass(frozen=True, slots=True)
class Limit:
    """A bound [SI] on a number of the evaluation.

    scale: a miss by this much is a violation of 1. origin: the key of the study that asks for it.
    """

    quantity: Quantity
    least: float | None = None
    most: float | None = None
    scale: float = 1.0
    origin: str = ""

    def margin(self, value: float | None) -> float:
        """By how much of the scale the bound is kept; below 0: missed. None: a number without bound (no buckling)."""
        if self.least is not None:
            return math.inf if value is None else (value - self.least) / self.scale
        if self.most is None:
            return math.inf
        if value is None:
            raise StudyError(f"constraints.limits.{self.quantity.key}: the evaluation has no such number")
        return (self.most - value) / self.scale


@dataclass(frozen=True, slots=True)
class Verdict:
    """What an evaluation is worth; fields as in `Evaluation`."""

    status: Status
    reason: str | None
    objectives: dict[str, float] = field(default_factory=dict)
    constraints: dict[str, float] = field(default_factory=dict)
    violations: dict[str, float] = field(default_factory=dict)
    margins: dict[str, float] = field(default_factory=dict)


def judge(
    config: StudyConfig, document: Document, functions: Functions, chosen: Iterable[Limit] | None = None
) -> Verdict:
    """The verdict on the numbers of a design.

    Args:
        config: the study's, as configured by the design. document: design, parts, flight, objective_families.
        functions: the study's own functions of an evaluation by key, `module:function`.
        chosen: limits to judge; None: all of the study's.
    Raises: StudyError: an objective or limit names a number that the evaluation does not have; an own function fails.
    """
    flight = document["flight"]
    lost = bool(flight) and not flight["completed"]  # no flight: parts alone are judged
    constraints: dict[str, float] = {}
    margins: dict[str, float] = {}
    reasons = []
    for limit in limits(config) if chosen is None else chosen:
        value = value_of(document, limit.quantity, functions)
        if value is not None:
            constraints[limit.quantity.key] = value
        if value is None and lost:
            continue
        key, margin = limit.quantity.key, limit.margin(value)
        margins[key] = min(margin, margins.get(key, math.inf))
        if margin < 0.0 and key != FLIGHT_MISSED:
            reasons += misses(document, limit, value)
    if lost:
        reasons.append(loss(flight))
    constraints |= watched(document, constraints)
    feasible = not any(margin < 0.0 for margin in margins.values())
    return Verdict(
        status="feasible" if feasible else "infeasible",
        reason=None if feasible else "; ".join(reasons),
        objectives={} if lost else objectives(config, document, functions),
        constraints=constraints,
        violations={key: max(0.0, -margin) for key, margin in margins.items()},
        margins={key: margin for key, margin in margins.items() if math.isfinite(margin)},
    )


def objectives(config: StudyConfig, document: Document, functions: Functions) -> dict[str, float]:
    """The minimized numbers by key. Raises: StudyError."""
    found = {}
    for key in config.objectives.keys:
        sign, name = (-1.0, key[1:]) if key.startswith(MINUS) else (1.0, key)
        if name in FAMILY:
            value = document["objective_families"][config.objectives.family].get(name)
        else:
            value = value_of(document, quantity(name), functions)
        if value is None:
            raise StudyError(f"objective {name!r}: the evaluation has no such number")
        found[key] = sign * value
    return found


def limits(config: StudyConfig) -> Iterator[Limit]:
    """Everything that a study demands: a completed flight if it has one, and what its [constraints] say."""
    asked = config.constraints
    if config.flight is not None:
        yield Limit(quantity(FLIGHT_MISSED), most=0.0, origin="flight")
    for key, least in asked.part_minima.items():
        origin = f"constraints.{MINIMA_KEYS[key]}"
        if key == "safety_factor" and any(case.safety_factor_min for part in config.parts for case in part.load_cases):
            yield from case_limits(config, least)
        else:
            yield Limit(quantity(key), least=least, scale=least, origin=origin)
    if config.interference is not None:
        for key, gap_mm in (
            ("body_clearance", asked.body_clearance_min_mm),
            ("plume_clearance", asked.plume_clearance_min_mm),
        ):
            if gap_mm is not None:
                least, origin = gap_mm * MILLIMETER, f"constraints.{key}_min_mm"
                yield Limit(quantity(key), least=least, scale=CLEARANCE_SCALE, origin=origin)
    for key, bound in asked.limits.items():
        if bound.minimum is not None:
            yield Limit(quantity(key), least=bound.minimum, scale=abs(bound.minimum) or 1.0, origin=LIMITS)
        if bound.maximum is not None:
            yield Limit(quantity(key), most=bound.maximum, scale=abs(bound.maximum) or 1.0, origin=LIMITS)


def case_limits(config: StudyConfig, otherwise: float) -> Iterator[Limit]:
    """A limit for every load case of every part, since some ask for a safety factor of their own."""
    for part in config.parts:
        for case in part.load_cases:
            least = case.safety_factor_min or otherwise
            path = f"parts.{part.name}.cases.{case.name}.safety_factor"
            label = f"{part.name}, load case {case.name}: safety factor"
            own = f"parts.{part.name}.cases[{case.name}].safety_factor_min"
            origin = own if case.safety_factor_min else f"constraints.{MINIMA_KEYS['safety_factor']}"
            yield Limit(Quantity(path, label, path=path), least=least, scale=least, origin=origin)


def value_of(document: Document, wanted: Quantity, functions: Functions) -> float | None:
    """A number of an evaluation [SI], None where it has none. Raises: StudyError: there is no such number."""
    if wanted.key in functions:
        value = _called(wanted.key, functions[wanted.key], document)
        if not math.isfinite(value):
            raise StudyError(f"{wanted.key}: gave {value} for this design")
        return value
    if wanted.key in FAMILY:
        member: float | None = document["objective_families"].get("rms", {}).get(wanted.key)
        return member
    return read(document, wanted.path or wanted.key)


def _called(name: str, function: Callable[[Document], float], document: Document) -> float:
    """What an own function gives. Raises: StudyError: it failed; with the line."""
    try:
        return float(function(document))
    except Exception as error:
        frames = traceback.extract_tb(error.__traceback__)
        place = f" ({Path(frames[-1].filename).name}, line {frames[-1].lineno})" if len(frames) > 1 else ""
        raise StudyError(f"{name}: {type(error).__name__}: {error}{place}") from error


def watched(document: Document, judged: Mapping[str, float]) -> dict[str, float]:
    """Clearances that are measured but not limited."""
    measured = document["flight"].get("interference") or {}
    names = ("body_clearance", "plume_clearance")
    return {name: measured[name] for name in names if name in measured and name not in judged}


def misses(document: Document, limit: Limit, value: float | None) -> list[str]:
    """A missed limit in words; a limit of every part once for each part that misses it."""
    key, label = limit.quantity.key, limit.quantity.label
    if limit.quantity.path == f"min(parts.*.{key})":
        each = {name: part.get(key) for name, part in document["parts"].items()}
        return [
            f"{name}: {_missed(limit, label, number)}"
            for name, number in each.items()
            if number is not None and number < (limit.least or -math.inf)
        ]
    return [_missed(limit, label, value)]


def _missed(limit: Limit, label: str, value: float | None) -> str:
    bound = limit.least if limit.least is not None else limit.most
    side = "below" if limit.least is not None else "above"
    words = label[:1].lower() + label[1:]
    return f"{words} {limit.quantity.text(value or 0.0, 4)} {side} {limit.quantity.text(bound or 0.0, 6)}"


def loss(flight: Mapping[str, Any]) -> str:
    """Why a flight was lost, in words."""
    why = explanation(flight.get("saturation", {}))
    return f"flight lost at {flight['failure_time']:.2f} s: {flight['failure_reason']}" + (f"; {why}" if why else "")
