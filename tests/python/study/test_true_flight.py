"""What a flight depends on: start, plant, rates, rotors, the unknown. Figures are of two independent simulators."""

from collections.abc import Sequence
from functools import cache

import numpy as np
import pytest

import ironcub_flight
from codesign import dynamics as dyn
from codesign import load_study

ORIGINAL, SHORT = (15, 42, 80, 108), (1, 48, 88, 50)
ROTORS = np.array([0.137, 0.137, 0.0795] + 8 * [0.0795] + 12 * [0.137])  # kg m², at the joints


@cache
def robot(design: tuple[int, ...]) -> dyn.Model:
    named = dict(zip(("angle", "distance", "offset", "length"), design, strict=True))
    return dyn.load_urdf(load_study("ironcub_paper").build_robot(named), joints=ironcub_flight.JOINTS)


def exact(torque_updates: int = 1, substeps: int = 4) -> dyn.FlightSettings:
    """The published flight on an exact plant."""
    settings = ironcub_flight.settings(1)
    settings.integrator = dyn.Integrator.runge_kutta_4
    settings.torque_updates, settings.substeps = torque_updates, substeps
    return settings


def rms(log: dyn.FlightLog) -> tuple[float, float, float]:
    assert log.completed, log.failure_reason
    return log.rms.momentum, log.rms.joint_velocity, log.rms.thrust


@pytest.mark.parametrize(
    ("design", "expected"),
    [(ORIGINAL, (1.662383, 0.422283, 666.2827)), (SHORT, (1.497805, 0.368136, 657.1080))],
)
def test_the_plant_is_that_of_two_other_simulators(design: tuple[int, ...], expected: Sequence[float]) -> None:
    assert rms(dyn.simulate_flight(robot(design), exact())) == pytest.approx(expected, rel=1e-6)


def test_rotors_known_to_the_controller_end_what_the_held_torque_does() -> None:
    settings = exact()
    settings.rotor_inertia = ROTORS
    found = rms(dyn.simulate_flight(robot(ORIGINAL), settings))
    assert found == pytest.approx((1.662050, 0.256640, 665.8081), rel=2e-5)


def test_so_does_a_torque_loop_of_1_ms_under_a_momentum_loop_of_8_ms() -> None:
    _, velocity, _ = rms(dyn.simulate_flight(robot(ORIGINAL), exact(torque_updates=8, substeps=1)))
    assert velocity == pytest.approx(0.2637, abs=1e-3)


def test_a_start_in_the_flown_trim_halves_the_momentum_error() -> None:
    settings = ironcub_flight.settings(1)
    settings.step, settings.integrator, settings.duration = 0.002, dyn.Integrator.runge_kutta_4, 9.6
    log = dyn.simulate_flight(robot(ORIGINAL), settings)
    settings.base_pose = np.block([[log.base_rotation[-1], np.array([[0.0], [0.0], [0.8]])], [np.eye(4)[3:]]])
    settings.initial_joints, settings.initial_thrusts = log.joint_positions[-1], log.thrust[-1]
    settings.initial_free_fall, settings.duration = False, 42.0
    found = rms(dyn.simulate_flight(robot(ORIGINAL), settings))
    assert found == pytest.approx((0.44663, 0.22453, 665.258), rel=1e-4)


def hovering(observer: float = 0.0) -> dyn.FlightSettings:
    """A flight that starts in a hover inside the robot's own joint ranges."""
    settings = exact(torque_updates=4, substeps=1)
    settings.initial_free_fall = False
    settings.limits = changed(settings.limits, joint_lower=np.zeros(0), joint_upper=np.zeros(0))
    settings.gains = changed(settings.gains, observer=observer)
    settings.trim = dyn.TrimSettings(joints=ironcub_flight.LEFT_ARM + ironcub_flight.RIGHT_ARM)
    settings.rotor_inertia = ROTORS
    return settings


def changed(part: object, **values: object) -> object:
    for name, value in values.items():
        setattr(part, name, value)
    return part


def test_a_trimmed_start_stays_where_it_is() -> None:
    settings = hovering()
    settings.duration, settings.trajectory = 4.0, []
    log = dyn.simulate_flight(robot(ORIGINAL), settings)
    assert log.completed
    assert log.max_com_error < 1e-4
    assert np.abs(log.momentum_error).max() < 1e-2
    weight = robot(ORIGINAL).total_mass * 9.81
    axes_up = log.thrust.sum(axis=1)
    assert axes_up[0] > weight
    assert np.ptp(log.thrust, axis=0).max() < 0.1


def test_what_cannot_hover_is_lost_at_once() -> None:
    settings = hovering()
    for jet in (jets := settings.actuators):
        jet.thrust_max = 150.0
    settings.actuators = jets
    log = dyn.simulate_flight(robot(ORIGINAL), settings)
    assert (log.completed, log.samples, log.failure_time) == (False, 0, 0.0)
    assert log.failure_reason == "no hover near the initial state"


def test_the_observer_takes_an_unknown_moment_from_the_attitude() -> None:
    tilt = {}
    for observer in (0.0, 5.0):
        settings = hovering(observer)
        settings.duration, settings.trajectory = 10.0, []
        settings.disturbances = dyn.Disturbances(wind_force=np.array([0.0, 1.5, 0.0]))
        log = dyn.simulate_flight(robot(ORIGINAL), settings)
        turn = log.rotation_reference[-1].T @ log.base_rotation[-1]
        tilt[observer] = np.degrees(np.arccos(np.clip(0.5 * (np.trace(turn) - 1.0), -1.0, 1.0)))
        if observer:
            assert log.unmodeled_force[-1, :3] == pytest.approx([0.0, 1.5, 0.0], abs=0.02)
    assert tilt[0.0] > 1.0
    assert tilt[5.0] < 0.1 * tilt[0.0]


def test_seeds_of_a_batch_are_the_flights_alone() -> None:
    settings = hovering(5.0)
    settings.duration = 2.0
    settings.disturbances = dyn.Disturbances(gust_deviation=np.full(3, 5.0), mass_deviation=0.01, thrust_deviation=0.01)
    batch = dyn.simulate_flights(robot(ORIGINAL), settings, [3, 4])
    for seed, log in zip((3, 4), batch, strict=True):
        settings.disturbances = changed(settings.disturbances, seed=seed)
        np.testing.assert_array_equal(log.velocity, dyn.simulate_flight(robot(ORIGINAL), settings).velocity)


def test_a_flight_at_half_its_steps_meets_the_same_gusts() -> None:
    settings = hovering(5.0)
    settings.duration, settings.trajectory = 4.0, []
    settings.disturbances = dyn.Disturbances(gust_deviation=np.full(3, 5.0), seed=3)
    whole = dyn.simulate_flight(robot(ORIGINAL), settings)
    settings.step *= 0.5
    half = dyn.simulate_flight(robot(ORIGINAL), settings)
    assert np.abs(whole.wind - half.wind[::2]).max() < 0.3  # each is of the torque period before its sample
    errors = [log.momentum_error[:, :3] for log in (whole, half)]
    assert np.sqrt((errors[0] ** 2).mean()) == pytest.approx(np.sqrt((errors[1] ** 2).mean()), rel=0.03)


def test_an_inertia_held_between_momentum_qps_changes_little() -> None:
    settings = hovering()
    renewed = rms(dyn.simulate_flight(robot(ORIGINAL), settings))
    settings.hold_inertia = True
    held = rms(dyn.simulate_flight(robot(ORIGINAL), settings))
    assert held != renewed
    assert held == pytest.approx(renewed, rel=2e-3)


def test_what_a_tank_holds_ends_the_flight() -> None:
    settings = hovering(5.0)
    settings.duration, settings.trajectory = 4.0, []
    settings.tank = dyn.Tank(frame="chest", position=np.array([-0.15, 0.0, 0.1]), fuel=0.1, consumption=4.7e-5)
    log = dyn.simulate_flight(robot(ORIGINAL), settings)
    assert not log.completed
    assert log.failure_reason == "the tank is empty"
    assert log.failure_time == pytest.approx(0.1 / (4.7e-5 * log.thrust.sum(axis=1).mean()), abs=0.02)


def test_refuses_settings_that_do_not_fit_each_other() -> None:
    for change, message in (
        ({"initial_free_fall": True}, "a robot that starts in hover does not fall"),
        ({"delays": dyn.Delays(torque=0.003)}, "delays.torque: is not a whole number of periods"),
        ({"rotor_inertia": np.ones(3)}, "rotor_inertia: has 3 values"),
        ({"disturbances": dyn.Disturbances(wind_velocity=np.ones(3))}, "acts on drag areas, and there are none"),
        ({"torque_updates": 0}, "torque_updates: must be at least 1"),
        ({"tank": dyn.Tank(frame="chest", fuel=80.0)}, "less mass or inertia than the fuel"),
    ):
        settings = hovering()
        for name, value in change.items():
            setattr(settings, name, value)
        with pytest.raises(ValueError, match=message):
            dyn.simulate_flight(robot(ORIGINAL), settings)
