"""From a run's folder to what the report shows."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

from codesign.chain.confirmed import CONFIRMED
from codesign.chain.judge import limits
from codesign.errors import CodesignError, DesignError
from codesign.problem.design_space import DesignValue
from codesign.problem.evaluation import Evaluation
from codesign.problem.identity import Identity
from codesign.problem.quantities import words
from codesign.report.comparison import load_comparison
from codesign.report.data import DesignWords, Entry, Limits, ReportData
from codesign.report.details import load_details
from codesign.report.study_words import flight_words, objective_quantities, part_words
from codesign.report.tolerances import load_tolerances
from codesign.storage.runs import Run, load_run, run_study
from codesign.study.choices import places_set
from codesign.study.config import StudyConfig

logger = logging.getLogger(__name__)


def read_report_data(
    directory: Path, study: Any = None, baseline: Evaluation | None = None, compare: Sequence[Path] = ()
) -> ReportData:
    """A run as the report shows it.

    Args:
        directory: the run's folder.
        study: its study, None if it cannot be loaded any more; then titles, labels and limits are missing.
        baseline: evaluation of the study's original design, where the run has none.
        compare: folders of runs whose fronts are shown beside this one's.
    Raises: StoreError if there is no run, or one to compare has other objectives.
    """
    run = load_run(directory)
    evaluated = baseline or _stored_baseline(run, study)
    read = ReportData(
        directory=Path(directory),
        title=study.title if study is not None else words(run.study["name"]),
        description=" ".join(study.description.split()) if study is not None else "",
        variables=run.space.variables,
        objectives=objective_quantities(run.objectives, None if study is None else study.config),
        entries=tuple(
            Entry(int(r.number if r.number is not None else k), r.evaluation, r.generation)
            for k, r in enumerate(run.search_records)
        ),
        baseline=evaluated,
        waiting=run.counts.get("queued", 0) + run.counts.get("running", 0),
        planned=len(run.search_records) + run.missing if run.missing or not run.finished else None,
        stopped=run.outcome if run.finished and run.missing else None,
        limits=demands(study.config) if study is not None else {},
        provenance=provenance(run),
        export_original=f"codesign export --study {run.study['source']}",
        labels={name: v.label for name, v in study.config.variables.items()} if study is not None else {},
        notes=_notes(run, study),
        baseline_missing=_baseline_missing(study) or ReportData.baseline_missing,
        describe=description(study) if study is not None else lambda _: DesignWords(),
        limits_of=_limits_of(study),
        tolerances=load_tolerances(Path(directory)),
        confirmed={tuple(r.evaluation.design.values()): r.evaluation for r in run.records if r.trajectory == CONFIRMED},
        stress_tolerance=study.config.fem.tolerance if study is not None else None,
    )
    others = tuple(load_comparison(Path(other), read, run.study["name"]) for other in compare)
    return replace(read, compared=others) if others else read


def description(study: Any) -> Callable[[Mapping[str, DesignValue]], DesignWords]:
    """The study in words, with a design's values in it."""

    @cache
    def of(values: tuple[tuple[str, DesignValue], ...]) -> DesignWords:
        config = configured(study, dict(values))
        return DesignWords(part_words(config), flight_words(config))

    return lambda design: of(tuple(design.items()))


def configured(study: Any, design: Mapping[str, DesignValue]) -> StudyConfig:
    """The study's settings with a design's values; as they stand where it has other variables by now."""
    config: StudyConfig = study.config
    try:
        study.space.indices(design)
    except DesignError:
        return config
    found: StudyConfig = study.configured(design)
    return found


def _limits_of(study: Any) -> Callable[[Mapping[str, DesignValue]], Limits] | None:
    """Limits by design, where some variable sets one."""
    if study is None or not any(_limits(place) for place in places_set(study.config)):
        return None
    return lambda design: demands(configured(study, design))


def _limits(place: str) -> bool:
    return place.startswith("constraints.") or place.endswith(".safety_factor_min")


def demands(config: StudyConfig) -> dict[str, tuple[str, float]]:
    """What a study demands of its constraints, SI units."""
    bounds = {}
    for limit in limits(config):
        sign, bound = (">=", limit.least) if limit.least is not None else ("<=", limit.most)
        if bound is not None:
            bounds[limit.quantity.key] = (sign, bound)
    return bounds


def study_of(directory: Path) -> Any:
    """The study of a run, or None with a logged reason: a report must come out without it too."""
    from codesign.chain.study import load_study

    source = run_study(directory)["source"]
    try:
        return load_study(source)
    except CodesignError as error:
        logger.warning("the run's study cannot be loaded: %s", error)
        return None


def same_study(directory: Path, study: Any) -> bool:
    """Whether the study, as it is now, would give the run's numbers again."""
    return study is not None and run_study(directory)["hash"] == study.hash


def _stored_baseline(run: Run, study: Any) -> Evaluation | None:
    if study is None or study.baseline is None:
        return None
    try:
        grid = run.space.indices(study.baseline)
    except DesignError:  # the study has other variables by now, or another grid
        return None
    for record in run.records:
        if record.grid == grid and record.trajectory == "":
            return record.evaluation
    wanted = study.baseline.to_dict()
    for detail in load_details(run.out).values():
        if detail.evaluation.design == wanted:
            return detail.evaluation
    return None


def _baseline_missing(study: Any) -> str:
    """Why a run has no evaluation of the original design although its study may name one; empty: it names none."""
    if study is None:
        return "The original design is not known, as the study cannot be loaded any more."
    if study.baseline is None:
        return ""
    return "The study's original design was not evaluated with this run, so there is nothing to compare with."


def _notes(run: Run, study: Any) -> tuple[str, ...]:
    if study is None:
        return ("The study of this run cannot be loaded any more: titles, limits and the original design are missing.",)
    if study.hash != run.study["hash"]:
        changes = Identity.from_document(run.study.get("identity")).differences(study.identity)
        return (
            f"The study, or the program, has changed since this run ({changes}): its numbers are those of the older "
            "version, and only stored ones are shown.",
        )
    return ()


def provenance(run: Run) -> dict[str, str]:
    """What made the numbers, for people."""
    settings, first = run.settings, next((e.provenance for e in run.evaluations if e.provenance), {})
    session: dict[str, Any] = run.sessions[-1] if run.sessions else {}
    host = session.get("provenance", {})
    search = f"{settings.get('algorithm', '?')}, seed {settings.get('seed', '?')}"
    if settings.get("population"):
        search += f", population {settings['population']}"
    runtime = f"{host.get('machine', '')}, {host.get('processors', '?')} processors, Python {host.get('python', '?')}"
    facts = {
        "study": f"{run.study['name']} ({run.study['source']}), hash {run.study['hash']}",
        "program": f"codesign {first.get('version', '?')}"
        + (f", commit {first['commit']}" if first.get("commit") else ""),
        "search": search,
        "started": run.sessions[0]["started"] if run.sessions else "",
        "time": f"{run.seconds:.0f} s in {len(run.sessions)} session{'s' if len(run.sessions) != 1 else ''}",
        "outcome": str(session.get("outcome") or ""),
        "machine": runtime if host else "",
        "libraries": ", ".join(f"{k} {v}" for k, v in host.get("packages", {}).items()),
        "run": str(run.out),
    }
    return {key: value for key, value in facts.items() if value}
