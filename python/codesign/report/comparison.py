"""Fronts of other runs beside that of a run, and how much of its gain over the original each of them reaches alone."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from codesign.errors import StoreError
from codesign.problem.pareto import Hypervolume, non_dominated
from codesign.report.pareto import Matrix
from codesign.storage.runs import load_run

if TYPE_CHECKING:
    from codesign.report.data import ReportData


@dataclass(frozen=True, slots=True, eq=False)
class ComparedRun:
    """The front of another run. ids: numbers of its designs; values: (n, m) their objectives, as `ReportData.values`.

    evaluated: designs of the whole run.
    """

    name: str
    evaluated: int
    ids: tuple[int, ...]
    values: Matrix


@dataclass(frozen=True, slots=True, eq=False)
class Reached:
    """What a run's front is worth beside the others.

    volume: hypervolume of it and the original in the box of all. share: its gain over the original as a part of that of
    the run that the others are compared with, None where there is no original or no gain. best: (m,) of each objective,
    as people read it. unbeaten: designs of its front that no other run's design beats.
    """

    name: str
    evaluated: int
    count: int
    unbeaten: int
    best: Matrix
    volume: float
    share: float | None


def load_comparison(directory: Path, run: ReportData, study_name: str = "") -> ComparedRun:
    """The front of the run in a folder. study_name: of the run it is compared with; the same: the folder names it.

    Raises: StoreError: there is no run, or it has other objectives, or no feasible design.
    """
    other = load_run(directory)
    if other.objectives != run.keys:
        raise StoreError(
            f"{directory}: minimizes {', '.join(other.objectives)}, the report's run {', '.join(run.keys)}: "
            "runs with different objectives cannot be compared"
        )
    if not other.front:
        raise StoreError(f"{directory}: has no feasible design to compare with")
    front = sorted(other.front, key=lambda record: record.evaluation.objectives[run.keys[0]])
    name = other.study["name"]
    return ComparedRun(
        name=name if name != study_name else Path(directory).resolve().name,
        evaluated=len(other.search_records),
        ids=tuple(-1 if record.number is None else record.number for record in front),
        values=np.array([run.vector(record.evaluation) for record in front]),
    )


def reached(run: ReportData) -> list[Reached]:
    """The run first, then those it is compared with; empty without any, or without a front."""
    if not run.compared or not run.front:
        return []
    own = ComparedRun("this run", len(run.entries), tuple(run.entries[i].id for i in run.front), run.values[run.front])
    everyone = [own, *run.compared]
    original = np.empty((0, len(run.keys))) if run.baseline_vector is None else run.baseline_vector[None]
    union = np.vstack([each.values for each in everyone])
    box = Hypervolume(np.vstack([union, original]))
    start = box.of(original) if len(original) else 0.0
    volumes = [box.of(np.vstack([each.values, original])) for each in everyone]
    gain = volumes[0] - start
    best, ends = non_dominated(union), np.cumsum([len(each.values) for each in everyone])
    return [
        Reached(
            each.name,
            each.evaluated,
            len(each.values),
            int(best[end - len(each.values) : end].sum()),
            run.signs * each.values.min(axis=0),
            volume,
            (volume - start) / gain if len(original) and gain > 0.0 else None,
        )
        for each, volume, end in zip(everyone, volumes, ends, strict=True)
    ]


def shares_in_words(run: ReportData) -> str:
    """How much of the run's gain over the original each of the others reaches alone; empty without an original."""
    found = reached(run)
    if not found or run.baseline_vector is None:
        return ""
    if found[0].share is None:
        return "This run gains no hypervolume over the original, so others have no share of it."
    each = [f"{100.0 * (other.share or 0.0):.0f}\u202f% by {other.name} alone" for other in found[1:]]
    text = each[0] if len(each) == 1 else f"{', '.join(each[:-1])} and {each[-1]}"
    return f"Of the hypervolume that this run gains over the original, {text.replace('%', '% is reached', 1)}."
