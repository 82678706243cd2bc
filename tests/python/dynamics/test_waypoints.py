"""Paths through way-points: their ends, smoothness, optimality, and who refuses what."""

import numpy as np
import pytest

import ironcub_flight
import ironcub_predictive as whole
from codesign import dynamics as dyn

POINTS = [(1.0, 0.0, 0.5, 0.0), (2.0, -1.0, 1.0, 40.0), (0.5, 0.5, 0.0, -20.0)]


def path(kind: dyn.WaypointKind, rest: float = 0.0) -> dyn.Path:
    waypoints = [
        dyn.Waypoint(position=np.array(point[:3]), yaw=np.deg2rad(point[3]), duration=duration, rest=rest)
        for point, duration in zip(POINTS, (2.0, 3.0, 1.5), strict=True)
    ]
    return dyn.Path(dyn.WaypointPath(start=1.0, waypoints=waypoints, kind=kind))


@pytest.mark.parametrize("kind", [dyn.WaypointKind.stop, dyn.WaypointKind.through], ids=lambda k: k.name)
def test_paths_reach_their_points_and_rest_at_both_ends(kind: dyn.WaypointKind) -> None:
    flown = path(kind)
    for time, point in zip((3.0, 6.0, 7.5), POINTS, strict=True):
        np.testing.assert_allclose(flown.at(time).value, [*point[:3], np.deg2rad(point[3])], atol=1e-12)
    for time in (0.0, 1.0, 7.5, 20.0):
        assert np.abs(flown.at(time).velocity).max() < 1e-10
        assert np.abs(flown.at(time).acceleration).max() < 1e-9
    np.testing.assert_array_equal(flown.at(0.5).value, np.zeros(4))
    np.testing.assert_array_equal(flown.at(20.0).value, flown.at(7.5).value)
    assert flown.end == pytest.approx(7.5)


def test_derivatives_are_those_of_the_position() -> None:
    flown, step = path(dyn.WaypointKind.through), 1e-5
    for time in (1.3, 2.7, 4.1, 6.9):
        before, now, after = (flown.at(time + shift) for shift in (-step, 0.0, step))
        np.testing.assert_allclose(now.velocity, (after.value - before.value) / (2 * step), atol=1e-8)
        np.testing.assert_allclose(now.acceleration, (after.velocity - before.velocity) / (2 * step), atol=1e-7)
        np.testing.assert_allclose(now.jerk, (after.acceleration - before.acceleration) / (2 * step), atol=1e-6)


def test_a_leg_that_stops_has_the_peaks_of_minimum_jerk() -> None:
    leg = dyn.Waypoint(position=np.array([3.0, 0.0, 4.0]), duration=2.0)
    flown = dyn.Path(dyn.WaypointPath(waypoints=[leg]))
    assert flown.peak_speed == pytest.approx(1.875 * 5.0 / 2.0, rel=1e-3)
    assert flown.peak_acceleration == pytest.approx(5.774 * 5.0 / 4.0, rel=1e-3)


def test_a_smooth_path_has_four_continuous_derivatives_and_less_jerk_than_one_that_stops() -> None:
    smooth, stopping = path(dyn.WaypointKind.through), path(dyn.WaypointKind.stop)
    for time in (3.0, 6.0):
        before, after = smooth.at(time - 1e-9), smooth.at(time + 1e-9)
        np.testing.assert_allclose(before.velocity, after.velocity, atol=1e-6)
        np.testing.assert_allclose(before.acceleration, after.acceleration, atol=1e-6)
        np.testing.assert_allclose(before.jerk, after.jerk, atol=1e-5)
        snap = [(smooth.at(time + s).jerk - smooth.at(time + s - 1e-6).jerk) / 1e-6 for s in (-1e-5, 2e-5)]
        np.testing.assert_allclose(snap[0], snap[1], atol=2e-2)
    times = np.linspace(1.0, 7.5, 2000)
    assert sum((smooth.at(t).jerk ** 2).sum() for t in times) < sum((stopping.at(t).jerk ** 2).sum() for t in times)


def test_a_rest_splits_a_smooth_path() -> None:
    resting, stopping = path(dyn.WaypointKind.through, rest=1.0), path(dyn.WaypointKind.stop, rest=1.0)
    for time in np.linspace(0.0, 11.0, 45):
        np.testing.assert_allclose(resting.at(time).value, stopping.at(time).value, atol=1e-12)


@pytest.mark.parametrize(
    ("wrong", "reason"),
    [({"duration": 0.0}, "duration"), ({"rest": -1.0}, "rest"), ({"position": np.full(3, np.nan)}, "position")],
)
def test_impossible_points_are_refused(wrong: dict, reason: str) -> None:
    with pytest.raises(ValueError, match=reason):
        dyn.Path(dyn.WaypointPath(waypoints=[dyn.Waypoint(**wrong)]))


def test_both_controllers_fly_way_points_and_stand_a_pulse() -> None:
    climb = dyn.WaypointPath(waypoints=[dyn.Waypoint(position=np.array([0.0, 0.0, 0.5]), duration=3.0)])
    push = dyn.Pulse(start=1.0, duration=0.2, force=np.array([20.0, 0.0, 0.0]))
    momentum = ironcub_flight.settings()
    momentum.trajectory, momentum.duration = [], 8.0
    for settings in (momentum, whole.settings(reference=False)):
        settings.path, settings.pulses, settings.duration = climb, [push], 8.0
        log = dyn.simulate_flight(whole.robot(), settings)
        assert log.completed
        rise = log.com_reference[-1] - log.com_reference[0]
        np.testing.assert_allclose(rise, [0.0, 0.0, 0.5], atol=1e-12)
        assert np.linalg.norm(log.com[-1] - log.com_reference[-1]) < 0.1
        calm = dyn.simulate_flight(whole.robot(), calmed(settings))
        assert np.abs(calm.com - log.com)[:, 0].max() > 0.005


def calmed(settings: dyn.FlightSettings) -> dyn.FlightSettings:
    settings.pulses = []
    return settings
