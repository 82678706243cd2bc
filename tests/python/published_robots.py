"""Robots of the published optimization run, remade from its table by the authors' rule.

The rule (not this project's own, which replaces inertials whole): start from the published Optim1 URDF; in the bracket
and forearm links replace mass and the three diagonal entries of the tensor, leaving center of mass, axes and products
of inertia as they are; move the jets by the formulas below; print every number with five significant digits.
"""

import csv
import re
from math import cos, radians, sin
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from codesign import dynamics as dyn

OUTPUTS = ("ang_mom_err", "lin_mom_err", "torso_vel_err", "l_arm_vel_err", "r_arm_vel_err", "thrust_mean_total_N")


def read_rows(table: Path) -> list[dict[str, str]]:
    """Rows of the published table that have outputs."""
    with table.open(newline="") as file:
        return [row for row in csv.DictReader(file) if row["error"] != "1"]


def published_outputs(row: dict[str, str]) -> NDArray[np.float64]:
    """Script objectives of a row, (6,) in the order of OUTPUTS."""
    return np.array([float(row[name]) for name in OUTPUTS])


def flown_outputs(log: dyn.FlightLog) -> NDArray[np.float64]:
    """The same of a flight."""
    parts = log.script_parts
    return np.array([parts.angular_momentum, parts.linear_momentum, *parts.joint_velocity, log.script.thrust])


def _digits(value: float) -> str:
    return f"{value:.5g}"


def _replace_inertial(urdf: str, link: str, mass: float, moments: list[float]) -> str:
    def edit(match: re.Match[str]) -> str:
        text = re.sub(r'<mass value="[^"]*"', f'<mass value="{_digits(mass)}"', match.group(0), count=1)
        for axis, moment in zip(("ixx", "iyy", "izz"), moments, strict=True):
            text = re.sub(rf'{axis}="[^"]*"', f'{axis}="{_digits(moment)}"', text, count=1)
        return text

    return re.sub(rf'<link name="{link}">.*?</inertial>', edit, urdf, count=1, flags=re.DOTALL)


def _replace_origin(urdf: str, joint: str, xyz: list[float], rpy: list[float] | None = None) -> str:
    def edit(match: re.Match[str]) -> str:
        text = re.sub(r'xyz="[^"]*"', f'xyz="{" ".join(map(_digits, xyz))}"', match.group(0), count=1)
        if rpy is not None:
            text = re.sub(r'rpy="[^"]*"', f'rpy="{" ".join(map(_digits, rpy))}"', text, count=1)
        return text

    return re.sub(rf'<joint name="{joint}".*?<origin[^>]*>', edit, urdf, count=1, flags=re.DOTALL)


def published_robot(optim1_urdf: str, row: dict[str, str]) -> str:
    """URDF text of a row's robot as the authors' program wrote it."""
    angle, distance = radians(float(row["angle_paper_deg"])), float(row["distance_mm"])
    offset, length = float(row["offset_mm"]), float(row["length_mm"])
    support = [
        (23.0274 + distance * cos(angle) + 15.0 * sin(angle)) / 1000.0,
        0.0,
        -(15.0 + distance * sin(angle) - 15.0 * cos(angle)) / 1000.0,
    ]
    urdf = optim1_urdf
    for side, sign in (("l", -1.0), ("r", 1.0)):
        for link, part in ((f"chest_{side}_bracket", "bracket"), (f"{side}_forearm", "forearm")):
            moments = [float(row[f"{axis}_{part}_kgmm2"]) * 1e-6 for axis in ("ixx", "iyy", "izz")]
            urdf = _replace_inertial(urdf, link, float(row[f"mass_{part}_kg"]), moments)
        urdf = _replace_origin(urdf, f"{side}_turbine_support", support, [0.0, angle, 0.0])
        urdf = _replace_origin(urdf, f"{side}_elbow_turbine", [-(210.0 + length) / 1000.0, 0.0, sign * offset / 1000.0])
    return urdf
