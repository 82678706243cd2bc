"""What is too heavy for the store and kept for a handful of designs: stress on the parts' surfaces, flight histories.

One compressed file per design, beside the run: `details/<values>.npz`.
"""

from __future__ import annotations

import json
import logging
import zipfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from codesign.files import replacing
from codesign.problem.design_space import value_text
from codesign.problem.evaluation import Evaluation

logger = logging.getLogger(__name__)

FOLDER = "details"
SAMPLES = 1200  # kept of a flight history: one a pixel of a wide chart

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class StressField:
    """Surface of a part.

    points (n, 3) [m]; triangles (m, 3), outward; von_mises (n,) [Pa]; peak: the stress that is judged [Pa].
    """

    points: Array
    triangles: NDArray[np.int64]
    von_mises: Array
    peak: float


@dataclass(frozen=True, slots=True)
class FlightHistory:
    """A flight's time histories, thinned to at most SAMPLES rows; rows are samples, world axes, SI.

    time (k,); com_error (k,) distance from the reference; attitude_error (k,) angle from the reference;
    thrust (k, jets); joint_velocity_error (k, groups) Euclidean norm over each group; base_position (k, 3);
    base_rotation (k, 3, 3); joint_positions (k, joints); com (k, 3); com_reference (k, 3); qp_iterations (k, 2).
    """

    trajectory: str
    jets: tuple[str, ...]
    groups: tuple[str, ...]
    joints: tuple[str, ...]
    arrays: dict[str, Array]

    def __getitem__(self, name: str) -> Array:
        return self.arrays[name]


@dataclass(frozen=True, slots=True)
class Detail:
    """Fields and histories of one design."""

    evaluation: Evaluation
    parts: dict[str, StressField]
    flight: FlightHistory | None


def detail_key(evaluation: Evaluation) -> str:
    """Name of a design's detail file: its values in order, `15-42-80-108`; hyphens of names are doubled."""
    values = evaluation.design.values()
    return "-".join(v.replace("-", "--") if isinstance(v, str) else value_text(v) for v in values)


def save_detail(folder: Path, detail: Detail) -> Path:
    """Writes a detail into `folder`, completely or not at all."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{detail_key(detail.evaluation)}.npz"
    arrays: dict[str, Any] = {}
    head: dict[str, Any] = {"evaluation": detail.evaluation.to_dict(), "peaks": {}}
    for name, part in detail.parts.items():
        head["peaks"][name] = part.peak
        arrays[f"part {name} points"] = part.points.astype(np.float32)
        arrays[f"part {name} triangles"] = part.triangles.astype(np.int32)
        arrays[f"part {name} von_mises"] = part.von_mises.astype(np.float32)
    if detail.flight is not None:
        flight = detail.flight
        head["flight"] = {
            "trajectory": flight.trajectory, "jets": flight.jets, "groups": flight.groups, "joints": flight.joints,
        }  # fmt: skip
        arrays |= {f"flight {name}": values.astype(np.float32) for name, values in flight.arrays.items()}
    with replacing(path) as beside:
        np.savez_compressed(beside, head=np.frombuffer(json.dumps(head).encode(), dtype=np.uint8), **arrays)
    return path


def load_detail(path: Path) -> Detail:
    """Reads what `save_detail` wrote. Raises: OSError, ValueError, KeyError, BadZipFile if the file is not one."""
    with path.open("rb") as file, np.load(file, allow_pickle=False) as archive:
        head = json.loads(archive["head"].tobytes())
        parts = {
            name: StressField(
                archive[f"part {name} points"].astype(float),
                archive[f"part {name} triangles"].astype(np.int64),
                archive[f"part {name} von_mises"].astype(float),
                peak,
            )
            for name, peak in head["peaks"].items()
        }
        flight = None
        if "flight" in head:
            names = {key: tuple(head["flight"][key]) for key in ("jets", "groups", "joints")}
            arrays = {
                key.removeprefix("flight "): archive[key].astype(float)
                for key in archive.files
                if key.startswith("flight ")
            }
            flight = FlightHistory(head["flight"]["trajectory"], **names, arrays=arrays)
    return Detail(Evaluation.from_dict(head["evaluation"]), parts, flight)


def load_details(run_directory: Path) -> dict[str, Detail]:
    """All readable details of a run by `detail_key`; a damaged file counts as absent, with a warning."""
    found = {}
    for path in sorted((run_directory / FOLDER).glob("*.npz")):
        try:
            detail = load_detail(path)
        except (OSError, ValueError, KeyError, zipfile.BadZipFile) as error:
            logger.warning("%s is left out: %s: %s", path, type(error).__name__, error)
            continue
        found[detail_key(detail.evaluation)] = detail
    return found


def rotation_angle(rotation: Array) -> Array:
    """Angles (k,) [rad] of rotations (k, 3, 3); exact for small ones, robust to matrices not quite orthonormal."""
    R = rotation
    axis = np.stack([R[:, 2, 1] - R[:, 1, 2], R[:, 0, 2] - R[:, 2, 0], R[:, 1, 0] - R[:, 0, 1]], axis=1)
    return np.asarray(np.arctan2(np.linalg.norm(axis, axis=1), np.einsum("kii->k", R) - 1.0))


def flight_history(
    log: Any, trajectory: str, jets: tuple[str, ...], joints: tuple[str, ...], groups: dict[str, list[str]]
) -> FlightHistory:
    """Thinned histories of a `dynamics.FlightLog`. groups: joint group -> its joints."""
    stride = max(1, -(-len(log.time) // SAMPLES))
    known = np.isfinite(np.asarray(log.joint_positions)).all(axis=1) & np.isfinite(np.asarray(log.com)).all(axis=1)
    kept = np.flatnonzero(known)[::stride]  # of a lost flight, what comes before
    rotation = np.asarray(log.base_rotation)[kept].reshape(-1, 3, 3)
    reference = np.asarray(log.rotation_reference)[kept].reshape(-1, 3, 3)
    turned = np.swapaxes(reference, 1, 2) @ rotation
    velocity = np.asarray(log.velocity)[kept, 6:] - np.asarray(log.joint_velocity_command)[kept]
    columns = [[joints.index(joint) for joint in members] for members in groups.values()]
    arrays = {
        "time": np.asarray(log.time)[kept].ravel(),
        "com": np.asarray(log.com)[kept],
        "com_reference": np.asarray(log.com_reference)[kept],
        "com_error": np.linalg.norm(np.asarray(log.com)[kept] - np.asarray(log.com_reference)[kept], axis=1),
        "attitude_error": rotation_angle(turned),
        "thrust": np.asarray(log.thrust)[kept],
        "joint_velocity_error": np.array([np.linalg.norm(velocity[:, c], axis=1) for c in columns])
        .reshape(-1, len(velocity))
        .T,
        "base_position": np.asarray(log.base_position)[kept],
        "base_rotation": rotation,
        "joint_positions": np.asarray(log.joint_positions)[kept],
        "qp_iterations": np.asarray(log.qp_iterations)[kept].astype(float),
        "active_bounds": np.asarray(log.active_bounds)[kept].astype(float).ravel(),
    }
    return FlightHistory(trajectory, jets, tuple(groups), joints, arrays)
