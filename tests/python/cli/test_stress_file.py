"""Files of `codesign stress`: repair on request, refusals with a remedy, hints about units."""

from dataclasses import dataclass

import numpy as np
import pytest

from codesign.cli.stress import stress_document
from codesign.cli.stress_file import describe_repair, load_file, repair_document, unit_hints
from codesign.errors import MeshError
from codesign.geometry import shape
from codesign.geometry.shape import Shape
from codesign.parts.materials import named_material
from codesign.parts.part import Part
from codesign.parts.step import write_step
from stl_files import box, stl


@dataclass(frozen=True)
class Bar(Part):
    """A bar of 40 x 10 x 10 mm."""

    name: str = "bar"
    density: float = 7850.0

    def shape(self) -> Shape:
        return shape.box((0, 0, 0), (40, 10, 10))


BAR = box((0, 0, 0), (40, 10, 10))
ERGAL = named_material("ergal")
CLAMPED = (["normal:-1,0,0"], ["normal:1,0,0: 0 0 -100"])


def test_repair_on_request_is_reported(tmp_path):
    path = stl(tmp_path / "part.stl", BAR, BAR[:1])
    with pytest.raises(MeshError, match=r"part.stl: .* triangles written twice: 1; --repair mends it"):
        load_file(path, 1e-3, repair=False)
    document = stress_document(path, 1e-3, named_material("steel_s235"), *CLAMPED, edge_length_mm=5.0, repair=True)
    repair = document["repair"]
    assert (repair["changed"], repair["doubled_facets"]) == (True, 1)
    assert repair["triangles"] == {"before": 13, "after": 12}
    assert repair["volume"]["after"] == pytest.approx(4000e-9, rel=1e-9)
    assert document["volume"] == pytest.approx(4000e-9, rel=1e-9)
    assert "1 doubled facets dropped: volume 4000 mm³" in describe_repair(repair)
    untouched = repair_document(load_file(stl(path, BAR), 1e-3, repair=True)[1])
    assert describe_repair(untouched) == "nothing to repair"


def test_what_repair_cannot_mend_is_said(tmp_path):
    path = stl(tmp_path / "part.stl", BAR, np.add(BAR, (60, 0, 0)))
    with pytest.raises(MeshError, match=r"2 bodies of 4000 and 4000 mm³ around .*; --repair does not help"):
        load_file(path, 1e-3, repair=False)
    with pytest.raises(MeshError, match=r"part.stl: the surface is open: 3 edges"):
        load_file(stl(path, BAR[1:]), 1e-3, repair=True)


def test_no_simplify_keeps_every_edge(tmp_path):
    """A ledge of 0.04 mm, which simplification would remove."""
    path = stl(tmp_path / "part.stl", BAR, box((40, 0, 0), (60, 10, 10.04)))
    kept, gone = (
        stress_document(
            path, 1e-3, named_material("ergal"), *CLAMPED, edge_length_mm=10.0, repair=True, simplify=simplify
        )
        for simplify in (False, True)
    )
    assert kept["mesh"]["collapsed_edges"] == 0
    assert kept["volume"] == pytest.approx(6008e-9, rel=1e-9)
    assert gone["mesh"]["collapsed_edges"] > 0
    assert gone["tetrahedra"] < kept["tetrahedra"]


def test_step_files_are_read_in_their_own_units(tmp_path):
    path = tmp_path / "part.stp"
    write_step(Bar(), path)
    for scale in (1e-3, 1.0):  # of the selections
        surface, report = load_file(path, scale, repair=False)
        assert report is None
        assert np.ptp(surface.points, axis=0) == pytest.approx([0.04, 0.01, 0.01])
    path.write_text("ISO-10303-21;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n")
    with pytest.raises(MeshError, match=r"part.stp"):
        load_file(path, 1e-3, repair=False)
    with pytest.raises(MeshError, match=r"none.stl: No such file"):
        load_file(tmp_path / "none.stl", 1e-3, repair=False)


def test_units_that_look_wrong_are_mentioned(tmp_path):
    path = stl(tmp_path / "part.stl", box((0, 0, 0), (0.2, 0.03, 0.02)))  # meters
    doubts = stress_document(path, 1e-3, named_material("steel_s235"), *CLAMPED)["warnings"]
    assert any("only 0.2 x 0.03 x 0.02 mm: is the file in meters (--scale 1)?" in doubt for doubt in doubts)
    assert any(" times the part, small ones are assumed" in doubt for doubt in doubts)
    right = stress_document(path, 1.0, named_material("steel_s235"), *CLAMPED)
    bent = 100 * 0.2**3 / (3 * 210e9 * 0.03 * 0.02**3 / 12)  # F L³ / (3 E I)
    assert right["max_displacement"] == pytest.approx(bent, rel=0.02)
    assert not any("--scale" in doubt for doubt in right["warnings"])
    surface, _ = load_file(stl(path, BAR), 1.0, repair=False)  # millimeters taken for meters
    assert "smaller units (--scale 0.001)" in unit_hints(surface, 1.0, 0.0)[0]
    assert np.allclose(np.ptp(surface.points, axis=0), (40, 10, 10))
