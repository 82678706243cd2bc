"""Confirmation: which designs, kept with the run, and what the report makes of it."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import synthetic_run
from codesign.chain.confirmed import CONFIRMED, with_confirmed
from codesign.chain.study import load_study
from codesign.followup.confirmation import confirm_designs
from codesign.problem.evaluation import Evaluation
from codesign.report.reading import read_report_data
from codesign.report.verdict import run_verdict
from codesign.storage.records import Record
from codesign.storage.runs import load_run
from codesign.storage.store import RunStore

STUDY = synthetic_run.Study()
LOOSE = {"safety_factor": 11.0, "peak_stress": 42e6, "stress_error": 4e6, "tolerance_reached": False}


def strength(factor: float, share: float) -> dict[str, Any]:
    """A part as confirmed."""
    numbers = {"safety_factor": factor, "peak_stress": 462e6 / factor, "stress_error": share * 462e6 / factor}
    return {**numbers, "load_case": "load", "cases": {"load": numbers}, "tolerance_reached": share <= 0.05}


def revisiting(found: Callable[[Evaluation], dict[str, Any]]) -> Any:
    """Stands for `revisit`, keeps made-up confirmations in the run; and how many designs it was asked for."""
    asked: list[int] = []

    def revisit(out: Path, trajectories: Sequence[str], designs: Sequence[Any], **_: Any) -> list[Record]:
        assert trajectories == [CONFIRMED]
        asked.append(len(designs))
        records = []
        with RunStore.open(out) as store:
            for design in designs:
                grid = STUDY.space.indices(design)
                parts = {name: found(design) for name in synthetic_run.evaluate(synthetic_run.BASELINE).parts}
                record = Record(None, None, grid, CONFIRMED, Evaluation(dict(design), "skipped", "alone", parts=parts))
                store.enqueue([(None, None, grid, dict(design))], STUDY.hash, CONFIRMED)
                store.finish(record)
                records.append(record)
        return records

    return revisit, asked


def write(folder: Path, numbers: dict[str, Any]) -> None:
    """A run whose parts all have some numbers."""
    designs = synthetic_run.evaluations(60)
    made = [replace(e, parts={name: {**p, **numbers} for name, p in e.parts.items()}) for e in designs]
    synthetic_run.write_run(folder, made)


def test_open_designs_are_confirmed_and_may_be_built(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write(tmp_path / "a", LOOSE)
    before = read_report_data(tmp_path / "a", STUDY)
    assert before.recommended is not None
    verdict = run_verdict(before, before.recommended)
    assert "less twice that" in verdict.reasons[0]
    assert f"codesign confirm {tmp_path / 'a'} analyzes" in verdict.remedies[0]
    revisit, asked = revisiting(lambda _: strength(10.9, 0.03))
    monkeypatch.setattr("codesign.followup.confirmation.revisit", revisit)
    found = confirm_designs(tmp_path / "a", study=STUDY)
    assert asked == [len(before.front)] == [len(found)]
    after = read_report_data(tmp_path / "a", STUDY)
    assert after.recommended is not None
    assert after.objections(after.recommended) == ()
    assert len(after.entries) == len(before.entries)
    assert load_run(tmp_path / "a").counts.get("skipped", 0) == 0


def test_a_design_that_fails_on_a_finer_mesh_gives_way(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The recommended design misses its limit, so that the next one is recommended, and confirmed in turn."""
    write(tmp_path / "a", {"safety_factor": 30.0, "peak_stress": 15e6, "stress_error": 4e5})
    first = read_report_data(tmp_path / "a", STUDY)
    assert first.recommended is not None
    bad = first.entries[first.recommended].evaluation.design
    revisit, asked = revisiting(lambda design: strength(9.0 if design == bad else 29.0, 0.03))
    monkeypatch.setattr("codesign.followup.confirmation.revisit", revisit)
    found = confirm_designs(tmp_path / "a", study=STUDY)
    assert asked == [1, 1]
    run = read_report_data(tmp_path / "a", STUDY)
    assert run.recommended is not None
    assert run.entries[run.recommended].id == found[1].number != found[0].number
    told = run_verdict(run, first.recommended)
    assert told.kind == "barred"
    assert "a safety factor of 9, below its limit 10" in told.reasons[0]


def test_what_could_not_be_confirmed_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write(tmp_path / "a", {"safety_factor": 30.0, "peak_stress": 15e6, "stress_error": 4e5})
    run = read_report_data(tmp_path / "a", STUDY)
    assert run.recommended is not None
    design = run.entries[run.recommended].evaluation.design
    failed = Evaluation.failure(dict(design), "memory limit of 2048 MiB exceeded")
    run = replace(run, confirmed={tuple(design.values()): failed})
    assert run.recommended is not None
    verdict = run_verdict(run, run.recommended)
    assert verdict.notes[0] == ("Its parts could not be confirmed on a finer mesh: memory limit of 2048 MiB exceeded.")
    assert verdict.remedies[-1].startswith("Search on")


def test_failed_confirmations_are_tried_again(tmp_path: Path) -> None:
    """A row that is not the search's is unfinished again after a failure; those of the search are left alone."""
    write(tmp_path / "a", LOOSE)
    record = load_run(tmp_path / "a").search_records[0]
    design, grid = record.evaluation.design, record.grid
    with RunStore.open(tmp_path / "a") as store:
        for reason in ("out of memory", None):
            store.enqueue([(None, None, grid, dict(design))], STUDY.hash, CONFIRMED)
            found = Evaluation.failure(dict(design), reason) if reason else Evaluation(dict(design), "skipped")
            store.finish(Record(None, None, grid, CONFIRMED, found))
            store.retry([(grid, CONFIRMED), (grid, "")])
        (kept,) = [r for r in store.records() if r.trajectory == CONFIRMED]
        assert kept.evaluation.status == "skipped"
        assert [r for r in store.records() if r.grid == grid and r.trajectory == ""] == [record]


def test_flown_load_cases_keep_their_numbers() -> None:
    """Confirmed are static cases alone; where a flown one decides, the part's own numbers stay."""
    flown = {"safety_factor": 8.0, "peak_stress": 58e6, "stress_error": 2e6}
    part = {"mass": 1.0, **flown, "load_case": "flown", "cases": {"load": strength(12.0, 0.08), "flown": flown}}
    merged = with_confirmed(Evaluation({}, "feasible", parts={"rod": part}), {"rod": strength(11.0, 0.03)}).parts["rod"]
    assert merged["safety_factor"] == 8.0
    assert merged["cases"]["load"]["safety_factor"] == 11.0
    assert merged["cases"]["flown"] == flown


def test_parts_are_refined_at_the_peak_and_known_the_second_time() -> None:
    study, design = load_study("gimbal_quad"), {"reach": 200, "height": 30}
    kept: dict[str, Any] = {}

    class Cache:
        get, put = kept.get, kept.__setitem__

    found = study.evaluate(design, trajectory=CONFIRMED, cache=Cache())  # type: ignore[arg-type]
    assert (found.status, found.flight) == ("skipped", {})
    strut = found.parts["strut"]
    assert strut["refinements"] >= 1
    assert strut["tolerance_reached"] == (strut["stopped"] is None)
    kept.update({key: value | {"mass": 7.0} for key, value in kept.items()})
    assert study.evaluate(design, trajectory=CONFIRMED, cache=Cache()).parts["strut"]["mass"] == 7.0  # type: ignore[arg-type]


def test_safety_factors_among_the_constraints_are_those_confirmed():
    part = {**strength(12.0, 0.05), "mass": 1.0, "load_case": "load"}
    design = Evaluation({}, "feasible", parts={"rod": part}, constraints={"safety_factor": 12.0, "tracking": 0.1})
    found = with_confirmed(design, {"rod": strength(11.0, 0.03)})
    assert found.constraints == {"safety_factor": 11.0, "tracking": 0.1}
    assert design.constraints["safety_factor"] == 12.0
