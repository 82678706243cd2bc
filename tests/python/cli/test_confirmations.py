"""What `codesign evaluate --confirm` prints of the load cases of a part."""

from typing import Any

from codesign.cli.confirmations import print_confirmations
from codesign.parts.strength import Confirmation
from codesign.problem.evaluation import Evaluation

STEP = "start from a finer mesh"


def numbers(factor: float, error: float) -> dict[str, Any]:
    return {"safety_factor": factor, "peak_stress": 400e6 / factor, "stress_error": error * 400e6 / factor}


def part(cases: dict[str, dict[str, Any]]) -> dict[str, Any]:
    rest = {"stress_50": 1e6, "max_displacement": 1e-4, "tetrahedra": 5000, "seconds": {"solve": 1.0}}
    return {**cases["pull"], **rest, "load_case": "pull", "cases": cases, "tolerance_reached": True}


def test_every_case_has_a_line_and_one_that_is_not_settled_its_next_step(capsys):
    searched = {"pull": numbers(10.0, 0.03), "push": numbers(20.0, 0.08)}
    settled = {"change": 0.021, "settled": True, "next_step": None}
    loose = {"change": None, "settled": False, "next_step": STEP}
    confirmed = {"pull": numbers(9.9, 0.03) | settled, "push": numbers(16.0, 0.07) | loose}
    flown = part(searched | {"gust": numbers(15.0, 0.02)})
    evaluation = Evaluation({"a": 1.0}, "feasible", None, {}, parts={"arm": flown})
    print_confirmations(evaluation, {"arm": Confirmation(part(searched), part(confirmed))})
    lines = [" ".join(line.split()) for line in capsys.readouterr().out.splitlines()]
    assert "pull 10.00 9.90 -1.0 % 2.1 % 3.0 % settled" in lines
    assert "push 20.00 16.00 -20.0 % - 7.0 % not resolved" in lines
    assert f"push: {STEP}" in lines
    assert any(line.startswith("gust not confirmed") for line in lines)
