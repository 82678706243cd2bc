"""`codesign stress` on a STEP file: faces by name and number, holes by radius."""

import math
from dataclasses import dataclass

import numpy as np
import pytest

from codesign import fem
from codesign.cli.stress import stress_document
from codesign.errors import CodesignError
from codesign.fem.holes import cylinder_of, holes
from codesign.geometry import Shape, box, cylinder
from codesign.parts import Part, write_step
from codesign.parts.materials import named_material


@dataclass(frozen=True)
class Plate(Part):
    """A plate with two holes of 6 mm, one of 8 mm and a boss."""

    name: str = "plate"
    density: float = 2700.0

    def shape(self) -> Shape:
        plate = box((0, 0, 0), (60, 30, 8), x0="clamp")
        for x, radius in ((12, 3), (24, 3), (36, 4)):
            plate = plate - cylinder(radius, -1, 9).moved(x, 15, 0)
        return plate + cylinder(5, 8, 14, end_face="pad").moved(50, 15, 0)


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("step")
    write_step(Plate(), folder / "plate.step")
    Plate().write_stl(folder / "plate.stl")
    return folder


def run(path, fix, load):
    return stress_document(path, 1e-3, named_material("ergal"), fix, load, edge_length_mm=4.0)


def test_from_a_step_file_to_a_safety_factor_by_face_names(files):
    document = run(files / "plate.step", ["face:clamp"], ["face:pad: 0 0 -200"])
    clamp, pad = document["places"]
    assert clamp["area"] == pytest.approx(30 * 8 * 1e-6, rel=1e-6)
    assert pad["area"] == pytest.approx(math.pi * 25 * 1e-6, rel=0.02)
    assert 1.0 < document["safety_factor"] < 1000.0
    assert document["reaction_force"] == pytest.approx([0.0, 0.0, 200.0], abs=1e-6)


def test_holes_are_chosen_by_their_radius_in_step_and_stl(files):
    for name in ("plate.step", "plate.stl"):
        document = run(
            files / name, ["hole:r=3"], ["face:pad: 0 0 -200" if name == "plate.step" else "near:50,15,14: 0 0 -200"]
        )
        assert document["places"][0]["area"] == pytest.approx(2 * 2 * math.pi * 3 * 8 * 1e-6, rel=0.02)


@pytest.mark.parametrize(
    ("fix", "message"),
    [
        ("face:clmp", "no face 'clmp'.*'clamp'"),
        ("face:99", "no face 'face 99'"),
        ("hole:r=5", r"no hole of radius 5 mm; the holes have radii of 3, 4 mm"),
        ("hole:r=-1", "radius must be positive"),
        ("face:", "expected near"),
    ],
)
def test_faces_that_are_not_there_are_answered_by_what_is(files, fix, message):
    with pytest.raises(CodesignError, match=message):
        run(files / "plate.step", [fix], ["face:pad: 0 0 -200"])


def test_a_boss_is_no_hole_and_a_plane_no_cylinder(files):
    surface = fem.label_by_angle(fem.load_surface(files / "plate.stl", 1e-3))
    radii = sorted(round(hole.radius * 1e3, 2) for hole in holes(surface).values())
    assert radii == [3.0, 3.0, 4.0]
    for index in range(len(surface.face_names)):
        found = cylinder_of(surface, np.asarray(surface.face) == index)
        if found is not None and not found.hollow:
            assert found.radius == pytest.approx(5e-3, rel=1e-3)
            assert abs(found.axis[2]) == pytest.approx(1.0, abs=1e-6)
            assert found.center[:2] == pytest.approx([0.05, 0.015], abs=1e-5)
