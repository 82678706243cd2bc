"""Confirmation: the parts of chosen designs once more, in full on meshes refined at the peak, kept with the run.

Confirmations are evaluations like those of a search, isolated and resumable, and rows of the run's store; the report
judges a design by them where there are some.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from codesign.chain.confirmed import CONFIRMED
from codesign.errors import StoreError
from codesign.execution.pool import Limits
from codesign.followup.reevaluate import revisit
from codesign.followup.validation import select
from codesign.problem.design_space import DesignValue
from codesign.problem.evaluation import Evaluation
from codesign.report.data import ReportData
from codesign.report.objections import UNSETTLED
from codesign.report.reading import read_report_data, study_of
from codesign.search.progress import Progress

PATIENCE, ROOM = 5.0, 4  # times the study's limits of time and memory: finer meshes, several of them


@dataclass(frozen=True, slots=True)
class Confirmed:
    """A design before and after. evaluation: as the search has it; found: its parts confirmed, or why they are not."""

    number: int
    evaluation: Evaluation
    found: Evaluation


def confirm_designs(
    run_directory: str | Path,
    designs: Sequence[str] = (),
    *,
    workers: int | None = None,
    study: Any = None,
    progress: Callable[[Progress], None] | None = None,
) -> list[Confirmed]:
    """Confirms designs of a run; what the run knows already is not computed again, unless it failed.

    Args:
        designs: as in `validate`. none: the recommended one, and those of the best compromises that nothing but the
            error of their stress speaks against; where another is recommended then, that one too.
        workers: parallel evaluations; by default as in the study's [execution].
        progress: called with the state after every change.
    Raises: StoreError (no run, being written), DesignError (no such design), StudyError (the study has changed).
    """
    directory = Path(run_directory)
    study = study if study is not None else study_of(directory)
    if study is None:
        raise StoreError(f"{directory}: the run's study cannot be loaded, so its designs cannot be confirmed")
    execution = study.execution
    limits = Limits(PATIENCE * execution.time_limit_s, ROOM * execution.memory_limit_mib)
    done: dict[int, Confirmed] = {}
    while True:
        run = read_report_data(directory, study)
        positions = _named(run, designs) if designs else _open(run)
        wanted = [position for position in positions if position not in done]
        if not wanted:
            return list(done.values())
        values: list[Mapping[str, DesignValue]] = [run.entries[position].evaluation.design for position in wanted]
        records = revisit(
            directory, [CONFIRMED], values, study=study, workers=workers, progress=progress, limits=limits, again=True
        )
        for position, record in zip(wanted, records, strict=True):
            entry = run.entries[position]
            done[position] = Confirmed(entry.id, entry.evaluation, record.evaluation)


def _named(run: ReportData, designs: Sequence[str]) -> list[int]:
    chosen = select(run, designs).values()
    return [i for i, entry in enumerate(run.entries) if entry.evaluation.design in chosen]


def _open(run: ReportData) -> list[int]:
    """The recommended design, and the best compromises that may be lifted by a finer mesh."""
    against = {i: run.objections(i) for i in run.front}
    liftable = [i for i, found in against.items() if found and all(o.kind in UNSETTLED for o in found)]
    return ([] if run.recommended is None else [run.recommended]) + [i for i in liftable if i != run.recommended]
