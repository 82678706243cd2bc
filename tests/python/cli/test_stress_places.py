"""`codesign stress`: what each place caught, and places and loads that make no sense."""

import json
import subprocess
import sys

import pytest

import fem_surfaces
from codesign import fem
from codesign.cli.stress import stress_document
from codesign.cli.stress_options import StressInputError
from codesign.errors import MeshError
from codesign.parts.materials import named_material

STEEL = named_material("steel_s235")
END, PULL = "normal:-1,0,0", "normal:1,0,0: 100 0 0"


@pytest.fixture
def block(tmp_path):
    """40 x 20 x 10 mm."""
    return fem_surfaces.write_stl(fem_surfaces.box((40, 20, 10)), tmp_path / "block.stl")


def test_near_ends_where_the_plane_ends(tmp_path):
    """The shelf of a filleted bracket, not the fillet and the back behind it (safety factor 8.3, 0.042 mm).

    4.3 if 3 mm around the load's border were left out, where the fillet is most stressed; 0.0932 mm if the load also
    covers the first facet of the fillet.
    """
    path = fem_surfaces.write_stl(fem_surfaces.l_bracket(), tmp_path / "bracket.stl")
    shelf = stress_document(path, 1e-3, STEEL, ["near:0,10,30"], ["near:55,10,5: 0 0 -200"], 2.0)
    assert shelf["safety_factor"] == pytest.approx(3.65, rel=0.04)
    assert shelf["max_displacement"] == pytest.approx(0.0932e-3, rel=0.02)
    clamp, load = shelf["places"]
    assert (clamp["kind"], clamp["type"], clamp["facets"]) == ("clamp", "plane", 2)
    assert clamp["area"] == pytest.approx(60e-3 * 20e-3)
    assert (load["kind"], load["type"], load["bend_deg"]) == ("load", "plane", pytest.approx(0.0, abs=1e-6))
    assert load["area"] == pytest.approx(47e-3 * 20e-3)
    assert load["centroid"] == pytest.approx([36.5e-3, 10e-3, 5e-3])
    assert load["force"] == [0.0, 0.0, -200.0]
    assert not shelf["warnings"]


def test_a_place_that_bends_far_is_a_warning(tmp_path):
    path = fem_surfaces.write_stl(fem_surfaces.l_bracket(), tmp_path / "bracket.stl")
    fillet = stress_document(path, 1e-3, STEEL, ["near:0,10,30"], ["near:7.3,10,7.3: 0 0 -200"], 3.0)
    load = fillet["places"][1]
    assert load["type"] == "cylinder"
    assert load["facets"] == 32
    assert load["bend_deg"] == pytest.approx(90 - 90 / 16, abs=0.1)
    assert any("near:7.3,10,7.3" in warning and "bends by 84" in warning for warning in fillet["warnings"])


def test_most_of_the_surface_is_a_warning(block):
    document = stress_document(block, 1e-3, STEEL, ["box:-1,-1,-1,41,21,5"], ["normal:0,0,1: 0 0 -100"], 5.0)
    assert document["places"][0]["type"] == "plane"  # the box holds the bottom and no whole side
    document = stress_document(block, 1e-3, STEEL, ["normal:0,0,-1:91"], ["normal:0,0,1: 0 0 -100"], 5.0)
    assert document["places"][0]["type"] == "5 planes"
    assert any("of the whole surface" in warning for warning in document["warnings"])


@pytest.mark.parametrize(
    ("fix", "load", "message"),
    [
        (END, "normal:-1,0,0: 0 0 -100", "acts on held faces only"),
        (END, "box:100,0,0,101,1,1: 0 0 -100", "load 'box:100,0,0,101,1,1' selects nothing.*outside of the part"),
        ("normal:1,1,0", "normal:1,0,0: 0 0 -100", "clamp 'normal:1,1,0' selects nothing: no facet looks there"),
    ],
    ids=["held", "outside", "no direction"],
)
def test_places_and_loads_without_effect_are_refused(block, fix, load, message):
    with pytest.raises(StressInputError, match=message):
        stress_document(block, 1e-3, STEEL, [fix], [load], 5.0)


@pytest.mark.parametrize("half", [2.0, 0.1])
def test_a_patch_within_a_facet_is_cut_out(block, half):
    """Also one that is much smaller than the elements."""
    patch = f"box:{20 - half},{10 - half},9.9,{20 + half},{10 + half},10.1"
    document = stress_document(block, 1e-3, STEEL, [END], [f"{patch}: 0 0 -100"], 5.0)
    load = document["places"][1]
    assert load["area"] == pytest.approx(4e-6 * half**2, rel=2e-3)
    assert load["centroid"] == pytest.approx([20e-3, 10e-3, 10e-3])
    assert document["reaction_force"] == pytest.approx([0.0, 0.0, 100.0], abs=1e-5)
    assert document["max_displacement"] > 0.0


def test_borders_that_give_no_mesh_are_told(block, monkeypatch):
    """Sides of elements are taken instead of exact borders; the reason is no secret."""
    mesh, tries = fem.tetrahedralize, iter((MeshError("edges meet at 0.1°"),))

    def first_fails(*arguments, **options):
        if (error := next(tries, None)) is not None:
            raise error
        return mesh(*arguments, **options)

    monkeypatch.setattr(fem, "tetrahedralize", first_fails)
    document = stress_document(block, 1e-3, STEEL, [END], ["normal:1,0,0: 100 0 0"], 5.0)
    assert any("as their borders gave no mesh: edges meet at 0.1°" in warning for warning in document["warnings"])
    assert document["places"][1]["area"] == pytest.approx(200e-6, rel=1e-6)


def test_loads_that_cancel_are_refused(block):
    loads = ["normal:1,0,0: 100 0 0", "normal:1,0,0: -100 0 0"]
    with pytest.raises(StressInputError, match="the loads add up to nothing"):
        stress_document(block, 1e-3, STEEL, [END], loads, 5.0)


def test_a_load_on_the_clamp_is_bad_input_on_the_command_line(block):
    command = [sys.executable, "-m", "codesign.cli", "stress", str(block), "--fix", "normal:1,0,0", "--json"]
    done = subprocess.run([*command, "--load", "normal:1,0,0: 0 0 -100"], capture_output=True, check=False, text=True)
    assert done.returncode == 2
    assert "held faces only" in json.loads(done.stdout)["error"]["message"]
    assert "Traceback" not in done.stderr
