"""A bent plate: one leg at the wall, one under the shelf, with a rounded inner corner."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass

from codesign.geometry.profile import Path
from codesign.geometry.shape import Extrusion, Frame, Shape
from codesign.parts import Part, parameter

WIDTH, LEG, FILLET = 30.0, 60.0, 5.0  # mm


@dataclass(frozen=True)
class Bracket(Part):
    """x points away from the wall, z up; the shelf lies on the upper leg."""

    reach: float = parameter("mm", minimum=30.0)
    thickness: float = parameter("mm", minimum=2.0, maximum=20.0)
    _: KW_ONLY
    name: str = "bracket"
    density: float = 2700.0

    def shape(self) -> Shape:
        """The side view, extruded across the width."""
        t = self.thickness
        side = (
            Path(0.0, -LEG).line(t, -LEG).line(t, -t, radius=FILLET).line(self.reach, -t)
            .line(self.reach, 0.0).line(0.0, 0.0, face="seat").close(face="wall")
        )  # fmt: skip
        across = Frame((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0))
        return Extrusion(side, -WIDTH / 2.0, WIDTH / 2.0, across)
