"""Designs of a run under another study of the same variables: other loads, another flight, as a run of its own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Unpack

from codesign.errors import StudyError
from codesign.followup.validation import select
from codesign.report.reading import read_report_data, study_of
from codesign.search.optimization import Resources, StudyLike, evaluate_designs, load_problem
from codesign.storage.runs import Run

DEFAULT_DESIGNS = ("front",)


@dataclass(frozen=True, slots=True)
class Extremes:
    """A constraint over several designs. least, most: its values [SI]; margin: the smallest, of design `tightest`."""

    key: str
    least: float
    most: float
    margin: float
    tightest: int  # the design's number in the run


def evaluate_under(
    study: StudyLike,
    run_directory: str | Path,
    designs: Sequence[str] = DEFAULT_DESIGNS,
    *,
    out: str | Path,
    **resources: Unpack[Resources],
) -> Run:
    """Evaluates chosen designs of a run under another study; a new run in `out`, kept and resumable like any.

    Args:
        study: with the variables of the run's study.
        designs: `recommended`, `best`, `front`, `spread:N` or a design's number, as in `validate`.
        resources: see Resources.
    Raises: StudyError (other variables), DesignError (no such design), StoreError (no run, or `out` exists).
    """
    other = load_problem(study)
    run = read_report_data(Path(run_directory), study_of(Path(run_directory)))
    chosen = list(select(run, designs).values())
    for design in chosen:
        if set(design) != set(other.space.names):
            raise StudyError(
                f"{other.name}: its variables are {', '.join(other.space.names)}, those of {run_directory} "
                f"{', '.join(design)}: its designs are none of this study"
            )
    return evaluate_designs(other, chosen, out=out, **resources)


def extremes(run: Run) -> list[Extremes]:
    """Each constraint over the designs of a run that have its number, in the order of the study."""
    numbered = {record.number: record.evaluation for record in run.search_records if record.number is not None}
    found = []
    for key in dict.fromkeys(key for evaluation in numbered.values() for key in evaluation.constraints):
        margins = {number: each.margins[key] for number, each in numbered.items() if key in each.margins}
        if margins:
            values = [numbered[number].constraints[key] for number in margins]
            tightest = min(margins, key=lambda number: margins[number])
            found.append(Extremes(key, min(values), max(values), margins[tightest], tightest))
    return found
