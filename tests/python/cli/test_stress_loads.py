"""Loads and supports of `codesign stress` beyond total forces: pressure, traction, gravity, rollers; closed forms."""

import numpy as np
import pytest

from codesign.cli.stress import stress_document
from codesign.cli.stress_options import StressInputError, find_material, parse_support
from codesign.fem.selections import NamedFace, Near
from codesign.geometry import Shape, box
from codesign.parts.part import Part

LENGTH, WIDTH, HEIGHT = 40.0, 10.0, 10.0  # mm
STEEL = find_material("200,0.3,250,8000")
ROLLERS = ["normal:-1,0,0: x", "normal:0,-1,0: y", "normal:0,0,-1: z"]


class Bar(Part):
    """A block along x."""

    def shape(self) -> Shape:
        return box((0, 0, 0), (LENGTH, WIDTH, HEIGHT))


@pytest.fixture(scope="module")
def bar(tmp_path_factory):
    path = tmp_path_factory.mktemp("bar") / "bar.stl"
    Bar(name="bar", density=8000.0).write_stl(path)
    return path


def run(bar, load, fix=ROLLERS, **options):
    return stress_document(bar, 1e-3, STEEL, fix, load, edge_length_mm=5.0, **options)


def test_rollers_and_traction_give_uniaxial_stress(bar):
    document = run(bar, ["normal:1,0,0: traction 100 0 0"])
    assert document["peak_stress"] == pytest.approx(100e6, rel=1e-9)
    assert document["safety_factor"] == pytest.approx(2.5, rel=1e-9)
    strain = 100e6 / 200e9
    moved = strain * np.array([LENGTH, 0.3 * WIDTH, 0.3 * HEIGHT]) * 1e-3
    assert document["max_displacement"] == pytest.approx(np.linalg.norm(moved), rel=1e-9)
    assert document["applied_force"] == pytest.approx([100e6 * 1e-4, 0.0, 0.0], rel=1e-9)
    assert document["places"][0]["axes"] == "x"


def test_pressure_all_around_has_no_shear(bar):
    sides = [f"normal:{n}: pressure 50" for n in ("1,0,0", "0,1,0", "0,0,1")]
    document = run(bar, sides)
    assert document["peak_stress"] < 1e-3 * 50e6
    assert document["reaction_force"] == pytest.approx([50e6 * 1e-4, 50e6 * 4e-4, 50e6 * 4e-4], rel=1e-9)


def test_gravity_is_carried_by_the_clamp(bar):
    document = run(bar, [], fix=["normal:-1,0,0"], acceleration="0 0 -9.81")
    weight = LENGTH * WIDTH * HEIGHT * 1e-9 * 8000.0 * 9.81
    assert document["reaction_force"] == pytest.approx([0.0, 0.0, weight], abs=1e-6 * weight)


@pytest.mark.parametrize(
    ("fix", "load", "options", "message"),
    [
        (ROLLERS, ["normal:1,0,0: pressure 1 2"], {}, "expected a finite number"),
        (ROLLERS, ["normal:1,0,0: traction 0 0 0"], {}, "the traction is zero"),
        (ROLLERS, [], {}, "at least one of each"),
        (ROLLERS, [], {"acceleration": "0 0"}, "expected 3 finite numbers"),
        (ROLLERS, [], {"acceleration": "0 0 0"}, "is zero"),
    ],
)
def test_wrong_loads_are_refused(bar, fix, load, options, message):
    with pytest.raises(StressInputError, match=message):
        run(bar, load, fix, **options)


def test_gravity_needs_a_density(bar):
    with pytest.raises(StressInputError, match="needs a density"):
        stress_document(bar, 1e-3, find_material("200,0.3,250"), ["normal:-1,0,0"], [], acceleration="0 0 -9.81")


def test_directions_of_a_support():
    assert parse_support("near:1,2,3: xz", 1.0) == (Near((1.0, 2.0, 3.0)), "xz")
    assert parse_support("near:1,2,3", 1.0)[1] == "xyz"
    assert parse_support("face:x", 1.0) == (NamedFace("x"), "xyz")
    assert parse_support("face:seat:y", 1.0) == (NamedFace("seat"), "y")
