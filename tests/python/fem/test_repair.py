"""Surfaces as files bring them: what is wrong is said, and repair gives the solid that was meant."""

import manifold3d
import numpy as np
import pytest

from codesign import fem
from codesign.errors import MeshError
from stl_files import box, facets_of, stl

CUBE = ((0, 0, 0), (10, 10, 10))


@pytest.fixture
def read(tmp_path):
    """Facets as a surface, by way of a file."""
    return lambda *facets: fem.read_stl(stl(tmp_path / "part.stl", *facets), 1e-3)


def t_junction():
    """A block of 40 x 20 x 10 mm; one facet of its front is cut in two where its neighbor is not."""
    facets = box((0, 0, 0), (40, 20, 10))
    cut = next(i for i, f in enumerate(facets) if {tuple(p) for p in f} >= {(0, 0, 10), (40, 0, 10)})
    k = next(k for k in range(3) if {tuple(facets[cut][k]), tuple(facets[cut][k - 2])} == {(0, 0, 10), (40, 0, 10)})
    a, b, tip = (facets[cut][k - i] for i in (0, 2, 1))
    middle = 0.5 * (a + b)
    return np.concatenate([np.delete(facets, cut, axis=0), [[a, middle, tip], [middle, b, tip]]])


def test_a_t_junction_is_named_and_split(read):
    surface = read(t_junction())
    with pytest.raises(MeshError, match=r"open: 3 edges .* corner \(0.02, 0, 0.01\) m .* \(a T-junction\)"):
        fem.check_surface(surface)
    repaired, report = fem.repair_surface(surface)
    assert fem.mass_properties(repaired, 1.0).volume == pytest.approx(8000e-9, rel=1e-9)
    assert (report.t_junctions, report.triangles, report.volume[0]) == (1, (13, 14), None)
    assert report.largest_shift < 1e-12


def test_a_facet_written_twice_is_dropped(read):
    for twice in (slice(0, 1), slice(0, 12)):  # one, and every one
        facets = box(*CUBE)
        surface = read(facets, facets[twice])
        with pytest.raises(MeshError, match=f"triangles meet .* triangles written twice: {twice.stop}"):
            fem.check_surface(surface)
        repaired, report = fem.repair_surface(surface)
        assert len(repaired.triangles) == 12
        assert report.doubled == twice.stop
        assert report.volume[1] == pytest.approx(1e-6, rel=1e-9)
        assert report.area[1] == pytest.approx(6e-4, rel=1e-9)


def test_a_wall_without_thickness_is_dropped(read):
    wall = np.array([[[0, 0, 10], [10, 0, 10], [5, 0, 15]], [[5, 0, 15], [10, 0, 10], [0, 0, 10]]], dtype=float)
    repaired, report = fem.repair_surface(read(box(*CUBE), wall))
    assert (len(repaired.triangles), report.doubled) == (12, 2)


def test_facets_and_shells_are_turned_outward(read):
    facets = box(*CUBE)
    facets[3] = facets[3, ::-1]
    _, report = fem.repair_surface(read(facets))
    assert report.turned == 1
    assert report.volume[1] == pytest.approx(1e-6, rel=1e-9)
    with pytest.raises(MeshError, match="inside-out: it encloses -1000 mm³"):
        fem.check_surface(read(box(*CUBE, inside_out=True)))
    _, report = fem.repair_surface(read(box(*CUBE, inside_out=True)))
    assert (report.turned_shells, report.volume) == (1, (pytest.approx(-1e-6), pytest.approx(1e-6)))
    assert report.largest_shift == 0.0


@pytest.mark.parametrize("inside_out", [False, True])
def test_a_cavity_stays_a_cavity(read, inside_out):
    shells = box(*CUBE, inside_out), box((2, 2, 2), (5, 5, 5), not inside_out)
    repaired, report = fem.repair_surface(read(*shells))
    assert fem.mass_properties(repaired, 1.0).volume == pytest.approx(973e-9, rel=1e-9)
    assert report.changed == inside_out


@pytest.mark.parametrize(
    ("other", "volume", "area", "counted"),
    [
        (box((5, 5, 5), (15, 15, 15)), 1875, 1050, "united"),  # overlapping
        (box((5, 5, 5), (15, 15, 15), inside_out=True), 1875, 1050, "united"),
        (box((10, 0, 0), (15, 10, 10)), 1500, 800, "doubled"),  # touching
        (box((2, 2, 2), (5, 5, 5)), 1000, 600, "united"),  # one inside the other
    ],
)
def test_bodies_that_overlap_or_touch_are_united(read, other, volume, area, counted):
    surface = read(box(*CUBE), other)
    with pytest.raises(MeshError):
        fem.check_surface(surface)
    repaired, report = fem.repair_surface(surface)
    assert getattr(report, counted) == {"united": 2, "doubled": 4}[counted]
    assert report.volume[1] == pytest.approx(volume * 1e-9, rel=1e-6)
    assert report.area[1] == pytest.approx(area * 1e-6, rel=1e-6)
    assert report.largest_shift < 1e-9
    assert fem.tetrahedralize(repaired, 8e-3).quality.volume == pytest.approx(volume * 1e-9, rel=1e-9)


def test_bodies_apart_are_counted_and_placed(read):
    surface = read(box(*CUBE), box((20, 0, 0), (25, 10, 10)))
    named = r"2 bodies of 1000 and 500 mm³ around \(0.005, 0.005, 0.005\) and \(0.0225, 0.005, 0.005\) m"
    with pytest.raises(MeshError, match=named):
        fem.tetrahedralize(surface, 5e-3)
    with pytest.raises(MeshError, match=named + r".* repair within 0.00574 mm does not help"):
        fem.repair_surface(surface)


def test_a_gap_is_closed_within_the_tolerance(read):
    facets = box(*CUBE)
    facets[facets[:, :, 2].min(axis=1) == 10.0] += (0.0, 0.0, 0.004)  # the lid hovers
    with pytest.raises(MeshError, match=r"open: 8 edges .* repair within 0.00346 mm does not help"):
        fem.repair_surface(read(facets))
    _, report = fem.repair_surface(read(facets), 5e-6)
    assert report.merged_points == 4
    assert report.volume[1] == pytest.approx(1e-6, rel=1e-3)
    assert report.largest_shift == pytest.approx(4e-6, rel=1e-2)


def test_holes_are_not_filled(read):
    with pytest.raises(MeshError, match=r"open: 3 edges .* does not help"):
        fem.repair_surface(read(box(*CUBE)[1:]))


def test_a_sound_surface_keeps_its_arrays_and_names(read):
    plain = read(box(*CUBE))
    named = fem.SurfaceMesh(plain.points, plain.triangles, [0] * 12, ["all"])
    repaired, report = fem.repair_surface(named)
    assert repaired.face_names == ["all"]
    assert (repaired.points == plain.points).all()
    assert not report.changed
    with pytest.raises(ValueError, match="tolerance = 0"):
        fem.repair_surface(named, 0.0)


@pytest.mark.parametrize(
    ("start", "named"),
    [
        (b"ISO-10303-21;\nHEADER;\n", "a STEP file: read it by load_step"),
        (b"# Blender\nmtllib a.mtl\no Cube\nv 1.0 1.0 -1.0\nf 1 2 3\n", "an OBJ file: convert"),
        (b"v 1 1 1\nv 1 0 0\nf 1 2 3\n", "an OBJ file"),
        (b"PK\x03\x04\x14\x00____3D/3dmodel.model", "a 3MF file"),
        (b"PK\x03\x04\x14\x00____part.stl", "a zip archive: unpack"),
        (b"ply\nformat ascii 1.0\n", "a PLY file"),
        (b"glTF\x02\x00\x00\x00", "a GLB file"),
        (b'{"asset": {"version": "2.0"}}', "a glTF file"),
        (b"\r\n<!doctype HTML>\n<html>", "a web page: the download failed"),
        (b"<?xml version='1.0'?>\n<COLLADA>", "a COLLADA file"),
        (b"<?xml version='1.0'?>\n<robot name='a'>", "URDF"),
        (b"OFF\n8 12 0\n", "an OFF file"),
        (b"version https://git-lfs.github.com/spec/v1\n", "a Git LFS pointer: fetch"),
        (b" " * 72 + b"S      1\n", "an IGES file"),
        (b"  0\nSECTION\n  2\nHEADER\n", "a DXF drawing"),
        (b"\x1f\x8b\x08", "compressed by gzip"),
    ],
)
@pytest.mark.parametrize("length", [0, 500])
def test_other_formats_are_named(tmp_path, start, named, length):
    path = tmp_path / "part.stl"
    path.write_bytes(start + b" " * length)
    with pytest.raises(MeshError, match=f"part.stl: not an STL file but .*{named}"):
        fem.load_surface(path)


def test_simplification_does_not_make_a_sound_surface_cross_itself(tmp_path):
    plate = manifold3d.Manifold.cube((40, 20, 6))
    vertical = manifold3d.Manifold.cylinder(8, 3, 3, 64).translate((20, 10, -1))
    level = manifold3d.Manifold.cylinder(30, 3, 3, 64).rotate((90, 0, 0)).translate((20, 25, 3.02))  # 0.02 mm above
    surface = fem.load_surface(stl(tmp_path / "part.stl", facets_of(plate - vertical - level)), 1e-3)
    mesh = fem.tetrahedralize(surface, 3e-3)  # elements half as long as the holes are wide: their walls are chords
    assert mesh.quality.volume == pytest.approx(4209.8e-9, rel=5e-3)


def test_a_sliver_of_an_unnamed_face_refuses_no_part(tmp_path):
    outline = [(-0.1, 10), (10, 8.21909714), (10, 20), (0, 20), (0, 10)]  # a knife lip of 0.1 mm and 10 degrees
    block = manifold3d.Manifold.extrude(manifold3d.CrossSection([outline]), 10)
    surface = fem.load_surface(stl(tmp_path / "part.stl", facets_of(block)), 1e-3)
    for candidate in (surface, fem.SurfaceMesh(surface.points, surface.triangles)):
        mesh = fem.tetrahedralize(candidate, 2e-3)
        assert mesh.quality.volume == pytest.approx(1089.94e-9, rel=1e-4)
        assert mesh.nodes[:, 0].min() == pytest.approx(-0.1e-3, rel=1e-6)  # the lip
