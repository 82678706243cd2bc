"""Edges of finished solids rounded and beveled: both evaluators make the volume of the closed form."""

import math

import numpy as np
import pytest

from codesign.errors import GeometryError
from codesign.geometry import Frame, box, chamfer, cylinder, fillet, plate, polygon
from codesign.geometry.brep import build_brep
from codesign.geometry.profile import Resolution
from codesign.geometry.solid import build_solid, mesh_volume

BLOCK = box((0, 0, 0), (40, 30, 10), z1="top", x1="right", y0="front", x0="left", y1="back", z0="bottom")
CORNER = 1.0 - math.pi / 4  # area between a square of side 1 and its quarter circle


def revolved(area: float, centroid: float) -> float:
    """Pappus."""
    return 2.0 * math.pi * centroid * area


def rounding(radius: float, edge: float, sign: float) -> float:
    """Volume between the corner of a plane and a cylinder and its rounding; sign: the plane lies outside or inside."""
    centroid = radius * (0.5 - math.pi / 4 * (1.0 - 4.0 / (3.0 * math.pi))) / CORNER
    return revolved(CORNER * radius**2, edge + sign * centroid)


HOLE = cylinder(6, -1, 11, face="bore").moved(20, 15)
PLATE = BLOCK - HOLE
BOSS = BLOCK + cylinder(8, 5, 25, face="boss", end_face="head").moved(20, 15)
TILTED = Frame((3, 4, 5), (0.6, 0.8, 0.0), (0.0, 0.0, 1.0))
SLOPE = polygon((0, 0), (20, 0), (10, 10), (0, 10), faces=["", "slope", "up", ""])
CASES = {
    "straight": (fillet(BLOCK, ("top", "right"), radius=3), 12000 - CORNER * 9 * 30),
    "bevel": (chamfer(BLOCK, ("right", "top"), size=2), 12000 - 2 * 30),
    "rim of a hole": (fillet(PLATE, ("top", "bore"), radius=2), 12000 - 360 * math.pi - rounding(2, 6, 1)),
    "countersink": (
        chamfer(PLATE, ("bore", "bottom"), size=1.5),
        12000 - 360 * math.pi - revolved(1.125, 6.5),
    ),
    "head of a boss": (fillet(BOSS, ("head", "boss"), radius=2), 12000 + 960 * math.pi - rounding(2, 8, -1)),
    "foot of a boss": (fillet(BOSS, ("boss", "top"), radius=3), 12000 + 960 * math.pi + rounding(3, 8, 1)),
    "tilted": (
        fillet(PLATE.placed(TILTED), ("top", "bore"), ("bottom", "bore"), radius=2),
        12000 - 360 * math.pi - 2 * rounding(2, 6, 1),
    ),
    "obtuse": (
        fillet(
            plate(polygon((0, 0), (20, 0), (10, 10), (0, 10), faces=["", "slope", "up", ""]), 5),
            ("up", "slope"),
            radius=4,
        ),
        5 * (150 - 16 * (math.tan(math.pi / 8) - math.pi / 8)),
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_both_evaluators_make_the_closed_form(name):
    shape, volume = CASES[name]
    assert build_brep(shape).volume == pytest.approx(volume, rel=1e-9)
    coarse, fine = (mesh_volume(shape, Resolution(48, 0.02, refine)) for refine in (1, 2))
    assert (4.0 * fine - coarse) / 3.0 == pytest.approx(volume, rel=2e-6)
    solid = build_solid(shape, Resolution(48)).tidied()
    corners = solid.points[solid.triangles]
    mesh = np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6.0
    assert mesh == pytest.approx(volume, rel=2e-3)  # chords


def test_edges_of_one_call_may_meet():
    """A frame of four bevels, mitered at the corners."""
    top = [("top", side) for side in ("left", "right", "front", "back")]
    shape = chamfer(BLOCK, *top, size=2, face="bevel")
    prismatoid = 2 / 6 * (40 * 30 + 4 * 38 * 28 + 36 * 26)
    assert build_brep(shape).volume == pytest.approx(8 * 1200 + prismatoid, rel=1e-9)
    rounded = fillet(BLOCK, *top, radius=2, face="bevel")
    assert "bevel" in build_solid(rounded, Resolution(48)).names
    mitered = 8 * 1200 + sum(
        (40 - 2 * x) * (30 - 2 * x) * w for x, w in ((2 - math.sqrt(4 - z * z), dz) for z, dz in slices(2))
    )
    assert build_brep(rounded).volume == pytest.approx(mitered, rel=1e-6)


def slices(height: float) -> list[tuple[float, float]]:
    """Gauss points and weights over a height."""
    nodes, weights = np.polynomial.legendre.leggauss(200)
    return list(zip((0.5 * height * (nodes + 1)).tolist(), (0.5 * height * weights).tolist(), strict=True))


def test_names_of_new_faces():
    shape = fillet(PLATE, ("top", "bore"), radius=2, face="round")
    brep = build_brep(shape)
    assert brep.area("round") == pytest.approx(2 * math.pi * (8 * math.pi - 4), rel=1e-9)
    assert set(build_solid(shape, Resolution(48)).names) >= {"round", "top", "bore"}


def test_what_is_no_such_edge_is_refused():
    ell = plate(polygon((0, 0), (20, 0), (20, 5), (5, 5), (5, 20), (0, 20), faces=["", "", "in", "up", "", ""]), 5)
    stepped = BLOCK + box((30, 0, 5), (40, 30, 20), x0="step")
    grooved = BLOCK - box((15, -1, 5), (20, 31, 11), x0="wall")
    pocket = BLOCK - box((35, 10, 5), (41, 20, 11))
    cases = [
        (lambda: fillet(BLOCK, ("top", "lid"), radius=1), "no face 'lid'"),
        (lambda: fillet(BLOCK, ("left", "right"), radius=1), "meet in no edge"),
        (lambda: fillet(ell, ("in", "up"), radius=1), "a straight inner edge"),
        (lambda: fillet(stepped, ("front", "top"), radius=1), "no room there, or the edge ends"),
        (lambda: fillet(BLOCK, ("top", "right"), radius=12), "no room there"),
        (lambda: fillet(PLATE, ("top", "bore"), radius=10), "no room there"),
        (lambda: fillet(grooved, ("top", "front"), radius=1), "interrupted"),
        (lambda: fillet(pocket, ("top", "right"), radius=1), "interrupted"),
        (lambda: fillet(BOSS, ("head", "boss"), radius=9), "cannot be worked by 9 mm"),
        (lambda: fillet(BLOCK, ("top", "right"), radius=0), "a size above 0"),
        (lambda: chamfer(BLOCK, size=1), "name edges"),
    ]
    for make, words in cases:
        with pytest.raises(GeometryError, match=words):
            make()
