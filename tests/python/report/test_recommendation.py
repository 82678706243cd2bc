"""Which design the report recommends, and what it says against building it."""

from dataclasses import replace
from pathlib import Path

import pytest

import synthetic_run
from codesign.problem.evaluation import Evaluation
from codesign.report.data import ReportData
from codesign.report.evidence import evidence
from codesign.report.objections import objections
from codesign.report.page.document import page_document
from codesign.report.page.summary import summary
from codesign.report.reading import read_report_data
from codesign.report.recommendation import left_out, load_cases, nothing_to_build, price, second_opinion, strength, why
from codesign.report.validation import Disturbance, Flight, Validation
from codesign.report.verdict import run_verdict

STUDY = synthetic_run.Study()
LIMITS = {"safety_factor": (">=", 10.0)}


@pytest.fixture(scope="module")
def evaluations() -> list[Evaluation]:
    return synthetic_run.evaluations(150)


def report_data(folder: Path, evaluations: list[Evaluation]) -> ReportData:
    synthetic_run.write_run(folder, evaluations)
    return read_report_data(folder, STUDY, synthetic_run.evaluate(synthetic_run.BASELINE))


def with_gaps(evaluation: Evaluation, body: float, plume: float = 0.03) -> Evaluation:
    gaps = {"body_clearance": body, "plume_clearance": plume}
    return replace(evaluation, constraints=evaluation.constraints | gaps)


def part(evaluation: Evaluation, **numbers: object) -> Evaluation:
    return replace(evaluation, parts={name: {**p, **numbers} for name, p in evaluation.parts.items()})  # type: ignore[dict-item]


def test_a_sound_design_has_no_objection():
    assert objections(with_gaps(synthetic_run.evaluate(synthetic_run.BASELINE), 0.003), LIMITS) == ()


@pytest.mark.parametrize(
    ("body", "plume", "said"), [(-0.006, 0.03, "overlap by 6.0\u202fmm"), (0.003, -0.0349, "34.9\u202fmm deep")]
)
def test_a_design_that_collides_is_barred_even_if_nothing_limits_it(body, plume, said):
    (found,) = objections(with_gaps(synthetic_run.evaluate(synthetic_run.BASELINE), body, plume), {})
    assert found.final
    assert said in found.text


def test_an_objection_names_the_pair_that_is_nearest():
    bad = with_gaps(synthetic_run.evaluate(synthetic_run.BASELINE), -0.006)
    pairs = [{"links": ["left_rod", "chest"], "clearance": 0.1}, {"links": ["rod", "hip"], "clearance": -0.006}]
    (found,) = objections(replace(bad, flight={**bad.flight, "interference": {"bodies": pairs, "plumes": []}}), {})
    assert "(rod and hip)" in found.text


@pytest.mark.parametrize(
    ("numbers", "said"),
    [
        (
            {"safety_factor": 11.5, "tolerance_reached": False, "peak_stress": 1e6, "stress_error": 9.4e4},
            "estimated at 9.4\u202f%, and the safety factor 11.5 less twice that, 9.68, misses its limit 10",
        ),
        ({"safety_factor": 10.1, "peak_stress": 1e6, "stress_error": 4e4}, "by less than its error"),
    ],
)
def test_stress_that_is_not_settled_is_an_objection_that_may_be_lifted(numbers, said):
    found = objections(part(synthetic_run.evaluate(synthetic_run.BASELINE), **numbers), LIMITS)
    assert found
    assert not any(objection.final for objection in found)
    assert said in found[0].text


def test_an_error_that_no_limit_feels_is_no_objection():
    """40 ± 8 % against 10 is sound whatever tolerance is asked for; without a limit the error itself is judged."""
    loose = {"safety_factor": 40.0, "tolerance_reached": False, "peak_stress": 1e6, "stress_error": 8e4}
    design = part(synthetic_run.evaluate(synthetic_run.BASELINE), **loose)
    assert objections(design, LIMITS, tolerance=0.05) == ()
    (found, _) = objections(design, {}, tolerance=0.05)
    assert found.text.endswith("is not settled: its error is estimated at 8\u202f% (tolerance 5\u202f%)")
    unresolved = part(design, peak_resolved=False, stress_error=6e5)
    assert "too much to tell anything" in objections(unresolved, {"safety_factor": (">=", 1.5)}, tolerance=0.05)[0].text


@pytest.mark.parametrize(
    ("factor", "settled", "said"), [(13.0, False, True), (15.0, False, False), (13.0, True, False)]
)
def test_a_confirmed_case_whose_peak_still_moves_is_not_settled(factor, settled, said):
    """The case does not govern; 20 % of change count as 20 % of error: 13 / 1.4 misses 10, 15 / 1.4 keeps it."""
    thrust = {"safety_factor": factor, "peak_stress": 1e6, "stress_error": 3e4, "change": 0.2, "settled": settled}
    landing = {"safety_factor": 11.0, "peak_stress": 2e6, "stress_error": 5e4, "change": 0.01, "settled": True}
    cases, design = {"thrust": thrust, "landing": landing}, synthetic_run.evaluate(synthetic_run.BASELINE)
    design = part(design, load_case="landing", cases=cases, confirmed=True, tolerance_reached=settled)
    found = objections(design, LIMITS, tolerance=0.05)
    assert bool(found) is said
    assert all("in load case thrust" in one.text and "moved it by 20\u202f%" in one.text for one in found)


def test_every_load_case_is_judged_by_its_own_limit():
    """The case that governs keeps its limit by far; another one is within its error of its own."""
    cases = {
        "thrust": {"safety_factor": 4.1, "peak_stress": 1e6, "stress_error": 5e4},
        "landing": {"safety_factor": 3.0, "peak_stress": 2e6, "stress_error": 5e4},
    }
    design = part(synthetic_run.evaluate(synthetic_run.BASELINE), load_case="landing", cases=cases)
    limits = {f"parts.{name}.cases.{case}.safety_factor": (">=", least) for name in design.parts for case, least in
              (("thrust", 4.0), ("landing", 1.5))}  # fmt: skip
    found = objections(design, limits)
    assert len(found) == len(design.parts)
    assert "in load case thrust keeps its limit 4 by less than its error, 5\u202f%" in found[0].text


def test_infeasible_and_failed_designs_are_barred(evaluations):
    for evaluation in evaluations:
        assert any(o.final for o in objections(evaluation, LIMITS)) == (evaluation.status != "feasible")


def test_the_best_design_that_does_not_collide_is_recommended(tmp_path, evaluations):
    plain = report_data(tmp_path / "plain", evaluations)
    barred = set(plain.front) - {plain.front[-1]}
    run = report_data(
        tmp_path / "run", [with_gaps(e, -0.006 if i in barred else 0.003) for i, e in enumerate(evaluations)]
    )
    assert run.front == plain.front
    assert run.recommended not in barred
    assert not run.objections(run.recommended)
    for i in run.choices:  # nothing that may be built beats a choice
        others = run.values[[j for j in range(len(evaluations)) if run.feasible[j] and not run.objections(j)]]
        assert not ((others <= run.values[i]).all(axis=1) & (others < run.values[i]).any(axis=1)).any()
    assert f"{len(barred)} of the {len(run.front)} best compromises found" in left_out(run)
    assert f"{len(barred)} overlap bodies of the robot" in why(run)
    text = summary(run)
    assert "design to build" not in text


def test_nothing_is_recommended_where_every_design_collides(tmp_path, evaluations):
    run = report_data(tmp_path / "run", [with_gaps(e, -0.006, -0.01) for e in evaluations])
    assert run.front
    assert run.recommended is None
    text = summary(run)
    assert '<h2 class="bad">No design to build</h2>' in text
    assert "Build design" not in text
    assert "overlap bodies of the robot" in text


def test_nothing_is_recommended_where_finer_meshes_find_every_design_too_weak(tmp_path, evaluations):
    run = report_data(tmp_path / "run", [e for e in evaluations if e.status == "feasible"][:3])
    weak = {"safety_factor": 9.0, "peak_stress": 51e6, "stress_error": 2e6}
    found = {
        tuple(entry.evaluation.design.values()): part(entry.evaluation, **weak, load_case="load", cases={"load": weak})
        for entry in run.entries
    }
    run = replace(run, confirmed=found)
    assert run.recommended is None
    text = nothing_to_build(run)
    assert "below its limit 10" in text or "miss the limit of the safety factor on a finer mesh" in text
    assert text.endswith(
        "Ask for larger safety factors or finer meshes ([fem] accuracy, edge_length_mm) and search again."
    )


def test_a_design_that_is_not_settled_is_a_candidate(tmp_path, evaluations):
    doubtful = [
        part(e, safety_factor=10.5, peak_stress=1e6, stress_error=8e4, tolerance_reached=False) if e.parts else e
        for e in evaluations
    ]
    run = report_data(tmp_path / "run", doubtful)
    assert run.recommended is not None
    text = summary(run)
    assert "Candidate: design" in text
    assert "Not to be built yet" in text
    assert f"codesign confirm {run.directory}" in text
    assert "Build design" not in text


def test_a_search_that_still_finds_better_designs_is_not_settled(tmp_path, evaluations):
    run = report_data(tmp_path / "run", evaluations)
    assert run.late_growth[0] > 0.01
    assert run.recommended is not None
    verdict = run_verdict(run, run.recommended)
    (said,) = verdict.reasons
    assert "has not settled" in said
    assert (verdict.kind, verdict.head) == ("candidate", "Not to be built yet")
    assert verdict.remedies == (f"Search on: codesign resume {run.directory} --evaluations 300.",)
    other = next(i for i in run.front if i != run.recommended)
    assert f"recommends design {run.entries[run.recommended].id} instead" in run_verdict(run, other).notes[-1]


def test_the_choice_is_explained_with_its_distances_and_its_price(tmp_path, evaluations):
    run = report_data(tmp_path / "run", evaluations)
    (first, distance), (second, _) = run.ranking[:2]
    assert first == run.recommended
    assert f"at a distance of {distance:.2f}" in why(run)
    assert f"design {run.entries[second].id} (" in why(run)
    assert "above the lowest among them" in price(run)


def test_strength_names_load_support_and_material(tmp_path, evaluations):
    said = strength(report_data(tmp_path / "run", evaluations))
    for words in ("250\u202fN pressing on face seat", "face mount held", "462\u202fMPa", "at least 10 is asked for"):
        assert words in said


def test_every_load_case_is_told_with_its_limit_its_error_and_the_tolerance(tmp_path, evaluations):
    """On the first screen for the recommended design, on its card for any; the one that decides comes first."""
    cases = {
        "thrust": {"safety_factor": 24.3, "peak_stress": 11.4e6, "stress_error": 0.87e6},
        "landing": {"safety_factor": 14.9, "peak_stress": 56.8e6, "stress_error": 4.4e6},
    }
    more = {"load_case": "landing", "cases": cases, "first_frequency": 80.12, "peak_position": [0.0, 0.0, 0.0]}
    made = [part(e, **more) if e.parts else e for e in evaluations]
    run = report_data(tmp_path / "run", made)
    said = load_cases(run)
    told = "load case landing, which decides: safety factor 14.9 (at least 10), peak stress 56.8 ± 4.4\u202fMPa"
    assert f"{told} (7.7\u202f%); load case thrust: safety factor 24.3 (at least 10)" in said
    assert "first natural frequency 80.12\u202fHz; nothing that hangs on the part is counted" in said
    assert "5\u202f% is asked for ([fem] tolerance)" in said
    assert said in summary(run).replace("&amp;", "&")
    assert run.recommended is not None
    shown = page_document(run)["designs"][run.recommended]["s"]
    assert all(told in texts[0] for texts in shown)


def flights(run: ReportData, changes: list[float]) -> Validation:
    old, design = {"thrust": 100.0}, dict(run.entries[run.recommended].evaluation.design)
    found = []
    for seed, change in enumerate(changes):
        for role, theta, value in (
            ("original", synthetic_run.BASELINE, 100.0),
            ("recommended", design, 100.0 * (1.0 + change)),
        ):
            found.append(Flight(role, theta, "hover", seed, True, None, old | {"thrust": value}, {}))
    return Validation(tuple(found), Disturbance())


def test_a_gain_is_green_only_where_all_other_flights_agree(tmp_path, evaluations):
    run = report_data(tmp_path / "run", evaluations)
    assert evidence(run, None, 2).text == "no other flights, no error estimate"
    assert evidence(run, flights(run, [-0.02, -0.01, -0.015]), 2).sense == "good"
    assert evidence(run, flights(run, [0.02, 0.01, 0.015]), 2).sense == "bad"
    mixed = evidence(run, flights(run, [-0.02, 0.01, -0.015]), 2)
    assert (mixed.sense, mixed.text) == ("", "not certain: −2.0\u202f% … +1.0\u202f% in 3 other flights")
    assert "big open" in summary(run)


def test_a_knee_that_pays_much_for_little_names_the_better_trade(tmp_path, evaluations):
    """Thrust varies by 3 % over the front, momentum by a factor: the knee weighs both ranges alike."""
    feasible = [e for e in evaluations if e.status == "feasible"][:3]
    trades = [(1.0, 0.2, 103.0), (2.6, 0.2, 101.0), (6.0, 0.2, 100.0)]
    made = [
        replace(e, objectives=dict(zip(("momentum", "joint_velocity", "thrust"), values, strict=True)))
        for e, values in zip(feasible, trades, strict=True)
    ]
    run = replace(report_data(tmp_path / "run", made), baseline=None)
    assert run.recommended == 1
    said = second_opinion(run)
    assert said.startswith(f"Look at design {run.entries[0].id} too")
    assert "momentum error −61.5\u202f%" in said
    assert "thrust +2.0\u202f%" in said
    assert said in summary(run)
    assert second_opinion(replace(run, entries=run.entries[:1])) == ""
