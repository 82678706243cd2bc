"""Tolerances: chosen designs as they would be made, each with other dimensions, material and jet angles.

Samples are whole evaluations, run isolated like those of a search, and become rows of the run's store; a repeated call
adds what is missing. All designs are made with the same luck, so that they can be compared sample by sample.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from codesign.chain.scatter import sample_name
from codesign.errors import StoreError
from codesign.files import write_text
from codesign.followup.reevaluate import revisit
from codesign.followup.validation import select
from codesign.problem.evaluation import Evaluation
from codesign.report.reading import read_report_data, study_of
from codesign.report.tolerances import FILE, MadeDesign, Spread, Tolerances, load_tolerances

DEFAULT_DESIGNS = ("recommended",)
DEFAULT_SAMPLES = 100  # one that is not feasible is 1 %
MOST_REASONS = 5


def sample_designs(
    run_directory: str | Path,
    designs: Sequence[str] = DEFAULT_DESIGNS,
    *,
    samples: int = DEFAULT_SAMPLES,
    workers: int | None = None,
    study: Any = None,
    progress: Callable[[int, int], None] | None = None,
) -> Tolerances:
    """Makes chosen designs of a run many times within the study's [tolerances]; keeps the result with the run.

    Args:
        designs: as in `validate`. samples: how often each is made. workers: parallel evaluations.
        progress: called with the evaluations done and the number of those that the run does not hold yet.
    Raises: StoreError (no run, being written), DesignError (no such design), ValueError: no samples.
    """
    if samples < 1:
        raise ValueError(f"samples = {samples}: at least one is needed")
    directory = Path(run_directory)
    study = study if study is not None else study_of(directory)
    if study is None:
        raise StoreError(f"{directory}: the run's study cannot be loaded, so its designs cannot be sampled")
    chosen = select(read_report_data(directory, study), designs)
    base = study.config.flight.trajectory if study.config.flight is not None else ""
    names = [sample_name(base, number) for number in range(1, samples + 1)]
    told = None if progress is None else lambda state: progress(state.done, state.total)
    records = revisit(directory, names, list(chosen.values()), study=study, workers=workers, progress=told)
    made = {
        role: made_design(role, design, [r.evaluation for r in records[i * samples : (i + 1) * samples]])
        for i, (role, design) in enumerate(chosen.items())
    }
    known = load_tolerances(directory)
    others = [each for each in (known.designs if known else ()) if each.design not in chosen.values()]
    found = Tolerances((*made.values(), *others), msgspec.to_builtins(study.config.tolerances))
    write_text(directory / FILE, found.to_json())
    return found


def made_design(role: str, design: Mapping[str, Any], evaluations: Sequence[Evaluation]) -> MadeDesign:
    """A design over its samples; one without mesh, or that could not be built, counts as not feasible."""
    numbers: dict[str, list[float]] = {}
    for evaluation in evaluations:
        for name, value in evaluation.objectives.items():
            numbers.setdefault(name, []).append(value)
        for name, part in evaluation.parts.items():
            if part.get("safety_factor") is not None:
                numbers.setdefault(f"parts.{name}.safety_factor", []).append(part["safety_factor"])
    reasons = dict.fromkeys(e.reason or e.status for e in evaluations if e.status != "feasible")
    return MadeDesign(
        role,
        dict(design),
        len(evaluations),
        sum(evaluation.status == "feasible" for evaluation in evaluations),
        tuple(reasons)[:MOST_REASONS],
        {name: spread_of(values) for name, values in numbers.items()},
    )


def spread_of(values: Sequence[float]) -> Spread:
    """Smallest, 5 %, 50 %, 95 % and largest of some numbers."""
    return Spread(*(float(q) for q in np.quantile(values, [0.0, 0.05, 0.5, 0.95, 1.0])))
