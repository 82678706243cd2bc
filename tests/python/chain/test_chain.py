"""The whole chain on real parts, meshes and flights."""

import json
import re

import pytest

import codesign
from codesign.chain.study import load_study
from codesign.errors import DesignError
from codesign.storage.cache import MemoryCache

ORIGINAL = {"angle": 15, "distance": 42, "offset": 80, "length": 108}


@pytest.fixture(scope="module")
def cache():
    return MemoryCache()


@pytest.fixture(scope="module")
def original(cache):
    return load_study("ironcub_paper").evaluate(ORIGINAL, cache=cache)


def test_original_design_is_feasible(original):
    assert original.status == "feasible", original.reason
    assert original.constraints["safety_factor"] > 10
    assert original.constraints["flight_missed_share"] == 0
    assert original.violations == {"safety_factor": 0.0, "flight_missed_share": 0.0}


def test_original_flight_meets_the_consistent_physics_reference(original):
    # spec: independent implementation of the same flight without added fillets; these move it by a few 1e-4
    families = original.objective_families
    assert families["rms"]["momentum"] == pytest.approx(1.7139, rel=2e-3)
    assert families["rms"]["joint_velocity"] == pytest.approx(0.26115, rel=2e-3)
    assert families["rms"]["thrust"] == pytest.approx(665.72, rel=5e-4)
    assert families["script"]["momentum"] == pytest.approx(121.60, rel=2e-3)
    assert families["script"]["joint_velocity"] == pytest.approx(743.4, rel=5e-3)


def test_document_has_every_promised_key(original):
    document = json.loads(original.to_json())
    assert document["design"] == ORIGINAL
    assert set(document["objectives"]) == {"momentum", "joint_velocity", "thrust"}
    assert {"safety_factor", "flight_missed_share"} <= set(document["constraints"])
    for part in ("jetpack_bracket", "forearm_support"):
        assert {
            *("mass", "com", "inertia", "safety_factor", "peak_stress", "stress_50", "stress_error"),
            *("max_displacement", "work", "nodes", "tetrahedra", "seconds"),
        } <= set(document["parts"][part])
    assert {
        "trajectory",
        "duration",
        "max_com_error",
        "max_attitude_error",
        "min_thrust",
        "max_thrust",
        "seconds",
    } <= set(document["flight"])
    assert {"geometry", "fem", "flight", "total"} <= set(document["seconds"])
    assert {"version", "study_hash", "commit"} <= set(document["provenance"])
    assert set(document["objective_families"]) == {"rms", "script", "paper"}


def test_result_does_not_depend_on_what_the_process_did_before(original):
    study = load_study("ironcub_paper")
    study.evaluate({"angle": 10, "distance": 78, "offset": 88, "length": 148})  # once ended the process in CGAL
    again = study.evaluate(ORIGINAL)
    for name, part in original.parts.items():
        assert {k: v for k, v in again.parts[name].items() if k != "seconds"} == {
            k: v for k, v in part.items() if k != "seconds"
        }
    assert again.objective_families == original.objective_families


def test_cached_parts_give_the_same_evaluation(original, cache):
    again = load_study("ironcub_paper").evaluate(ORIGINAL, cache=cache)
    assert again.objectives == original.objectives
    assert again.parts == original.parts


def test_steep_bracket_loses_the_flight_and_stays_without_objectives(cache):
    lost = load_study("ironcub_paper").evaluate([60, 54, 90, 74], cache=cache)
    assert lost.status == "infeasible"
    assert re.match(r"flight lost at [1-9]\.", lost.reason or "")
    assert lost.objectives == {}
    assert lost.violations["flight_missed_share"] == pytest.approx(1 - lost.flight["failure_time"] / 42.0)


def test_evaluate_at_the_top_level_takes_names_or_a_sequence():
    with pytest.raises(DesignError, match="off the grid"):
        codesign.evaluate([15, 43, 80, 108, "ergal", "ti-6al-4v"])


def test_second_robot_runs_through_the_same_engine():
    result = load_study("gimbal_quad").evaluate({"reach": 200, "height": 30})
    assert result.status == "feasible", result.reason
    assert result.parts["strut"]["safety_factor"] > 10
