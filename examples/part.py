"""A part of your own: parameters first, shape after. Prints its mass and writes STL and STEP.

python examples/part.py [folder for the files]
"""

import sys
from dataclasses import KW_ONLY, dataclass
from pathlib import Path

from codesign.geometry.profile import Path as Outline
from codesign.geometry.shape import Extrusion, Frame, Shape, at_points, stepped_hole
from codesign.parts import Part, parameter, write_step


@dataclass(frozen=True)
class MotorAngle(Part):
    """Angle bracket: a foot with two M5 screws and an upright plate with a bore and four M3 holes for a motor."""

    width: float = parameter("mm", minimum=40, maximum=120)
    height: float = parameter("mm", minimum=40, maximum=150)
    bore: float = parameter("mm", minimum=5, maximum=60)
    _: KW_ONLY
    name: str = "motor_angle"
    density: float = 2700.0
    thickness: float = 6.0

    def check(self) -> None:
        """The motor's four holes lie 5 mm outside of its bore."""
        clearance = self.bore / 2 + 5 + 1.6 + 3
        self.limit("width", minimum=2 * clearance, because="3 mm wall beside the motor's holes")
        self.limit("height", minimum=2 * clearance + self.thickness + 8, because="3 mm wall around the motor's holes")

    def shape(self) -> Shape:
        """Side view extruded over the width, then the holes."""
        t, foot, center = self.thickness, 45.0, self.height - self.bore / 2 - 9.6
        side = (
            Outline(0, 0).line(foot, 0, face="mount").line(foot, t).line(t, t, radius=8)
            .line(t, self.height, face="seat").line(0, self.height).close()
        )  # fmt: skip
        body = Extrusion(side, -self.width / 2, self.width / 2, Frame(x=(1, 0, 0), y=(0, 0, 1)))
        screw = stepped_hole((2.75, -1, t), (5, t, t + 9))
        motor = Frame((0, 0, center), x=(0, 1, 0), y=(0, 0, 1))  # its z points along x, through the upright plate
        reach = self.bore / 2 + 5
        holes = [stepped_hole((self.bore / 2, -1, t + 1))]
        holes += [at_points(stepped_hole((1.6, -1, t + 1)), [(-reach, 0), (reach, 0), (0, -reach), (0, reach)])]
        shape = body - at_points(screw, [(30, -self.width / 4), (30, self.width / 4)])
        for hole in holes:
            shape = shape - hole.placed(motor)
        return shape


def main(folder: Path) -> None:
    """Builds one variant."""
    part = MotorAngle(width=60, height=70, bore=22)
    properties = part.mass_properties()
    print(f"{part.title}: {1e3 * properties.mass:.2f} g, center of mass {(1e3 * properties.com).round(2)} mm")
    print(f"faces: {', '.join(part.faces)}; surface: {len(part.surface().triangles)} triangles")
    part.write_stl(folder / "motor_angle.stl")
    write_step(part, folder / "motor_angle.step")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path.cwd())
