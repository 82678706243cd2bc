"""A part whose body is a STEP file of another program, with a bore of its own. Prints its mass and writes a STEP file.

python examples/imported/step_strut.py [folder for the files]
"""

import sys
from dataclasses import KW_ONLY, dataclass
from pathlib import Path

from codesign.geometry.shape import Frame, Shape, cylinder
from codesign.parts import Part, imported_file, parameter, write_step


@dataclass(frozen=True)
class Strut(Part):
    """The bar of strut.step, 80 x 16 x 12 mm with the faces `mount` and `tip`, with a bore across it."""

    bore: float = parameter("mm", minimum=3, maximum=10)
    place: float = parameter("mm", minimum=10, maximum=70)
    _: KW_ONLY
    name: str = "strut"
    density: float = 2700.0

    def check(self) -> None:
        """A wall of 3 mm beside the bore."""
        self.limit("bore", maximum=16 - 6, because="3 mm wall beside the bore")

    def through_holes(self) -> int:
        """The bore."""
        return 1

    def shape(self) -> Shape:
        """Another content of the file is refused: its hash stands here, and so in the hash of a study."""
        bar = imported_file(Path(__file__).with_name("strut.step"), sha256="cdea9f77ff8e6d54")
        return bar - cylinder(self.bore / 2, -1, 13, Frame((self.place, 0, 0)))


def main(folder: Path) -> None:
    """Builds one variant."""
    part = Strut(bore=6, place=60)
    properties = part.mass_properties()
    print(f"{part.title}: {1e3 * properties.mass:.2f} g, center of mass {(1e3 * properties.com).round(2)} mm")
    print(f"faces: {', '.join(part.faces)}; surface: {len(part.surface().triangles)} triangles")
    write_step(part, folder / "strut_bored.step")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path.cwd())
