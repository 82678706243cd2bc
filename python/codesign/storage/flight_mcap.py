"""The history of a flight as ROS 2 messages in an MCAP file, which plotting tools show as named curves."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import numpy as np

from codesign import dynamics as dyn
from codesign.errors import LibraryError
from codesign.files import temporary_folder
from codesign.transforms import Matrix, quaternion

JOINTS, JETS, COMMANDS, BASE = "/joint_states", "/jets", "/jet_commands", "/odom"
JOINT_STATE, ODOMETRY = "sensor_msgs/msg/JointState", "nav_msgs/msg/Odometry"
FLIGHT, STRING = "/flight", "std_msgs/msg/String"
NANOSECONDS = 1e9


def write_mcap(
    log: dyn.FlightLog,
    settings: dyn.FlightSettings,
    base_link: str,
    path: str | os.PathLike[str],
    metadata: dict[str, str],
) -> None:
    """Messages of every sample, ROS 2 CDR, stamped with the flight's time from 0.

    /joint_states: positions, velocities, torques as effort. /jets: thrusts as effort [N]. /jet_commands: commands as
    effort, in the unit of the jets' dynamics. /odom: pose of the base link in the world; its twist in base axes, as the
    message wants it. /flight: once, the metadata as JSON.

    Raises: LibraryError without rosbags.
    """
    try:
        from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
        from rosbags.typesys import Stores, get_typestore
    except ImportError as error:
        raise LibraryError.of(error, "a flight log as MCAP") from error
    path = Path(path)
    store = get_typestore(Stores.ROS2_HUMBLE)
    with temporary_folder(path) as folder:
        bag = folder / "bag"
        writer = Writer(bag, version=9, storage_plugin=StoragePlugin.MCAP)
        writer.set_compression(CompressionMode.STORAGE, CompressionFormat.ZSTD)
        with writer:
            messages = _Messages(log, settings, base_link, store.types)
            topics = {JOINTS: JOINT_STATE, JETS: JOINT_STATE, COMMANDS: JOINT_STATE, BASE: ODOMETRY}
            channels = {topic: writer.add_connection(topic, kind, typestore=store) for topic, kind in topics.items()}
            words = store.types[STRING](data=json.dumps(metadata))
            flight = writer.add_connection(FLIGHT, STRING, typestore=store)
            writer.write(flight, 0, store.serialize_cdr(words, STRING))
            for k in range(log.samples):
                for topic, message in messages.of(k).items():
                    time = round(float(log.time[k]) * NANOSECONDS)
                    writer.write(channels[topic], time, store.serialize_cdr(message, topics[topic]))
        next(bag.glob("*.mcap")).replace(path)


class _Messages:
    """The messages of a sample, as the typestore's classes."""

    def __init__(self, log: dyn.FlightLog, settings: dyn.FlightSettings, base_link: str, types: Any) -> None:
        self.log, self.types, self.base_link = log, types, base_link
        self.joints, self.jets = list(settings.joints), [jet.frame for jet in settings.actuators]
        self.quaternions = quaternion(log.base_rotation)

    def of(self, k: int) -> dict[str, Any]:
        log, empty = self.log, np.zeros(0)
        return {
            JOINTS: self._state(k, self.joints, log.joint_positions[k], log.velocity[k, 6:], log.torque[k]),
            JETS: self._state(k, self.jets, empty, empty, log.thrust[k]),
            COMMANDS: self._state(k, self.jets, empty, empty, log.thrust_command[k]),
            BASE: self._odometry(k),
        }

    def _header(self, k: int, frame: str) -> Any:
        seconds, rest = divmod(round(float(self.log.time[k]) * NANOSECONDS), int(NANOSECONDS))
        stamp = self.types["builtin_interfaces/msg/Time"](sec=seconds, nanosec=rest)
        return self.types["std_msgs/msg/Header"](stamp=stamp, frame_id=frame)

    def _state(self, k: int, names: list[str], position: Matrix, velocity: Matrix, effort: Matrix) -> Any:
        position, velocity, effort = (np.ascontiguousarray(values) for values in (position, velocity, effort))
        header = self._header(k, "")
        return self.types[JOINT_STATE](header=header, name=names, position=position, velocity=velocity, effort=effort)

    def _odometry(self, k: int) -> Any:
        types, log = self.types, self.log
        world_R_base = log.base_rotation[k]
        linear, angular = (
            types["geometry_msgs/msg/Vector3"](*(world_R_base.T @ v).tolist())
            for v in (log.velocity[k, :3], log.velocity[k, 3:6])
        )
        w, x, y, z = self.quaternions[k].tolist()
        pose = types["geometry_msgs/msg/Pose"](
            position=types["geometry_msgs/msg/Point"](*log.base_position[k].tolist()),
            orientation=types["geometry_msgs/msg/Quaternion"](x=x, y=y, z=z, w=w),
        )
        unknown = np.zeros(36)
        return types[ODOMETRY](
            header=self._header(k, "world"),
            child_frame_id=self.base_link,
            pose=types["geometry_msgs/msg/PoseWithCovariance"](pose=pose, covariance=unknown),
            twist=types["geometry_msgs/msg/TwistWithCovariance"](
                twist=types["geometry_msgs/msg/Twist"](linear=linear, angular=angular), covariance=unknown
            ),
        )
