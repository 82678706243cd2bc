"""What speaks against building a design, whatever its objectives: it does not fly, collides, or is not settled."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from codesign.problem.evaluation import Evaluation
from codesign.problem.quantities import words
from codesign.report.tolerances import MadeDesign
from codesign.units import MILLIMETER

UNSETTLED = (
    "have a stress that is not settled",
    "keep the safety factor by less than its error",
)  # kinds that a finer mesh may lift
# Times its estimated error: a safety factor that keeps its limit even then is settled, whatever the error.
COMFORT = 2.0
TOO_WEAK = "miss the limit of the safety factor on a finer mesh"  # a kind that a finer mesh brings
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


def objections(
    evaluation: Evaluation, limits: Limits, made: MadeDesign | None = None, tolerance: float | None = None
) -> tuple[Objection, ...]:
    """Everything that speaks against a design, the final ones first.

    made: its samples within the tolerances. tolerance: relative error of the stress that the study asks for, None if it
    is not known.
    """
    found = []
    if made is not None and not made.robust:
        lost, reason = made.samples - made.feasible, f" ({made.reasons[0]})" if made.reasons else ""
        text = f"{lost} of {made.samples} samples within the tolerances are not feasible{reason}"
        found.append(Objection("are made in tolerance but not feasible too often", text, True))
    if evaluation.status != "feasible":
        reason = evaluation.reason or "a constraint is violated"
        found.append(Objection(f"are {evaluation.status}", f"it is {evaluation.status}: {reason}", True))
    found += [
        o
        for o in (
            _overlap(evaluation),
            _blast(evaluation),
            *_parts(evaluation, limits, tolerance),
            _control(evaluation),
        )
        if o
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


def _parts(evaluation: Evaluation, limits: Limits, tolerance: float | None) -> list[Objection]:
    """Parts of a feasible design whose strength is not settled, each with its worst load case."""
    found: list[Objection] = []
    if evaluation.status != "feasible":
        return found
    for name, part in evaluation.parts.items():
        cases = part.get("cases") or {part.get("load_case", ""): part}
        against = [each for case in cases if (each := _strength(name, part, case, limits, tolerance)) is not None]
        found += sorted(against, key=lambda objection: not objection.final)[:1]
    return found


def _strength(
    name: str, part: Mapping[str, Any], case: str, limits: Limits, tolerance: float | None
) -> Objection | None:
    """What the error of a load case's stress says against a part.

    The safety factor is judged as an interval: where it keeps its limit even less COMFORT times its estimated error,
    the error does not matter, however large; where no limit is set, it must be within the tolerance. A confirmed case
    is settled if its change by the last refinement is, too; the larger of both counts.
    """
    numbers = part.get("cases", {}).get(case, part)
    factor, share, least = numbers.get("safety_factor"), error_share(numbers), least_factor(name, case, limits)
    of = f"{words(name).lower()}" + (f" in load case {words(case).lower()}" if len(part.get("cases", {})) > 1 else "")
    if factor is not None and least is not None and share is not None:
        if factor < least:
            text = f"a finer mesh gives the {of} a safety factor of {factor:.3g}, below its limit {least:g}"
            return Objection(TOO_WEAK, text, True)
        if least > factor / (1.0 + share):
            text = f"the safety factor {factor:.3g} of the {of} keeps its limit {least:g} by less than its error"
            return Objection(UNSETTLED[1], f"{text}, {_percent(share)}", False)
    change = numbers.get("change") or 0.0
    moved = f", and the last refinement moved it by {_percent(change)}" if change > (tolerance or 0.0) else ""
    asked = (f" (tolerance {_percent(tolerance)})" if tolerance is not None else "") + moved
    on = " on meshes refined at the peak" if part.get("confirmed") else ""
    told = f"the stress of the {of} is not settled: its error{on} is estimated at {_percent(share or 0.0)}{asked}"
    if numbers.get("peak_resolved") is False:
        return Objection(UNSETTLED[0], f"{told}, too much to tell anything", False)
    governs = case == part.get("load_case", case)
    loose = not numbers.get("settled", not governs or part.get("tolerance_reached") is not False)
    if not loose and (tolerance is None or share is None or share <= tolerance):
        return None
    if factor is None or least is None:
        return Objection(UNSETTLED[0], told, False)
    lowest = factor / (1.0 + COMFORT * max(share or 0.0, change))
    if lowest >= least:
        return None
    twice = "twice the larger of both" if moved else "twice that"
    text = f"{told}, and the safety factor {factor:.3g} less {twice}, {lowest:.3g}, misses its limit {least:g}"
    return Objection(UNSETTLED[0], text, False)


def error_share(numbers: Mapping[str, Any]) -> float | None:
    """Estimated error of a peak stress relative to it; None where there is none."""
    peak, error = numbers.get("peak_stress"), numbers.get("stress_error")
    return error / peak if peak and error is not None else None


def _percent(share: float) -> str:
    return f"{100 * share:.3g}\u202f%"


def singular(kind: str) -> str:
    """An objection's kind said of one design: `have a stress …` -> `has a stress …`."""
    verb, _, rest = kind.partition(" ")
    return f"{ {'have': 'has', 'are': 'is', 'miss': 'misses'}.get(verb, verb + 's') } {rest}"


def least_factor(name: str, case: str, limits: Limits) -> float | None:
    """Safety factor that is asked of a load case of a part: the largest of the limits that mean it."""
    return _least(f"parts.{name}.cases.{case}.safety_factor", name, "safety_factor", limits)


def least_frequency(name: str, limits: Limits) -> float | None:
    """First natural frequency [Hz] that is asked of a part."""
    return _least("", name, "first_frequency", limits)


def _least(own: str, name: str, number: str, limits: Limits) -> float | None:
    keys = (own, f"parts.{name}.{number}", f"min(parts.*.{number})", number)
    return max((limits[key][1] for key in keys if limits.get(key, ("", 0.0))[0] == ">="), default=None)


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
