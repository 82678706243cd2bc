"""`codesign stress`: the critical place is read, and what is left out is shown."""

import pytest

import fem_surfaces
from codesign.cli.stress import stress_document
from codesign.cli.stress_options import find_material
from codesign.parts.materials import named_material

ERGAL, STEEL = named_material("ergal"), named_material("steel_s235")
WALLS = ["normal:-1,0,0", "normal:1,0,0", "normal:0,1,0", "normal:0,-1,0"]


def test_a_fillet_beside_the_border_of_a_load_is_read(tmp_path):
    """12.6 MPa in the fillet at the floor's edge; 7.3 MPa in the middle if 3 mm around the load were left out."""
    path = fem_surfaces.write_stl(fem_surfaces.filleted_tray(), tmp_path / "tray.stl")
    document = stress_document(path, 1e-3, ERGAL, WALLS, ["box:9,9,1.49,51,51,1.51: 0 0 -100"], 1.0)
    assert document["peak_stress"] == pytest.approx(12.6e6, rel=0.05)
    x, y, z = (1e3 * c for c in document["peak_position"])
    assert 1.4 < z < 2.5  # near the floor
    assert min(abs(x - 9.5), abs(x - 50.5), abs(y - 9.5), abs(y - 50.5)) < 0.7  # at its edge
    assert document["peak_resolved"]
    left_out = document["left_out"]
    assert left_out["stress"] < document["peak_stress"]
    assert left_out["border_distance"] <= document["exclusion"]["largest"]


def test_a_sharp_pocket_edge_is_left_out_and_shown(tmp_path):
    """14.6 MPa under the middle of the floor; at the sharp edge the stress has no limit."""
    path = fem_surfaces.write_stl(fem_surfaces.sharp_tray(), tmp_path / "tray.stl")
    document = stress_document(path, 1e-3, ERGAL, WALLS, ["near:30,30,1: 0 0 -100"], 1.05)
    assert document["peak_stress"] == pytest.approx(14.6e6, rel=0.05)
    assert document["left_out"]["stress"] > 1.5 * document["peak_stress"]
    assert document["left_out"]["border_distance"] < 3e-3
    assert any("left out" in warning for warning in document["warnings"])


def test_a_holes_edge_is_read(tmp_path):
    """Gross stress 1 MPa, stress concentration 4.31 (Peterson, hole of half the width), in 3-D up to 4.4."""
    path = fem_surfaces.write_stl(fem_surfaces.holed_strip(), tmp_path / "strip.stl")
    document = stress_document(path, 1e-3, STEEL, ["normal:-1,0,0"], ["normal:1,0,0: 300 0 0"])
    assert document["peak_stress"] == pytest.approx(4.36e6, rel=0.03)


def test_a_beam_is_read_in_proportion_to_its_height(tmp_path):
    """8 m x 1 m x 1 m: 432 MPa at the root by beam theory; 3 mm from the clamp the stress has no meaning."""
    path = fem_surfaces.write_stl(fem_surfaces.box((8, 1, 1)), tmp_path / "beam.stl")
    material = find_material("210,0.3,250")
    document = stress_document(path, 1.0, material, ["normal:-1,0,0"], ["normal:1,0,0: 0 0 -9e6"])
    assert document["max_displacement"] == pytest.approx(88.4e-3, rel=0.01)
    assert document["exclusion"]["largest"] == pytest.approx(0.2, rel=0.01)
    assert document["peak_stress"] == pytest.approx(432e6, rel=0.06)
    assert document["left_out"]["stress"] > document["peak_stress"]


def test_the_stress_of_a_volume_is_not_above_the_peak(tmp_path):
    path = fem_surfaces.write_stl(fem_surfaces.hollow_cube(), tmp_path / "cube.stl")
    document = stress_document(path, 1e-3, ERGAL, ["near:0,0,-20"], ["near:0,0,20: 0 0 -250"])
    assert 0.0 < document["stress_50"] <= document["peak_stress"]


def test_a_mesh_that_touches_itself_on_tiny_ledges_is_mentioned(tmp_path):
    """A window 19 micrometers high."""
    path = fem_surfaces.write_stl(fem_surfaces.windowed_bar(4.205), tmp_path / "bar.stl")
    document = stress_document(path, 1e-3, ERGAL, ["normal:-1,0,0"], ["normal:1,0,0: 0 0 -10"])
    faults = document["mesh"]["small_faults"]
    assert faults > 0
    assert sum(f"touches itself at {faults} places" in warning for warning in document["warnings"]) == 1


def test_a_peak_at_a_clamps_rim_is_told(tmp_path):
    """A cantilever is stressed most where it is clamped, so that the rule of exclusion makes the number."""
    path = fem_surfaces.write_stl(fem_surfaces.box((60.0, 10.0, 10.0)), tmp_path / "beam.stl")
    document = stress_document(path, 2e-3, ERGAL, ["normal:-1,0,0"], ["normal:1,0,0: 0 0 -100"], 1.0)
    assert any("from the rim of a clamp" in warning for warning in document["warnings"])
