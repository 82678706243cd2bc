"""Faces near a point: a plane, cylinder, cone or sphere and no more, on the surface of a file and on a mesh."""

import manifold3d as m3
import numpy as np
import pytest

import fem_surfaces
from codesign import fem
from codesign._core import fem as _core
from codesign.fem.cut import cut_by_box
from codesign.fem.selections import Box, Near, label_surface


def surface(solid):
    """A solid [mm] as a surface [mm]."""
    mesh = solid.to_mesh()
    triangles = np.asarray(mesh.tri_verts, dtype=np.int32)
    return fem.SurfaceMesh(np.asarray(mesh.vert_properties[:, :3], dtype=float), triangles, [0] * len(triangles), [""])


def patch(of, point):
    start = _core.nearest_triangle(of, np.array(point, dtype=float))
    return _core.smooth_patch(of, start, np.radians(30.0))


def area(of, triangles):
    a, b, c = (of.points[of.triangles[triangles, k]] for k in range(3))
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()


def chords(radius, count):
    return 2.0 * count * radius * np.sin(np.pi / count)


PLATE = fem_surfaces.box((60, 60, 10)) - m3.Manifold.cylinder(20.0, 8.0, 8.0, 64).translate((30, 30, -5))
DOME = m3.Manifold.sphere(10.0, 48) - fem_surfaces.box((40, 40, 20), (-20, -20, -20))
FUNNEL = m3.Manifold.cylinder(20.0, 12.0, 4.0, 48)
ROUNDED = m3.Manifold.batch_hull(
    [m3.Manifold.cylinder(30.0, 4.0, 4.0, 32).translate((x, y, 0)) for x in (4, 26) for y in (4, 6)]
)  # 30 x 10 with edges of radius 4

PIPE = m3.Manifold.cylinder(20.0, 5.0, 5.0, 48)
CAPSULE = PIPE + m3.Manifold.sphere(5.0, 48).translate((0, 0, 20))  # the dome joins the side smoothly
TAPERED = PIPE + m3.Manifold.cylinder(20.0, 5.0, 2.0, 48).translate((0, 0, 20))  # the cone joins it at 8.5°


@pytest.mark.parametrize(
    ("solid", "point", "kind", "expected"),
    [
        (PLATE, (30, 38, 5), "cylinder", chords(8.0, 64) * 10),
        (PLATE, (50, 50, 10), "plane", 3600 - 0.5 * 64 * 64 * np.sin(2 * np.pi / 64)),
        (DOME, (0, 0, 10), "sphere", 2 * np.pi * 100),
        (DOME, (6, 0, 8), "sphere", 2 * np.pi * 100),
        (FUNNEL, (8, 0, 10), "cone", np.pi * (12 + 4) * np.hypot(20, 8)),
        (ROUNDED, (15, 0, 15), "plane", 22 * 30),
        (ROUNDED, (15, 10, 15), "plane", 22 * 30),
        (ROUNDED, (0, 5, 15), "plane", 2 * 30),
        (ROUNDED, (1.2, 1.2, 15), "cylinder", chords(4.0, 32) / 4 * 30),
        (CAPSULE, (5, 0, 10), "cylinder", chords(5.0, 48) * 20),
        (CAPSULE, (0, 0, 25), "sphere", 2 * np.pi * 25),
        (TAPERED, (5, 0, 10), "cylinder", chords(5.0, 48) * 20),
        (TAPERED, (3.5, 0, 30), "cone", np.pi * (5 + 2) * np.hypot(20, 3)),
        (fem_surfaces.l_bracket(), (30, 10, 5), "plane", 47 * 20),
        (fem_surfaces.l_bracket(4), (30, 10, 5), "plane", 47 * 20),
        (fem_surfaces.l_bracket(), (12.8, 10, 5.0), "cylinder", 16 * 16 * np.sin(np.pi / 64) * 20),
        (fem_surfaces.l_bracket(3), (7.3, 10, 7.3), "cylinder", 3 * 16 * np.sin(np.pi / 12) * 20),
        (fem_surfaces.filleted_tray(), (30, 30, 1.5), "plane", 1600),
    ],
)  # fmt: skip
def test_a_face_of_a_file_is_known(solid, point, kind, expected):
    of = surface(solid)
    found = patch(of, point)
    assert found.type == kind
    assert area(of, found.triangles) == pytest.approx(expected, rel=0.01)


@pytest.mark.parametrize("point", [(13, 0, 0), (12, 0, 2.2), (10, 0, 3), (7, 0, 0)])
def test_a_torus_is_taken_whole(point):
    """It is no plane, cylinder, cone or sphere, though each ring of its facets lies on a sphere."""
    torus = surface(m3.Manifold.revolve(m3.CrossSection.circle(3.0, 24).translate((10.0, 0.0)), 48))
    found = patch(torus, point)
    assert found.type == "free"
    assert len(found.triangles) == len(torus.triangles)


def test_a_rounded_rim_ends_at_the_flat_but_not_at_the_side_that_it_joins():
    """A disk with a torus as its rim: what is none of the four shapes ends at planes and sharp edges."""
    turn = np.linspace(0.0, np.pi / 2, 9)
    outline = [
        (0.0, 0.0),
        (20.0, 0.0),
        *zip(17.0 + 3.0 * np.cos(turn), 7.0 + 3.0 * np.sin(turn), strict=True),
        (0.0, 10.0),
    ]
    disk = surface(m3.Manifold.revolve(m3.CrossSection([outline]), 64))
    found = patch(disk, (17 + 3 * np.sqrt(0.5), 0, 7 + 3 * np.sqrt(0.5)))
    side, rim = 2 * np.pi * 20 * 7, 2 * np.pi * (17 * np.pi / 2 * 3 + 3 * 3)
    assert found.type == "free"
    assert area(disk, found.triangles) == pytest.approx(side + rim, rel=0.01)


def test_noise_of_a_file_does_not_matter():
    of = surface(PLATE)
    shaken = fem.SurfaceMesh(
        of.points + np.random.default_rng(1).normal(0.0, 2e-4, of.points.shape), of.triangles, of.face, of.face_names
    )
    for point in ((30, 38, 5), (50, 50, 10)):
        assert patch(shaken, point).triangles == patch(of, point).triangles


@pytest.mark.parametrize(
    ("point", "expected"),
    [((55, 10, 5), 47 * 20), ((7.3, 10, 7.3), 16 * 16 * np.sin(np.pi / 64) * 20)],
    ids=["plane", "fillet"],
)
def test_faces_near_on_a_mesh_end_where_the_shape_does(point, expected):
    """Within half a row of sides at each end: the border between the two is no line of this mesh."""
    mesh = fem.tetrahedralize(surface(fem_surfaces.l_bracket()), 2.0)
    found = fem.faces_near(point).on(mesh).triangles
    assert _core.face_area(mesh, found) == pytest.approx(expected, abs=2 * 20 * 2.0)


def test_a_box_within_a_facet_cuts_it():
    of = surface(fem_surfaces.box((40, 20, 10)))
    cut = cut_by_box(of, (10, 5, 9), (12, 6, 11))
    assert fem.mass_properties(cut, 1.0).volume == pytest.approx(8000)
    named = label_surface(of, [Box((10, 5, 9), (12, 6, 11)), Near((0, 10, 5))])
    assert area(named.surface, np.flatnonzero(named.masks[0])) == pytest.approx(2.0)
    assert area(named.surface, np.flatnonzero(named.masks[1])) == pytest.approx(200.0)


def test_boxes_within_one_facet_are_all_cut_out():
    """What one box cuts leaves small facets in the others; they hold all of their area nevertheless."""
    of = surface(fem_surfaces.box((100, 100, 1)))
    corners = [(x, y) for x in (0, 96) for y in (0, 96)]
    labeled = label_surface(of, [Box((x, y, -0.1), (x + 4, y + 4, 0.1)) for x, y in corners])
    for (x, y), mask in zip(corners, labeled.masks, strict=True):
        middles = labeled.surface.points[labeled.surface.triangles[mask]].mean(axis=1)
        below = np.flatnonzero(mask)[middles[:, 2] < 1e-9]
        assert area(labeled.surface, below) == pytest.approx(16.0), (x, y)
