"""The boundary of a mesh has the topology of its surface, also where walls are thin; right values from closed forms
and from CalculiX on finer meshes."""

from __future__ import annotations

import manifold3d
import numpy as np
import pytest

import fem_surfaces
from codesign import fem
from codesign.errors import MeshError, MeshLimitError

ERGAL = fem.Material("ergal", 71.7e9, 0.3, 462e6, 2800.0)


def box(lower, upper):
    """A solid between two corners [mm]."""
    return manifold3d.Manifold.cube(np.subtract(upper, lower).tolist()).translate(list(map(float, lower)))


def surface_of(solid):
    """In meters."""
    mesh = solid.to_mesh()
    points = np.asarray(mesh.vert_properties)[:, :3].astype(float) * 1e-3
    return fem.SurfaceMesh(points, np.asarray(mesh.tri_verts).astype(np.int32))


def tray(floor=1.0):
    return surface_of(box((0, 0, 0), (60, 60, 8)) - box((8, 8, floor), (52, 52, 9)))


def wedge(angle_deg, length=30.0, width=20.0):
    """A solid between two planes that meet at the y axis."""
    height = length * np.tan(np.radians(angle_deg))
    points = [[x, y, z] for y in (0.0, width) for x, z in ((0.0, 0.0), (length, 0.0), (length, height))]
    triangles = [[0, 1, 2], [3, 5, 4], [0, 4, 1], [0, 3, 4], [1, 5, 2], [1, 4, 5], [0, 2, 5], [0, 5, 3]]
    return fem.SurfaceMesh(np.array(points) * 1e-3, np.array(triangles))


def euler_characteristic(triangles):
    """Of closed manifold triangles; fails if an edge has not exactly two of them."""
    edges = np.sort(np.vstack([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    edges, uses = np.unique(edges, axis=0, return_counts=True)
    assert (uses == 2).all()
    return len(np.unique(triangles)) - len(edges) + len(triangles)


def assert_same_as_surface(mesh, surface, volume_tolerance=2e-3):
    assert euler_characteristic(mesh.boundary[:, :3]) == euler_characteristic(surface.triangles)
    volume = fem.mass_properties(surface, 1.0).volume
    assert mesh.quality.volume == pytest.approx(volume, rel=volume_tolerance)


def displacement(mesh, held, pushed, force, material=ERGAL):
    supports = [fem.Support(selection) for selection in held]
    return fem.solve_static(mesh, material, supports, [fem.Force(pushed, force)]).max_displacement


def test_floor_of_a_tray_stays_whole_and_as_soft_as_it_is():
    surface = tray()
    mesh = fem.tetrahedralize(surface)
    assert_same_as_surface(mesh, surface)
    assert mesh.report.genus == [0]
    assert mesh.report.refinements == 0
    walls = [fem.faces_with_normal(n) for n in ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0))]
    floor = fem.faces_near((0.030, 0.030, 0.001))
    assert displacement(mesh, walls, floor, (0, 0, -100)) == pytest.approx(0.0395e-3, rel=0.02)


def test_a_given_edge_length_is_refined_where_it_tears_the_floor():
    surface = tray()
    mesh = fem.tetrahedralize(surface, 1.6e-3)
    assert_same_as_surface(mesh, surface)
    assert mesh.report.refinements >= 1
    assert mesh.report.surface_distance < 0.05e-3


@pytest.mark.parametrize(
    ("solid", "edge_length_mm"),
    [
        (box((0, 0, 0), (30, 30, 10)) - box((6, 6, 1), (24, 24, 11)), 1.3),
        (box((0, 0, 0), (60, 40, 1)) + box((25, 0, 0.5), (35, 40, 20)), 1.3),
    ],
    ids=["pocket", "block on a plate"],
)
def test_thin_plates_beside_thick_blocks_stay_whole(solid, edge_length_mm):
    surface = surface_of(solid)
    for size in (None, 1e-3 * edge_length_mm):
        assert_same_as_surface(fem.tetrahedralize(surface, size), surface)


@pytest.mark.parametrize("angle_deg", [2.0, 5.0, 10.0])
def test_wedges_keep_their_edge(angle_deg):
    surface = wedge(angle_deg)
    mesh = fem.tetrahedralize(surface, 4e-3)
    assert_same_as_surface(mesh, surface)
    assert len(mesh.tets) < 40_000


def test_a_cavity_close_to_the_outside_stays_closed():
    surface = surface_of(box((0, 0, 0), (30, 20, 10)) - box((5, 5, 0.8), (25, 15, 6)))
    mesh = fem.tetrahedralize(surface)
    assert mesh.report.genus == [0, 0]
    assert_same_as_surface(mesh, surface)


def test_a_wedge_keeps_its_edge_at_the_default_size():
    surface = wedge(5.0)
    mesh = fem.tetrahedralize(surface)
    assert_same_as_surface(mesh, surface)
    assert mesh.quality.volume * 1e9 == pytest.approx(0.5 * 30.0**2 * np.tan(np.radians(5.0)) * 20.0, rel=1e-6)


BLOCK = box((0, 0, 0), (40, 40, 40))


@pytest.mark.parametrize(
    ("solid", "size_mm", "rel"),
    [
        (box((0, 0, 0), (20, 20, 20)) - box((5, 5, 5), (15, 15, 15)), None, 1e-9),
        (BLOCK - manifold3d.Manifold.sphere(8.0, 32).translate([20.0, 20.0, 20.0]), 4.8, 5e-3),
        (BLOCK - manifold3d.Manifold.sphere(8.0, 32).translate([20.0, 20.0, 20.0]), 9.5, 5e-3),
        (
            box((0, 0, 0), (60, 20, 20)) - manifold3d.Manifold.cylinder(40.0, 0.9, 0.9, 32).rotate([0.0, 90.0, 0.0])
            .translate([10.0, 10.0, 10.0]),
            None,
            3e-3,
        ),
    ],
    ids=["box", "sphere", "sphere, coarse", "rod"],
)  # fmt: skip
def test_a_sealed_cavity_stays_empty(solid, size_mm, rel):
    """Also one without sharp edges, at which the mesher would begin."""
    surface = surface_of(solid)
    mesh = fem.tetrahedralize(surface, None if size_mm is None else size_mm * 1e-3)
    assert mesh.report.genus == [0, 0]
    assert_same_as_surface(mesh, surface, volume_tolerance=rel)


def test_a_hole_beneath_the_surface_stays_a_tunnel():
    rod = manifold3d.Manifold.cylinder(42.0, 3.0, 3.0, 32).rotate([0.0, 90.0, 0.0]).translate([-1.0, 10.0, 3.6])
    surface = surface_of(box((0, 0, 0), (40, 20, 8)) - rod)
    mesh = fem.tetrahedralize(surface)
    assert mesh.report.genus == [1]
    assert_same_as_surface(mesh, surface, volume_tolerance=5e-3)


@pytest.mark.parametrize("angle_deg", [10.0, 28.0])
@pytest.mark.parametrize("edge_length", [None, 1e-3])
def test_a_rib_that_meets_a_taller_post_at_a_grazing_angle_keeps_the_groove_open(angle_deg, edge_length):
    """Where the groove ends, the post cuts the upper edges of the rib at that angle."""
    post = manifold3d.Manifold.cylinder(8.0, 6.0, 6.0, 32)
    x = 6.0 * float(np.cos(np.radians(angle_deg)))
    surface = surface_of(post + box((x, 0, 0), (x + 2.2, 12, 5)))
    mesh = fem.tetrahedralize(surface, edge_length)
    assert_same_as_surface(mesh, surface, volume_tolerance=5e-3)
    assert mesh.report.small_faults == 0
    assert mesh.report.refinements <= 3  # 2 with CGAL 5, 3 with CGAL 6


@pytest.mark.parametrize("edge_length", [None, 1.8e-3])
def test_a_window_lower_than_an_element_stays_open(edge_length):
    """Twice as high as the faults that are only counted; closed it would be a manifold of another genus."""
    surface = surface_of(fem_surfaces.windowed_bar(4.1102))
    mesh = fem.tetrahedralize(surface, None if edge_length is None else fem.default_size(surface, edge_length))
    assert mesh.report.genus == [2]
    assert_same_as_surface(mesh, surface, volume_tolerance=5e-3)


def test_a_boundary_that_touches_itself_on_a_tiny_ledge_bounds_the_solid_of_its_surface():
    surface = surface_of(fem_surfaces.windowed_bar(4.205))
    mesh = fem.tetrahedralize(surface)
    assert mesh.report.small_faults > 0
    assert mesh.report.genus == [2]
    assert mesh.quality.volume == pytest.approx(fem.mass_properties(surface, 1.0).volume, rel=5e-3)


def test_an_edge_length_far_too_small_is_refused_before_walls_are_measured():
    with pytest.raises(MeshLimitError, match=r"max_vertices\): an edge length of at least 0\.\d+ mm is needed"):
        fem.default_size(tray(), 1e-7)


def test_what_cannot_be_kept_is_refused_with_its_place():
    with pytest.raises(MeshError, match=r"another topology than its surface near \(.*\) mm: .*max_vertices"):
        fem.tetrahedralize(tray(), 2e-3, max_vertices=5000)


def test_default_size_follows_the_local_wall():
    size = fem.default_size(tray(), 3e-3)
    middle_of_floor, corner = size(np.array([[0.03, 0.03, 0.001], [0.001, 0.001, 0.004]]))
    assert 0.85e-3 <= middle_of_floor < 0.98e-3
    assert corner > 2.5e-3
    assert size.scaled(0.5).smallest == pytest.approx(0.5 * size.smallest)
    assert fem.default_size(wedge(20.0), 3e-3).smallest == pytest.approx(3e-3)


def test_a_large_thin_plate_does_not_ask_for_more_elements_than_stated():
    size = fem.default_size(surface_of(box((0, 0, 0), (400, 400, 1))))
    assert size.smallest > 0.85e-3


def dome(chords=16, rings=6, radius=45.0, height=90.0, jitter=1e-3):
    """Half an ellipsoid on a disk, whose rim is uneven by `jitter`; its only sharp edges lie in (nearly) one plane."""
    random = np.random.default_rng(0)
    points = []
    for ring in range(rings):
        up, turn = ring / rings * np.pi / 2, 2 * np.pi * (np.arange(chords) + 0.5 * (ring % 2)) / chords
        z = np.full(chords, height * np.sin(up)) + (jitter * random.standard_normal(chords) if ring == 0 else 0.0)
        points.append(np.stack([radius * np.cos(up) * np.cos(turn), radius * np.cos(up) * np.sin(turn), z], axis=1))
    points.append([[0.0, 0.0, height]])
    return fem.SurfaceMesh(np.vstack(points) * 1e-3, dome_triangles(chords, rings))


def dome_triangles(chords, rings):
    """(m, 3): rings of points, each turned by half a chord from the one below, a tip, and a fan below."""
    triangles = [[0, k + 1, k] for k in range(1, chords - 1)]
    for ring in range(rings - 1):
        for k in range(chords):
            a, b = ring * chords + k, ring * chords + (k + 1) % chords
            if ring % 2 == 0:
                above, beside = a + chords, (ring + 1) * chords + (k - 1) % chords
            else:
                above, beside = b + chords, a + chords
            triangles += [[a, b, above], [a, above, beside]]
    last, tip = (rings - 1) * chords, rings * chords
    triangles += [[last + k, last + (k + 1) % chords, tip] for k in range(chords)]
    return np.array(triangles, dtype=np.int32)


@pytest.mark.parametrize("size", [0.0108, 0.013])
def test_a_dome_over_its_rim_is_filled(size):
    surface = dome()
    assert_same_as_surface(fem.tetrahedralize(surface, fem.SizeField(size)), surface, volume_tolerance=0.02)


def test_a_cap_that_folds_the_surface_is_turned_away():
    """A triangle 40 nm high on an edge: three sharp lines within its height, between which no mesh came to an end."""
    points = np.array([[x, y, z] for z in (0.0, 20.0) for y in (0.0, 30.0) for x in (0.0, 40.0)], dtype=float)
    tip = [20.0, -2.4e-5, 20.0 + 3.2e-5]  # above the upper edge of the side y = 0, and before it
    quads = ((0, 2, 3, 1), (4, 5, 7, 6), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    triangles += [(0, 1, 8), (1, 5, 8), (0, 8, 4), (4, 8, 5)]  # the side, and the cap over the edge from 4 to 5
    surface = fem.SurfaceMesh(np.vstack([points, tip]) * 1e-3, np.array(triangles, dtype=np.int32))
    mesh = fem.tetrahedralize(surface, 6e-3, max_questions=2_000_000)
    assert_same_as_surface(mesh, surface)
    assert 0.0 < mesh.report.collapse_distance < 1e-7


def test_a_breakdown_of_the_refinement_is_answered_by_another_size():
    """Numbers in single precision: at this edge length the refinement contradicts itself by rounding."""
    xs, ys = (-0.03522159531712532, 0.1574999988079071), (-0.03819999843835831, 0.09560000151395798)
    zs = (0.05146408826112747, -0.00033591125975362957)
    order = ((0, 0, 0), (0, 1, 0), (0, 0, 1), (0, 1, 1), (1, 1, 0), (1, 1, 1), (1, 0, 0), (1, 0, 1))
    quads = ((0, 1, 2, 3), (1, 4, 3, 5), (4, 6, 5, 7), (6, 0, 7, 2), (6, 4, 0, 1), (5, 7, 3, 2))
    triangles = np.array([t for a, b, c, d in quads for t in ((a, b, c), (c, b, d))], dtype=np.int32)
    surface = fem.SurfaceMesh(np.array([(xs[i], ys[j], zs[k]) for i, j, k in order]), triangles)
    assert_same_as_surface(fem.tetrahedralize(surface, fem.SizeField(0.012512632608364677)), surface)
