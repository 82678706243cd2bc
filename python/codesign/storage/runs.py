"""Finished and unfinished runs: reading, listing, comparing."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from codesign.errors import StoreError
from codesign.problem.design_space import DesignSpace, Variable
from codesign.problem.evaluation import Evaluation
from codesign.problem.pareto import Hypervolume, non_dominated, objective_rows
from codesign.problem.quantities import quantity
from codesign.storage.database import DATABASE
from codesign.storage.records import Generation, Record
from codesign.storage.store import RunStore

COMPLETE = ("budget used up", "every design of the grid has been evaluated")  # outcomes of which nothing is missing


@dataclass(frozen=True, slots=True, repr=False)
class Run:
    """A run as stored: read once, then independent of the file."""

    out: Path
    study: dict[str, Any]
    space: DesignSpace
    objectives: tuple[str, ...]
    settings: dict[str, Any]
    records: list[Record]
    generations: list[Generation]
    sessions: list[dict[str, Any]]
    counts: dict[str, int]

    def __repr__(self) -> str:
        name = self.study.get("name", "study")
        return f"<Run {str(self.out)!r} of {name}: {len(self.search_records)} designs, {len(self.front)} on the front>"

    @property
    def search_records(self) -> list[Record]:
        """Rows that the search asked for on the study's own trajectory, in its order."""
        return [record for record in self.records if record.number is not None]

    @property
    def evaluations(self) -> list[Evaluation]:
        """Evaluations of the search, in its order."""
        return [record.evaluation for record in self.search_records]

    @property
    def front(self) -> list[Record]:
        """The feasible rows of the search that no other dominates."""
        feasible = [record for record in self.search_records if record.evaluation.status == "feasible"]
        keep = non_dominated(objective_rows((record.evaluation for record in feasible), self.objectives))
        return [record for record, kept in zip(feasible, keep, strict=True) if kept]

    @property
    def population(self) -> list[Record]:
        """The survivors of the last generation."""
        by_number = {record.number: record for record in self.search_records}
        return [by_number[number] for number in self.generations[-1].population] if self.generations else []

    @property
    def hypervolume(self) -> float | None:
        """After the last generation; the box is fixed by the start population (see front.Hypervolume)."""
        return self.generations[-1].hypervolume if self.generations else None

    @property
    def finished(self) -> bool:
        """Whether the search came to its end."""
        return self.outcome not in (None, "interrupted", "stopped by an error")

    @property
    def outcome(self) -> str | None:
        """How the last session ended; None while it runs, or if its process died."""
        return self.sessions[-1]["outcome"] if self.sessions else None

    @property
    def missing(self) -> int:
        """Evaluations of the budget that were not made, in a run that goes on or that was stopped before its end."""
        if self.outcome in COMPLETE:
            return 0
        return max(0, int(self.settings.get("evaluations") or 0) - len(self.search_records))

    @property
    def seconds(self) -> float:
        """Wall time of all sessions."""
        return float(sum(session["seconds"] for session in self.sessions))


def _variable(document: dict[str, Any]) -> Variable:
    """A design variable as a run keeps it; those of earlier versions have no values."""
    return Variable(**document | {"values": tuple(document.get("values", ()))})


def load_run(out: str | Path) -> Run:
    """Reads a run, finished or not, also while it is being written. Raises: StoreError."""
    with RunStore.read(out) as store:
        meta = store.meta
        return Run(
            out=Path(out),
            study=meta["study"],
            space=DesignSpace(tuple(_variable(document) for document in meta["variables"])),
            objectives=tuple(meta["objectives"]),
            settings=meta["settings"],
            records=store.records(),
            generations=store.generations(),
            sessions=store.sessions(),
            counts=store.counts(),
        )


def run_study(out: str | Path) -> dict[str, Any]:
    """What a run says of its study (source, hash, identity), without reading its rows. Raises: StoreError."""
    with RunStore.read(out) as store:
        study: dict[str, Any] = store.meta["study"]
        return study


def find_runs(folder: str | Path) -> Iterator[Path]:
    """Folders of runs: `folder` itself and those below it, sorted."""
    for database in sorted(Path(folder).rglob(DATABASE)):
        yield database.parent


def summarize(run: Run) -> dict[str, Any]:
    """What a list of runs shows of one."""
    return {
        "run": str(run.out),
        "study": run.study["name"],
        "study_hash": run.study["hash"],
        "algorithm": run.settings["algorithm"],
        "seed": run.settings["seed"],
        "started": run.sessions[0]["started"] if run.sessions else None,
        "seconds": run.seconds,
        "outcome": run.outcome,
        "designs": len(run.search_records),
        "missing": run.missing,
        "statuses": run.counts,
        "front": len(run.front),
        "hypervolume": run.hypervolume if len(run.objectives) > 1 else None,
        "best": _best(run),
    }


def _best(run: Run) -> str | None:
    """The lowest value of a single objective, with its unit; a hypervolume says nothing of it."""
    if len(run.objectives) != 1 or not run.front:
        return None
    (key,) = run.objectives
    return quantity(key).text(run.front[0].evaluation.objectives[key])


def list_runs(folder: str | Path) -> list[dict[str, Any]]:
    """Summaries of all runs in and below a folder; one that cannot be read has only `run` and `error`."""
    summaries = []
    for out in find_runs(folder):
        try:
            summaries.append(summarize(load_run(out)))
        except StoreError as error:
            summaries.append({"run": str(out), "error": str(error)})
    return summaries


def compare_runs(runs: Sequence[Run]) -> list[dict[str, Any]]:
    """Hypervolumes of several runs of one study in one box, spanned by all their feasible designs.

    `hypervolume`: in that box. `non_dominated`: how many of the run's front no design of any other run dominates.
    Raises: StoreError if their objectives differ.
    """
    if len({run.objectives for run in runs}) > 1:
        of = "; ".join(f"{run.out}: {', '.join(run.objectives)}" for run in runs)
        raise StoreError(f"these runs have different objectives and cannot be compared: {of}")
    fronts = [objective_rows((record.evaluation for record in run.front), run.objectives) for run in runs]
    everything = [objective_rows(run.evaluations, run.objectives) for run in runs]
    together = [values for values in everything if len(values)]
    if not together:
        return [summarize(run) | {"hypervolume": None, "non_dominated": 0} for run in runs]
    import numpy as np

    box = Hypervolume(np.vstack(together))
    union = np.vstack(fronts)
    keep = non_dominated(union)
    ends = np.cumsum([len(front) for front in fronts])
    rows = []
    for run, front, end in zip(runs, fronts, ends, strict=True):
        own = int(keep[end - len(front) : end].sum())
        volume = {"hypervolume": box.of(front)} if len(run.objectives) > 1 else {}
        rows.append(summarize(run) | volume | {"non_dominated": own})
    return rows
