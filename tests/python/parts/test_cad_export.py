"""Exported files load where they are used; numbers and places are right."""

import json
from pathlib import Path

import numpy as np
import pytest
import trimesh

from codesign.parts.cad_export import export_parts
from codesign.parts.component import Component
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
def test_stl_is_a_closed_solid_in_millimetres(part: JetpackBracket | ForearmJetSupport, folder: Path) -> None:
    mesh = trimesh.load(folder / f"{part.name}.stl")
    assert mesh.is_watertight
    assert mesh.body_count == 1
    properties = part.mass_properties()
    assert mesh.volume == pytest.approx(properties.volume * 1e9, rel=1e-3)  # chords of 0.01 mm
    np.testing.assert_allclose(mesh.center_mass, properties.com * 1e3, atol=0.05)
    header = (folder / f"{part.name}.stl").read_bytes()[:80]
    assert header.startswith(b"codesign " + part.title.encode())


def test_glb_places_all_components_in_metres_with_y_up(folder: Path) -> None:
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
    assert json.loads(data[20 : 20 + int.from_bytes(data[12:16], "little")])["asset"]["version"] == "2.0"


def test_3mf_holds_every_part_once_in_millimetres(folder: Path) -> None:
    pytest.importorskip("lxml")
    scene = trimesh.load(folder / "parts.3mf")
    volumes = sorted(mesh.volume for mesh in scene.geometry.values())
    expected = sorted([BRACKET.mass_properties().volume * 1e9, *[FOREARM.mass_properties().volume * 1e9] * 2])
    np.testing.assert_allclose(volumes, expected, rtol=1e-3)
    assert all(mesh.is_watertight for mesh in scene.geometry.values())


def test_two_parts_of_one_name_are_refused(tmp_path: Path) -> None:
    other = JetpackBracket(20, 50)
    components = [Component("a", BRACKET, np.eye(4)), Component("b", other, np.eye(4))]
    with pytest.raises(ValueError, match="same name"):
        export_parts(components, tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_component_refuses_what_is_no_pose() -> None:
    with pytest.raises(ValueError, match="component a: the pose"):
        Component("a", BRACKET, np.diag([2.0, 1.0, 1.0, 1.0]))
