"""Arm of a multirotor: a flange, a drawn tube and a tilted seat for the motor, welded into one piece.

Part frame (mm): x = 0 is the mounting plane on the hub, x points outwards along the tube's axis, z up.
"""

from __future__ import annotations

import math
from dataclasses import KW_ONLY, dataclass

import numpy as np

from codesign.geometry.profile import Path, Vector
from codesign.geometry.shape import Frame, Revolution, Shape, cylinder
from codesign.parts.part import Part, parameter
from codesign.units import DEGREE, MILLIMETER

FLANGE, FLANGE_WIDTH, ROOT_FILLET = 4.0, 8.0, 6.0  # thickness, beyond the tube, where tube and flange meet
SEAT_RADIUS, SEAT_THICKNESS, TUBE_END = 12.0, 4.0, 16.0  # of the motor's seat; the tube beyond the motor's axis


@dataclass(frozen=True)
class Arm(Part):
    """Tube of `diameter` and `wall` that carries a motor at `length`, turned by `tilt` about the tube's axis."""

    length: float = parameter("mm", minimum=80.0, maximum=600.0)
    tilt: float = parameter("deg", minimum=-60.0, maximum=60.0)
    diameter: float = parameter("mm", minimum=8.0, maximum=40.0)
    wall: float = parameter("mm", minimum=0.5, maximum=5.0)
    _: KW_ONLY
    name: str = "arm"
    density: float = 2700.0

    def check(self) -> None:
        """The tube is hollow."""
        self.limit("wall", maximum=self.diameter / 2.0 - 2.0, because="2 mm left inside the tube")

    def through_holes(self) -> int:
        """The bore."""
        return 1

    def shape(self) -> Shape:
        """Rod and flange turned in one, the seat's saddle on it, and the bore through all of them."""
        outer, end = self.diameter / 2.0, self.length + TUBE_END
        rod = (
            Path(0.0, 0.0).line(end, 0.0).line(end, outer).line(FLANGE, outer, radius=ROOT_FILLET)
            .line(FLANGE, outer + FLANGE_WIDTH).line(0.0, outer + FLANGE_WIDTH).close(face="mount")
        )  # fmt: skip
        saddle = cylinder(SEAT_RADIUS, 0.0, outer + SEAT_THICKNESS, end_face="seat")
        along = Frame((0.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
        bore = cylinder(outer - self.wall, -1.0, end + 1.0, along)
        return Revolution(rod) + saddle.rotated("x", self.tilt).moved(self.length) - bore

    def interfaces(self) -> dict[str, Vector]:
        """motor: center of the seat's upper face, z along the motor's axis [m]."""
        sine, cosine, height = math.sin(self.tilt * DEGREE), math.cos(self.tilt * DEGREE), self.seat_height
        part_T_motor = np.array(
            [
                [1.0, 0.0, 0.0, self.length * MILLIMETER],
                [0.0, cosine, -sine, -sine * height],
                [0.0, sine, cosine, cosine * height],
                [0.0, 0.0, 0.0, 1.0],
            ]
        )
        return {"motor": part_T_motor}

    @property
    def seat_height(self) -> float:
        """Of the seat's upper face above the tube's axis [m]."""
        return (self.diameter / 2.0 + SEAT_THICKNESS) * MILLIMETER
