"""Validation: chosen designs and the original on trajectories that the search has not seen, calm and disturbed.

Calm flights are whole evaluations and become rows of the run's store. Disturbed flights repeat them with gusts and with
errors of mass and thrust that the controller does not know, all drawn from a seed; they are kept in `validation.json`.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np

from codesign.errors import DesignError, StoreError, StudyError
from codesign.files import write_text
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
        seeds: disturbed repetitions of each flight; 0 for none.   disturbance: their size.
        workers: parallel evaluations and flights; by default one a processor.
        progress: called with the disturbed flights done and their total number.
    Raises: StoreError (no run, being written), DesignError (no such design), StudyError (no such trajectory).
    """
    from codesign.followup.reevaluate import revisit

    directory = Path(run_directory)
    study = study if study is not None else study_of(directory)
    if study is None:
        raise StoreError(f"{directory}: the run's study cannot be loaded, so its designs cannot be flown")
    run = read_report_data(directory, study)
    chosen = select(run, designs)
    if study.baseline is not None:
        chosen = {ORIGINAL: study.baseline.to_dict(), **chosen}
    names = tuple(trajectories or study.config.validation.trajectories or study.trajectories)
    for name in names:
        if name not in study.config.trajectories:
            raise StudyError(f"no trajectory {name!r}; this study has {', '.join(study.trajectories)}")
    records = revisit(directory, names, list(chosen.values()), study=study, workers=workers)
    known = {(tuple(r.evaluation.design.values()), r.trajectory): r.evaluation for r in records}
    flights = [
        _calm(role, design, name, known[tuple(study.space.design(design).to_dict().values()), name])
        for role, design in chosen.items()
        for name in names
    ]
    size = disturbance or Disturbance()
    flights += disturbed_flights(study, chosen, names, seeds, size, workers, progress)
    validation = Validation(tuple(flights), size)
    write_text(directory / FILE, validation.to_json())
    return validation


def select(run: ReportData, designs: Iterable[str]) -> dict[str, dict[str, float]]:
    """Designs by role, each once. Raises: DesignError for an unknown selector, number, or a run without a front."""
    chosen: dict[str, int] = {}
    for selector in designs:
        chosen |= _positions(run, selector)
    unique: dict[str, dict[str, float]] = {}
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
            raise DesignError(
                f"{run.directory} has no design to recommend: every feasible one overlaps bodies or plumes"
            )
        return {"recommended": run.recommended}
    if selector == "best":
        return {f"lowest {o.label.lower()}": run.best[o.key] for o in run.objectives}
    positions = run.front if selector == "front" else [run.front[i] for i in spread(run.values[run.front], int(count))]
    return {f"design {run.entries[i].id}": i for i in positions}


def _calm(role: str, design: Mapping[str, float], trajectory: str, evaluation: Any) -> Flight:
    figures = {k: v for k, v in evaluation.flight.items() if isinstance(v, float)}
    completed = bool(evaluation.objectives)
    reason = None if completed else evaluation.reason
    return Flight(role, dict(design), trajectory, None, completed, reason, dict(evaluation.objectives), figures)


def disturbed_flights(
    study: Any,
    designs: Mapping[str, Mapping[str, float]],
    trajectories: Sequence[str],
    seeds: int,
    disturbance: Disturbance,
    workers: int | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> list[Flight]:
    """Every design on every trajectory with seeds 1 … `seeds`; the same disturbances for all designs.

    The native flight releases the interpreter's lock, so threads are enough.
    """
    from codesign import dynamics as dyn
    from codesign.chain.flight import joint_names

    if seeds == 0:
        return []
    models = {
        role: dyn.load_urdf(study.build_robot(design), joints=joint_names(study.configured(design).flight))
        for role, design in designs.items()
    }
    cases = [
        (role, number, seed) for role in designs for number in range(len(trajectories)) for seed in range(1, seeds + 1)
    ]
    done = 0

    def fly(case: tuple[str, int, int]) -> Flight:
        role, number, seed = case
        return _disturbed(study, models[role], role, designs[role], trajectories[number], seed, number, disturbance)

    flights = []
    with ThreadPoolExecutor(workers or os.cpu_count() or 1) as pool:
        for flight in pool.map(fly, cases):
            flights.append(flight)
            done += 1
            if progress is not None:
                progress(done, len(cases))
    return flights


def _disturbed(
    study: Any,
    model: Any,
    role: str,
    design: Mapping[str, float],
    trajectory: str,
    seed: int,
    number: int,
    size: Disturbance,
) -> Flight:
    from codesign import dynamics as dyn
    from codesign.chain.documents import flight_document, objective_families
    from codesign.chain.flight import flight_settings

    config = study.configured(study.space.design(design))
    settings = flight_settings(config.flight, config.trajectories[trajectory])
    settings.disturbances = dyn.Disturbances(
        gust_deviation=np.full(3, size.gust),
        gust_time=size.gust_time,
        mass_deviation=size.mass,
        thrust_deviation=size.thrust,
        seed=SEED_STRIDE * number + seed,
    )
    log = dyn.simulate_flight(model, settings)
    completed = log.status == dyn.FlightStatus.completed
    family = objective_families(log)[config.objectives.family]
    figures = {
        k: v for k, v in flight_document(trajectory, log, config.flight.duration_s, 0.0).items() if isinstance(v, float)
    }
    return Flight(
        role,
        dict(design),
        trajectory,
        seed,
        completed,
        None if completed else f"lost at {log.failure_time:.2f} s: {log.failure_reason}",
        {name: family[name] for name in config.objectives.minimise} if completed else {},
        figures,
    )
