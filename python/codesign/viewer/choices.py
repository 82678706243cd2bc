"""Designs that the viewer offers: of a run, of the command line, the study's original."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from codesign.errors import CodesignError
from codesign.problem.design_space import DesignValue, value_text
from codesign.problem.evaluation import Evaluation
from codesign.report.data import ReportData
from codesign.report.details import FOLDER, Detail, load_details
from codesign.report.reading import read_report_data, same_study, study_of
from codesign.report.verdict import Verdict, run_verdict

ORIGINAL = "original"


@dataclass(frozen=True, slots=True)
class Choice:
    """A design that can be picked: how it is called, its values, its evaluation (None: not evaluated yet).

    verdict: of the run that it is of, on building it.
    """

    name: str
    design: dict[str, DesignValue]
    evaluation: Evaluation | None = None
    verdict: Verdict | None = None


def find_choices(
    study: Any, design: Mapping[str, DesignValue] | None, run_directory: str | Path | None
) -> tuple[list[Choice], Any, dict[str, Detail], ReportData | None]:
    """What can be picked, the one to show first at the head; the study; details that are known; the run."""
    choices: list[Choice] = []
    run = None
    details: dict[str, Detail] = {}
    if run_directory is not None:
        directory = Path(run_directory)
        study = study if study is not None else study_of(directory)
        run = read_report_data(directory, study)
        details = load_details(directory)
        choices += [Choice(role, dict(e.design), e, _verdict(run, e)) for role, e in run.highlights.items()]
        known = [choice.design for choice in choices]
        front = [run.entries[i] for i in run.front]
        choices += [
            Choice(f"design {e.id}", dict(e.evaluation.design), e.evaluation, _verdict(run, e.evaluation))
            for e in front
            if e.evaluation.design not in known
        ]
    if study is None:
        raise CodesignError("the study cannot be loaded, so its robot cannot be shown")
    if design is not None:
        values = study.space.design(design).to_dict()
        choices = [Choice(", ".join(f"{k} {value_text(v)}" for k, v in values.items()), values), *choices]
    if study.baseline is not None and all(c.design != study.baseline.to_dict() for c in choices):
        choices.append(Choice(ORIGINAL, study.baseline.to_dict()))
    if not choices:
        raise CodesignError("nothing to show: give a design, or a run that has designs")
    return choices, study, details, run


def _verdict(run: ReportData, evaluation: Evaluation) -> Verdict | None:
    position = run.find(evaluation)
    return None if position is None else run_verdict(run, position)


def details_folder(run_directory: str | Path | None, study: Any) -> Path | None:
    """Where computed details are kept: beside the run, if the study is still the run's."""
    if run_directory is None or not same_study(Path(run_directory), study):
        return None
    return Path(run_directory) / FOLDER
