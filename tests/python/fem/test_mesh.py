"""Surfaces read from files, their mass properties, and tetrahedra made from them."""

import struct
from pathlib import Path

import numpy as np
import pytest

from codesign import fem
from codesign.errors import MeshError

CUBE_POINTS = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=float)
CUBE_QUADS = {  # outward
    "bottom": (0, 2, 3, 1),
    "top": (4, 5, 7, 6),
    "front": (0, 1, 5, 4),
    "back": (2, 6, 7, 3),
    "left": (0, 4, 6, 2),
    "right": (1, 3, 7, 5),
}


def box(size=(1.0, 1.0, 1.0), names=CUBE_QUADS):
    """A box with one face a side."""
    triangles, face = [], []
    for k, quad in enumerate(CUBE_QUADS.values()):
        a, b, c, d = quad
        triangles += [(a, b, c), (a, c, d)]
        face += [k, k]
    return fem.SurfaceMesh(CUBE_POINTS * size, np.array(triangles), face, list(names))


def cylinder(radius, height, segments):
    """A prism with faces bottom, top, side; z from 0 to height."""
    angle = 2 * np.pi * np.arange(segments) / segments
    ring = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)
    points = np.vstack([np.c_[ring, np.zeros(segments)], np.c_[ring, np.full(segments, height)]])
    triangles, face = [], []
    for i in range(segments):
        j = (i + 1) % segments
        triangles += [(i, j, j + segments), (i, j + segments, i + segments)]
        face += [2, 2]
    for i in range(1, segments - 1):
        triangles += [(0, i + 1, i), (segments, segments + i, segments + i + 1)]
        face += [0, 1]
    return fem.SurfaceMesh(points, np.array(triangles), face, ["bottom", "top", "side"])


def triangle_areas(points, triangles):
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)


def face_area(mesh, name):
    chosen = mesh.boundary_face == mesh.face_names.index(name)
    return triangle_areas(mesh.nodes, mesh.boundary[chosen]).sum()


def write_binary(path: Path, corners):
    records = b"".join(struct.pack("<12fH", 0, 0, 0, *np.ravel(t), 0) for t in corners)
    path.write_bytes(b"solid made by a careless program".ljust(80) + struct.pack("<I", len(corners)) + records)


def write_ascii(path: Path, corners):
    text = ["solid box"]
    for t in corners:
        text += ["facet normal 0 0 0", "outer loop", *(f"vertex {x!r} {y!r} {z!r}" for x, y, z in t.tolist())]
        text += ["endloop", "endfacet"]
    path.write_text("\n".join([*text, "endsolid box"]))


@pytest.fixture
def cube_corners():
    surface = box()
    return surface.points[surface.triangles]


@pytest.mark.parametrize("write", [write_binary, write_ascii])
def test_stl_is_read_and_its_faces_are_found(tmp_path, cube_corners, write):
    write(tmp_path / "cube.stl", 25.0 * cube_corners)
    surface = fem.load_surface(tmp_path / "cube.stl", scale=1e-3)
    assert surface.points.shape == (8, 3)
    assert surface.triangles.shape == (12, 3)
    assert surface.face_names == [""] * 6
    assert fem.mass_properties(surface, 1.0).volume == pytest.approx(0.025**3, rel=1e-12)


def test_arrays_of_a_surface_are_read_only_views():
    surface = box()
    with pytest.raises(ValueError, match="read-only"):
        surface.points[0, 0] = 1.0
    assert surface.points.base is not None


def test_mass_properties_of_a_box_far_from_the_origin():
    a, b, c = 0.2, 0.3, 0.5
    surface = box((a, b, c))
    moved = fem.SurfaceMesh(surface.points + np.array([10.0, -20.0, 5.0]), surface.triangles)
    for body, offset in ((surface, 0.0), (moved, [10.0, -20.0, 5.0])):
        properties = fem.mass_properties(body, density=2700.0)
        mass = 2700.0 * a * b * c
        assert properties.mass == pytest.approx(mass, rel=1e-11)
        assert properties.com == pytest.approx(np.array([a, b, c]) / 2 + offset, rel=1e-12)
        expected = mass / 12 * np.diag([b * b + c * c, a * a + c * c, a * a + b * b])
        assert properties.inertia == pytest.approx(expected, rel=1e-9, abs=1e-12 * mass)


def test_mesh_of_a_box_fills_it_and_keeps_its_faces():
    surface = box((0.03, 0.02, 0.01))
    mesh = fem.tetrahedralize(surface, edge_length=0.004)
    assert mesh.quality.volume == pytest.approx(0.03 * 0.02 * 0.01, rel=1e-12)
    assert face_area(mesh, "top") == pytest.approx(0.03 * 0.02, rel=1e-12)
    assert face_area(mesh, "right") == pytest.approx(0.02 * 0.01, rel=1e-12)
    assert mesh.quality.min_dihedral_deg > 5.0
    top = mesh.boundary[mesh.boundary_face == mesh.face_names.index("top")]
    assert mesh.nodes[top][..., 2] == pytest.approx(0.01, abs=1e-15)
    # mid nodes in the middle of the edges 01 12 02 03 13 23
    for column, (i, j) in enumerate([(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)], start=4):
        middle = 0.5 * (mesh.nodes[mesh.tets[:, i]] + mesh.nodes[mesh.tets[:, j]])
        assert mesh.nodes[mesh.tets[:, column]] == pytest.approx(middle, abs=1e-16)


def test_mesh_of_a_cylinder_follows_the_round_side():
    mesh = fem.tetrahedralize(cylinder(0.01, 0.03, 48), edge_length=0.003)
    exact = 0.5 * 48 * np.sin(2 * np.pi / 48) * 0.01**2 * 0.03
    assert mesh.quality.volume == pytest.approx(exact, rel=0.02)
    assert mesh.quality.min_dihedral_deg > 5.0
    side = mesh.boundary[mesh.boundary_face == mesh.face_names.index("side")]
    radius = np.linalg.norm(mesh.nodes[side[:, :3]][..., :2], axis=-1)
    assert radius.min() > 0.01 * np.cos(np.pi / 48) - 1e-9
    assert radius.max() < 0.01 + 1e-9


def test_curved_elements_fill_a_round_part_that_straight_ones_cut_off():
    """Edges of half the radius: the mid-edge nodes carry the shape."""
    surface = cylinder(0.01, 0.03, 96)
    volume = fem.mass_properties(surface, 1.0).volume
    straight = fem.tetrahedralize(surface, 0.005, facet_distance=0.2, curved=False)
    curved = fem.tetrahedralize(surface, 0.005, facet_distance=0.2)
    assert np.array_equal(straight.tets, curved.tets)
    side = curved.boundary[curved.boundary_face == curved.face_names.index("side")]
    radius = np.linalg.norm(curved.nodes[side][..., :2], axis=-1)
    assert np.quantile(radius, 0.05) > 0.00999  # a straight edge would be at 0.0097
    material = fem.Material("steel", 210e9, 0.3, 1.0)

    def integrated(mesh):  # area of the curved side, from the pressure that balances on it
        return fem.solve_static(
            mesh, material, [fem.Support("bottom")], [fem.Acceleration([0.0, 0.0, -1.0])]
        ).reactions.sum(axis=0)[2]

    assert integrated(straight) < 0.97 * volume
    assert integrated(curved) == pytest.approx(volume, rel=3e-3)


def test_border_between_faces_is_kept_although_it_is_flat():
    """The top of a box in two faces: the border is a line of the mesh, areas are exact."""
    points = np.vstack([CUBE_POINTS, [[0.4, 0, 1], [0.4, 1, 1]]])
    triangles = [(0, 2, 3), (0, 3, 1), (0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5)]  # bottom, left, right
    triangles += [(0, 1, 5), (0, 5, 8), (0, 8, 4), (2, 6, 9), (2, 9, 7), (2, 7, 3)]  # front, back
    triangles += [(4, 8, 9), (4, 9, 6), (8, 5, 7), (8, 7, 9)]
    face = [0] * 12 + [1, 1, 2, 2]
    surface = fem.SurfaceMesh(points, np.array(triangles), face, ["", "narrow", "wide"])
    mesh = fem.tetrahedralize(surface, edge_length=0.15)
    assert face_area(mesh, "narrow") == pytest.approx(0.4, rel=1e-12)
    assert face_area(mesh, "wide") == pytest.approx(0.6, rel=1e-12)


def test_size_field_makes_elements_small_near_its_source():
    source = fem.SizeSource([[0, 0, 1.0], [1.0, 0, 1.0]], size=0.05, growth=0.5, radius=0.1)
    field = fem.SizeField(0.3, [source])
    assert field(np.array([[0.5, 0, 1.0], [0.5, 0.3, 1.0], [0.5, 1, 0]])) == pytest.approx([0.05, 0.15, 0.3])
    mesh = fem.tetrahedralize(box(), field)
    corners = mesh.nodes[mesh.tets[:, :4]]
    center = corners.mean(axis=1)
    near = np.hypot(center[:, 1], center[:, 2] - 1) < 0.1
    far = np.hypot(center[:, 1], center[:, 2] - 1) > 0.9
    edge = np.linalg.norm(corners[:, 0] - corners[:, 1], axis=1)
    assert 0.04 < edge[near].mean() < 0.075
    assert edge[far].mean() > 0.15


def test_the_same_surface_gives_the_same_mesh():
    first, second = (fem.tetrahedralize(cylinder(0.01, 0.03, 48), 0.003) for _ in range(2))
    assert np.array_equal(first.nodes, second.nodes)
    assert np.array_equal(first.tets, second.tets)


def test_meshing_stops_at_its_limits():
    with pytest.raises(MeshError, match="time_limit"):
        fem.tetrahedralize(box(), edge_length=0.02, time_limit=0.05)
    with pytest.raises(MeshError, match="max_vertices"):
        fem.tetrahedralize(box(), edge_length=0.05, max_vertices=500)


def test_bad_surfaces_are_refused():
    good = box()
    with pytest.raises(MeshError, match="open: 3 edges"):
        fem.mass_properties(fem.SurfaceMesh(good.points, good.triangles[1:]), 1.0)
    with pytest.raises(MeshError, match="inside-out"):
        fem.mass_properties(fem.SurfaceMesh(good.points, good.triangles[:, ::-1]), 1.0)
    turned = good.triangles.copy()
    turned[3] = turned[3, ::-1]
    with pytest.raises(MeshError, match="oriented against each other"):
        fem.mass_properties(fem.SurfaceMesh(good.points, turned), 1.0)
    with pytest.raises(MeshError, match="empty"):
        fem.mass_properties(fem.SurfaceMesh(good.points, np.zeros((0, 3), int)), 1.0)
    with pytest.raises(MeshError, match="not finite"):
        fem.SurfaceMesh(np.full((3, 3), np.nan), [[0, 1, 2]])
    with pytest.raises(ValueError, match="density"):
        fem.mass_properties(good, 0.0)
    with pytest.raises(ValueError, match="outside"):
        fem.SurfaceMesh(good.points, [[0, 1, 8]])
    two = fem.SurfaceMesh(np.vstack([good.points, good.points + 0.5]), np.vstack([good.triangles, good.triangles + 8]))
    with pytest.raises(MeshError, match="crosses itself"):
        fem.tetrahedralize(two, 0.3)
    apart = fem.SurfaceMesh(
        np.vstack([good.points, good.points + np.array([2, 0, 0])]), np.vstack([good.triangles, good.triangles + 8])
    )
    with pytest.raises(MeshError, match="2 bodies"):
        fem.tetrahedralize(apart, 0.3)


def test_a_wedge_too_thin_to_mesh_is_stopped():
    """Two sharp lines at 0.2 degrees need ever smaller balls: the clock ends it."""
    tip = np.radians(0.2)
    outline = np.array([[0.0, 0.0], [0.1, 0.0], [0.1 * np.cos(tip), 0.1 * np.sin(tip)]])
    points = np.vstack([np.column_stack([outline, np.full(3, z)]) for z in (0.0, 0.02)])
    sides = [[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3], [2, 3, 5]]
    wedge = fem.SurfaceMesh(points, [[0, 2, 1], [3, 4, 5], *sides])
    with pytest.raises(MeshError, match="time_limit"):
        fem.tetrahedralize(wedge, 0.005, time_limit=0.5)


@pytest.mark.parametrize("name", ["optim1_bracket.stl", "optim1_l_forearm.stl", "optim3_l_forearm.stl"])
def test_published_parts_mesh_as_they_are(shared_data, name):
    surface = fem.load_surface(shared_data / "parts" / name, scale=1e-3)
    mesh = fem.tetrahedralize(surface, edge_length=0.006)
    assert mesh.quality.min_dihedral_deg > 4.0
    assert mesh.report.collapse_distance <= 5e-5
    assert mesh.quality.volume == pytest.approx(fem.mass_properties(surface, 1.0).volume, rel=5e-3)
