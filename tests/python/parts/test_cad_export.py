"""Exported files load where they are used; numbers and places are right."""

import itertools
import json
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import manifold3d
import numpy as np
import pytest
import trimesh

import codesign
from codesign.geometry.layout import lay_out
from codesign.geometry.mesh_files import write_glb
from codesign.parts.cad_export import export_parts
from codesign.parts.component import Component
from codesign.parts.part import EXPORT_RESOLUTION
from codesign.studies.ironcub.bracket import JetpackBracket
from codesign.studies.ironcub.forearm import ForearmJetSupport

BRACKET, FOREARM = JetpackBracket(15, 42), ForearmJetSupport(80, 108)


def pose(x: float, y: float, z: float) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, :3] = [[1, 0, 0], [0, -1, 0], [0, 0, -1]]
    matrix[:3, 3] = (x, y, z)
    return matrix


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    target = tmp_path_factory.mktemp("export") / "cad"
    components = [
        Component("l_bracket", BRACKET, pose(0.1, 0.2, 0.3)),
        Component("r_bracket", BRACKET, pose(0.1, -0.2, 0.3)),
        Component("l_forearm", FOREARM, pose(0.0, 0.4, 0.0)),
        Component("r_forearm", FOREARM.mirrored("z", "r_forearm_support"), pose(0.0, -0.4, 0.0)),
    ]
    written = export_parts(components, target)
    assert sorted(written) == sorted(target.iterdir())
    return target


def test_all_files_are_there(folder: Path) -> None:
    parts = ("jetpack_bracket", "forearm_support", "r_forearm_support")
    expected = {f"{part}.{suffix}" for part in parts for suffix in ("stl", "step")}
    assert {file.name for file in folder.iterdir()} == expected | {"parts.3mf", "assembly.glb", "assembly.step"}


@pytest.mark.parametrize("part", [BRACKET, FOREARM], ids=lambda part: part.name)
def test_stl_is_a_closed_solid_in_millimeters(part: JetpackBracket | ForearmJetSupport, folder: Path) -> None:
    mesh = trimesh.load(folder / f"{part.name}.stl")
    assert mesh.is_watertight
    assert mesh.body_count == 1
    properties = part.mass_properties()
    assert mesh.volume == pytest.approx(properties.volume * 1e9, rel=1e-3)  # chords of 0.01 mm
    np.testing.assert_allclose(mesh.center_mass, properties.com * 1e3, atol=0.05)
    header = (folder / f"{part.name}.stl").read_bytes()[:80]
    assert header.startswith(b"codesign " + part.title.encode())


def test_glb_places_all_components_in_meters_with_y_up(folder: Path) -> None:
    scene = trimesh.load(folder / "assembly.glb")
    assert set(scene.geometry) == {"jetpack_bracket", "forearm_support", "r_forearm_support"}
    y_up_R_z_up = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])
    transform, geometry = scene.graph["r_bracket"]
    assert geometry == "jetpack_bracket"
    np.testing.assert_allclose(transform[:3, 3], y_up_R_z_up @ [0.1, -0.2, 0.3], atol=1e-12)
    np.testing.assert_allclose(transform[:3, :3], y_up_R_z_up @ pose(0, 0, 0)[:3, :3], atol=1e-12)
    volume = scene.geometry["jetpack_bracket"].volume
    assert volume == pytest.approx(BRACKET.mass_properties().volume, rel=1e-3)
    data = (folder / "assembly.glb").read_bytes()
    assert int.from_bytes(data[8:12], "little") == len(data)
    gltf = json.loads(data[20 : 20 + int.from_bytes(data[12:16], "little")])
    assert gltf["asset"] == {"version": "2.0", "generator": f"codesign {codesign.__version__}"}
    names = [node["name"] for node in gltf["nodes"] if node["name"] != "y up"]  # which some versions of trimesh write
    assert names == ["z up", "l_bracket", "r_bracket", "l_forearm", "r_forearm"]
    assert [mesh["name"] for mesh in gltf["meshes"]] == list(scene.geometry)  # two brackets share one
    (material,) = gltf["materials"]
    assert material["name"] == "metal"
    assert all(
        p["material"] == 0 and set(p["attributes"]) == {"POSITION"} for m in gltf["meshes"] for p in m["primitives"]
    )


def test_glb_holds_the_points_and_triangles_of_its_solids(folder: Path) -> None:
    solid = BRACKET.solid(EXPORT_RESOLUTION)
    scene = trimesh.load(folder / "assembly.glb", process=False, merge_primitives=False)
    read = scene.geometry["jetpack_bracket"]
    np.testing.assert_array_equal(read.faces, solid.triangles)
    np.testing.assert_array_equal(read.vertices, (solid.points * 1e-3).astype(np.float32))


def test_two_nodes_of_one_name_are_refused(tmp_path: Path) -> None:
    solid = BRACKET.solid(EXPORT_RESOLUTION)
    with pytest.raises(ValueError, match="same name: left"):
        write_glb({"a": solid}, [("left", "a", np.eye(4))] * 2, tmp_path / "a.glb")
    assert not list(tmp_path.iterdir())


def read_3mf(path: Path) -> list[tuple[str, np.ndarray, np.ndarray]]:
    """Name, placed points [mm] and triangles of every item on the plate."""
    core = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"
    with zipfile.ZipFile(path) as package:
        model = ElementTree.fromstring(package.read("3D/3dmodel.model"))
    assert model.get("unit") == "millimeter"
    objects = {}
    for element in model.iter(f"{core}object"):
        points = np.array([[float(v.get(axis)) for axis in "xyz"] for v in element.iter(f"{core}vertex")])
        triangles = np.array([[int(t.get(f"v{k}")) for k in (1, 2, 3)] for t in element.iter(f"{core}triangle")])
        objects[element.get("id")] = (element.get("name"), points, triangles)
    items = []
    for item in model.iter(f"{core}item"):
        name, points, triangles = objects[item.get("objectid")]
        matrix = np.array(item.get("transform").split(), dtype=float).reshape(4, 3)
        np.testing.assert_array_equal(matrix[:3], np.eye(3))
        items.append((name, points + matrix[3], triangles))
    return items


def test_3mf_is_a_plate_with_all_that_the_design_needs(folder: Path) -> None:
    items = read_3mf(folder / "parts.3mf")
    assert [name for name, _, _ in items] == ["jetpack_bracket"] * 2 + ["forearm_support", "r_forearm_support"]
    bodies = []
    for name, points, triangles in items:
        part = FOREARM if "forearm" in name else BRACKET
        body = manifold3d.Manifold(manifold3d.Mesh64(points, triangles.astype(np.uint64)))
        assert body.volume() == pytest.approx(part.mass_properties().volume * 1e9, rel=1e-3)
        assert 0.0 <= points[:, 2].min() < 1e-3
        bodies.append(body)
    for one, other in itertools.combinations(bodies, 2):
        assert (one ^ other).is_empty()
        assert one.min_gap(other, 10.0) >= 5.0
    model = zipfile.ZipFile(folder / "parts.3mf").read("3D/3dmodel.model").decode()
    assert model.count("<object ") == 3  # the two brackets share one


def test_rectangles_are_laid_out_apart_and_compactly() -> None:
    sizes = [(float(w), float(d)) for w, d in np.random.default_rng(0).integers(1, 60, (40, 2))]
    corners = lay_out(sizes, gap=2.0)
    for (a, s), (b, t) in itertools.combinations(list(zip(corners, sizes, strict=True)), 2):
        assert any(a[i] + s[i] + 2.0 <= b[i] or b[i] + t[i] + 2.0 <= a[i] for i in (0, 1))
    ends = np.array(corners) + np.array(sizes)
    assert np.min(corners) == 0.0
    assert np.prod(ends.max(axis=0)) < 1.4 * sum((w + 2) * (d + 2) for w, d in sizes)
    assert lay_out([]) == []
    assert lay_out([(300.0, 10.0), (5.0, 5.0)]) == [(0.0, 0.0), (0.0, 15.0)]


def test_two_parts_of_one_name_are_refused(tmp_path: Path) -> None:
    other = JetpackBracket(20, 50)
    components = [Component("a", BRACKET, np.eye(4)), Component("b", other, np.eye(4))]
    with pytest.raises(ValueError, match="same name"):
        export_parts(components, tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_component_refuses_what_is_no_pose() -> None:
    with pytest.raises(ValueError, match="component a: the pose"):
        Component("a", BRACKET, np.diag([2.0, 1.0, 1.0, 1.0]))
