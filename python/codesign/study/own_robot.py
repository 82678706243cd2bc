"""A runnable study of jets on a robot of the user's: `codesign new NAME --urdf robot.urdf`."""

from __future__ import annotations

import json
import math
import os
import shutil
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from string import Template
from typing import Any

import numpy as np

from codesign import dynamics as dyn
from codesign.errors import StudyError, UrdfError
from codesign.files import write_text
from codesign.robot.description import RobotDescription
from codesign.robot.inertial import Inertial
from codesign.robot.mounts import Mount, arms_around, arms_on, arms_to, is_held, mended, propellers, start_posture
from codesign.studies.hexarotor.arm import Arm
from codesign.study.gains import attitude_gains, linear_gains
from codesign.study.imports import PACKAGE
from codesign.study.reference import SCHEMA_FILE, study_schema
from codesign.transforms import rpy_from_rotation

GRAVITY = 9.81  # m/s²
THRUST_TO_WEIGHT = 2.0
MOTOR_MASS = 0.009  # kg per newton of its largest thrust
DRAG_TORQUE = 0.016  # N m per newton, of a propeller
FULL_THRUST_TIME = 0.2  # s from none to all
TILT_DEG = 25.0  # of jets around a robot: enough to push sideways
LANDING = 3.0  # times the largest thrust
ARM_STRENGTH = 240e6 / 4.0  # Pa: yield of the arms' alloy over the wanted safety factor
TUBES_MM = (8, 10, 12, 16, 20, 25, 30, 40)  # outer diameters of drawn tubes with a wall of 2 mm
WALL_MM = 2.0
ATTITUDE_POLE, POSITION_FREQUENCY = 20.0, 1.2  # rad/s
LEAST_TORQUE = 1.0  # N m


@dataclass(frozen=True, slots=True)
class NewStudy:
    """What was written, and what to know about it."""

    files: list[Path]
    notes: list[str]


@dataclass(frozen=True, slots=True)
class _Sizes:
    """Of one jet and its arm. mass: of the whole robot [kg]; thrusts [N]; diameter, length [mm]; tilt [deg]."""

    mass: float
    hover: float
    most: float
    diameter: int
    length: float
    tilt: float


def study_of_robot(
    folder: str | Path, urdf: str | Path, jets: Sequence[str] = (), mounts: Sequence[str] = (), count: int = 6
) -> NewStudy:
    """Writes a runnable study of jets on tube arms for a robot.

    Args:
        folder: new. urdf: the robot. jets: its links that are propellers or jets; by default those of a multirotor are
            found by name. mounts: links that get an arm with a jet each. count: of arms around the robot, where neither
            is given or found.
    Raises: StudyError: the folder holds files, or both jets and mounts are given; UrdfError: the robot cannot be read,
        has an impossible inertia, or lacks a link.
    """
    folder = Path(folder)
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise StudyError(f"{folder}: exists and is not empty")
    if jets and mounts:
        raise StudyError("either jets (links that push) or mounts (links that get a jet), not both")
    robot, repaired = mended(RobotDescription.load(urdf, as_published=True))
    if robot.total_mass <= 0.0:
        raise UrdfError(f"{urdf}: the robot has no mass")
    posture = start_posture(robot)
    given = list(jets) or ([] if mounts else propellers(robot))
    tilt = TILT_DEG if not given and not mounts and count >= 6 else 0.0
    number = len(given) or len(mounts) or count
    motor_share = 0.0 if given else MOTOR_MASS
    estimate = robot.total_mass / (1.0 - motor_share * THRUST_TO_WEIGHT * GRAVITY / math.cos(math.radians(tilt)))
    thrust = THRUST_TO_WEIGHT * estimate * GRAVITY / number / math.cos(math.radians(tilt))
    motor = _motor(motor_share * thrust)
    if given:
        armed, placed = arms_to(robot, given)
        placed = sorted(placed, key=lambda mount: mount.azimuth)
    elif mounts:
        armed, placed = arms_on(robot, mounts, motor, posture)
    else:
        armed, placed = arms_around(robot, count, motor, posture)
    sizes = _sizes(armed, placed, tilt)
    steerable = bool(mounts and posture) or (tilt > 0.0)
    text = Template((PACKAGE / "study" / "own_robot.toml").read_text(encoding="utf-8")).substitute(
        _values(folder.name, armed, placed, sizes, posture, steerable)
    )
    files = _write(folder, armed, text)
    return NewStudy(files, _notes(robot, placed, repaired, given, posture))


def _motor(mass: float) -> Inertial:
    """A short cylinder, twice as wide as high."""
    radius = 0.02 * (max(mass, 1e-3) / 0.1) ** (1.0 / 3.0)
    moment = mass * radius**2
    return Inertial(mass, np.array([0.0, 0.0, radius]), np.diag([0.34, 0.34, 0.5]) * moment)


def _sizes(robot: RobotDescription, mounts: Sequence[Mount], tilt: float) -> _Sizes:
    """Thrust that hovers and twice of it, and the thinnest tube that bears it with a safety factor of four."""
    length = max(round(1e2 * max(mount.length for mount in mounts)) * 10.0, 80.0)
    mass, diameter = robot.total_mass, TUBES_MM[0]
    slope = math.cos(math.radians(tilt))
    for diameter in TUBES_MM:
        arm = Arm(length, tilt, float(diameter), min(WALL_MM, diameter / 2.0 - 2.0)).mass_properties().mass
        mass = robot.total_mass + len(mounts) * (arm - robot.inertial(mounts[0].arm).mass)  # type: ignore[union-attr]
        bending = THRUST_TO_WEIGHT * mass * GRAVITY / len(mounts) / slope * 1e-3 * length
        outer, inner = 1e-3 * diameter, 1e-3 * (diameter - 2.0 * WALL_MM)
        section = math.pi * (outer**4 - inner**4) / (32.0 * outer)
        if bending / section <= ARM_STRENGTH:
            break
    hover = mass * GRAVITY / len(mounts) / slope
    return _Sizes(mass, hover, THRUST_TO_WEIGHT * hover, diameter, length, tilt)


def _values(
    name: str,
    robot: RobotDescription,
    mounts: Sequence[Mount],
    sizes: _Sizes,
    posture: Mapping[str, float],
    steerable: bool,
) -> dict[str, Any]:
    """What the template takes."""
    near = TUBES_MM.index(sizes.diameter)
    tubes = [d for d in TUBES_MM[max(near - 1, 1) : near + 3] if d >= 10] or [10]
    tube = max(sizes.diameter, 10)
    step = max(round(0.25 * sizes.length, -1), 10.0)
    model = dyn.load_urdf(robot.to_text(), joints=list(posture))
    inertia = np.diag(dyn.locked_inertia(model, np.eye(4), list(posture.values()))[-3:, -3:])
    position = linear_gains(POSITION_FREQUENCY)
    attitude = attitude_gains(float(np.exp(np.log(inertia).mean())), ATTITUDE_POLE)
    efforts = [limit.effort or 0.0 for joint in posture if (limit := robot.joint(joint).limit) is not None]
    torque = max([LEAST_TORQUE, *efforts])
    senses = [DRAG_TORQUE * (-1) ** k for k in range(len(mounts))]
    return {
        "name": name,
        "robot": robot.name.replace('"', "'"),
        "count": len(mounts),
        "mass": f"{sizes.mass:.3g}",
        "length": f"{sizes.length:g}",
        "length_min": f"{max(sizes.length - step, 80.0):g}",
        "length_max": f"{sizes.length + step:g}",
        "tilt": f"{sizes.tilt:g}",
        "tilt_min": "10" if sizes.tilt else "0",
        "tilt_max": "40" if sizes.tilt else "10",
        "tubes": "\n".join(f"{d}x2 = {{ diameter = {d}.0, wall = {WALL_MM} }}" for d in tubes),
        "tube": f"{tube}x2",
        "hover_thrust": f"{sizes.hover:.3g}",
        "max_thrust": f"{sizes.most:.3g}",
        "min_thrust": f"{0.02 * sizes.most:.2g}",
        "landing": f"{LANDING * sizes.most:.3g}",
        "thrust_rate": f"{sizes.most / FULL_THRUST_TIME:.3g}",
        "placements": "\n\n".join(_placement(mount, k % 2 == 1) for k, mount in enumerate(mounts)),
        "frames": ", ".join(json.dumps(mount.jet) for mount in mounts),
        "axes": ", ".join(str(list(mount.axis)) for mount in mounts),
        "reactions": ", ".join(map(str, senses)),
        "joint_group": _joint_group(robot, posture),
        "linear_proportional": f"{position.proportional:.4g}",
        "linear_derivative": f"{position.derivative:.4g}",
        "linear_momentum": f"{position.momentum:.4g}",
        "attitude_proportional": f"{attitude.proportional:.4g}",
        "attitude_derivative": f"{attitude.derivative:.4g}",
        "torque": f"{torque:g}",
        "torque_rate": f"{10.0 * torque:g}",
        "windows": _windows(steerable),
    }


def _placement(mount: Mount, mirrored: bool) -> str:
    rpy = [round(math.degrees(angle), 9) + 0.0 for angle in rpy_from_rotation(mount.jet_rotation)]
    turned = f", interface_T_child = {{ rpy_deg = {rpy} }}" if any(rpy) else ""
    lines = ["[[parts.placements]]", f"link = {json.dumps(mount.arm)}"]
    lines += ['mirror = "y" # left and right in turn'] if mirrored else []
    lines += [f'joints = {{ {json.dumps(mount.joint)} = {{ interface = "motor"{turned} }} }}']
    return "\n".join(lines)


def _joint_group(robot: RobotDescription, posture: Mapping[str, float]) -> str:
    """The section of the joints; those that are not in it stay at zero."""
    held = [joint for joint in robot.moving_joint_names if is_held(robot, joint)]
    comment = f"\n# Held at zero, since they have no range: {', '.join(held)}." if held else ""
    if not posture:
        return comment + "\n"
    ranges = []
    for joint in posture:
        limit = robot.joint(joint).limit
        assert limit is not None  # a joint without range is held
        low, high = (math.degrees(end or 0.0) for end in (limit.lower, limit.upper))
        ranges.append([math.ceil(low), math.floor(high)])
    lines = [
        comment,
        "[[flight.joint_groups]]",
        'name = "joints"',
        f"joints = {json.dumps(list(posture))}",
        f"initial_rad = {[round(angle, 4) for angle in posture.values()]}",
        f"ranges_deg = {ranges}",
        "posture_gain_hz = 5.0",
        "velocity_weight = 1.0",
        "",
    ]
    return "\n".join(lines) + "\n"


def _windows(steerable: bool) -> str:
    """Commands of the trajectory; without banking, robots whose jets are parallel only climb and turn."""
    commands = [(1, 3, "up = 1"), (3, 5, "forward = 1"), (5, 7, "left = 1"), (8, 10, "yaw = 1")]
    chosen = commands if steerable else [commands[0], commands[3]]
    return "\n".join(f"  {{ from_s = {start}, to_s = {end}, {what} }}," for start, end, what in chosen)


def _write(folder: Path, robot: RobotDescription, text: str) -> list[Path]:
    folder.mkdir(parents=True, exist_ok=True)
    robot = robot.with_mesh_filenames(_mesh_paths(robot, folder))
    study = write_text(folder / "study.toml", text)
    schema = write_text(folder / SCHEMA_FILE, json.dumps(study_schema(), indent=1) + "\n")
    arm = Path(shutil.copy(PACKAGE / "studies" / "hexarotor" / "arm.py", folder / "arm.py"))
    return [study, robot.write(folder / "robot.urdf"), arm, schema]


def _mesh_paths(robot: RobotDescription, folder: Path) -> dict[str, str]:
    """Relative mesh paths as they are from the new folder."""
    names = {name for _, name in robot.mesh_filenames() if "://" not in name and not Path(name).is_absolute()}
    start = robot.directory or Path.cwd()
    return {name: os.path.relpath(start / name, folder.resolve()) for name in names}


def _notes(
    robot: RobotDescription,
    mounts: Sequence[Mount],
    repaired: Sequence[str],
    given: Sequence[str],
    posture: Mapping[str, float],
) -> list[str]:
    notes = [f"{robot.name}: {robot.total_mass:.3g} kg, {len(posture)} joints with ranges"]
    if given:
        notes.append(f"jets: its links {', '.join(mount.jet for mount in mounts)}, on new arms")
    else:
        notes.append(
            f"jets: {len(mounts)} new ones on arms; --jets names links that are jets, --mount links that get one"
        )
    if repaired:
        notes.append(f"links of no mass with an inertia that no body has, mended: {', '.join(repaired)}")
    return notes
