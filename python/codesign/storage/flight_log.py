"""The history of a flight as a table with named, dimensioned columns: CSV and Parquet."""

from __future__ import annotations

import csv
import io
import json
import os
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from codesign import dynamics as dyn
from codesign.errors import LibraryError
from codesign.files import replacing, write_text
from codesign.robot.jets import COMMAND_UNITS, dynamics_kind
from codesign.transforms import Matrix, quaternion

NAMES_OF_UNITS = {"m/s": "m_s", "rad/s": "rad_s", "N/s": "n_s", "N m": "n_m", "N": "n", "%": "percent", "": ""}
WORLD, BASE = "world axes", "base axes"


@dataclass(frozen=True)
class Column:
    """One quantity over the samples of a flight: what it is of ("base", a joint, a jet), unit, axes if any, values."""

    quantity: str
    subject: str
    unit: str
    values: Matrix
    axes: str = ""

    @property
    def name(self) -> str:
        """quantity, subject and unit: joint_position.elbow_rad."""
        stem = f"{self.quantity}.{self.subject}" if self.subject else self.quantity
        unit = NAMES_OF_UNITS.get(self.unit, self.unit)
        return f"{stem}_{unit}" if unit else stem

    @property
    def description(self) -> dict[str, str]:
        """For the metadata of a column."""
        return {key: value for key, value in (("unit", self.unit), ("axes", self.axes), ("of", self.subject)) if value}


def flown_columns(log: dyn.FlightLog, settings: dyn.FlightSettings, slides: Collection[str] = ()) -> list[Column]:
    """All histories of a flight; rotations as quaternions w, x, y, z without jumps of sign.

    slides: joints of the flight that move along their axis, in meters.
    Torque, thrust command and wind of a sample act from it to the next one, the thrust of a sample holds at it.
    """
    jets = [jet.frame for jet in settings.actuators]
    joints = list(settings.joints)
    columns = [Column("time", "", "s", log.time)]
    columns += _vectors("base_position", "m", log.base_position, WORLD)
    columns += _quaternions("base_quaternion", log.base_rotation)
    columns += _vectors("base_velocity", "m/s", log.velocity[:, :3], WORLD)
    columns += _vectors("base_angular_velocity", "rad/s", log.velocity[:, 3:6], WORLD)
    angles, rates, torques = (
        [slide if name in slides else turn for name in joints]
        for turn, slide in (("rad", "m"), ("rad/s", "m/s"), ("N m", "N"))
    )
    columns += _each("joint_position", joints, angles, log.joint_positions)
    columns += _each("joint_velocity", joints, rates, log.velocity[:, 6:])
    columns += _each("joint_torque", joints, torques, log.torque)
    columns += _each("joint_velocity_command", joints, rates, log.joint_velocity_command)
    columns += _each("thrust", jets, ["N"] * len(jets), log.thrust)
    commands = [COMMAND_UNITS[dynamics_kind(jet)] for jet in settings.actuators]
    columns += _each("thrust_command", jets, commands, log.thrust_command)
    columns += _each("thrust_rate_command", jets, ["N/s"] * len(jets), log.thrust_rate_command)
    columns += _vectors("com", "m", log.com, WORLD)
    columns += _vectors("com_reference", "m", log.com_reference, WORLD)
    columns += _vectors("com_velocity_reference", "m/s", log.com_velocity_reference, WORLD)
    columns += _quaternions("base_quaternion_reference", log.rotation_reference)
    columns += _vectors("base_angular_velocity_reference", "rad/s", log.angular_velocity_reference, BASE)
    columns += _vectors("wind_force", "N", log.wind, WORLD)
    return columns


def flown_metadata(log: dyn.FlightLog, settings: dyn.FlightSettings, more: dict[str, str]) -> dict[str, str]:
    """What a reader must know to repeat the flight; `more`: study, design, trajectory."""
    return {
        **more,
        "status": "completed" if log.completed else f"lost: {log.failure_reason} at {log.failure_time} s",
        "step_s": repr(log.step),
        "integrator": settings.integrator.name,
        "substeps": str(settings.substeps),
        "joints": ",".join(settings.joints),
        "jets": ",".join(jet.frame for jet in settings.actuators),
        "quaternions": "w x y z, world_R_base",
    }


def write_csv(columns: Sequence[Column], path: str | os.PathLike[str]) -> None:
    """One line per sample; numbers read back exactly."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([column.name for column in columns])
    writer.writerows(np.column_stack([column.values for column in columns]).tolist())
    write_text(Path(path), text.getvalue())


def write_parquet(columns: Sequence[Column], path: str | os.PathLike[str], metadata: dict[str, str]) -> None:
    """Parquet with units and axes of each column in its metadata. Raises: LibraryError without pyarrow."""
    try:
        import pyarrow as pa
        import pyarrow.parquet as pq
    except ImportError as error:
        raise LibraryError.of(error, "a flight log as Parquet") from error
    fields = [pa.field(column.name, pa.float64(), nullable=False, metadata=column.description) for column in columns]
    schema = pa.schema(fields, metadata={**metadata, "columns": json.dumps([column.name for column in columns])})
    table = pa.table([np.ascontiguousarray(column.values) for column in columns], schema=schema)
    encodings: dict[str, Any] = {column.name: "BYTE_STREAM_SPLIT" for column in columns}
    with replacing(path) as temporary:
        pq.write_table(table, temporary, compression="zstd", use_dictionary=False, column_encoding=encodings)


def _vectors(quantity: str, unit: str, values: Matrix, axes: str) -> list[Column]:
    return [Column(quantity, "xyz"[i], unit, values[:, i], axes) for i in range(3)]


def _quaternions(quantity: str, rotations: Matrix) -> list[Column]:
    q = quaternion(rotations)
    turns = np.sign(np.einsum("ni,ni->n", q[1:], q[:-1]))
    turns[turns == 0.0] = 1.0
    q[1:] *= np.cumprod(np.where(np.isfinite(turns), turns, 1.0))[:, None]
    return [Column(quantity, "wxyz"[i], "", q[:, i], "world_R_base") for i in range(4)]


def _each(quantity: str, names: Sequence[str], units: Sequence[str], values: Matrix) -> list[Column]:
    return [Column(quantity, name, unit, column) for name, unit, column in zip(names, units, values.T, strict=True)]
