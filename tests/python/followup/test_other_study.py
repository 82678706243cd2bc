"""Designs of a run under another study: which are evaluated, and what is nearest to its limit."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import synthetic_run
from codesign.errors import DesignError, StudyError
from codesign.followup import other_study
from codesign.followup.other_study import evaluate_under, extremes
from codesign.problem.evaluation import Evaluation
from codesign.storage.runs import load_run
from codesign.study import StudyData, load

STUDY = synthetic_run.Study()


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out: Path = tmp_path_factory.mktemp("other") / "run"
    synthetic_run.write_run(out, synthetic_run.evaluations(60))
    return out


def test_the_front_is_evaluated_under_the_other_study(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[Any] = []
    monkeypatch.setattr(other_study, "study_of", lambda _: STUDY)
    monkeypatch.setattr(other_study, "evaluate_designs", lambda *given, **options: asked.append((given, options)))
    evaluate_under(STUDY, folder, out=tmp_path / "new", workers=1)
    (study, designs), options = asked[0]
    front = [dict(record.evaluation.design) for record in load_run(folder).front]
    assert study is STUDY
    assert sorted(designs, key=str) == sorted(front, key=str)
    assert options == {"out": tmp_path / "new", "workers": 1}


def test_other_variables_and_unknown_designs_are_refused(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(other_study, "study_of", lambda _: STUDY)
    with pytest.raises(StudyError, match=r"ironcub: its variables are .*bracket_material.*, those of .* angle"):
        evaluate_under(load("ironcub", StudyData), folder, out=tmp_path / "new")
    with pytest.raises(DesignError, match="no design 99999"):
        evaluate_under(STUDY, folder, ["99999"], out=tmp_path / "new")


def test_extremes_name_the_design_that_is_nearest_to_a_limit(tmp_path: Path) -> None:
    base = synthetic_run.evaluations(3)
    factors = {12.0: 0.2, 9.0: -0.1, 30.0: 2.0}
    made = [
        Evaluation(e.design, e.status, objectives=e.objectives, constraints={"factor": f}, margins={"factor": m})
        for e, (f, m) in zip(base, factors.items(), strict=True)
    ]
    synthetic_run.write_run(tmp_path / "run", made)
    (found,) = extremes(load_run(tmp_path / "run"))
    assert (found.key, found.least, found.most, found.margin, found.tightest) == ("factor", 9.0, 30.0, -0.1, 1)


def test_a_number_that_some_designs_lack_is_of_the_others(tmp_path: Path) -> None:
    known, lacking = synthetic_run.evaluations(2)
    made = [
        Evaluation(known.design, "infeasible", constraints={"factor": 9.0}, margins={"factor": -0.1}),
        Evaluation(lacking.design, "failed", "no mesh"),
    ]
    synthetic_run.write_run(tmp_path / "run", made)
    assert [(each.least, each.tightest) for each in extremes(load_run(tmp_path / "run"))] == [(9.0, 0)]
