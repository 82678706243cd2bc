"""`codesign stress`: selections, materials, the numbers of a bar in tension, refusals."""

import json
import subprocess
import sys
from itertools import product

import numpy as np
import pytest

from codesign.cli.stress import stress_document
from codesign.cli.stress_options import AskedLoad, StressInputError, find_material, parse_load
from codesign.errors import FileError, MeshError
from codesign.parts.materials import named_material
from vtu_files import read_vtu

CORNERS = np.array(list(product((0.0, 100.0), (0.0, 10.0), (0.0, 10.0))))
QUADS = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
PULL = "normal:1,0,0: 1000 0 0"


@pytest.fixture
def bar(tmp_path):
    """A bar of 100 x 10 x 10 mm as an ASCII STL in millimeters."""
    lines = ["solid bar"]
    for a, b, c, d in QUADS:
        for triangle in ((a, b, c), (a, c, d)):
            vertices = ["vertex {} {} {}".format(*CORNERS[i]) for i in triangle]
            lines += ["facet normal 0 0 0", "outer loop", *vertices, "endloop", "endfacet"]
    path = tmp_path / "bar.stl"
    path.write_text("\n".join([*lines, "endsolid"]))
    return path


@pytest.mark.parametrize("fix", ["normal:-1,0,0", "near:0,5,5", "box:-1,-1,-1,0.1,11,11", "normal:-1,0.1,0:10"])
def test_a_bar_in_tension(bar, fix, tmp_path):
    document = stress_document(bar, 1e-3, named_material("ergal"), [fix], [PULL], 5.0, tmp_path / "bar.vtu")
    assert document["stress_50"] == pytest.approx(10e6, rel=0.04)  # 1000 N over 100 mm², more near the clamp
    assert document["safety_factor"] == pytest.approx(462 / 10, rel=0.06)  # 3 mm beside the clamp: +4 %
    assert document["max_displacement"] == pytest.approx(10e6 * 0.1 / 71.7e9, rel=0.02)
    assert document["reaction_force"] == pytest.approx([-1000, 0, 0], abs=1e-5)
    assert document["mass"] == pytest.approx(2810 * 1e-5, rel=1e-9)
    assert 0 < document["stress_error"] < 0.2 * document["peak_stress"]
    assert document["edge_length"] == 5e-3
    field = read_vtu(tmp_path / "bar.vtu")
    assert field.strings["material"] == "ergal"
    assert field.point_data["displacement"][:, 0].max() == pytest.approx(document["max_displacement"], rel=1e-3)


def test_the_edge_length_follows_the_wall(bar):
    document = stress_document(bar, 1e-3, named_material("ergal"), ["normal:-1,0,0"], [PULL])
    assert 1.5e-3 < document["edge_length"] < 4e-3  # mean wall 4.8 mm
    assert document["tetrahedra"] < 60_000


def test_a_part_of_micrometers(bar):
    document = stress_document(bar, 1e-6, named_material("ergal"), ["normal:-1,0,0"], ["normal:1,0,0: 1e-3 0 0"], 5e-3)
    assert document["exclusion"]["largest"] < 11e-6
    assert document["safety_factor"] == pytest.approx(462 / 10, rel=0.4)  # nearer to the clamp


def test_forces_add_up(bar):
    halves = ["normal:1,0,0: 500 0 0", "box:99.9,-1,-1,101,11,11: 500,0,0"]
    document = stress_document(bar, 1e-3, named_material("ergal"), ["near:0,5,5"], halves, 5.0)
    assert document["applied_force"] == [1000, 0, 0]
    assert document["stress_50"] == pytest.approx(10e6, rel=0.04)


def test_materials_by_name_and_by_numbers():
    assert find_material("ergal").yield_strength == 462e6
    custom = find_material("210,0.3,235,7850")
    assert (custom.young_modulus, custom.poisson_ratio, custom.yield_strength, custom.density) == (
        210e9, 0.3, 235e6, 7850,
    )  # fmt: skip
    for text in ("unobtainium", "210,0.3", "210,0.7,235", "-1,0.3,235", "210,0.3,0"):
        with pytest.raises(StressInputError):
            find_material(text)


@pytest.mark.parametrize(
    ("fix", "load", "message"),
    [
        (["near:0,0"], [PULL], "expected 3 finite numbers"),
        (["close:0,0,0"], [PULL], "expected near:"),
        (["normal:0,0,0"], [PULL], "direction is zero"),
        (["normal:-1,0,0"], ["normal:1,0,0"], "expected 'SELECTION: fx fy fz'"),
        (["normal:-1,0,0"], ["normal:1,0,0: 0 0 0"], "force is zero"),
        (["normal:-1,0,0"], ["normal:1,0,0: 1 nan 0"], "expected 3 finite numbers"),
        (["box:500,0,0,600,1,1"], [PULL], "selects no"),
        ([], [PULL], "--fix"),
        (["normal:-1,0,0: q"], [PULL], "'q' is no set of directions"),
        (["normal:-1,0,0: xx"], [PULL], "'xx' is no set of directions"),
        (["normal:-1,0,0"], ["normal:1,0,0: torque 1 2 3"], "expected 'SELECTION: fx fy fz'"),
    ],
)
def test_selections_that_make_no_sense_are_refused(bar, fix, load, message):
    with pytest.raises(StressInputError, match=message):
        stress_document(bar, 1e-3, named_material("ergal"), fix, load, 5.0)


def test_fields_and_picture_are_written(bar, tmp_path):
    vtu, png = tmp_path / "bar.vtu", tmp_path / "bar.png"
    stress_document(bar, 1e-3, named_material("ergal"), ["normal:-1,0,0"], [PULL], 5.0, vtu, png)
    field = read_vtu(vtu)
    assert {"displacement", "stress", "von_mises"} <= set(field.point_data)
    assert len(field.cell_data["error"]) == len(field.cells)
    assert png.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("vtu", "png", "message"),
    [
        ("bar.stl", None, "--vtu .*is the part itself"),
        (None, "bar.stl", "--png .*is the part itself"),
        ("a.x", "a.x", "--png .*is the file of --vtu too"),
    ],
)
def test_no_output_replaces_the_part_or_another_output(bar, vtu, png, message):
    before = bar.read_bytes()
    targets = [None if name is None else bar.parent / name for name in (vtu, png)]
    with pytest.raises(FileError, match=message):
        stress_document(bar, 1e-3, named_material("ergal"), ["normal:-1,0,0"], [PULL], 5.0, *targets)
    assert bar.read_bytes() == before


@pytest.mark.parametrize("scale", [1e300, 1e-300])
def test_scales_beyond_all_measure_are_one_message(bar, scale):
    with pytest.raises(MeshError, match="check the scale"):
        stress_document(bar, scale, named_material("ergal"), ["normal:-1,0,0"], [PULL])


def test_loads_accept_commas_and_spaces():
    assert parse_load("near:1,2,3: 1, 2 -3", 1e-3)[1] == AskedLoad("force", (1.0, 2.0, -3.0))


def test_bad_files_are_mesh_errors(tmp_path):
    (tmp_path / "empty.stl").write_bytes(b"")
    with pytest.raises(MeshError, match=r"empty\.stl: the file is empty"):
        stress_document(tmp_path / "empty.stl", 1e-3, named_material("ergal"), ["near:0,0,0"], [PULL])


def test_command_line_prints_one_document_and_its_exit_code_is_the_verdict(bar):
    command = [sys.executable, "-m", "codesign.cli", "stress", str(bar), "--fix", "normal:-1,0,0", "--edge-length", "5"]
    weak = subprocess.run([*command, "--load", "normal:1,0,0: 1e6 0 0", "--json"], capture_output=True, check=False)
    assert weak.returncode == 1
    assert json.loads(weak.stdout)["safety_factor"] < 1.0
    text = subprocess.run([*command, "--load", PULL], capture_output=True, text=True, check=False)
    assert text.returncode == 0
    assert "safety factor" in text.stdout
