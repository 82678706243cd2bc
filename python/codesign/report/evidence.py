"""How far a gain over the original can be trusted: what other flights of the same designs say about it."""

from __future__ import annotations

from dataclasses import dataclass

from codesign.report.data import ReportData
from codesign.report.validation import Validation
from codesign.report.words import EQUAL, percent, plural

ENOUGH = 3  # other flights before a gain is called one


@dataclass(frozen=True, slots=True)
class Evidence:
    """sense: "good" or "bad" if all other flights agree on it, else "". text: what they say."""

    sense: str
    text: str


def evidence(run: ReportData, validation: Validation | None, k: int) -> Evidence:
    """What is known of the change of objective `k` from the original to the recommended design."""
    changes = _changes(run, validation, run.objectives[k].key)
    if not changes:
        return Evidence("", "no other flights, no error estimate" if run.flies else "")
    low, high = min(changes), max(changes)
    first, last = sorted(run.objectives[k].sign * change for change in (low, high))
    flights = plural(len(changes), "other flight")
    if len(changes) < ENOUGH or (low <= EQUAL and high >= -EQUAL):
        return Evidence("", f"not certain: {percent(first)} … {percent(last)} in {flights}")
    return Evidence("good" if high < 0 else "bad", f"{percent(first)} … {percent(last)} in {flights}")


def validated(run: ReportData, validation: Validation | None) -> bool:
    """Whether the recommended design was flown on other trajectories or under disturbances."""
    return any(_changes(run, validation, objective.key) for objective in run.objectives)


def _changes(run: ReportData, validation: Validation | None, key: str) -> list[float]:
    if validation is None or run.recommended is None:
        return []
    design = dict(run.entries[run.recommended].evaluation.design)
    role = next((flight.role for flight in validation.flights if flight.design == design), None)
    return [] if role is None else list(validation.change(role, key).values())
