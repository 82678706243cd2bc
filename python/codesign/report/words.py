"""The report in words: what was optimised, what was gained, which design to build and why."""

from __future__ import annotations

from collections.abc import Sequence

from codesign.report.data import ReportData

EQUAL = 5e-4  # relative change that is called none


def number(value: float, digits: int = 4) -> str:
    """`digits` significant digits without exponent, true minus sign."""
    if value != value:
        return "–"
    text = f"{value:.{digits}g}"
    if "e" in text:
        text = f"{value:.0f}" if abs(value) >= 1 else f"{value:.{digits + 3}f}"
    return text.replace("-", "−")


def percent(change: float, digits: int = 1) -> str:
    """A relative change with its sign: `−8.4 %`."""
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
    """What was optimised and what came out of it, in numbers of designs."""
    names = listed([run.label(v).lower() for v in run.variables])
    aims = listed([o.label.lower() for o in run.objectives])
    total = len(run.entries)
    if not total:
        return f"The search varies {names} to lower {aims}. No design has been evaluated yet."
    combinations = 1
    for levels in run.space.levels:
        combinations *= levels
    feasible = run.counts["feasible"]
    if not feasible:
        outcome = "None of them meets every constraint"
    elif total == 1:
        outcome = "It meets every constraint"
    else:
        outcome = (
            f"{'One' if feasible == 1 else f'{feasible:,}'} of them meet{'s' if feasible == 1 else ''} every constraint"
        )
    if len(run.front) > 1:
        outcome += f"; {len(run.front)} are best compromises, which no other design beats in everything"
    evaluated = f"Of {combinations:,} possible designs it evaluated {total:,}."
    return f"The search varied {names} to lower {aims}. {evaluated} {outcome}."


def gained(run: ReportData) -> str:
    """What the recommended design gains over the original."""
    if run.recommended is None:
        return ""
    if run.baseline_vector is None:
        if run.baseline is None:
            return "The study names no original design to compare with."
        return (
            f"The original design gives no objectives to compare with ({run.baseline.reason or run.baseline.status})."
        )
    gain = run.gain(run.recommended)
    assert gain is not None
    lower = [
        f"{o.label.lower()} by {100 * -g:.1f}\u202f%" for o, g in zip(run.objectives, gain, strict=True) if g < -EQUAL
    ]
    higher = [
        f"{o.label.lower()} by {100 * g:.1f}\u202f%" for o, g in zip(run.objectives, gain, strict=True) if g > EQUAL
    ]
    if run.entries[run.recommended].evaluation.design == run.baseline.design if run.baseline else False:
        return "The original design is itself the best compromise found."
    if not lower:
        return "No design found so far improves on the original."
    text = f"Compared with the original, the recommended design lowers {listed(lower)}"
    if higher:
        return f"{text}; it raises {listed(higher)}."
    both = len(run.dominating)
    return f"{text}." + (
        f" {both} of the {len(run.front)} compromises beat the original in every objective." if both > 1 else ""
    )


def why(run: ReportData) -> str:
    """Why the recommended design is recommended."""
    if run.recommended is None:
        return ""
    if len(run.front) == 1:
        return "It is the only feasible design that no other beats."
    kept = " Only designs that are nowhere worse than the original were considered." if run.dominating else ""
    return (
        "It is the knee of the front: of all best compromises, the one closest to having the best value of every "
        f"objective at once.{kept}"
    )


def price(run: ReportData) -> str:
    """What the recommended design gives up against the best found of each objective."""
    if run.recommended is None or len(run.front) < 2:
        return ""
    lost = []
    for k, objective in enumerate(run.objectives):
        best, here = run.values[run.best[objective.key], k], run.values[run.recommended, k]
        if best != 0 and (here - best) / abs(best) > EQUAL:
            lost.append(f"{objective.label.lower()} {100 * (here - best) / abs(best):.1f}\u202f%")
    return (
        f"Its price: {listed(lost)} above the lowest found."
        if lost
        else "It is also the best in every single objective."
    )


def strength(run: ReportData) -> str:
    """How strong the recommended design's weakest part is."""
    if run.recommended is None:
        return ""
    parts = run.entries[run.recommended].evaluation.parts
    factors = {name: part["safety_factor"] for name, part in parts.items() if part.get("safety_factor")}
    if not factors:
        return ""
    weakest = min(factors, key=lambda name: factors[name])
    asked = f" (at least {run.limits['safety_factor'][1]:g} is asked for)" if "safety_factor" in run.limits else ""
    return (
        f"Its weakest part, the {weakest.replace('_', ' ')}, would bear {factors[weakest]:.1f} times its load{asked}."
    )


def caveats(run: ReportData) -> list[str]:
    """What a reader must know before trusting the page."""
    notes = list(run.notes)
    if run.waiting or (run.planned and len(run.entries) < run.planned):
        missing = f" of {run.planned:,} planned" if run.planned else ""
        notes.append(
            f"This run is not finished: {plural(len(run.entries), 'design')}{missing} evaluated so far. "
            "Continue it with codesign resume; everything below holds for what is there."
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
