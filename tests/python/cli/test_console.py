"""What the terminal says of a run."""

import json

import pytest
from rich.console import Console

from codesign.cli import console
from codesign.problem.evaluation import Evaluation
from codesign.report.verdict import Verdict
from codesign.search.optimization import evaluate_designs
from codesign.storage.records import Record
from codesign.storage.runs import Run
from fake_study import study


def evaluation(reach: float, **violations: float) -> Evaluation:
    reason = "; ".join(f"{name} below 10" for name, value in violations.items() if value)
    return Evaluation({"reach": reach}, "infeasible", reason, {"mass": 1.0}, violations=violations)


@pytest.fixture
def run(tmp_path) -> Run:
    """A run of one design, whose evaluations the tests replace."""
    return evaluate_designs(study(levels=[3]), [{"a": 0.5}], out=tmp_path / "run", cache=None, workers=1)


def replaced(run: Run, evaluations: list[Evaluation], monkeypatch: pytest.MonkeyPatch) -> Run:
    monkeypatch.setattr(Run, "evaluations", property(lambda _: evaluations))
    monkeypatch.setattr(Run, "front", property(lambda _: ()))
    return run


def test_a_run_without_a_feasible_design_names_the_least_infeasible(run, monkeypatch, capsys):
    designs = [
        evaluation(1.2, safety_factor=0.5, mass=0.0),
        evaluation(1.3, safety_factor=0.25),
        evaluation(1.4, mass=0.9),
    ]
    assert console.print_run(replaced(run, designs, monkeypatch), as_json=False) == 1
    told = capsys.readouterr().out
    assert "nothing is feasible; the least infeasible design: reach=1.3" in told
    assert "safety_factor below 10" in told and "safety_factor violated by 0.25" in told
    assert console.print_run(run, as_json=True) == 1
    assert json.loads(capsys.readouterr().out)["least_infeasible"]["design"] == {"reach": 1.3}


def test_numbers_are_printed_in_the_units_they_are_named_with(run, monkeypatch, capsys):
    found = Evaluation({"reach": 1.0}, "feasible", None, {"mass": 0.0894, "max_displacement": 0.0008015}, seconds={})
    console.print_evaluation(found)
    told = " ".join(capsys.readouterr().out.split())
    assert "mass 0.0894 kg" in told and "max_displacement 0.8015 mm" in told
    monkeypatch.setattr(Run, "front", property(lambda _: [Record(1, 0, (0,), "", found)]))
    console.print_run(run, as_json=False)
    told = capsys.readouterr().out
    assert "mass [kg]" in told and "max_displacement [mm]" in told and "0.8015" in told


def test_a_run_whose_designs_all_failed_says_why(run, monkeypatch, capsys):
    designs = [Evaluation.failure({"reach": k}, "MeshError: no mesh" if k else "time limit") for k in range(3)]
    assert console.print_run(replaced(run, designs, monkeypatch), as_json=False) == 1
    assert "all 3 designs failed, 2 of them: MeshError: no mesh" in capsys.readouterr().out
    assert console.print_run(run, as_json=True) == 1
    assert json.loads(capsys.readouterr().out)["least_infeasible"] is None


def test_the_table_of_a_front_fits_the_terminal(run, monkeypatch, capsys):
    designs = {"weak": 3.0, "strong": 7.0}
    parts = {name: {"safety_factor": factor} for name, factor in designs.items()}
    many = {f"a_long_name_{k}": 10.0 * k for k in range(12)}
    found = Record(17, 0, (0,), "", Evaluation(many, "feasible", None, {"mass": 1.5}, parts=parts))
    monkeypatch.setattr(Run, "front", property(lambda _: [found]))
    for width, named in ((80, False), (400, True)):
        monkeypatch.setattr(console, "out", Console(width=width, markup=False))
        assert console.print_run(run, as_json=False) == 0
        told = capsys.readouterr().out
        assert ("a_long_name_11" in told, "…" in told) == (named, False)
        assert [cell.strip() for cell in told.splitlines()[-2].strip("│").split("│")][-2:] == ["1.5", "3"]


@pytest.mark.parametrize(("width", "shown"), [(200, ("seed", "outcome")), (60, ("run", "designs"))])
def test_a_list_of_runs_leaves_out_what_is_empty_or_has_no_room(monkeypatch, capsys, width, shown):
    """A single objective has no hypervolume, but a best value; heads are not broken in a narrow terminal."""
    row = {
        "run": "runs/hexa", "study": "hexa", "algorithm": "surrogate", "seed": 1, "designs": 28, "front": 1,
        "hypervolume": None, "best": "0.08799 kg", "seconds": 577.92, "missing": 6,
        "outcome": "wall time of 540 s used up",
    }  # fmt: skip
    monkeypatch.setattr(console, "out", Console(markup=False, width=width))
    console.print_runs([row], ("seconds", "missing", "outcome"))
    told = capsys.readouterr().out
    assert "hypervolume" not in told
    assert "0.08799 kg" in told
    assert all(name in told for name in shown)
    assert max(map(len, told.splitlines())) <= width


@pytest.mark.parametrize("kind", ["build", "candidate", "barred"])
def test_a_verdict_is_told_with_its_reasons_and_remedies(capsys, kind):
    verdict = Verdict(kind, "design 3", () if kind == "build" else ("It is thin.",), ("Make it thick.",))
    console.print_verdict(verdict.document())
    told = capsys.readouterr().out
    assert told.startswith(
        {"build": "Build design 3: ", "candidate": "not to be built yet: It", "barred": "not to be built: It"}[kind]
    )
    assert ("Make it thick." in told) == (kind != "build")
