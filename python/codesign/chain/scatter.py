"""Scatter of what is made: dimensions, material and jet angles of one sample, drawn within a study's tolerances.

A sample is named by its number in the trajectory, `envelope~17`, so that all designs are made with the same luck, and a
run stores and resumes samples as it does other trajectories.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import msgspec
import numpy as np

from codesign.errors import StudyError
from codesign.problem.design_space import DesignValue
from codesign.robot.assembly import PartPlacement, Pose
from codesign.study.config import PartConfig, StudyConfig, TolerancesConfig
from codesign.transforms import rotation_about, rotation_from_rpy, rpy_from_rotation
from codesign.units import DEGREE

MARK = "~"
DEVIATIONS = 3.0  # standard deviations of a tolerance; what is drawn beyond is cut off there
# ISO 2768-1: deviation allowed [mm] up to a nominal length [mm], by class.
LENGTHS = {
    "f": ((6, 0.05), (30, 0.1), (120, 0.15), (400, 0.2), (1000, 0.3), (2000, 0.5)),
    "m": ((6, 0.1), (30, 0.2), (120, 0.3), (400, 0.5), (1000, 0.8), (2000, 1.2)),
    "c": ((3, 0.2), (6, 0.3), (30, 0.5), (120, 0.8), (400, 1.2), (1000, 2.0), (2000, 3.0)),
}


def split_sample(trajectory: str | None) -> tuple[str | None, int | None]:
    """Trajectory without its sample, and the sample's number. Raises: StudyError: no number."""
    if trajectory is None or MARK not in trajectory:
        return trajectory, None
    base, _, number = trajectory.rpartition(MARK)
    if not number.isdecimal():
        raise StudyError(f"trajectory {trajectory!r}: the sample after {MARK} must be a whole number")
    return base or None, int(number)


def sample_name(trajectory: str, sample: int) -> str:
    """A trajectory flown by the robot as it is made in one sample."""
    return f"{trajectory}{MARK}{sample}"


def made(
    config: StudyConfig, design: Mapping[str, DesignValue], sample: int
) -> tuple[StudyConfig, dict[str, DesignValue]]:
    """Configuration and design values of a sample: what parts take in mm and degrees, materials, jet angles.

    Numbers that no part takes as a length or an angle stay. Draws are in the order of the study's file: the same for
    all designs.
    """
    tolerances, rng = config.tolerances, np.random.default_rng([sample, 2768])
    values = dict(design)
    shaped = {variable for part in config.parts for variable in part.parameters.values()}
    for name, variable in config.variables.items():
        share = _share(rng)
        value = values[name]
        if name in shaped and variable.unit and not isinstance(value, str):
            values[name] = value + share * tolerance_of(value, variable.unit, tolerances)
    materials = {}
    factors = {}
    for name, material in config.materials.items():
        stiffness, strength, weight = (
            1.0 + _share(rng) * DEVIATIONS * deviation
            for deviation in (tolerances.young_modulus, tolerances.yield_strength, tolerances.density)
        )
        factors[name] = weight
        materials[name] = msgspec.structs.replace(
            material,
            young_modulus_gpa=material.young_modulus_gpa * stiffness,
            yield_strength_mpa=material.yield_strength_mpa * strength,
            density_kg_m3=material.density_kg_m3 * weight,
        )
    parts = [_tilted(part, factors[part.material], tolerances, rng) for part in config.parts]
    return msgspec.structs.replace(config, materials=materials, parts=parts), values


def tolerance_of(value: float, unit: str, tolerances: TolerancesConfig) -> float:
    """Largest deviation of a length [mm] or an angle [deg]. Raises: StudyError: longer than the standard's table."""
    if unit == "deg":
        return tolerances.angle_deg
    for length, deviation in LENGTHS[tolerances.dimensions]:
        if abs(value) <= length:
            return deviation
    raise StudyError(f"tolerances.dimensions: ISO 2768 has no tolerance for a length of {value:g} mm")


def _share(rng: np.random.Generator) -> float:
    """Of a tolerance: normal, cut off at its ends."""
    return float(np.clip(rng.standard_normal() / DEVIATIONS, -1.0, 1.0))


def _tilted(part: PartConfig, weight: float, tolerances: TolerancesConfig, rng: np.random.Generator) -> PartConfig:
    """The part with its own density scattered, and what hangs on its interfaces tilted about two axes."""
    placements = []
    for place in part.placements:
        joints = {
            name: msgspec.structs.replace(
                attachment, interface_T_child=_turned(attachment.interface_T_child, tolerances.jet_angle_deg, rng)
            )
            for name, attachment in place.joints.items()
        }
        placements.append(_with_joints(place, joints))
    density = None if part.density_kg_m3 is None else part.density_kg_m3 * weight
    return msgspec.structs.replace(part, placements=placements, density_kg_m3=density)


def _with_joints(place: PartPlacement, joints: Mapping[str, object]) -> PartPlacement:
    return msgspec.structs.replace(place, joints=dict(joints))


def _turned(pose: Pose, most_deg: float, rng: np.random.Generator) -> Pose:
    """A pose turned about the interface's x and y axes by angles within the tolerance."""
    about_x, about_y = (_share(rng) * most_deg * DEGREE for _ in range(2))
    turn = rotation_about(np.array([1.0, 0.0, 0.0]), about_x) @ rotation_about(np.array([0.0, 1.0, 0.0]), about_y)
    rpy = rpy_from_rotation(turn @ rotation_from_rpy([angle * DEGREE for angle in pose.rpy_deg]))
    roll, pitch, yaw = (math.degrees(angle) for angle in rpy)
    return msgspec.structs.replace(pose, rpy_deg=(roll, pitch, yaw))
