"""Clearances of a flown design: its parts as convex pieces, measured over the postures of its flights."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from codesign.chain.flight import joint_names
from codesign.parts.part import COARSE_RESOLUTION, Part
from codesign.robot.clearance import flown_interference
from codesign.robot.hulls import convex_pieces
from codesign.transforms import Matrix
from codesign.units import MILLIMETER

if TYPE_CHECKING:
    from codesign import dynamics as dyn
    from codesign.robot.description import RobotDescription
    from codesign.study.config import StudyConfig


def clearances(
    config: StudyConfig, parts: Mapping[str, Part], robot: RobotDescription, flights: Sequence[dyn.FlightLog]
) -> dict[str, Any]:
    """Clearances over the flown postures of all flights; empty if the study does not ask for them.

    Of a robot that did not fly at all, having no hover, those of the study's initial posture.
    """
    if config.interference is None:
        return {}
    history = np.concatenate([flight.joint_positions for flight in flights])
    times = np.concatenate([flight.time for flight in flights])
    finite = np.isfinite(history).all(axis=1)
    history, times = history[finite], times[finite]
    if not len(history):
        initial = [angle for group in config.flown.joint_groups for angle in group.initial_rad]
        history, times = np.array([initial]), np.zeros(1)
    slices = config.interference.slices
    placed = {part.name: (part.placements, part_pieces(parts[part.name], slices)) for part in config.parts}
    return flown_interference(robot, config.interference, placed, joint_names(config.flown), history, times)


@functools.lru_cache(maxsize=512)
def part_pieces(part: Part, slices: int) -> tuple[Matrix, ...]:
    """Convex pieces of a part, part axes [m]; kept (10 kB each), since designs share parts."""
    solid = part.shared_solid(COARSE_RESOLUTION)  # 0.6 mm inside the largest radius
    return tuple(convex_pieces(solid.points * MILLIMETER, solid.triangles, slices))
