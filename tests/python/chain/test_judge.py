"""The judge: any number of an evaluation as objective or constraint."""

import msgspec
import numpy as np
import pytest

from codesign.chain import documents
from codesign.chain.judge import Limit, judge, limits
from codesign.chain.study import load_study
from codesign.errors import StudyError
from codesign.problem import numbers
from codesign.problem.numbers import Number
from codesign.problem.quantities import QUANTITIES, quantity, read
from codesign.study import new_study
from codesign.study.config import LimitConfig

MINIMIZED = 'minimize = ["momentum", "joint_velocity", "thrust"]'
PARTS = {
    "rod": {"mass": 0.4, "safety_factor": 12.0, "buckling_factor": None, "frequencies": [80.0, 91.0]},
    "plate": {"mass": 0.6, "safety_factor": 30.0, "buckling_factor": 55.0, "frequencies": [120.0, 140.0]},
}
FLIGHT = {"completed": True, "missed_share": 0.0, "qp_failures": 0, "max_torque": 60.0, "max_com_error": None}
DOCUMENT = {
    "parts": PARTS,
    "flight": FLIGHT,
    "objective_families": {"rms": {"momentum": 1.5, "joint_velocity": 0.3, "thrust": 660.0}},
}


@pytest.fixture(scope="module")
def config():
    return load_study("gimbal_quad").config


def asked(config, minimize=("momentum",), maximize=(), **bounds):
    objectives = msgspec.structs.replace(config.objectives, minimize=minimize, maximize=maximize)
    constraints = msgspec.structs.replace(config.constraints, limits=bounds.get("limits", {}))
    return msgspec.structs.replace(config, objectives=objectives, constraints=constraints, interference=None)


def test_numbers_of_an_evaluation_by_path():
    assert read(DOCUMENT, "parts.rod.mass") == 0.4
    assert read(DOCUMENT, "sum(parts.*.mass)") == pytest.approx(1.0)
    assert read(DOCUMENT, "parts.plate.frequencies.1") == 140.0
    assert read(DOCUMENT, "min(parts.*.buckling_factor)") == 55.0  # a part that cannot buckle does not count
    assert read(DOCUMENT, "flight.max_com_error") is None
    with pytest.raises(StudyError, match=r"no 'max_torq' there; nearest is 'max_torque'"):
        read(DOCUMENT, "flight.max_torq")
    with pytest.raises(StudyError, match="needs min"):
        read(DOCUMENT, "parts.*.mass")
    with pytest.raises(StudyError, match="is not a number"):
        read(DOCUMENT, "parts.rod")


def test_every_name_of_the_table_has_words_and_one_place():
    for name, entry in QUANTITIES.items():
        assert entry.key == name and entry.label and entry.meaning
    assert len({entry.label for entry in QUANTITIES.values()}) == len(QUANTITIES)


def test_mass_and_safety_factor_as_objectives(config):
    verdict = judge(asked(config, ("mass", "parts.rod.mass"), ("safety_factor",)), DOCUMENT, {})
    assert verdict.objectives == {"mass": pytest.approx(1.0), "parts.rod.mass": 0.4, "-safety_factor": -12.0}
    assert quantity("-safety_factor").label == "Safety factor"


def test_a_constraint_on_any_number_takes_one_line_of_the_study(config):
    strict = asked(
        config, limits={"max_torque": LimitConfig(maximum=50.0), "mass": LimitConfig(minimum=0.5, maximum=2.0)}
    )
    verdict = judge(strict, DOCUMENT, {})
    assert verdict.status == "infeasible"
    assert verdict.reason == "largest joint torque 60 N·m above 50 N·m"
    assert verdict.violations["max_torque"] == pytest.approx(0.2)
    assert verdict.violations["mass"] == 0.0
    assert verdict.margins["max_torque"] == pytest.approx(-0.2)
    assert verdict.margins["mass"] == pytest.approx(0.5)  # the nearer of both bounds, 1 kg
    assert {limit.quantity.key for limit in limits(strict)} >= {"max_torque", "mass", "safety_factor"}


@pytest.mark.parametrize(("wanted", "violation"), [(0.8, 0.25), (1.0, 0.0), (1.25, 0.2)])
def test_equal_limits_are_an_equality(config, wanted, violation):
    verdict = judge(asked(config, limits={"mass": LimitConfig(minimum=wanted, maximum=wanted)}), DOCUMENT, {})
    assert verdict.violations["mass"] == pytest.approx(violation)


def test_the_reason_names_every_part_that_misses_a_limit_of_all(config):
    document = DOCUMENT | {"parts": {"rod": PARTS["rod"] | {"safety_factor": 9.5}, "plate": PARTS["plate"]}}
    verdict = judge(asked(config), document, {})
    assert verdict.reason == "rod: safety factor 9.5 below 10"
    assert verdict.violations["safety_factor"] == pytest.approx(0.05)


def test_numbers_of_one_part_have_its_name_and_the_unit_of_all():
    assert quantity("parts.arm.mass").title == "Arm: mass (kg)"
    assert quantity("parts.arm.cases.hard_landing.safety_factor").title == "Arm, load case hard landing: safety factor"
    assert quantity("-parts.left_arm.first_frequency").title == "Left arm: first natural frequency (Hz)"
    assert quantity("parts.arm.max_displacement").factor == 1000.0
    assert quantity("parts.arm.work").title == "Parts: arm: work"
    assert quantity("sum(parts.*.mass)").title == "Mass of the parts (kg)"
    assert quantity("flight.tracking").title == quantity("tracking").title == "Tracking error (m)"
    assert quantity("power:power_in_watts").title == "Power (W)"
    assert quantity("power:power_in_parsecs").title == "Power in parsecs"


def test_own_functions_of_an_evaluation(tmp_path):
    new_study(tmp_path / "study")
    (tmp_path / "study" / "costs.py").write_text(
        "def price(evaluation):\n    return 40.0 * sum(part['mass'] for part in evaluation['parts'].values())\n"
    )
    file = tmp_path / "study" / "study.toml"
    text = file.read_text()
    assert MINIMIZED in text
    file.write_text(text.replace(MINIMIZED, 'minimize = ["momentum", "costs:price"]'))
    study = load_study(file)
    assert study.objectives == ("momentum", "costs:price")
    assert judge(study.config, DOCUMENT, study.functions).objectives == {"momentum": 1.5, "costs:price": 40.0}
    assert quantity("costs:price").label == "Price"


def test_an_own_function_knows_the_design_and_its_faults_have_a_line(tmp_path):
    new_study(tmp_path / "study")
    (tmp_path / "study" / "costs.py").write_text(
        "def price(evaluation):\n    return 2.0 * evaluation['design']['reach']\n\n"
        "def wrong(evaluation):\n    return evaluation['desing']['reach']\n"
    )
    file = tmp_path / "study" / "study.toml"
    text = file.read_text()
    file.write_text(text.replace(MINIMIZED, 'minimize = ["momentum", "costs:price"]'))
    study = load_study(file)
    evaluation = study.evaluate(study.baseline)
    assert evaluation.objectives["costs:price"] == 2.0 * study.baseline["reach"]
    file.write_text(text.replace(MINIMIZED, 'minimize = ["momentum", "costs:wrong"]'))
    with pytest.raises(StudyError, match=r"costs:wrong: KeyError: 'desing' \(costs.py, line 5\)"):
        judge(study.config, DOCUMENT | {"design": {}}, load_study(file).functions, [Limit(quantity("costs:wrong"))])


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ('minimize = ["momentun"]', "did you mean 'momentum'"),
        ('minimize = ["parts.strutt.mass"]', "no part 'strutt'; did you mean 'strut'"),
        ('minimize = ["mass", "mass"]', "named twice"),
        ("minimize = []", "one to 6"),
        ('minimize = ["costs:price"]', "No module named 'costs'"),
    ],
)
def test_wrong_names_are_refused_before_anything_runs(tmp_path, line, message):
    new_study(tmp_path / "study")
    file = tmp_path / "study" / "study.toml"
    file.write_text(file.read_text().replace(MINIMIZED, line))
    with pytest.raises(StudyError, match=message):
        load_study(file)


def test_a_lost_flight_is_infeasible_by_the_share_it_missed(config):
    lost = FLIGHT | {"completed": False, "missed_share": 0.75, "failure_time": 5.0, "failure_reason": "too far"}
    verdict = judge(asked(config), DOCUMENT | {"flight": lost, "objective_families": {}}, {})
    assert verdict.status == "infeasible"
    assert verdict.objectives == {}
    assert verdict.violations["flight_missed_share"] == verdict.constraints["flight_missed_share"] == 0.75
    assert verdict.reason == "flight lost at 5.00 s: too far"
    document = DOCUMENT | {"flight": FLIGHT | {"qp_failures": 3}}  # steps without a solution alone lose no flight
    assert judge(asked(config), document, {}).status == "feasible"


def test_a_new_number_of_the_flight_takes_two_entries(monkeypatch, tmp_path):
    """The example of CONTRIBUTING.md."""
    new = Number("flight.torque_rms", "N·m", "root mean square of the joint torques")
    monkeypatch.setattr(numbers, "NUMBERS", (*numbers.NUMBERS, new))
    monkeypatch.setitem(
        documents.FLIGHT_NUMBERS, "torque_rms", lambda log: float(np.sqrt(np.mean(np.square(log.torque))))
    )
    new_study(tmp_path / "study")
    file = tmp_path / "study" / "study.toml"
    text = file.read_text().replace("duration_s = 20.0", "duration_s = 1.6")
    file.write_text(text.replace(MINIMIZED, 'minimize = ["flight.torque_rms", "thrust"]'))
    evaluation = load_study(file).evaluate({"reach": 200, "height": 30})
    assert evaluation.objectives["flight.torque_rms"] == evaluation.flight["torque_rms"] > 0.0
