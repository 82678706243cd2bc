"""Smooth surfaces behind coarse tessellations: shapes with known volumes, the authors' STL files."""

import json
import struct
import subprocess
import sys

import manifold3d
import numpy as np
import pytest

from codesign import fem
from codesign.cli.stress import stress_document
from codesign.errors import MeshError
from codesign.parts.materials import named_material
from codesign.studies.ironcub.bracket import JetpackBracket
from codesign.studies.ironcub.forearm import ForearmJetSupport


def extruded(outlines, height, names=None):
    mesh = manifold3d.CrossSection([np.asarray(outline) for outline in outlines]).extrude(height).to_mesh()
    points, triangles = np.asarray(mesh.vert_properties)[:, :3].astype(float), np.asarray(mesh.tri_verts)
    if names is None:
        return fem.SurfaceMesh(points, triangles)
    low, high = (points[triangles, 2].max(axis=1) < 1e-9), (points[triangles, 2].min(axis=1) > height - 1e-6)
    return fem.SurfaceMesh(points, triangles, np.where(low, 0, np.where(high, 1, 2)).tolist(), names)


def circle(radius, segments, center=(0.0, 0.0), hole=False):
    angle = 2 * np.pi * np.arange(segments) / segments * (-1 if hole else 1)
    return np.asarray(center) + radius * np.column_stack([np.cos(angle), np.sin(angle)])


def volume(surface):
    return fem.mass_properties(surface, 1.0).volume


def write_stl(path, surface):
    corners = surface.points[surface.triangles]
    records = b"".join(struct.pack("<12fH", 0, 0, 0, *np.ravel(t), 0) for t in corners)
    path.write_bytes(b"\0" * 80 + struct.pack("<I", len(corners)) + records)
    return path


@pytest.mark.parametrize(("segments", "angle", "better"), [(8, 50, 10), (10, 40, 10), (12, 40, 10), (20, 40, 5)])
def test_a_rod_gets_its_volume_and_bending_inertia_back(segments, angle, better):
    radius, length = 4.5, 130.0
    rod = extruded([circle(radius, segments)], length)
    smooth, report = fem.smooth_surface(rod, angle)
    area, second = np.pi * radius**2, np.pi * radius**4 / 4
    for surface, factor in ((rod, 1.0), (smooth, 1 / better)):
        moments = fem.mass_properties(surface, 1.0).inertia
        bending = 0.5 * moments[2, 2] / length  # of the section
        assert abs(volume(surface) / (area * length) - 1) < factor * 1.01 * (1 - volume(rod) / (area * length))
        assert abs(bending / second - 1) < factor * 13.3 / segments**2
    assert report.facets == 2 * segments
    assert report.reason == ""
    assert report.max_distance == pytest.approx(radius * (1 - np.cos(np.pi / segments)), rel=0.02)
    assert report.volume_change == pytest.approx(volume(smooth) / volume(rod) - 1, rel=1e-9)


@pytest.mark.parametrize("segments", [10, 12, 20])
def test_holes_in_a_plate_become_round_and_its_faces_stay_flat_and_named(segments):
    holes = [circle(8, segments, (15, 20), hole=True), circle(12, segments, (40, 20), hole=True)]
    outline = [(0, 0), (60, 0), (60, 40), (0, 40)]
    plate = extruded([outline, *holes], 5.0, ["bottom", "top", "side"])
    smooth, report = fem.smooth_surface(plate)
    area = 2400 - np.pi * (64 + 144)
    assert abs(volume(smooth) / (5 * area) - 1) < 0.1 * (volume(plate) / (5 * area) - 1)
    assert report.facets == 4 * segments
    assert smooth.face_names == ["bottom", "top", "side"]
    for face, height in ((0, 0.0), (1, 5.0)):
        corners = smooth.points[smooth.triangles[smooth.face == face]]
        np.testing.assert_allclose(corners[..., 2], height, atol=1e-12)
        a, b, c = corners.transpose(1, 0, 2)
        assert 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() == pytest.approx(area, rel=1e-3)


def test_a_block_with_rounded_edges_and_corners_keeps_its_flats():
    ball = manifold3d.Manifold.sphere(4.0, 16)
    places = [(x, y, z) for x in (0, 20) for y in (0, 15) for z in (0, 10)]
    mesh = manifold3d.Manifold.batch_hull([ball.translate(place) for place in places]).to_mesh()
    block = fem.SurfaceMesh(np.asarray(mesh.vert_properties)[:, :3].astype(float), np.asarray(mesh.tri_verts))
    smooth, _ = fem.smooth_surface(block)
    exact = 3000 + 8 * 650 + np.pi * 16 * 45 + 4 / 3 * np.pi * 64
    assert abs(volume(smooth) / exact - 1) < 0.1 * abs(volume(block) / exact - 1)
    a, b, c = (smooth.points[smooth.triangles[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a) / 2
    areas = np.linalg.norm(normals, axis=1)
    for axis, wanted in enumerate((150, 200, 300)):
        for sign in (-1, 1):
            facing = sign * normals[:, axis] > (1 - 1e-10) * areas
            assert areas[facing].sum() == pytest.approx(wanted, rel=1e-9)


def test_the_smooth_surface_has_no_gaps_and_no_smoothing_left_to_do():
    rod = extruded([circle(4.5, 12)], 30.0)
    smooth, report = fem.smooth_surface(rod)
    again, second = fem.smooth_surface(smooth)
    directed = np.concatenate([smooth.triangles[:, [k, (k + 1) % 3]] for k in range(3)])
    assert len(np.unique(directed, axis=0)) == len(directed)
    assert len(np.unique(np.vstack([directed, directed[:, ::-1]]), axis=0)) == len(directed)
    assert second.max_distance < 0.1 * report.max_distance
    assert abs(second.volume_change) < 0.1 * report.volume_change
    assert len(again.triangles) <= 4 * len(smooth.triangles)


def test_boxes_are_returned_unchanged_and_bad_arguments_refused():
    box = extruded([[(0, 0), (10, 0), (10, 10), (0, 10)]], 10.0)
    smooth, report = fem.smooth_surface(box)
    np.testing.assert_array_equal(smooth.points, box.points)
    np.testing.assert_array_equal(smooth.triangles, box.triangles)
    assert (report.facets, report.max_distance, report.volume_change) == (0, 0.0, 0.0)
    assert "nothing to curve" in report.reason
    with pytest.raises(ValueError, match="feature_angle"):
        fem.smooth_surface(box, 90.0)
    with pytest.raises(MeshError, match="open"):
        fem.smooth_surface(fem.SurfaceMesh(box.points, box.triangles[1:]))


def test_stress_says_that_facets_look_round_and_curves_them_when_asked(tmp_path):
    """A rod under tension: its twelve facets have 4.5 % less area than the circle."""
    path = write_stl(tmp_path / "rod.stl", extruded([circle(4.5, 12)], 60.0))
    arguments = (path, 1e-3, named_material("ergal"), ["near:0,0,0"], ["normal:0,0,1: 0 0 1000"], 1.5)
    literal, smooth = stress_document(*arguments), stress_document(*arguments, smooth=True)
    assert literal["smoothing"] is None
    assert smooth["facets_literal"] is None
    assert literal["facets_literal"] == smooth["smoothing"]
    assert smooth["smoothing"]["facets"] == 24
    assert smooth["smoothing"]["max_distance"] == pytest.approx(0.153e-3, rel=0.02)
    assert smooth["smoothing"]["volume_change"] == pytest.approx(0.047, abs=0.004)
    area = np.pi * 4.5e-3**2
    extension = 1000 * 0.06 / 71.7e9 / area
    assert smooth["max_displacement"] == pytest.approx(extension, rel=0.01)
    assert literal["max_displacement"] == pytest.approx(extension / 0.955, rel=0.01)
    assert smooth["reaction_force"] == pytest.approx([0, 0, -1000], abs=1e-4)


def test_facets_are_taken_literally_if_their_smooth_surface_cannot_be_meshed(tmp_path, monkeypatch):
    path = write_stl(tmp_path / "rod.stl", extruded([circle(4.5, 12)], 30.0))
    mesh = fem.tetrahedralize

    def refuse(surface, size, **options):
        if len(surface.triangles) > 100:
            raise MeshError("too fine")
        return mesh(surface, size, **options)

    monkeypatch.setattr(fem, "tetrahedralize", refuse)
    arguments = (path, 1e-3, named_material("ergal"), ["near:0,0,0"], ["normal:0,0,1: 0 0 1000"], 2.0)
    document = stress_document(*arguments, smooth=True)
    assert "too fine" in document["smoothing"]["reason"]
    assert document["smoothing"]["facets"] == 0
    assert document["volume"] == pytest.approx(3 * 4.5e-3**2 * 0.03, rel=0.02)  # of the prism


def test_command_line_reports_both(tmp_path):
    path = write_stl(tmp_path / "rod.stl", extruded([circle(4.5, 12)], 30.0))
    command = [sys.executable, "-m", "codesign.cli", "stress", str(path), "--fix", "near:0,0,0", "--edge-length", "2"]
    command += ["--load", "normal:0,0,1: 0 0 1000"]
    text = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    assert "facets that look round" in text
    assert "--smooth" in text
    text = subprocess.run([*command, "--smooth"], capture_output=True, text=True, check=True).stdout
    assert "facets curved back" in text
    output = subprocess.run([*command, "--smooth", "--json"], capture_output=True, check=True).stdout
    assert json.loads(output)["smoothing"]["facets"] == 24


PARTS = [
    ("optim1_bracket", JetpackBracket.as_published(1, 47.9133)),
    ("optim3_bracket", JetpackBracket.as_published(1, 47.9133)),
    ("optim1_l_forearm", ForearmJetSupport.as_published(88, 50)),
    ("optim3_l_forearm", ForearmJetSupport.as_published(100, 130)),
]


@pytest.mark.parametrize(("name", "part"), PARTS, ids=[name for name, _ in PARTS])
def test_published_files_get_the_volume_of_the_true_parts(shared_data, name, part):
    surface = fem.load_surface(shared_data / "parts" / f"{name}.stl", scale=1e-3)
    smooth, report = fem.smooth_surface(surface)
    exact = part.mass_properties().volume
    assert report.reason == ""
    assert abs(volume(smooth) / exact - 1) < min(1e-3, 0.3 * abs(volume(surface) / exact - 1))


MOUNT = ["box:-6.01,-100,-100,7,100,100"]
BASE = ["box:-21,-31,-0.01,200,31,0.01", "box:-21,-31,14.99,200,31,15.01"]


@pytest.mark.parametrize(
    ("name", "fix", "load", "reference"),
    [  # displacement [mm] of the true part with its fillets, docs/meshing.md
        ("optim1_bracket", BASE, "near:81.05,0,1.979: -4.3631 0 249.9619", 0.0174),
        ("optim1_l_forearm", MOUNT, "near:-109,15,-20: 250 0 0", 0.517),
        ("optim3_l_forearm", MOUNT, "near:-189,15,-20: 250 0 0", 1.108),
    ],
)
def test_published_files_bend_like_the_true_parts(shared_data, name, fix, load, reference):
    path = shared_data / "parts" / f"{name}.stl"
    document = stress_document(path, 1e-3, named_material("ergal"), fix, [load], smooth=True)
    assert document["max_displacement"] * 1e3 == pytest.approx(reference, rel=0.03)
    assert document["mesh"]["min_dihedral_deg"] > 4.0
    assert document["smoothing"]["reason"] == ""
