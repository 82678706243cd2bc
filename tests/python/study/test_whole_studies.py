"""Studies of body and predictive controller: settings, variables, hovers that do not exist, mistakes."""

import json

import numpy as np
import pytest

import ironcub_predictive as whole
from codesign import dynamics as dyn
from codesign import load_study
from codesign.chain.flight import find_trajectory, flight_settings
from codesign.chain.fly import fly_robot
from codesign.chain.study import Study
from codesign.errors import StudyError
from codesign.study.loading import study_from


def raw_study(name: str = "ironcub_whole") -> tuple[dict, Study]:
    study = load_study(name)
    return json.loads(json.dumps(study.raw)), study


PUBLISHED_RATE = {"throttle_every": 20, "small_steps": 7, "control_steps": 12}  # at 200 Hz; the study's own is 50 Hz


def at_published_rate() -> Study:
    raw, study = raw_study()
    raw["flight"]["step_s"] = 0.005
    raw["flight"]["mpc"] |= PUBLISHED_RATE
    return study_from(raw, study.path, Study)


def test_the_study_flies_what_the_reference_flies() -> None:
    config = at_published_rate().config
    settings, wanted = flight_settings(config.flown, find_trajectory(config, "route")), whole.settings(reference=False)
    for attribute in ("joints", "step", "duration"):
        assert getattr(settings, attribute) == getattr(wanted, attribute)
    for attribute in ("body", "joints", "period", "throttle_every", "small_steps", "large_steps", "control_steps"):
        assert getattr(settings.predictive, attribute) == getattr(wanted.predictive, attribute)
    assert settings.predictive.joint_speed == 2.0 and settings.predictive.model.gravity_coupling
    for attribute in ("stiffness", "damping_ratio", "passive"):
        ours, theirs = (getattr(s.servo_plant.servo, attribute) for s in (settings, wanted))
        np.testing.assert_array_equal(ours, theirs)
    assert repr(settings.actuators[0].dynamics) == repr(wanted.actuators[0].dynamics)
    assert repr(settings.predictive.weights) == repr(dyn.PredictiveWeights())
    path = dyn.Path(settings.path)
    late = dyn.Path(whole.route())  # its reference numbers start 1 ms late
    for time in np.linspace(0.0, 29.0, 30):
        np.testing.assert_allclose(path.at(time).value, late.at(time + 0.001).value, atol=1e-12)


def test_the_loop_is_one_smooth_path() -> None:
    config = load_study("ironcub_whole").config
    path = dyn.Path(flight_settings(config.flown, find_trajectory(config, "loop")).path)
    assert path.end == pytest.approx(129.0)
    assert 0.75 < path.peak_speed < 0.95
    assert path.peak_acceleration < 0.6  # of the climb; 0.1 m/s² in the loop
    np.testing.assert_allclose(path.at(129.0).value, [0.0, 0.0, 2.5, 0.0], atol=1e-12)


def test_a_weight_is_a_design_variable() -> None:
    study = load_study("ironcub_retuned")
    design = dict(study.baseline) | {"w_com": 0.5, "w_throttle": -1.0}
    weights = flight_settings(
        study.configured(study.space.design(design)).flown, study.config.trajectories["route"]
    ).predictive.weights
    np.testing.assert_allclose(weights.com, np.array([500.0, 500.0, 5000.0]) * 10**0.5)
    assert weights.throttle_first == pytest.approx(8000.0) and weights.throttle_change == pytest.approx(8000.0)
    assert weights.joint_displacement == 65000.0


def test_a_robot_flies_without_its_parts_rebuilt() -> None:
    raw, study = raw_study()
    raw["trajectories"]["route"]["duration_s"] = 2.0
    short = study_from(raw, study.path, Study)
    document = fly_robot(short, study.build_robot(study.baseline), trajectory="route")
    flight = document["flight"]
    assert document["status"] == "completed" and flight["duration"] == pytest.approx(2.0)
    assert flight["fuel"] == pytest.approx(2.0 * 0.03175, rel=1e-3)
    assert flight["hover_margin"] == pytest.approx(0.193, abs=1e-3)
    assert flight["joints"]["l_elbow"]["peak_torque"] > 0.0
    assert flight["min_clearance"] > 0.15


def test_without_a_hover_a_design_is_lost_at_its_start() -> None:
    raw, study = raw_study()
    raw["flight"]["jets"]["max_thrust_n"] = 170.0
    weak = study_from(raw, study.path, Study)
    document = fly_robot(weak, study.build_robot(study.baseline))
    assert document["status"] == "lost"
    assert "no hover" in document["reason"]
    assert document["constraints"]["flight_missed_share"] == 1.0


def test_without_a_hover_clearances_are_those_of_the_initial_posture() -> None:
    study = load_study("ironcub_whole")
    found = study.evaluate_lazily(dict(study.baseline) | {"angle": 70.0}, [])
    assert found.status == "infeasible"
    assert "no hover" in (found.reason or "")
    assert found.flight["interference"]["bodies"][0]["time"] == 0.0
    assert found.violations["body_clearance"] > 0.0  # turbine and head of this design meet


def test_rates_of_control_agree_on_what_a_route_burns() -> None:
    fast, slow = at_published_rate(), load_study("ironcub_whole")
    burnt = []
    for study in (fast, slow):
        raw = json.loads(json.dumps(study.raw))
        raw["trajectories"]["route"]["duration_s"] = 6.0
        short = study_from(raw, study.path, Study)
        flight = fly_robot(short, short.build_robot(short.baseline), trajectory="route")["flight"]
        burnt.append(flight["fuel"])
    assert burnt[1] == pytest.approx(burnt[0], rel=1e-3)


@pytest.mark.parametrize(
    ("place", "value", "reason"),
    [
        (("controller",), "momentum_qp", "the controller 'momentum_qp' needs it"),
        (("jet_model",), "integrator", "controller 'mpc' needs one of [flight.jet_models] (mk3)"),
        (("jet_model",), "mk4", "did you mean 'mk3'"),
        (("mpc", "body"), "chost", "did you mean 'chest'"),
        (("mpc", "joints"), ["l_elbow", "l_elbow"], "joint 'l_elbow' is named twice"),
        (("mpc", "control_steps"), 30, "flight.mpc.control_steps"),
        (("mpc", "large_step_s"), 0.01, "flight.mpc.large_step_s"),
        (("servo", "groups"), [], "no servo for joint 'torso_pitch'"),
        (("initial_state", "trim", "joints"), ["l_elbo"], "did you mean 'l_elbow'"),
    ],
)
def test_mistakes_are_refused_by_name(place: tuple[str, ...], value: object, reason: str) -> None:
    raw, study = raw_study()
    node = raw["flight"]
    for key in place[:-1]:
        node = node[key]
    node[place[-1]] = value
    with pytest.raises(StudyError) as refused:
        study_from(raw, study.path, Study)
    assert reason in str(refused.value)
