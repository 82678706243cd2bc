"""A part drawn in build123d (extra `build123d`), for a study as any other. Prints its mass and writes a STEP file.

python examples/imported/build123d_clip.py [folder for the files]
"""

import sys
from dataclasses import KW_ONLY, dataclass
from pathlib import Path

import build123d as bd

from codesign.geometry.shape import Shape
from codesign.parts import Part, imported, parameter, write_step


@dataclass(frozen=True)
class Clip(Part):
    """A plate with rounded corners, two screws and a post with a filleted root."""

    width: float = parameter("mm", minimum=30, maximum=80)
    height: float = parameter("mm", minimum=10, maximum=60)
    _: KW_ONLY
    name: str = "clip"
    density: float = 2700.0
    thickness: float = 6.0

    def through_holes(self) -> int:
        """The two screws."""
        return 2

    def shape(self) -> Shape:
        """Everything is build123d's; faces get their names by its selectors."""
        with bd.BuildPart() as clip:
            with bd.BuildSketch():
                bd.RectangleRounded(self.width, self.width / 2, 5)
            bd.extrude(amount=self.thickness)
            with bd.Locations((0, 0, self.thickness)):
                bd.Cylinder(6, self.height, align=(bd.Align.CENTER, bd.Align.CENTER, bd.Align.MIN))
            root = clip.edges().filter_by(bd.GeomType.CIRCLE).filter_by(lambda e: abs(e.radius - 6) < 1e-6)
            bd.fillet(root.sort_by(bd.Axis.Z)[0], 2)
            with bd.GridLocations(self.width - 12, 0, 2, 1):
                bd.CounterBoreHole(2.25, 4, 2.5)
        faces = clip.faces().sort_by(bd.Axis.Z)
        return imported(clip, {"mount": faces[0], "seat": faces[-1]})


def main(folder: Path) -> None:
    """Builds one variant."""
    part = Clip(width=50, height=25)
    properties = part.mass_properties()
    print(f"{part.title}: {1e3 * properties.mass:.2f} g, center of mass {(1e3 * properties.com).round(2)} mm")
    print(f"faces: {', '.join(part.faces)}; surface: {len(part.surface().triangles)} triangles")
    write_step(part, folder / "clip.step")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path.cwd())
