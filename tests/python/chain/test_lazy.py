"""Lazy evaluations: what stops early says so and has no number; what does not stop is the whole evaluation."""

import dataclasses
from types import SimpleNamespace

import msgspec
import pytest

from codesign import _core
from codesign.chain import chain, clearances
from codesign.chain.lazy import NOT_COMPUTED, STRENGTH_NOT_COMPUTED, can_wait
from codesign.chain.study import load_study
from codesign.study.config import ExecutionConfig, LimitConfig, ObjectivesConfig

STUDY = load_study("ironcub_paper")
DESIGN = {"angle": 15, "distance": 42, "offset": 80, "length": 108}


def numbers(evaluation):
    """Everything but times."""
    document = evaluation.to_dict()
    for part in document["parts"].values():
        del part["seconds"]
    del document["seconds"], document["flight"]["seconds"]
    return document


@pytest.fixture(scope="module")
def whole():
    return STUDY.evaluate(DESIGN)


def test_a_design_that_can_enter_the_front_is_evaluated_whole(whole):
    values = list(whole.objectives.values())
    beside = (values[0] * 0.9, values[1] * 1.1, values[2])
    assert numbers(STUDY.evaluate_lazily(DESIGN, [(3, beside)])) == numbers(whole)


@pytest.mark.parametrize("study", [STUDY, None], ids=["flight first", "clearances too"])
def test_what_was_flown_and_measured_first_is_not_done_again(whole, monkeypatch, study):
    calls = []

    def counted(function):
        return lambda *given: calls.append(function.__name__) or function(*given)

    monkeypatch.setattr(chain, "_core", SimpleNamespace(**vars(_core)))
    monkeypatch.setattr(chain._core, "evaluate", counted(_core.evaluate))
    monkeypatch.setattr(clearances, "flown_interference", counted(clearances.flown_interference))
    found = (study or strength_last(STUDY)).evaluate_lazily(DESIGN, [])
    assert sorted(calls) == ["evaluate", "flown_interference"]
    assert numbers(found) == numbers(whole)
    assert found.seconds["total"] >= sum(found.seconds[key] for key in ("geometry", "fem", "flight"))


def test_a_design_that_cannot_is_flown_only(whole):
    found = STUDY.evaluate_lazily(DESIGN, [(3, (9.0, 9.0, 9.0)), (7, tuple(whole.objectives.values()))])
    assert found.status == "skipped"
    assert found.reason == f"design 7 is nowhere worse; {NOT_COMPUTED}"
    assert found.objectives == whole.objectives
    assert found.objective_families == whole.objective_families
    assert found.parts == {}
    assert set(found.constraints) == {"flight_missed_share"}
    assert {key: value for key, value in whole.flight.items() if key not in ("interference", "seconds")} == {
        key: value for key, value in found.flight.items() if key != "seconds"
    }


def test_a_lost_flight_needs_no_strength():
    lost = {"angle": 60, "distance": 54, "offset": 90, "length": 74}
    found = STUDY.evaluate_lazily(lost, [])
    assert found.status == "infeasible"
    assert found.reason.startswith("flight lost at")
    assert found.reason.endswith(NOT_COMPUTED)
    assert found.total_violation > 0
    assert found.parts == {}


def strength_last(study):
    """The study, with clearances measured before a design is left out."""
    return dataclasses.replace(
        study, config=msgspec.structs.replace(study.config, execution=ExecutionConfig(lazy="strength"))
    )


def test_where_strength_alone_waits_clearances_are_known(whole):
    found = strength_last(STUDY).evaluate_lazily(DESIGN, [(7, tuple(whole.objectives.values()))])
    assert found.status == "skipped"
    assert found.reason == f"design 7 is nowhere worse; {STRENGTH_NOT_COMPUTED}"
    assert found.flight["interference"] == whole.flight["interference"]
    assert found.parts == {}
    assert found.constraints == {key: value for key, value in whole.constraints.items() if key != "safety_factor"}


def test_where_strength_alone_waits_a_missed_clearance_decides(whole):
    constraints = msgspec.structs.replace(STUDY.config.constraints, plume_clearance_min_mm=200.0)
    strict = dataclasses.replace(STUDY, config=msgspec.structs.replace(STUDY.config, constraints=constraints))
    found = strength_last(strict).evaluate_lazily(DESIGN, [])
    assert found.status == "infeasible"
    assert found.reason.endswith(STRENGTH_NOT_COMPUTED)
    assert found.margins["plume_clearance"] < 0.0
    changed = msgspec.structs.replace(
        STUDY.config, objectives=ObjectivesConfig(minimize=("momentum", "body_clearance"))
    )
    assert can_wait(msgspec.structs.replace(changed, execution=ExecutionConfig(lazy="strength")))


@pytest.mark.parametrize(
    ("minimize", "early"),
    [
        (("momentum", "thrust"), True),
        (("momentum", "mass"), True),
        (("parts.jetpack_bracket.mass", "flight.max_torque"), True),
        (("momentum", "max_displacement"), False),
        (("momentum", "body_clearance"), False),
        (("momentum", "costs:price"), False),
        (("momentum", "sum(parts.*.work)"), False),
    ],
)
def test_objectives_from_flight_and_masses_can_be_told_early(minimize, early):
    changed = msgspec.structs.replace(STUDY.config, objectives=ObjectivesConfig(minimize=minimize))
    assert can_wait(changed) is early


def test_a_limit_of_the_flight_is_judged_first(whole):
    torque = whole.flight["max_torque"]
    limits = {"flight.max_torque": LimitConfig(maximum=0.5 * torque)}
    constraints = msgspec.structs.replace(STUDY.config.constraints, limits=limits)
    strict = dataclasses.replace(STUDY, config=msgspec.structs.replace(STUDY.config, constraints=constraints))
    found = strict.evaluate_lazily(DESIGN, [])
    assert found.status == "infeasible"
    assert found.margins["flight.max_torque"] == pytest.approx(-1.0)
    assert NOT_COMPUTED in found.reason
