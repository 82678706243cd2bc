"""Strut that carries one gimballed jet: mounting plate, bar and jet seat in one piece.

Part frame (mm): x = 0 is the mounting plane on the frame, x points outwards, z up; y = 0 is the symmetry plane.
"""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass

import numpy as np

from codesign.geometry.profile import Path, Vector
from codesign.geometry.shape import Extrusion, Frame, Shape, cylinder
from codesign.parts.part import Part, parameter
from codesign.units import MILLIMETER

PLATE, WIDTH, SEAT_RADIUS = 12.0, 24.0, 24.0
ROOT_FILLET = 6.0  # where bar and plate meet: the stressed corner


@dataclass(frozen=True)
class Strut(Part):
    """Bar of section 24 × `height` that holds the jet's seat `reach` outside of the mounting plane."""

    reach: float = parameter("mm", minimum=80.0, maximum=500.0)
    height: float = parameter("mm", minimum=12.0, maximum=80.0)
    _: KW_ONLY
    name: str = "strut"
    density: float = 2810.0

    def shape(self) -> Shape:
        """Side view extruded across the bar's width, and the round seat at its end."""
        half, plate = self.height / 2.0, self.height / 2.0 + 20.0
        side = (
            Path(0.0, -plate).line(PLATE, -plate).line(PLATE, -half, radius=ROOT_FILLET).line(self.reach, -half)
            .line(self.reach, half).line(PLATE, half, radius=ROOT_FILLET).line(PLATE, plate).line(0.0, plate)
            .close(face="mount")
        )  # fmt: skip
        across = Frame((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0))
        seat = cylinder(SEAT_RADIUS, -half - 4.0, half, Frame((self.reach, 0.0, 0.0)), start_face="seat")
        return Extrusion(side, -WIDTH / 2.0, WIDTH / 2.0, across) + seat

    def interfaces(self) -> dict[str, Vector]:
        """jet: center of the seat's lower face, axes of the part [m]."""
        part_T_jet = np.eye(4)
        part_T_jet[:3, 3] = np.array([self.reach, 0.0, -self.height / 2.0 - 4.0]) * MILLIMETER
        return {"jet": part_T_jet}
