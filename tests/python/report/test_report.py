"""The report: what it says, what it holds, how it behaves for odd runs."""

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import synthetic_run
from codesign.errors import StoreError
from codesign.problem.evaluation import Evaluation
from codesign.report import write_report
from codesign.report.data import reasons
from codesign.report.details import detail_key, load_detail, load_details, save_detail
from codesign.report.page.encode import page_detail
from codesign.report.page.html import render
from codesign.report.page.summary import summary
from codesign.report.pareto import hypervolume_history, knee_distances, late_growth, spread
from codesign.report.reading import read_report_data
from codesign.report.recommendation import why
from codesign.report.words import caveats, gained, searched
from synthetic_details import detail

STUDY = synthetic_run.Study()


@pytest.fixture(scope="module")
def evaluations() -> list[Evaluation]:
    return synthetic_run.evaluations(150)


def report_data(folder: Path, evaluations: list[Evaluation], **options: object):
    synthetic_run.write_run(folder, evaluations, **options)
    return read_report_data(folder, STUDY, synthetic_run.evaluate(synthetic_run.BASELINE))


def page_text(folder: Path, study: object = STUDY) -> str:
    return write_report(folder, study=study, compute=False, figures=False).html.read_text()


def embedded(text: str) -> dict[str, object]:
    return json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', text, re.S).group(1))


def test_knee_is_the_point_nearest_to_all_best_values():
    front = np.array([[0.0, 1.0], [0.2, 0.3], [1.0, 0.0]])
    assert np.argmin(knee_distances(front)) == 1


def test_knee_prefers_designs_that_are_nowhere_worse_than_the_original():
    front = np.array([[0.0, 1.0], [0.2, 0.3], [1.0, 0.0]])
    assert np.argmin(knee_distances(front, baseline=np.array([1.5, 0.1]))) == 2
    assert (
        np.argmin(knee_distances(front, baseline=np.array([-1.0, -1.0]))) == 1
    )  # nothing is better: the whole front counts


def test_spread_takes_the_extremes_first_and_no_point_twice():
    front = np.column_stack([np.linspace(0, 1, 21), 1 - np.linspace(0, 1, 21)])
    chosen = spread(front, 5)
    assert set(chosen[:2]) == {0, 20}
    assert sorted(chosen) == [0, 5, 10, 15, 20]
    assert spread(front[:1], 4) == [0]


def test_hypervolume_never_falls_and_ignores_unusable_designs():
    values = np.array([[0.5, 0.5], [np.nan, np.nan], [0.9, 0.9], [0.1, 0.2]])
    history = hypervolume_history(values, np.isfinite(values).all(axis=1))
    assert history[0] == history[1] == history[2] > 0
    assert history[3] > history[2]


def test_front_is_feasible_and_no_feasible_design_beats_it(tmp_path, evaluations):
    run = report_data(tmp_path / "run", evaluations)
    for i in run.front:
        assert run.entries[i].evaluation.status == "feasible"
        others = run.values[run.feasible]
        assert not ((others <= run.values[i]).all(axis=1) & (others < run.values[i]).any(axis=1)).any()


def test_gain_in_words_is_the_gain_in_numbers(tmp_path, evaluations):
    run = report_data(tmp_path / "run", evaluations)
    before, after = run.baseline.objectives, run.entries[run.recommended].evaluation.objectives
    saved = 100 * (before["momentum"] - after["momentum"]) / before["momentum"]
    assert f"momentum error by {saved:.1f}\u202f%" in gained(run)
    assert f"{len(evaluations)}. " in searched(run)
    assert "knee" in why(run)


def test_page_is_one_file_that_loads_nothing(tmp_path, evaluations):
    synthetic_run.write_run(tmp_path / "run", evaluations)
    text = page_text(tmp_path / "run")
    markup = re.sub(r'<script(?: type="text/plain" id="plotly")?>.*?</script>', "", text, flags=re.S)
    assert not re.search(r"""(?:src|href|url)\s*[=(]\s*["']?(?:https?:)?//""", markup)
    assert "default-src 'none'" in markup
    assert len(text) < 15e6
    assert sorted(p.name for p in (tmp_path / "run").iterdir() if not p.name.startswith("run.")) == ["report.html"]


def test_page_holds_every_design_with_its_stored_numbers(tmp_path, evaluations):
    synthetic_run.write_run(tmp_path / "run", evaluations)
    document = embedded(page_text(tmp_path / "run"))
    assert len(document["designs"]) == len(evaluations)
    for row, evaluation in zip(document["designs"], evaluations, strict=True):
        assert row["x"] == list(evaluation.design.values())
        stored = [evaluation.objectives.get(key) for key in ("momentum", "joint_velocity", "thrust")]
        assert row["f"] == [None if v is None else pytest.approx(v, rel=1e-6) for v in stored]


def test_constraints_have_units_and_only_limits_are_judged(tmp_path, evaluations):
    watched = [replace(e, constraints=e.constraints | {"body_clearance": -0.0025}) for e in evaluations]
    synthetic_run.write_run(tmp_path / "run", watched)
    document = embedded(page_text(tmp_path / "run"))
    shown = {constraint["key"]: constraint for constraint in document["constraints"]}
    assert shown["safety_factor"]["rule"] == "≥ 10"
    assert (shown["body_clearance"]["unit"], shown["body_clearance"]["rule"]) == ("mm", "")
    place = list(shown).index("body_clearance")
    assert {row["c"][place] for row in document["designs"] if row["id"] is not None} == {-2.5}


def test_failed_designs_are_shown_with_their_reasons_and_never_ranked(tmp_path, evaluations):
    run = report_data(tmp_path / "run", evaluations)
    failed = [e.id for e in run.entries if e.evaluation.status == "failed"]
    assert failed
    assert not set(failed) & {run.entries[i].id for i in run.front}
    assert sorted(i for status, _, ids in reasons(run) if status == "failed" for i in ids) == failed
    assert "volume of the mesh is 1.8 % off" in page_text(tmp_path / "run")


def test_text_from_outside_cannot_become_markup(tmp_path, evaluations):
    bad = Evaluation.failure(evaluations[0].design, "</script><script>alert(1)</script>")
    synthetic_run.write_run(tmp_path / "run", [bad, *evaluations[1:]])
    text = page_text(tmp_path / "run")
    assert "<script>alert" not in text
    assert embedded(text)["designs"][0]["reason"] == bad.reason


@pytest.mark.parametrize("case", ["none feasible", "one design", "interrupted", "empty", "no study"])
def test_odd_runs_give_a_sensible_report(tmp_path, evaluations, case):
    infeasible = [e for e in evaluations if e.status != "feasible"]
    finished = {
        "none feasible": infeasible,
        "one design": [e for e in evaluations if e.status == "feasible"][:1],
        "empty": [],
    }
    interrupted = case == "interrupted"
    chosen = finished.get(case, evaluations)
    synthetic_run.write_run(tmp_path / "run", chosen, planned=1000 if interrupted else None, ended=not interrupted)
    text = page_text(tmp_path / "run", study=STUDY if case != "no study" else None)
    said = re.sub(r"<[^>]+>", "", re.sub(r"<(script|style).*?</\1>", "", text, flags=re.S))
    expected = {
        "none feasible": "nothing to recommend",
        "one design": "only feasible design",
        "interrupted": "not finished: 150 designs of 1,000",
        "empty": "No design has been evaluated yet",
        "no study": "cannot be loaded any more",
    }
    assert expected[case] in said
    assert "nan" not in said.lower().replace("provenance", "")


def test_a_changed_study_is_told(tmp_path, evaluations):
    changed = type("Changed", (synthetic_run.Study,), {"hash": "other"})()
    synthetic_run.write_run(tmp_path / "run", evaluations)
    assert any("changed since this run" in note for note in caveats(read_report_data(tmp_path / "run", changed)))


def test_no_run_is_a_clear_error(tmp_path):
    with pytest.raises(StoreError, match="no run here"):
        write_report(tmp_path, study=STUDY)


def test_details_come_back_as_they_were_kept(tmp_path):
    kept = detail(synthetic_run.evaluate(synthetic_run.BASELINE))
    back = load_detail(save_detail(tmp_path, kept))
    assert back.evaluation == kept.evaluation
    assert np.allclose(back.flight["thrust"], kept.flight["thrust"], rtol=1e-6)
    part = back.parts["jetpack_bracket"]
    assert np.array_equal(part.triangles, kept.parts["jetpack_bracket"].triangles)
    assert np.allclose(part.points, kept.parts["jetpack_bracket"].points, atol=1e-7)


def test_damaged_details_count_as_absent_and_are_told(tmp_path, caplog):
    kept = detail(synthetic_run.evaluate(synthetic_run.BASELINE))
    path = save_detail(tmp_path / "details", kept)
    path.write_bytes(path.read_bytes()[:1000])
    assert load_details(tmp_path) == {}
    assert f"{path} is left out" in caplog.text
    assert detail_key(kept.evaluation) == "15-42-80-108"


def test_report_without_an_original_design(tmp_path, evaluations):
    bare = type("Bare", (synthetic_run.Study,), {"baseline": None})()
    synthetic_run.write_run(tmp_path / "run", evaluations)
    run = read_report_data(tmp_path / "run", bare)
    assert run.recommended is not None
    assert "names no original" in gained(run)
    with_one = read_report_data(tmp_path / "run", type("Changed", (synthetic_run.Study,), {"hash": "other"})())
    assert "names no original" not in gained(with_one)


def test_reasons_show_the_range_of_their_numbers(tmp_path, evaluations):
    run = report_data(tmp_path / "run", evaluations)
    (lost,) = (reason for _, reason, _ in reasons(run) if "flight lost" in reason)
    assert re.fullmatch(r"flight lost at 1\.\d+ to 3\.\d+ s: attitude error above 90°", lost)


def test_the_last_quarter_of_a_search_is_measured_on_the_front():
    values = np.array([[1.0, 3.0], [3.0, 1.0], [1e6, 1e6], [2.0, 1.5]])
    growth, late = late_growth(values, np.ones(4, dtype=bool), [0, 1, 3])
    assert late == 1
    assert 0.5 < growth < 0.8  # the outlier does not hide it
    assert late_growth(values[:3], np.ones(3, dtype=bool), [0, 1]) == (0.0, 0)


def test_a_change_from_zero_is_no_number(tmp_path, evaluations):
    run = report_data(tmp_path / "run", evaluations)
    nothing = replace(run.baseline, objectives={**run.baseline.objectives, "thrust": 0.0})
    run = replace(run, baseline=nothing)
    assert np.isnan(run.gain(run.recommended)[2])
    text = summary(run)
    assert not re.search(r"\b(nan|inf)\b", text)


def test_numbers_that_are_infinite_or_unknown_are_dashes_with_a_reason(tmp_path, evaluations):
    def odd(evaluation: Evaluation) -> Evaluation:
        parts = {n: {**p, "safety_factor": float("inf"), "peak_stress": 0.0} for n, p in evaluation.parts.items()}
        limits = {"safety_factor": float("inf"), "first_frequency": float("nan")}
        return replace(evaluation, parts=parts, constraints=evaluation.constraints | limits)

    run = report_data(tmp_path / "run", evaluations)
    entries = tuple(replace(e, evaluation=odd(e.evaluation)) for e in run.entries)
    text = render(replace(run, entries=entries))
    rows = embedded(text)["designs"]
    assert {row["p"][0][1] for row in rows if row["p"][0] and row["id"] is not None} == {None}
    said = re.sub(r"<[^>]+>", "", re.sub(r"<(script|style).*?</\1>", "", text, flags=re.S))
    assert not re.search(r"\b(nan|inf|infinity)\b", said, re.IGNORECASE)
    failed = next(row for row in rows if row["status"] == 2)
    assert failed["reason"]  # what the page shows over the dash
    assert failed["f"] == [None, None, None]


def test_a_flight_without_counted_joints_has_no_chart_of_them():
    shown = detail(synthetic_run.evaluate(synthetic_run.BASELINE))
    flight = shown.flight
    still = replace(
        flight, groups=(), arrays=flight.arrays | {"joint_velocity_error": np.empty((len(flight["time"]), 0))}
    )
    charts = page_detail(replace(shown, flight=still))["flight"]["charts"]
    assert [chart["label"] for chart in charts] == ["Tracking error", "Attitude error", "Thrusts"]
