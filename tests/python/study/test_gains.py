"""Gains from bandwidths: the poles that were asked for, and those that a flight shows."""

import msgspec
import numpy as np
import pytest

from codesign import dynamics as dyn
from codesign.chain.flight import find_trajectory, flight_settings
from codesign.chain.study import load_study
from codesign.study.gains import AttitudeGains, LinearGains, attitude_gains, linear_gains

STEP = 0.001  # s, of the flights


@pytest.mark.parametrize(("frequency", "damping", "pole"), [(2.0, 1.0, 0.5), (4.0, 0.7, 0.9), (1.3, 1.0, 0.2)])
def test_the_position_has_the_poles_that_were_asked_for(frequency, damping, pole):
    wanted = np.roots(np.polymul([1.0, pole], [1.0, 2.0 * damping * frequency, frequency**2]))
    found = linear_gains(frequency, damping, pole).poles
    np.testing.assert_allclose(np.poly(found), np.poly(wanted), rtol=1e-9)


@pytest.mark.parametrize(("inertia", "pole", "damping"), [(0.02, 20.0, 0.8), (0.5, 30.0, 0.6), (5.0, 11.0, 1.0)])
def test_the_attitude_has_the_fast_pole_and_the_damping_that_were_asked_for(inertia, pole, damping):
    poles = attitude_gains(inertia, pole, damping).poles(inertia)
    assert np.abs(poles + pole).min() < 1e-6 * pole
    pair = poles[np.argsort(np.abs(poles + pole))[1:]]
    if damping < 1.0:
        np.testing.assert_allclose(-pair.real / np.abs(pair), damping, rtol=1e-6)
    assert (poles.real < 0.0).all()


@pytest.mark.parametrize("pole", [1.0, 2.0])
def test_the_law_has_a_pole_below_one(pole):
    with pytest.raises(ValueError, match="one pole below 1 rad/s"):
        linear_gains(3.0, 1.0, pole)
    assert LinearGains(1.5, 3.06, 10.0).poles.real.max() > -1.0


@pytest.fixture(scope="module")
def hexarotor():
    return load_study("hexarotor")


def flown(study, position, attitude, imbalance):
    """A hover of the shipped hexarotor whose propellers follow at once, started with wrong thrusts."""
    config = study.config
    start = msgspec.structs.replace(config.flight.initial_state, trim=None)
    untrimmed = msgspec.structs.replace(config.flight, initial_state=start)
    settings = flight_settings(untrimmed, find_trajectory(config, "box"), "integrator")
    settings.trajectory = []
    settings.step, settings.duration = STEP, 3.0
    settings.gains = dyn.Gains(
        momentum_proportional=position.proportional,
        momentum_derivative=position.derivative,
        momentum_integral=position.momentum,
        attitude_proportional=attitude.proportional,
        attitude_derivative=attitude.derivative,
        posture=np.zeros(0),
        torque_proportional=1.0,
        torque_integral=1.0,
    )
    weights = settings.weights
    weights.thrust_rate = 1e-9
    settings.weights = weights
    settings.initial_thrusts = settings.initial_thrusts * (1.0 + np.array(imbalance))
    model = dyn.load_urdf(study.build_robot(study.baseline), joints=[])
    return dyn.simulate_flight(model, settings), model, settings


def poles_of(history, count):
    """Poles (3,) of a decaying history, from the linear recurrence of every count-th sample."""
    sampled = history[::count]
    system = np.column_stack([sampled[2:-1], sampled[1:-2], sampled[:-3]])
    recurrence = np.linalg.lstsq(system, sampled[3:], rcond=None)[0]
    return np.sort_complex(np.log(np.roots([1.0, *-recurrence]).astype(complex)) / (count * STEP))


def test_a_flight_shows_the_poles_of_the_position(hexarotor):
    gains = linear_gains(4.0, 0.7, 0.6)
    log, _, _ = flown(hexarotor, gains, AttitudeGains(1.0, 7.0), [0.02] * 6)
    found = poles_of(log.com[:, 2] - log.com_reference[:, 2], 20)
    np.testing.assert_allclose(found, np.sort_complex(gains.poles), rtol=0.05)


def test_a_flight_shows_the_poles_of_the_attitude(hexarotor):
    gains = AttitudeGains(0.3, 3.0)
    log, model, settings = flown(hexarotor, linear_gains(4.0, 0.7, 0.6), gains, [0.02, -0.02] * 3)
    inertia = dyn.locked_inertia(model, settings.base_pose, [])[-1, -1]
    error = np.einsum("nij,nik->njk", log.rotation_reference, log.base_rotation)
    found = poles_of(0.5 * (error[:, 1, 0] - error[:, 0, 1]), 20)
    np.testing.assert_allclose(found, np.sort_complex(gains.poles(inertia)), rtol=0.05)
