"""What an export says: the report's verdict, every load case with its limit and error, what a frequency counts."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest

import synthetic_run
from codesign.chain.study import Study, load_study
from codesign.cli.export.design import design_of_run
from codesign.cli.export.order import Order
from codesign.cli.export.page import OrderPage
from codesign.parts.component import Component
from codesign.problem.evaluation import Evaluation
from codesign.report.page.summary import summary
from codesign.report.reading import read_report_data
from codesign.report.verdict import Verdict, study_verdict
from codesign.study.config import LoadCaseConfig, MassOnFaceConfig
from codesign.study.load_config import LoadConfig

DESIGN = {"reach": 200, "height": 30}


def stress(factor: float, peak: float, error: float, **more: Any) -> dict[str, Any]:
    """A load case as an evaluation keeps it."""
    left_out = {"stress": 18.6e6, "position": [0.0, 0.0, 0.0], "border_distance": 1e-3}
    return {
        "safety_factor": factor, "peak_stress": peak, "stress_error": error, "peak_resolved": True,
        "peak_position": [0.0066, 0.0002, -0.008], "left_out": left_out, "max_displacement": 2e-3, **more,
    }  # fmt: skip


CASES = {"thrust": stress(19.7, 14e6, 0.54e6), "landing": stress(3.94, 70e6, 2.7e6)}
ARM = {"mass": 0.0788, **CASES["landing"], "load_case": "landing", "cases": CASES, "first_frequency": 62.34}


def two_cases() -> Study:
    """The shipped quadrotor, its struts under two load cases, each with a limit of its own."""
    study = load_study("gimbal_quad")
    (strut,) = study.config.parts

    def case(name: str, force: float, least: float) -> LoadCaseConfig:
        return LoadCaseConfig(
            name=name, loads=[LoadConfig(face="seat", force_n=(0.0, 0.0, force))], safety_factor_min=least
        )

    motor = MassOnFaceConfig(face="seat", mass_kg=0.11, point_mm=(0.0, 0.0, 18.0))
    cases = [case("thrust", 12.0, 4.0), case("landing", 60.0, 1.5)]
    part = msgspec.structs.replace(strut, loads=[], cases=cases, masses=[motor])
    limits = msgspec.structs.replace(study.config.constraints, first_frequency_min_hz=60.0)
    return replace(study, config=msgspec.structs.replace(study.config, parts=[part], constraints=limits))


def page(arm: dict[str, Any], confirmed: dict[str, Any] | None = None) -> OrderPage:
    """A strut with two load cases and a motor on it, with made-up strength."""
    study = two_cases()
    design = study.space.design(DESIGN)
    part = study.build_parts(design)["strut"]
    numbers = {"tracking": 0.0644, "parts.strut.mass": 0.0788}
    evaluation = Evaluation(dict(DESIGN), "feasible", objectives=numbers, parts={"strut": arm})
    order = Order(study, design, [Component("front_strut", part, np.eye(4))], "design 14 of a")
    verdict = study_verdict(study, evaluation)
    return OrderPage(order, evaluation, verdict, {"strut": "full geometry, whole part"}, confirmed or {})


def test_every_load_case_stands_with_its_limit_and_its_error() -> None:
    text = page(ARM).text([])
    assert "| strut | thrust | (0, 0, 12)\u202fN on face seat | 19.7 | 4 | 14 ± 0.54\u202fMPa (3.9\u202f%) |" in text
    assert (
        "| strut | **landing**, decides | (0, 0, 60)\u202fN on face seat | **3.94** | 1.5 | 70 ± 2.7\u202fMPa" in text
    )
    assert "strut: face mount held; analyzed: full geometry, whole part. It carries 0.11\u202fkg on face seat" in text
    assert "first natural frequency 62.34\u202fHz (at least 60\u202fHz); counted with it: 0.11\u202fkg on face" in text
    assert "published" not in text
    assert "5\u202f% is asked for" in text


def test_the_manifest_has_the_same_for_programs() -> None:
    part = json.loads(page(ARM).manifest([]))["parts"][0]
    cases = {case["load_case"]: case for case in part["strength"]["cases"]}
    assert (cases["thrust"]["safety_factor_min"], cases["landing"]["safety_factor_min"]) == (4.0, 1.5)
    assert [name for name, case in cases.items() if case["decides"]] == ["landing"]
    assert part["strength"]["first_frequency"] == 62.34
    assert part["load_case"]["masses"][0]["mass_kg"] == 0.11
    assert "support" not in part["load_case"]["settings"]


def test_confirmed_numbers_stand_below_the_analyzed_ones() -> None:
    finer = {"strut": {**ARM, "cases": {"landing": stress(3.6, 76e6, 2.3e6)}, **stress(3.6, 76e6, 2.3e6)}}
    text = page(ARM, finer).text([])
    assert "| strut | **landing**, decides, on a finer mesh | (0, 0, 60)\u202fN on face seat | **3.6** | 1.5 |" in text


def test_a_peak_at_a_clamps_rim_is_told_with_what_to_do() -> None:
    rim = {"peak_at_exclusion": True, "border_distance": 4.1e-4}
    text = page({**ARM, **rim, "cases": {**CASES, "landing": CASES["landing"] | rim}}).text([])
    assert "0.41\u202fmm from the rim of a clamp or load, right beside what is left out there" in text
    assert "Hold the part as it is held in truth" in text
    assert "rim of a clamp" not in page(ARM).text([])
    hidden = {"left_out": {"stress": 92e6, "position": [0.0] * 3, "border_distance": 1e-4}}
    text = page({**ARM, "cases": {**CASES, "landing": CASES["landing"] | hidden}}).text([])
    assert "0.1\u202fmm from the rim of a clamp or load the model has 92\u202fMPa" in text


def test_what_was_minimized_has_the_names_of_the_report() -> None:
    text = page(ARM).text([])
    assert "| Tracking error | 0.0644 | m |" in text
    assert json.loads(page(ARM).manifest([]))["objective_labels"]["tracking"]["label"] == "Tracking error"


def test_report_and_export_give_one_verdict(tmp_path: Path) -> None:
    """The page's headline and reasons are those of the export of the same design."""
    study = load_study("ironcub_paper")
    synthetic_run.write_run(tmp_path / "a", synthetic_run.evaluations(150), study=study)
    run = read_report_data(tmp_path / "a", study)
    assert run.recommended is not None
    evaluation = run.entries[run.recommended].evaluation
    verdict = design_of_run(tmp_path / "a", "recommended").judge(evaluation)
    assert verdict.kind == "candidate"
    html = summary(run)
    for text in (verdict.title, verdict.head, *verdict.remedies):
        assert text in html
    assert "has not settled" in verdict.reasons[0]
    number = run.entries[run.front[-1]].id
    assert f"--design {run.entries[run.recommended].id} " in html
    assert design_of_run(tmp_path / "a", str(number)).judge(run.entries[run.front[-1]].evaluation).name == (
        f"design {number}"
    )


@pytest.mark.parametrize(("kind", "head"), [("build", ""), ("barred", "Not to be built")])
def test_titles_of_verdicts(kind: str, head: str) -> None:
    verdict = Verdict(kind, "design 3")  # type: ignore[arg-type]
    assert verdict.head == head
    assert verdict.document()["may_be_built"] == (kind == "build")
