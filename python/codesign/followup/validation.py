"""Validation: chosen designs and the original on trajectories that the search has not seen, calm and disturbed.

All flights are whole evaluations, run isolated like those of a search, and become rows of the run's store. Disturbed
flights repeat the calm ones with gusts and with errors of mass and thrust that the controller does not know, all drawn
from a seed; `validation.json` keeps which flights belong together.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

from codesign.chain.flight import disturbed
from codesign.errors import DesignError, StoreError, StudyError
from codesign.files import write_text
from codesign.problem.design_space import DesignValue
from codesign.problem.evaluation import Evaluation
from codesign.report.data import ReportData
from codesign.report.pareto import spread
from codesign.report.reading import read_report_data, study_of
from codesign.report.validation import FILE, ORIGINAL, Disturbance, Flight, Validation

DEFAULT_DESIGNS = ("recommended", "best")
SEED_STRIDE = 1000  # seeds of different trajectories do not meet


def validate(
    run_directory: str | Path,
    designs: Sequence[str] = DEFAULT_DESIGNS,
    trajectories: Sequence[str] | None = None,
    *,
    seeds: int = 5,
    disturbance: Disturbance | None = None,
    workers: int | None = None,
    study: Any = None,
    progress: Callable[[int, int], None] | None = None,
) -> Validation:
    """Flies chosen designs of a run and the study's original on validation trajectories; keeps the result with the run.

    Args:
        designs: `recommended` (the knee), `best` (of each objective), `front` (all of it), `spread:N` (N designs far
            apart on the front), or a design's number. The original is always flown.
        trajectories: of the study; by default those of its `[validation]` section.
        seeds: disturbed repetitions of each flight; 0 for none.
        disturbance: their size; by default as in `disturbance_of`.
        workers: parallel evaluations; by default as in the study's [execution].
        progress: called with the flights done and the number of those that the run does not hold yet.
    Raises: StoreError (no run, being written), DesignError (no such design), StudyError (no such trajectory).
    """
    from codesign.followup.reevaluate import revisit

    directory = Path(run_directory)
    study = study if study is not None else study_of(directory)
    if study is None:
        raise StoreError(f"{directory}: the run's study cannot be loaded, so its designs cannot be flown")
    if not study.trajectories:
        raise StudyError(f"{directory}: its study {study.name!r} has no [flight], so there is nothing to validate on")
    run = read_report_data(directory, study)
    chosen = select(run, designs)
    if study.baseline is not None:
        chosen = {ORIGINAL: study.baseline.to_dict(), **chosen}
    names = tuple(trajectories or study.config.validation.trajectories or study.trajectories)
    for name in names:
        if name not in study.config.trajectories:
            raise StudyError(f"no trajectory {name!r}; this study has {', '.join(study.trajectories)}")
    size = disturbance or disturbance_of(study)
    cases = _cases(names, seeds, size)
    told = None if progress is None else lambda state: progress(state.done, state.total)
    records = revisit(directory, list(cases), list(chosen.values()), study=study, workers=workers, progress=told)
    flown = {(record.grid, record.trajectory): record.evaluation for record in records}
    flights = [
        _flight(role, trajectory, seed, flown[study.space.indices(design), case])
        for disturbed_too in (False, True)
        for role, design in chosen.items()
        for case, (trajectory, seed) in cases.items()
        if (seed is not None) is disturbed_too
    ]
    validation = Validation(tuple(flights), size)
    write_text(directory / FILE, validation.to_json())
    return validation


def disturbance_of(study: Any) -> Disturbance:
    """How far validation strays from the model: as far as the study's own flights, if these do, else a little.

    Of gusts that differ by axis, the largest.
    """
    config = study.config
    own = config.trajectories[config.flown.trajectory].disturbances
    if not any((*own.gust_deviation_n, own.mass_deviation, own.thrust_deviation)):
        return Disturbance()
    return Disturbance(max(own.gust_deviation_n), own.gust_time_s, own.mass_deviation, own.thrust_deviation)


def select(run: ReportData, designs: Iterable[str]) -> dict[str, dict[str, DesignValue]]:
    """Designs by role, each once. Raises: DesignError for an unknown selector, number, or a run without a front."""
    chosen: dict[str, int] = {}
    for selector in designs:
        chosen |= _positions(run, selector)
    unique: dict[str, dict[str, DesignValue]] = {}
    for role, position in chosen.items():
        design = run.entries[position].evaluation.design
        if design not in unique.values():
            unique[role] = dict(design)
    return unique


def _positions(run: ReportData, selector: str) -> dict[str, int]:
    name, _, count = selector.partition(":")
    if selector.isdigit():
        for position, entry in enumerate(run.entries):
            if entry.id == int(selector):
                return {f"design {selector}": position}
        raise DesignError(f"no design {selector} in {run.directory}")
    if selector == ORIGINAL:
        return {}
    if selector not in ("recommended", "knee", "best", "front") and not (name == "spread" and count.isdigit()):
        raise DesignError(
            f"{selector!r} names no designs: expected recommended, best, front, spread:N, original or a design's number"
        )
    if not run.front:
        raise DesignError(f"{run.directory} has no feasible design to validate")
    if selector in ("recommended", "knee"):
        if run.recommended is None:
            raise DesignError(f"{run.directory} has no design to recommend; its report says why")
        return {"recommended": run.recommended}
    if selector == "best":
        return {f"lowest {o.label.lower()}": run.best[o.key] for o in run.objectives}
    positions = run.front if selector == "front" else [run.front[i] for i in spread(run.values[run.front], int(count))]
    return {f"design {run.entries[i].id}": i for i in positions}


def _flight(role: str, trajectory: str, seed: int | None, evaluation: Evaluation) -> Flight:
    figures = {key: value for key, value in evaluation.flight.items() if isinstance(value, float)}
    completed = bool(evaluation.objectives)
    reason = None if completed else evaluation.reason
    return Flight(
        role, dict(evaluation.design), trajectory, seed, completed, reason, dict(evaluation.objectives), figures
    )


def _cases(trajectories: Sequence[str], seeds: int, size: Disturbance) -> dict[str, tuple[str, int | None]]:
    """What every design flies: name for the chain -> trajectory and seed; calm flights first."""
    sizes = {
        "gust_deviation_n": size.gust,
        "gust_time_s": size.gust_time,
        "mass_deviation": size.mass,
        "thrust_deviation": size.thrust,
    }
    cases: dict[str, tuple[str, int | None]] = {name: (name, None) for name in trajectories}
    for number, name in enumerate(trajectories):
        for seed in range(1, seeds + 1):
            cases[disturbed(name, SEED_STRIDE * number + seed, sizes)] = name, seed
    return cases
