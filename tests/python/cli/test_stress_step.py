"""`codesign stress` on a STEP file: faces by name and number, holes by radius."""

import math
from dataclasses import dataclass

import numpy as np
import pytest

from codesign import fem
from codesign.cli.stress import stress_document
from codesign.cli.stress_file import face_documents, print_faces
from codesign.errors import CodesignError
from codesign.fem.holes import cylinder_of, holes
from codesign.fem.step import load_step
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
        assert document["places"][0]["type"] == "2 cylinders"


@pytest.mark.parametrize(
    ("fix", "message"),
    [
        ("face:clmp", "no face 'clmp'.*'clamp'"),
        ("face:99", "no face 'face 99'; there are face 1, clamp, .*`codesign faces FILE` lists"),
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


@dataclass(frozen=True)
class Angle(Part):
    """Two legs of 6 mm with an inner fillet of 5 mm, a bore of 10 mm, a slot of 6.6 mm."""

    name: str = "angle"
    density: float = 2700.0

    def shape(self) -> Shape:
        legs = box((0, 0, 0), (80, 40, 6)) + box((0, 0, 0), (6, 40, 60))
        corner = box((6, 0, 6), (11, 40, 11)) - cylinder(5, -1, 41).rotated("x", -90).moved(11, 0, 11)
        bore = cylinder(5, -1, 7).rotated("y", 90).moved(0, 20, 40)
        slot = cylinder(3.3, -1, 7).moved(40, 20, 0) + cylinder(3.3, -1, 7).moved(60, 20, 0)
        return legs + corner - bore - slot - box((40, 16.7, -1), (60, 23.3, 7))


@pytest.fixture(scope="module")
def angle(tmp_path_factory):
    path = tmp_path_factory.mktemp("angle") / "angle.step"
    write_step(Angle(), path)
    return path


def test_fillets_and_ends_of_slots_are_no_holes(angle):
    document = run(angle, ["normal:0,0,-1"], ["hole:r=5: bearing 0 0 -500"])
    assert document["places"][1]["area"] == pytest.approx(2 * math.pi * 5 * 6 * 1e-6, rel=0.02)
    with pytest.raises(CodesignError, match="the holes have radii of 5 mm; a round face of this radius does not close"):
        run(angle, ["normal:0,0,-1"], ["hole:r=3.3: 0 0 -500"])


def test_a_bore_in_two_halves_is_a_hole(angle):
    surface = load_step(angle).by_face()
    points, triangles = np.asarray(surface.points), np.asarray(surface.triangles)
    (bore,) = holes(surface)
    upper = (points[triangles].mean(axis=1)[:, 2] > 0.04) & (np.asarray(surface.face) == bore)
    face = np.where(upper, len(surface.face_names), np.asarray(surface.face))
    halves = fem.SurfaceMesh(points, triangles, face.tolist(), [*surface.face_names, "upper half"])
    assert len(holes(halves)) == 2
    only_one = np.asarray(halves.face) != bore
    open_surface = fem.SurfaceMesh(points, triangles[only_one], face[only_one].tolist(), list(halves.face_names))
    assert holes(open_surface) == {}


def test_faces_lists_what_can_be_selected(angle, capsys):
    documents = face_documents(angle)
    print_faces(documents)
    table = capsys.readouterr().out
    assert "face:1" in table and "hole" in table and "cylinder" in table
    assert sorted(round(f["radius"] * 1e3, 2) for f in documents if f["type"] == "cylinder") == [3.3, 3.3, 5.0]
    (bore,) = (f for f in documents if f["type"] == "hole")
    assert bore["center"] == pytest.approx([0.003, 0.020, 0.040], abs=1e-4)
