"""Logs of a flight give back its numbers exactly, with names and units."""

import csv
import json

import numpy as np
import pyarrow.parquet as parquet
import pytest
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore

from codesign import dynamics as dyn
from codesign.chain.flight import find_trajectory, flight_settings, joint_names
from codesign.chain.study import load_study
from codesign.storage.flight_log import flown_columns, flown_metadata, write_csv, write_parquet
from codesign.storage.flight_mcap import write_mcap
from codesign.transforms import quaternion, rotation_about


def fly(jets: str) -> tuple[dyn.FlightLog, dyn.FlightSettings]:
    study = load_study("ironcub_paper")
    settings = flight_settings(study.config.flight, find_trajectory(study.config, "envelope"), jets)
    settings.duration = 1.0
    model = dyn.load_urdf(study.base_robot.to_text(), joints=joint_names(study.config.flight))
    return dyn.simulate_flight(model, settings), settings


@pytest.fixture(scope="module")
def flight():
    return fly("integrator")


def test_csv_reads_back_exactly(flight, tmp_path):
    log, settings = flight
    columns = flown_columns(log, settings)
    write_csv(columns, tmp_path / "flight.csv")
    with (tmp_path / "flight.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == log.samples == 126
    read = {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}
    np.testing.assert_array_equal(read["time_s"], log.time)
    np.testing.assert_array_equal(read["base_position.z_m"], log.base_position[:, 2])
    np.testing.assert_array_equal(read["base_angular_velocity.y_rad_s"], log.velocity[:, 4])
    elbow = settings.joints.index("r_elbow")
    for name, values in (
        ("joint_position.r_elbow_rad", log.joint_positions[:, elbow]),
        ("joint_velocity.r_elbow_rad_s", log.velocity[:, 6 + elbow]),
        ("joint_torque.r_elbow_n_m", log.torque[:, elbow]),
        ("thrust.chest_l_jet_turbine_n", log.thrust[:, 2]),
        ("thrust_command.chest_l_jet_turbine_n_s", log.thrust_command[:, 2]),
        ("com_reference.x_m", log.com_reference[:, 0]),
    ):
        np.testing.assert_array_equal(read[name], values)
    q = np.column_stack([read[f"base_quaternion.{axis}"] for axis in "wxyz"])
    np.testing.assert_allclose(rotation(q), log.base_rotation, atol=1e-15)
    assert np.abs(np.diff(q, axis=0)).max() < 0.1  # no jumps of sign, although the robot flies near 180° of yaw


def test_commands_have_the_unit_of_the_jets(flight):
    log, settings = fly("turbine")
    names = [column.name for column in flown_columns(log, settings)]
    assert "thrust_command.l_arm_jet_turbine_percent" in names
    assert len(names) == len(set(names)) == len(flown_columns(*flight))
    sliding = {column.name for column in flown_columns(*flight, ["l_elbow"])} - {c.name for c in flown_columns(*flight)}
    assert sliding == {
        "joint_position.l_elbow_m",
        "joint_velocity.l_elbow_m_s",
        "joint_torque.l_elbow_n",
        "joint_velocity_command.l_elbow_m_s",
    }


def test_parquet_has_units_and_axes(flight, tmp_path):
    log, settings = flight
    columns = flown_columns(log, settings)
    write_parquet(columns, tmp_path / "flight.parquet", flown_metadata(log, settings, {"study": "ironcub_paper"}))
    table = parquet.read_table(tmp_path / "flight.parquet")
    assert table.column_names == [column.name for column in columns]
    for column in columns:
        np.testing.assert_array_equal(table[column.name].to_numpy(), column.values)
    field = table.schema.field("base_velocity.x_m_s").metadata
    assert field == {b"unit": b"m/s", b"axes": b"world axes", b"of": b"x"}
    assert table.schema.metadata[b"integrator"] == b"euler"
    assert table.schema.metadata[b"step_s"] == b"0.008"
    assert json.loads(table.schema.metadata[b"columns"]) == table.column_names


def test_mcap_is_read_by_name_and_exact(flight, tmp_path):
    log, settings = flight
    write_mcap(log, settings, "root_link", tmp_path / "flight.mcap", {"study": "ironcub_paper"})
    assert [path.name for path in tmp_path.iterdir()] == ["flight.mcap"]
    found: dict[str, list] = {}
    with AnyReader([tmp_path / "flight.mcap"], default_typestore=get_typestore(Stores.ROS2_HUMBLE)) as reader:
        for connection, time, raw in reader.messages():
            found.setdefault(connection.topic, []).append((time, reader.deserialize(raw, connection.msgtype)))
    assert {topic: len(messages) for topic, messages in found.items()} == {
        "/flight": 1,
        **dict.fromkeys(("/joint_states", "/jets", "/jet_commands", "/odom"), log.samples),
    }
    assert json.loads(found["/flight"][0][1].data) == {"study": "ironcub_paper"}
    for k, (time, message) in enumerate(found["/joint_states"]):
        assert time == round(log.time[k] * 1e9) == message.header.stamp.sec * 10**9 + message.header.stamp.nanosec
        assert message.name == settings.joints
        np.testing.assert_array_equal(message.position, log.joint_positions[k])
        np.testing.assert_array_equal(message.velocity, log.velocity[k, 6:])
        np.testing.assert_array_equal(message.effort, log.torque[k])
    for k, (_, message) in enumerate(found["/odom"]):
        angular = message.twist.twist.angular
        world = log.base_rotation[k] @ [angular.x, angular.y, angular.z]
        np.testing.assert_allclose(world, log.velocity[k, 3:6], atol=1e-15)
    np.testing.assert_array_equal(found["/jets"][-1][1].effort, log.thrust[-1])


def test_quaternions_of_all_angles():
    rng = np.random.default_rng(0)
    axes = rng.normal(size=(50, 3))
    angles = [0.0, 1e-9, 1e-3, 1.0, 2.0, np.pi - 1e-9, np.pi]
    R = np.array([rotation_about(axis / np.linalg.norm(axis), angle) for axis in axes for angle in angles])
    q = quaternion(R)
    assert q.shape == (350, 4)
    assert (q[:, 0] >= 0.0).all()
    np.testing.assert_allclose(np.linalg.norm(q, axis=1), 1.0, atol=1e-15)
    np.testing.assert_allclose(rotation(q), R, atol=1e-15)
    np.testing.assert_array_equal(quaternion(np.eye(3)), [1.0, 0.0, 0.0, 0.0])


def rotation(q):
    """Rotation matrices (n, 3, 3) of quaternions w, x, y, z (n, 4)."""
    w, x, y, z = q.T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), 2, 0)
