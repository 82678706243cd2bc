"""The recommended design in words: how it was chosen, what it costs, what speaks against building it."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping
from typing import Any

import numpy as np

from codesign.problem.quantities import words
from codesign.report.data import ReportData
from codesign.report.objections import TOO_WEAK, least_factor, singular
from codesign.report.strength import strength_words
from codesign.report.words import EQUAL, combinations, listed, percent, plural
from codesign.units import MILLIMETER

CLEARLY = 0.1  # logarithm of the product of the objectives: a tenth better in one of them, say
SETTLED = 0.01  # of the front's hypervolume: what the last quarter of a settled search adds at most


def why(run: ReportData) -> str:
    """Why the recommended design is recommended, and how it was chosen."""
    if run.recommended is None:
        return ""
    if len(run.choices) == 1 and len(run.objectives) == 1:
        return "" if passed_over(run) else f"No design that may be built has less: {_best(run, run.recommended)}."
    if len(run.choices) == 1:
        alone = "feasible design" if run.counts["feasible"] == 1 else "design that may be built"
        return f"It is the only {alone} that no other beats. {left_out(run)}".rstrip()
    ranks = [f"design {run.entries[i].id} ({distance:.2f})" for i, distance in run.ranking[1:3]]
    following = f"; next {'is' if len(ranks) == 1 else 'are'} {listed(ranks)}" if ranks else ""
    kept = " Only designs that are nowhere worse than the original were considered." if _guarded(run) else ""
    return (
        f"It is the knee of the {len(run.choices)} best compromises: with every objective scaled to run from 0 (best "
        f"among them) to 1 (worst), it is nearest to 0 in all of them, at a distance of {run.ranking[0][1]:.2f}"
        f"{following}. Other weights of the objectives would choose otherwise.{kept} {left_out(run)}"
    ).rstrip()


def _guarded(run: ReportData) -> bool:
    """Whether the choice was limited to designs that are nowhere worse than the original."""
    vector = run.baseline_vector
    return vector is not None and bool((run.values[run.choices] <= vector).all(axis=1).any())


def left_out(run: ReportData) -> str:
    """How many of the best compromises are no choice, and why."""
    choices = set(run.choices)
    others = [i for i in run.front if i not in choices]
    if not others:
        return ""
    if len(others) == 1:
        against = listed([objection.text for objection in run.objections(others[0])])
        return f"Design {run.entries[others[0]].id}, among the best found, was left out: {against}."
    kinds = Counter(kind for i in others for kind in {objection.kind for objection in run.objections(i)})
    because = listed([f"{number} {kind if number > 1 else singular(kind)}" for kind, number in kinds.most_common()])
    found = plural(len(run.front), "best compromise")
    return f"{len(others)} of the {found} found were left out: {because}."


def passed_over(run: ReportData) -> str:
    """Which designs have less of the only objective than the recommended one, the best first, and why not they."""
    if run.recommended is None or len(run.objectives) != 1:
        return ""
    values = run.values[:, 0]
    better = np.flatnonzero(run.feasible & (values < values[run.recommended]))
    if not len(better):
        return ""
    best = int(better[np.argmin(values[better])])
    against = listed([objection.text for objection in run.objections(best)])
    more = f" So are {len(better) - 1} more that have less than it." if len(better) > 2 else ""
    more = " So is 1 more that has less than it." if len(better) == 2 else more
    return (
        f"Design {run.entries[best].id} has less, {_best(run, best)} instead of {_best(run, run.recommended)}, and is "
        f"passed over: {against}.{more}"
    )


def _best(run: ReportData, position: int) -> str:
    """The only objective of a design, with its unit."""
    (objective,) = run.objectives
    return objective.text(run.entries[position].evaluation.objectives[objective.key], 4)


def price(run: ReportData) -> str:
    """What the recommended design gives up against the best of each objective that can be had."""
    if run.recommended is None or len(run.choices) < 2:
        return ""
    lost: dict[str, list[str]] = {}
    for k, objective in enumerate(run.objectives):
        best, here = run.values[run.choices, k].min(), run.values[run.recommended, k]
        if best != 0 and (here - best) / abs(best) > EQUAL:
            side = "below the highest" if objective.maximized else "above the lowest"
            lost.setdefault(side, []).append(f"{objective.label.lower()} {100 * (here - best) / abs(best):.1f}\u202f%")
    told = "; ".join(f"{listed(names)} {side} among them" for side, names in lost.items())
    return f"Its price: {told}." if lost else "It is also the best in every single objective."


def second_opinion(run: ReportData) -> str:
    """The choice whose objectives have the lowest product, if it trades clearly better than the recommended design.

    The knee weighs the whole range of each objective alike, even one that hardly varies; the product weighs alike what
    changes by the same share.
    """
    values = run.values[run.choices]
    if run.recommended is None or not (values > 0.0).all():
        return ""
    product = np.log(values).sum(axis=1)
    here, other = run.choices.index(run.recommended), int(np.argmin(product))
    if product[here] - product[other] < CLEARLY:
        return ""
    changes = [
        f"{o.label.lower()} {percent(now / before - 1.0)}"
        for o, now, before in zip(run.objectives, values[other], values[here], strict=True)
    ]
    return (
        f"Look at design {run.entries[run.choices[other]].id} too: where equal percentages count alike it is the "
        f"better trade, with {listed(changes)} against the recommended one."
    )


def strength(run: ReportData) -> str:
    """How strong the recommended design's weakest part is: under which load, how held, of what material."""
    if run.recommended is None:
        return ""
    parts = run.as_confirmed(run.entries[run.recommended].evaluation).parts
    factors = {name: factor for name, part in parts.items() if (factor := part.get("safety_factor"))}
    if not factors or not math.isfinite(min(factors.values())):
        return ""
    demanded, described = run.demanded(run.entries[run.recommended].evaluation), run.subject_words.parts
    limits = {name: least_factor(name, parts[name].get("load_case", ""), demanded) for name in factors}
    weakest = min(factors, key=lambda name: factors[name] / (limits[name] or 1.0))
    asked = f" (at least {limits[weakest]:g} is asked for)" if limits[weakest] is not None else ""
    asked += decided(parts[weakest])
    known = described.get(weakest)
    case = f": {known.load}; {known.material}. Other loads and supports were not analyzed" if known else ""
    name = weakest.replace("_", " ")
    return f"Its weakest part, the {name}, yields at {factors[weakest]:.1f} times its load{asked}{case}."


def load_cases(run: ReportData) -> str:
    """The recommended design's parts by load case, each with its limit and its error; frequencies, places."""
    if run.recommended is None:
        return ""
    parts = run.as_confirmed(run.entries[run.recommended].evaluation).parts
    demanded, described = run.demanded(run.entries[run.recommended].evaluation), run.subject_words.parts
    told = [text for name in parts if (known := described.get(name)) is not None
            for text in strength_words(name, parts[name], demanded, known.carried)]  # fmt: skip
    if not told:
        return ""
    asked = run.stress_tolerance
    errors = f" Errors are estimates; {100 * asked:g}\u202f% is asked for ([fem] tolerance)." if asked else ""
    return f"{'. '.join(told)}.{errors}"


def decided(part: Mapping[str, Any]) -> str:
    """Which of several load cases decides a part's strength, when, where, and how the flight fatigues it."""
    cases = part.get("cases", {})
    if len(cases) < 2:
        return ""
    text = f"; of its {len(cases)} load cases {words(part['load_case']).lower()} decides"
    if "time" in part:
        text += f", at {part['time']:.2f}\u202fs on {words(part['link']).lower()}"
    x, y, z = (value / MILLIMETER for value in part["peak_position"])
    text += f", at ({x:.1f}, {y:.1f}, {z:.1f})\u202fmm of the part"
    flights = [case["fatigue"]["flights"] for case in cases.values() if case.get("fatigue", {}).get("flights")]
    return text + (f"; by its fatigue it stands {min(flights):.1g} such flights" if flights else "")


def as_made(run: ReportData) -> str:
    """How the recommended design scatters within the tolerances, if it was sampled."""
    if run.recommended is None or run.tolerances is None:
        return ""
    found = run.tolerances.of(run.entries[run.recommended].evaluation.design)
    if found is None:
        return ""
    told = [
        f"safety factor of the {words(name.split('.')[1]).lower()} {spread.low:.1f} to {spread.high:.1f}"
        for name, spread in found.numbers.items()
        if name.endswith(".safety_factor")
    ]
    labels = {objective.key: objective.label.lower() for objective in run.objectives}
    for name, spread in found.numbers.items():
        if name in labels and spread.median:
            low, high = sorted((spread.low / spread.median, spread.high / spread.median))
            told.append(f"{labels[name]} {percent(low - 1.0)} to {percent(high - 1.0)}")
    feasible = f"{found.feasible} are feasible; nine of ten have {listed(told)}"
    return f"Made {found.samples} times within its tolerances, {feasible}."


def unsettled_search(run: ReportData) -> str:
    """Why better designs than the recommended one are likely; "" if the search has settled."""
    grown, late = run.late_growth
    if grown < SETTLED or len(run.entries) >= combinations(run):
        return ""
    designs, front = plural(len(run.entries), "design"), plural(len(run.front), "best compromise")
    return (
        f"The search has not settled: the last quarter of its {designs} found {late} of the {front} and "
        f"{100 * grown:.0f}\u202f% of the front's volume. Better designs are likely."
    )


def nothing_to_build(run: ReportData) -> str:
    """Why no design is recommended although there are feasible ones."""
    kinds = {objection.kind for i in run.front for objection in run.objections(i) if objection.final}
    weak = (
        "Ask for larger safety factors or finer meshes ([fem] accuracy, edge_length_mm)" if kinds & {TOO_WEAK} else ""
    )
    near = "Demand clearances (body_clearance_min_mm, plume_clearance_min_mm under [constraints])"
    todo = [text for text in (near if kinds - {TOO_WEAK} else "", weak) if text]
    return f"{left_out(run)} {'. '.join(todo)} and search again."


def clearances(run: ReportData) -> str:
    """How far clearances can be trusted, where they were measured."""
    if not any(entry.evaluation.flight for entry in run.entries):
        return ""
    keys = {key for entry in run.entries for key in entry.evaluation.constraints}
    if "body_clearance" in keys:
        return (
            "Clearances are those of simple shapes around the bodies, to about a centimeter and on the safe side, over "
            "the postures flown."
        )
    return ""
