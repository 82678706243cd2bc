"""Flight: reproduction of the published robots, histories, settings."""

import copy
import pickle
from pathlib import Path

import numpy as np
import pytest

import ironcub_flight
import published_robots
from codesign import dynamics as dyn
from codesign.errors import UrdfError

# Script objectives of the published robots (shared/data/published/README.md), in the order of
# published_robots.OUTPUTS.
PUBLISHED = {
    "optim1": (4.69508996, 106.07285930, 67.55456783, 301.37911992, 294.10473992, 656.84292784),
    "optim3": (6.98706386, 107.58307995, 66.44305356, 278.23660247, 274.27670015, 659.81837134),
}


def load(shared_data: Path, robot: str) -> dyn.Model:
    urdf = (shared_data / "published" / f"{robot}.urdf").read_text()
    return dyn.load_urdf(urdf, joints=ironcub_flight.JOINTS, as_published=True)


@pytest.mark.parametrize("robot", PUBLISHED)
def test_published_robot_gives_the_published_objectives(shared_data: Path, robot: str) -> None:
    log = dyn.simulate_flight(load(shared_data, robot), ironcub_flight.settings(1))
    assert log.completed and log.failure_reason is None and log.failure_time is None and log.qp_failures == 0
    np.testing.assert_allclose(published_robots.flown_outputs(log), PUBLISHED[robot], rtol=2e-9)  # all printed digits
    assert not log.ground_touched
    assert log.max_torque < 34.5 and log.max_com_error < 0.16


# A sample of the 237 rows that benchmarks/published/flights.py keeps, over all forearm lengths, with indefinite and
# with definite mass matrices; the published program drops base rotations below 1e-6 rad per step: rows 195 and 268.
ROWS = (
    "0 66 195 268 438 490 172 323 488 114 464 280 372 236 350 231 168 257 396 391 65 355 167 491 51".split()  # noqa: SIM905
)


@pytest.mark.parametrize("row_id", ROWS)
def test_published_row_gives_the_published_outputs(shared_data: Path, row_id: str) -> None:
    rows = {row["id"]: row for row in published_robots.read_rows(shared_data / "published" / "designs.csv")}
    optim1 = (shared_data / "published" / "optim1.urdf").read_text()
    urdf = published_robots.published_robot(optim1, rows[row_id])
    settings = ironcub_flight.settings(1)
    settings.rotation_deadband = 1e-6
    log = dyn.simulate_flight(dyn.load_urdf(urdf, joints=settings.joints, as_published=True), settings)
    expected = published_robots.published_outputs(rows[row_id])
    np.testing.assert_allclose(published_robots.flown_outputs(log), expected, rtol=1e-7)


def test_unphysical_inertias_are_refused_unless_asked_for(shared_data: Path) -> None:
    urdf = (shared_data / "published" / "optim1.urdf").read_text()
    with pytest.raises(UrdfError, match='"r_elbow_1" with those fixed to it: non-physical inertia'):
        dyn.load_urdf(urdf, joints=ironcub_flight.JOINTS)


def test_histories_are_read_only_views_that_outlive_the_log(shared_data: Path) -> None:
    settings = ironcub_flight.settings(1)
    settings.duration = 0.8
    log = dyn.simulate_flight(load(shared_data, "optim1"), settings)
    joints = log.joint_positions
    assert joints.shape == (101, 23) and joints.flags.c_contiguous and not joints.flags.owndata
    assert np.shares_memory(joints, log.joint_positions)
    assert log.base_rotation.shape == (101, 3, 3) and log.time.shape == (101,)
    np.testing.assert_allclose(log.base_rotation @ np.swapaxes(log.base_rotation, 1, 2), [np.eye(3)] * 101, atol=1e-13)
    with pytest.raises(ValueError, match="read-only"):
        joints[0, 0] = 1.0
    first = joints[0].copy()
    del log
    np.testing.assert_array_equal(joints[0], first)


def test_settings_name_what_is_wrong(shared_data: Path) -> None:
    with pytest.raises(TypeError, match="Gains has no attribute 'postur'"):
        dyn.Gains(postur=np.ones(3))
    settings = ironcub_flight.settings(1)
    settings.initial_joints = np.zeros(22)
    with pytest.raises(ValueError, match=r"initial_joints: has 22 values, must have one per joint \(23\)"):
        settings.validate()
    with pytest.raises(ValueError, match=r"step: is 0\.000000, must be positive"):
        dyn.simulate_flight(load(shared_data, "optim1"), dyn.FlightSettings())


def test_default_settings_are_of_no_robot() -> None:
    settings = dyn.FlightSettings()
    assert settings.joints == [] and settings.actuators == [] and settings.groups == [] and settings.trajectory == []
    given = (settings.gains, settings.weights, settings.limits, settings.command_speeds, settings.failure)
    for part in given:
        numbers = [getattr(part, name) for name, kind in vars(type(part)).items() if isinstance(kind, property)]
        assert not any(np.any(number) for number in numbers), part


def test_settings_copy_pickle_and_print() -> None:
    settings = ironcub_flight.settings(3)
    settings.integrator = dyn.Integrator.runge_kutta_4
    for twin in (copy.deepcopy(settings), copy.copy(settings), pickle.loads(pickle.dumps(settings))):
        assert repr(twin) == repr(settings)
        twin.gains.posture = np.zeros(23)
        assert settings.gains.posture[0] == 30.0
    assert "start=18" not in repr(settings) and "end=42" in repr(settings)


def test_settings_are_changed_in_place_through_their_groups() -> None:
    settings = ironcub_flight.settings(1)
    settings.weights.torque = 0.5
    settings.disturbances.wind_force = [1.0, 2.0, 3.0]
    assert settings.weights.torque == 0.5
    np.testing.assert_array_equal(settings.disturbances.wind_force, [1.0, 2.0, 3.0])
    assert settings.samples == 5251
