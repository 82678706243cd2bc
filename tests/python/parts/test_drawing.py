"""Drawings: bores as the parts have them, lines on the edges, sizes and captions on the sheet, files that read back."""

import dataclasses
import re
import shutil
import subprocess
from collections import Counter
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from matplotlib.font_manager import FontProperties
from matplotlib.textpath import TextPath
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopoDS import TopoDS

from codesign.errors import GeometryError
from codesign.geometry.brep import build_brep, explore
from codesign.geometry.features import cylinders, flats
from codesign.geometry.shape import Frame, at_points, box, cylinder, stepped_hole
from codesign.parts.bores import bores
from codesign.parts.drawing import Caption, draw_part
from codesign.parts.labels import label_circles
from codesign.parts.sheet import Sheet, write_dxf, write_pdf
from codesign.parts.step import part_breps
from codesign.parts.views import project
from codesign.studies.ironcub.bracket import JetpackBracket
from codesign.studies.ironcub.forearm import ForearmJetSupport

X, Y, Z = np.eye(3)
CAPTION = Caption("plate", "plate width=60", "ergal", 0.1234, 2800.0, 2, "a = 1 mm", "0123456789ab", "plate.step", "me")


@pytest.fixture(scope="module")
def plate():
    """60 x 40 x 10; two bores of 8 with counterbores of 14, 4 deep, from above; a blind one of 5 from the side."""
    drill = stepped_hole((4.0, -1.0, 6.0), (7.0, 6.0, 11.0))
    side = cylinder(2.5, -1.0, 8.0, Frame((0.0, 20.0, 5.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)))
    return build_brep(box((0, 0, 0), (60, 40, 10)) - at_points(drill, [(15, 20), (45, 20)]) - side)


def lengths(strokes):
    return sum(float(np.linalg.norm(np.diff(stroke.points, axis=0), axis=1).sum()) for stroke in strokes)


def words(sheet: Sheet) -> list[str]:
    return [word.text for word in sheet.words]


def test_bores_of_a_plate(plate):
    found = bores(plate)
    listed = Counter((tuple(bore.words), bore.direction, bore.through) for bore in found)
    assert listed[(("⌀14 × 4 / ⌀8 × 6 through",), "+Z", True)] == 2
    (blind,) = [bore for bore in found if not bore.through]
    assert blind.words == ["⌀5 × 8 blind"]
    np.testing.assert_allclose(blind.mouth, [0, 20, 5], atol=1e-9)
    np.testing.assert_allclose(blind.axis, [-1, 0, 0], atol=1e-12)
    assert flats(plate)[0].area == pytest.approx(60 * 40 - 2 * np.pi * 16)


def test_bores_of_shipped_parts_and_their_mirror_images():
    bracket, forearm = JetpackBracket(15, 42), ForearmJetSupport(80, 108)
    mirrored = forearm.mirrored("z", "mirrored")
    breps = part_breps([bracket, forearm, mirrored])
    counted = Counter(tuple(bore.words) for bore in bores(breps[bracket]))
    assert counted[("⌀6 × 3.4 / ⌀3.2 × 10.6 through",)] == 6
    assert counted[("⌀14 × 9 / ⌀8.4 × 6 through",)] == 2
    assert sum(bore.through for bore in bores(breps[bracket])) == bracket.through_holes()
    for part in (forearm, mirrored):
        found = bores(breps[part])
        assert sum(bore.hollow for bore in found) == forearm.through_holes()
        assert {round(2 * c.radius, 3) for c in cylinders(breps[part]) if not c.hollow} == {11.874, 18.0, 25.0, 45.0}


def test_lines_of_a_view_are_the_edges(plate):
    top = project(plate.shape, Z, X)
    circles = sorted(round(stroke.circle[2], 6) for stroke in top.visible if stroke.circle)
    assert circles == [4.0, 4.0, 7.0, 7.0]
    outline = 2 * (60 + 40)
    round_ = 2 * 2 * np.pi * (4 + 7)
    assert lengths(top.visible) == pytest.approx(outline + round_, rel=2e-3)  # chords of circles
    assert lengths(top.hidden) == pytest.approx(2 * 8 + 5, rel=1e-6)  # of the blind bore
    front = project(plate.shape, -Y, X)
    np.testing.assert_allclose(front.bounds, [[0, 0], [60, 10]], atol=1e-9)
    assert lengths(front.visible) == pytest.approx(2 * (60 + 10))
    bare = project(plate.shape, -Y, X, hidden=False)
    assert bare.hidden == ()


def test_views_hold_every_edge_of_a_prism():
    """A wedge without holes: all edges are seen or hidden in each view, each once."""
    wedge = build_brep(box((0, 0, 0), (10, 20, 30)))
    edges = [BRepAdaptor_Curve(TopoDS.Edge(e)) for e in explore(wedge.shape, TopAbs_ShapeEnum.TopAbs_EDGE)]
    assert len(edges) == 24  # each twice
    view = project(wedge.shape, np.array([1.0, -1.0, 1.0]), np.array([1.0, 1.0, 0.0]))
    assert (len(view.visible), len(view.hidden)) == (9, 3)


def test_the_sheet_says_what_is_ordered(plate):
    sheet = draw_part(plate, CAPTION)
    said = words(sheet)
    for text in ("plate width=60", "ergal, 2800 kg/m³", "0.1234 kg", "a = 1 mm", "0123456789ab", "plate.step", "me"):
        assert text in said
    assert "1 : 1" in said or "2 : 1" in said
    assert {"60", "40", "10"} <= set(said)
    assert {"A1", "A2", "A3"} <= set(said)
    assert any("ISO 2768-mK" in text for text in said)
    for points in (line.points for line in sheet.lines):
        assert (points >= 0).all()
        assert (points <= [420, 297]).all()


def test_inclined_faces_and_bores():
    bracket = JetpackBracket(15, 42)
    sheet = draw_part(part_breps([bracket])[bracket], CAPTION)
    assert "15°" in words(sheet)
    assert any(text.startswith("VIEW ALONG (0.2588, 0, -0.9659)") for text in words(sheet))
    assert max(line.points[:, 0].max() for line in sheet.lines) <= 410.0


def overlaps(sheet: Sheet) -> list[tuple[str, str]]:
    """Pairs of words whose letters, as the font has them, share a place."""
    font, boxes = FontProperties(family="DejaVu Sans"), []
    for word in (word for word in sheet.words if word.text.strip()):
        right = TextPath((0, 0), word.text, size=word.height / 0.73, prop=font).get_extents().x1
        left = {"left": 0.0, "center": -0.5 * right, "right": -right}[word.anchor]
        turn = np.radians(word.degrees)
        R = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
        corners = np.array([(u, v) for u in (left, left + right) for v in (0.0, word.height)]) @ R.T + [word.x, word.y]
        low, high = word.box
        wide = np.ptp(corners, axis=0) <= high - low + 0.6
        assert wide.all() or len(word.text) < 3 or len(word.text) > 8, word  # what labels are placed by
        boxes.append((word.text, corners.min(axis=0), corners.max(axis=0)))
    return [
        (a, b)
        for k, (a, low, high) in enumerate(boxes)
        for b, other_low, other_high in boxes[:k]
        if (np.minimum(high, other_high) - np.maximum(low, other_low) > 0.05).all()
    ]


def test_no_word_covers_another():
    """Fifty-five bores on 60 x 40 mm: numbers find room beside each other, dimensions and bores."""
    drill = stepped_hole((1.0, -1.0, 6.0), (1.6, 6.0, 11.0))
    places = [(x, y) for x in range(5, 60, 5) for y in (5, 9, 20, 24, 35)]
    bracket, forearm = JetpackBracket(15, 42), ForearmJetSupport(80, 108)
    breps = part_breps([bracket, forearm])
    for brep in (build_brep(box((0, 0, 0), (60, 40, 10)) - at_points(drill, places)), breps[bracket], breps[forearm]):
        assert overlaps(draw_part(brep, CAPTION)) == []


def test_numbers_stand_beside_their_circles():
    """In a large circle too, over no other one, and without any room on the way out."""
    sheet = Sheet(100.0, 100.0)
    circles = {
        "A": (np.array([50.0, 50.0]), 20.0),
        "B": (np.array([45.0, 50.0]), 2.0),
        "C": (np.array([55.0, 50.0]), 2.0),
    }
    label_circles(sheet, circles, 2.0)
    placed = {word.text: word.box for word in sheet.words}
    for name in ("B", "C"):
        for point in placed[name]:
            assert np.linalg.norm(point - circles["A"][0]) < 20.0
            assert all(np.linalg.norm(point - circles[other][0]) > 2.0 for other in ("B", "C"))
    assert all(np.linalg.norm(point - circles["A"][0]) > 20.0 for point in placed["A"])
    full = Sheet(100.0, 100.0)
    full.write("X" * 200, 50.0, 0.0, 100.0, "center")
    label_circles(full, {"A": circles["A"]}, 2.0)
    assert [word.text for word in full.words][1:] == ["A"]


def test_positions_are_noted(plate):
    sheet = draw_part(plate, dataclasses.replace(CAPTION, positions=(("seat", 0.2),)))
    assert "Position against datum A, the largest named flat face: seat 0.2." in words(sheet)


def test_too_large_parts_are_refused():
    with pytest.raises(GeometryError, match="90000 x 10 x 10 mm has no drawing"):
        draw_part(build_brep(box((0, 0, 0), (90000, 10, 10))), CAPTION)


def test_files_read_back(plate, tmp_path: Path):
    sheet = draw_part(plate, CAPTION)
    for name in ("a.pdf", "b.pdf"):
        write_pdf(sheet, tmp_path / name)
    assert (tmp_path / "a.pdf").read_bytes() == (tmp_path / "b.pdf").read_bytes()
    box_ = re.search(rb"/MediaBox \[ *0 0 ([\d.]+) ([\d.]+)", (tmp_path / "a.pdf").read_bytes())
    assert [float(number) * 25.4 / 72 for number in box_.groups()] == pytest.approx([420, 297], abs=0.01)
    write_dxf(sheet, tmp_path / "a.dxf")
    document = ezdxf.readfile(tmp_path / "a.dxf")
    assert not document.audit().errors
    assert document.units == ezdxf.units.MM
    kinds = Counter(entity.dxftype() for entity in document.modelspace())
    assert kinds["CIRCLE"] >= 6
    assert kinds["TEXT"] == len(sheet.words)
    assert {"HIDDEN", "VISIBLE", "CENTER"} <= {layer.dxf.name for layer in document.layers}
    if shutil.which("pdftotext"):
        text = subprocess.run(["pdftotext", tmp_path / "a.pdf", "-"], capture_output=True, text=True, check=True).stdout
        assert "plate width=60" in text
