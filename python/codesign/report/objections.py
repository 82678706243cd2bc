"""What speaks against building a design, whatever its objectives: it does not fly, collides, or is not settled."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from codesign.problem.evaluation import Evaluation
from codesign.problem.quantities import words
from codesign.report.tolerances import MadeDesign
from codesign.units import MILLIMETER

UNSETTLED = ("have a stress that is not settled", "keep the safety factor by less than its error")
Limits = Mapping[str, tuple[str, float]]  # constraint -> (">=" or "<=", bound in SI units)


@dataclass(frozen=True, slots=True)
class Objection:
    """A reason not to build a design.

    kind: designs that fail alike, in words. text: with this design's numbers. final: nothing but another design helps;
    otherwise a closer analysis may lift it.
    """

    kind: str
    text: str
    final: bool


def objections(evaluation: Evaluation, limits: Limits, made: MadeDesign | None = None) -> tuple[Objection, ...]:
    """Everything that speaks against a design, the final ones first. made: its samples within the tolerances."""
    found = []
    if made is not None and not made.robust:
        lost, reason = made.samples - made.feasible, f" ({made.reasons[0]})" if made.reasons else ""
        text = f"{lost} of {made.samples} samples within the tolerances are not feasible{reason}"
        found.append(Objection("are made in tolerance but not feasible too often", text, True))
    if evaluation.status != "feasible":
        reason = evaluation.reason or "a constraint is violated"
        found.append(Objection(f"are {evaluation.status}", f"it is {evaluation.status}: {reason}", True))
    found += [
        o for o in (_overlap(evaluation), _blast(evaluation), *_parts(evaluation, limits), _control(evaluation)) if o
    ]
    return tuple(sorted(found, key=lambda o: not o.final))


def _overlap(evaluation: Evaluation) -> Objection | None:
    gap = evaluation.constraints.get("body_clearance")
    if gap is None or gap >= 0.0:
        return None
    nearest = _nearest(evaluation, "bodies")
    pair = f" ({' and '.join(words(link).lower() for link in nearest['links'])})" if nearest else ""
    return Objection("overlap bodies of the robot", f"its bodies overlap by {_mm(-gap)}{pair}", True)


def _blast(evaluation: Evaluation) -> Objection | None:
    gap = evaluation.constraints.get("plume_clearance")
    if gap is None or gap >= 0.0:
        return None
    nearest = _nearest(evaluation, "plumes")
    hit = f" ({words(nearest['jet']).lower()} on {words(nearest['link']).lower()})" if nearest else ""
    return Objection("blow a plume on the robot", f"a plume reaches {_mm(-gap)} deep into the robot{hit}", True)


def _parts(evaluation: Evaluation, limits: Limits) -> list[Objection]:
    """Parts whose stress is not settled, or whose safety factor keeps its limit only by less than its error."""
    found = []
    for name, part in evaluation.parts.items():
        least = least_factor(name, part, limits)
        factor, peak, error = (part.get(key) for key in ("safety_factor", "peak_stress", "stress_error"))
        share = error / peak if error and peak else 0.0
        spelled, estimate = words(name).lower(), f"{100 * share:.1f}\u202f%"
        if part.get("tolerance_reached") is False:
            text = f"the stress of the {spelled} is not settled: its error is estimated at {estimate}"
            found.append(Objection(UNSETTLED[0], text, False))
        if factor and least and factor >= least > factor / (1.0 + share):
            text = f"the safety factor {factor:.1f} of the {spelled} keeps its limit {least:g} by less than its error"
            found.append(Objection(UNSETTLED[1], text, False))
    return found


def singular(kind: str) -> str:
    """An objection's kind said of one design: `have a stress …` -> `has a stress …`."""
    verb, _, rest = kind.partition(" ")
    return f"{ {'have': 'has', 'are': 'is'}.get(verb, verb + 's') } {rest}"


def least_factor(name: str, part: Mapping[str, Any], limits: Limits) -> float | None:
    """Safety factor that is asked of a part: of the load case that governs it, or of all."""
    asked = limits.get(f"parts.{name}.cases.{part.get('load_case')}.safety_factor") or limits.get("safety_factor")
    return None if asked is None else asked[1]


def _control(evaluation: Evaluation) -> Objection | None:
    steps = evaluation.constraints.get("qp_failures")
    if evaluation.status != "feasible" or not steps:
        return None
    return Objection(
        "have control steps without a solution", f"the controller found no solution in {steps:g} steps", False
    )


def _nearest(evaluation: Evaluation, kind: str) -> Mapping[str, Any] | None:
    """The pair with the smallest clearance, if the evaluation kept it."""
    pairs = (evaluation.flight.get("interference") or {}).get(kind) or []
    return min(pairs, key=lambda pair: pair["clearance"], default=None)


def _mm(length: float) -> str:
    return f"{length / MILLIMETER:.1f}\u202fmm"
