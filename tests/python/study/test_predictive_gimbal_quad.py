"""Predictive control of a robot that it was not written for: four gimballed jets, no arms, half the mass."""

import json
from typing import Any

import pytest

from codesign import load_study
from codesign.chain.fly import fly_robot
from codesign.chain.study import Study
from codesign.errors import StudyError
from codesign.study.loading import study_from

HOVER = [{"m": [0, 0, 0], "duration_s": 1}]
ROUTE = [
    {"m": [0, 0, 1.0], "duration_s": 4, "rest_s": 1},
    {"m": [1, 0.5, 1.0], "duration_s": 5, "rest_s": 1},
    {"m": [1, 0.5, 1.0], "yaw_deg": 30, "duration_s": 4, "rest_s": 1},
]
# Momentum goes with mass, its weight with one over mass squared: 2 log10(66.3 kg / 36.7 kg) = 0.5 from the humanoid's.
LIGHTER = {"linear_momentum": 0.5, "angular_momentum": 0.5}


def quad(waypoints: list[dict[str, Any]], duration_s: float, **mpc: Any) -> Study:
    """The shipped study's robot under predictive control, jets and fuel of the humanoid."""
    study, humanoid = load_study("gimbal_quad"), load_study("ironcub_whole").raw["flight"]
    raw = json.loads(json.dumps(study.raw))
    flight = raw["flight"]
    joints = flight["joint_groups"][0]["joints"]
    for section in ("command_speeds", "references", "gains", "weights", "limits"):
        del flight[section]
    flight |= {"controller": "mpc", "jet_model": "mk3", "jet_models": humanoid["jet_models"], "fuel": humanoid["fuel"]}
    flight |= {"step_s": 0.005, "duration_s": duration_s, "trajectory": "path"}
    flight["jets"]["max_thrust_n"] = 222.127
    flight["mpc"] = {"body": "body", "joints": joints, "joint_speed_rad_s": 2.0} | mpc
    group = {"joints": joints, "stiffness_n_m_rad": 1000, "damping_ratio": 0.7, "passive_n_m_s_rad": 1.0}
    flight["servo"] = {"groups": [group]}
    flight["initial_state"] |= {"free_fall_first_step": False, "trim": {"joints": joints}}
    raw["trajectories"] = {"path": {"waypoints": waypoints, "duration_s": duration_s}}
    raw["objectives"], raw["validation"] = {"minimize": ["tracking", "fuel"]}, {}
    return study_from(raw, study.path, Study)


def test_it_hovers_where_it_starts() -> None:
    study = quad(HOVER, 5.0)
    document = fly_robot(study, study.build_robot(study.baseline))
    assert document["status"] == "completed"
    assert document["flight"]["max_com_error"] < 1e-9
    assert document["flight"]["max_attitude_error"] < 1e-9
    assert document["flight"]["hover_margin"] == pytest.approx(0.595, abs=1e-3)


def test_it_flies_way_points_and_turns() -> None:
    study = quad(ROUTE, 18.0, weight_exponents=LIGHTER)
    document = fly_robot(study, study.build_robot(study.baseline))
    assert document["status"] == "completed"
    assert document["flight"]["tracking"] < 0.05
    assert document["flight"]["max_com_error"] < 0.1
    assert document["flight"]["final_com_error"] < 2e-3
    assert document["flight"]["max_attitude_error"] < 0.05


@pytest.mark.parametrize(("key", "value", "reason"), [("body", "chest", "chest"), ("joints", ["l_elbow"], "l_elbow")])
def test_names_of_another_robot_are_refused(key: str, value: object, reason: str) -> None:
    with pytest.raises(StudyError) as refused:
        quad(HOVER, 5.0, **{key: value})
    assert f"flight.mpc.{key}" in str(refused.value) and reason in str(refused.value)


def test_jets_that_it_cannot_predict_are_refused() -> None:
    raw = json.loads(json.dumps(quad(HOVER, 5.0).raw))
    raw["flight"]["jet_model"] = "integrator"
    with pytest.raises(StudyError, match="controller 'mpc' needs one of"):
        study_from(raw, load_study("gimbal_quad").path, Study)
