"""Saturation figures, the sentence that explains a loss, and gains that are tried in flights."""

import json
from types import SimpleNamespace

import msgspec
import numpy as np
import pytest

from codesign import dynamics as dyn
from codesign.chain.flight import find_trajectory, flight_settings, joint_names
from codesign.chain.fly import fly_robot
from codesign.chain.saturation import explanation, saturation
from codesign.chain.study import load_study
from codesign.chain.tuning import CALM, mean_inertia, poles, recommended, tune
from codesign.cli.tuning import print_tuning, tuning_document
from codesign.study import new_study


@pytest.fixture(scope="module")
def hexarotor():
    return load_study("hexarotor")


def edited(tmp_path, template, *changes):
    new_study(tmp_path / "study", template)
    file = tmp_path / "study" / "study.toml"
    text = file.read_text()
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    file.write_text(text)
    return load_study(file)


def test_shares_are_those_of_the_histories(hexarotor):
    flight = hexarotor.config.flight
    tilted = {**hexarotor.baseline, "tilt": 32.5}  # pushes sideways without coming to its limits
    model = dyn.load_urdf(hexarotor.build_robot(tilted), joints=joint_names(flight))
    log = dyn.simulate_flight(model, flight_settings(flight, find_trajectory(hexarotor.config, "box")))
    shares = saturation(log, flight)
    assert shares["thrust_rate_share"] == pytest.approx(np.abs(log.thrust_rate_command).mean() / 60.0, rel=1e-12)
    assert {shares[name] for name in ("thrust_at_most", "thrust_at_least", "torque_at_limit", "joint_at_limit")} == {
        0.0
    }
    narrow = msgspec.structs.replace(flight.jets, max_thrust_n=float(np.median(log.thrust.max(axis=1))))
    half = saturation(log, msgspec.structs.replace(flight, jets=narrow))
    assert half["thrust_at_most"] == pytest.approx(0.5, abs=0.2)


def test_joints_that_rest_at_an_end_do_not_count_as_driven_there():
    flight = load_study("gimbal_quad").config.flight
    (group,) = flight.joint_groups
    ranges = [(-90.0, 0.0)] * len(group.joints)
    flight = msgspec.structs.replace(flight, joint_groups=[msgspec.structs.replace(group, ranges_deg=ranges)])
    still = np.full((10, len(flight.jets.frames)), 5.0)
    joints = np.zeros((10, len(group.joints)))  # at their upper ends
    log = SimpleNamespace(thrust=still, thrust_rate_command=0.0 * still, torque=0.0 * joints, joint_positions=joints)
    assert saturation(log, flight)["joint_at_limit"] == 0.0
    joints[:5, 0] = -0.5
    assert saturation(log, flight)["joint_at_limit"] == 0.5


def test_gains_of_a_heavy_robot_on_a_light_one_are_named(tmp_path):
    changes = (
        ("attitude_proportional = 1.0", "attitude_proportional = 50.0"),
        ("attitude_derivative = 7.0", "attitude_derivative = 14.14"),
        ('jet_model = "lag"', 'jet_model = "integrator"'),
        ("step_s = 0.004", "step_s = 0.008"),
    )
    study = edited(tmp_path, "hexarotor", *changes)
    flown = fly_robot(study, study.build_robot(study.baseline))
    assert flown["flight"]["saturation"]["thrust_rate_share"] > 0.5
    assert flown["status"] == "lost"
    assert "of its limit: the gains are too high for the thrusters; `codesign tune`" in flown["reason"]
    trials = tune(study, study.baseline)
    assert not trials[0].completed
    assert recommended(trials).completed


def test_nothing_is_explained_by_limits_that_were_far():
    calm = dict.fromkeys(("thrust_rate_share", "thrust_at_most", "thrust_at_least", "torque_at_limit"), 0.1)
    assert explanation(calm) is None
    assert explanation({}) is None
    assert "too weak" in explanation(calm | {"thrust_at_most": 0.4})


def test_tried_gains_have_the_wanted_poles_and_are_compared_with_the_own_ones(hexarotor, capsys):
    trials = tune(hexarotor, hexarotor.baseline)
    assert trials[0].position is None
    assert trials[0].gains == hexarotor.config.flight.gains
    flight = hexarotor.config.flight
    model = dyn.load_urdf(hexarotor.build_robot(hexarotor.baseline), joints=[])
    inertia = mean_inertia(model, flight_settings(flight, find_trajectory(hexarotor.config, "box")))
    for trial in trials[1:]:
        found = poles(trial.gains, inertia)
        assert abs(found["position"][-1]) == pytest.approx(trial.position, rel=0.1)  # four digits of a double pole
        assert min(abs(pole + trial.attitude) for pole in found["attitude"]) < 5e-3 * trial.attitude
    best = recommended(trials)
    assert best.flight["saturation"]["thrust_rate_share"] <= CALM
    assert best.momentum == min(trial.momentum for trial in trials if trial.completed)
    print_tuning(trials, best)
    printed = capsys.readouterr().out
    assert f"linear_proportional = {best.gains.linear_proportional!r}" in printed
    assert json.loads(json.dumps(tuning_document(trials, best)))["recommended"]["joint_integral"] == 50.0
