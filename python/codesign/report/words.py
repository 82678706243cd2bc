"""The report in words: what was optimized, what was gained, which design to build and why."""

from __future__ import annotations

import math
import shlex
from collections.abc import Sequence

import numpy as np

from codesign.problem.quantities import Quantity
from codesign.report.data import ReportData

EQUAL = 5e-4  # relative change that is called none


def number(value: float, digits: int = 4) -> str:
    """`digits` significant digits without exponent, true minus sign."""
    if not math.isfinite(value):
        return "–"
    text = f"{value:.{digits}g}"
    if "e" in text:
        text = f"{value:.0f}" if abs(value) >= 1 else f"{value:.{digits + 3}f}"
    return text.replace("-", "−")


def percent(change: float, digits: int = 1) -> str:
    """A relative change with its sign: `−8.4 %`."""
    if not math.isfinite(change):
        return "–"
    sign = "+" if change > 0 else "−" if change < 0 else "±"
    return f"{sign}{abs(100 * change):.{digits}f}\u202f%"


def listed(items: Sequence[str]) -> str:
    """`a, b and c`."""
    if len(items) < 2:
        return "".join(items)
    return f"{', '.join(items[:-1])} and {items[-1]}"


def plural(count: int, one: str, many: str | None = None) -> str:
    """`1 design`, `3 designs`."""
    return f"{count} {one if count == 1 else many or one + 's'}"


def searched(run: ReportData) -> str:
    """What was optimized and what came out of it, in numbers of designs."""
    names = listed([run.label(v).lower() for v in run.variables])
    aims = aims_in_words(run)
    total = len(run.entries)
    if not total:
        return f"The search varies {names} to {aims}. No design has been evaluated yet."
    feasible = run.counts["feasible"]
    if not feasible:
        outcome = "None of them meets every constraint"
        if run.least_infeasible is not None:
            closest = run.entries[run.least_infeasible]
            outcome += f"; design {closest.id} comes closest: {closest.evaluation.reason}"
    elif total == 1:
        outcome = "It meets every constraint"
    else:
        outcome = (
            f"{'One' if feasible == 1 else f'{feasible:,}'} of them meet{'s' if feasible == 1 else ''} every constraint"
        )
    if len(run.front) > 1:
        outcome += f"; {len(run.front)} are best compromises, which no other design beats in everything"
    evaluated = f"Of {combinations(run):,} possible designs it evaluated {total:,}."
    return f"The search varied {names} to {aims}. {evaluated} {outcome}."


def aims_in_words(run: ReportData) -> str:
    """`lower mass and power, and raise stiffness`."""
    lowered = listed([o.label.lower() for o in run.objectives if not o.maximized])
    raised = listed([o.label.lower() for o in run.objectives if o.maximized])
    return ", and ".join(text for text in (lowered and f"lower {lowered}", raised and f"raise {raised}") if text)


def better_side(run: ReportData) -> str:
    """Which end of an objective's axis is the better one: `Lower is better, of stiffness higher`."""
    raised = [o.label.lower() for o in run.objectives if o.maximized]
    if len(raised) == len(run.objectives):
        return "Higher is better"
    return "Lower is better" + (f", of {listed(raised)} higher" if raised else "")


def combinations(run: ReportData) -> int:
    """Number of designs on the grid."""
    return math.prod(run.space.levels)


def gained(run: ReportData) -> str:
    """What the recommended design gains over the original."""
    if run.recommended is None:
        return ""
    if run.baseline_vector is None:
        if run.baseline is None:
            return run.baseline_missing
        return (
            f"The original design gives no objectives to compare with ({run.baseline.reason or run.baseline.status})."
        )
    gain = run.gain(run.recommended)
    assert gain is not None
    better = _changes([(o, g) for o, g in zip(run.objectives, gain, strict=True) if g < -EQUAL])
    worse = _changes([(o, g) for o, g in zip(run.objectives, gain, strict=True) if EQUAL < g < np.inf])
    if run.entries[run.recommended].evaluation.design == run.baseline.design if run.baseline else False:
        return "The original design is itself the best compromise found."
    if not better:
        return "No design found so far improves on the original."
    text = f"Compared with the original, the recommended design {better}"
    if worse:
        return f"{text}; it {worse}."
    both = len(run.dominating)
    return f"{text}." + (
        f" {both} of the {len(run.front)} compromises beat the original in every objective." if both > 1 else ""
    )


def _changes(changes: Sequence[tuple[Quantity, float]]) -> str:
    """`lowers mass by 3.0 % and raises stiffness by 2.0 %` of changes of minimized numbers."""
    told = []
    for verb, sense in (("lowers", -1.0), ("raises", 1.0)):
        names = [f"{o.label.lower()} by {100 * abs(g):.1f}\u202f%" for o, g in changes if o.sign * g * sense > 0]
        if names:
            told.append(f"{verb} {listed(names)}")
    return " and ".join(told)


def caveats(run: ReportData) -> list[str]:
    """What a reader must know before trusting the page."""
    notes = list(run.notes) + [known.warning for known in run.subject_words.parts.values() if known.warning]
    if run.stopped is not None:
        command = f" codesign resume {shlex.quote(str(run.directory))} makes the others." if not run.notes else ""
        notes.append(
            f"This search ended before its budget: {len(run.entries):,} of {run.planned:,} designs were evaluated "
            f"({run.stopped}).{command}"
        )
    elif run.waiting or (run.planned and len(run.entries) < run.planned):
        missing = f" of {run.planned:,} planned" if run.planned else ""
        notes.append(
            f"This run is not finished: {plural(len(run.entries), 'design')}{missing} evaluated so far. "
            f"Continue it with codesign resume {shlex.quote(str(run.directory))}; everything below holds for what is "
            "there."
        )
    if run.entries and not run.counts["feasible"]:
        notes.append(
            "No design meets every constraint, so there is no front and nothing to recommend. The reasons are below."
        )
    elif run.counts["feasible"] == 1:
        notes.append("Only one feasible design was found: there is no trade-off to show yet.")
    if run.baseline is not None and run.baseline.status != "feasible":
        because = run.baseline.reason or "a constraint is violated"
        notes.append(f"The original design is {run.baseline.status} in this study: {because}.")
    return notes
