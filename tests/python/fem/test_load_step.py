"""STEP files in: names, colors and kinds of faces, units, assemblies, what is refused."""

import math
from dataclasses import dataclass

import numpy as np
import pytest
from OCP.Interface import Interface_Static
from OCP.STEPControl import STEPControl_StepModelType, STEPControl_Writer

from codesign import fem
from codesign.errors import MeshError
from codesign.fem.step import load_step
from codesign.geometry.brep import build_brep
from codesign.geometry.shape import Shape, box, cylinder
from codesign.parts.component import Component
from codesign.parts.part import Part
from codesign.parts.step import write_step, write_step_assembly

EXACT = 40 * 30 * 8 - math.pi * 9 * 8 + math.pi * 25 * 6  # mm³


@dataclass(frozen=True)
class Plate(Part):
    """A plate with a hole of 6 mm and a boss of 10 mm."""

    name: str = "plate"
    density: float = 2700.0

    def shape(self) -> Shape:
        plate = box((0, 0, 0), (40, 30, 8), x0="clamp")
        hole = cylinder(3, -1, 9).moved(10, 15, 0)
        return (plate - hole) + cylinder(5, 8, 14, end_face="pad").moved(28, 15, 0)


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    path = tmp_path_factory.mktemp("step") / "plate.step"
    write_step(Plate(), path)
    return path


def test_a_solid_comes_in_with_its_faces(file):
    part = load_step(file)
    assert part.name == "plate"
    assert {face.name for face in part.faces} == {"", "clamp", "pad"}
    cylinders = {face.radius: face for face in part.faces if face.kind == "cylinder"}
    assert set(cylinders) == {0.003, 0.005}
    assert cylinders[0.003].hollow and not cylinders[0.005].hollow
    assert cylinders[0.003].area == pytest.approx(2 * math.pi * 3 * 8 * 1e-6, rel=1e-12)
    clamp = part.surface.face_names.index("clamp")
    assert np.count_nonzero(np.asarray(part.surface.face) == clamp) == np.count_nonzero(
        part.triangle_face == next(f.number for f in part.faces if f.name == "clamp") - 1
    )
    assert fem.mass_properties(part.surface, 1.0).volume * 1e9 == pytest.approx(EXACT, rel=3e-3)
    finer = load_step(file, chord=1e-6)
    assert fem.mass_properties(finer.surface, 1.0).volume * 1e9 == pytest.approx(EXACT, rel=1e-4)


def test_from_a_step_file_to_a_safety_factor(file):
    mesh = fem.tetrahedralize(load_step(file).surface, 3e-3)
    steel = fem.Material("steel", 210e9, 0.3, 7850.0, 235e6)
    result = fem.solve_static(mesh, steel, [fem.Support("clamp")], [fem.Force("pad", [0.0, 0.0, -500.0])])
    assert 0.0 < result.max_displacement < 1e-4
    assert np.asarray(result.reactions).sum(axis=0) == pytest.approx([0.0, 0.0, 500.0], abs=1e-6)


def test_inches_become_meters(tmp_path):
    shape = build_brep(Plate().shape()).shape
    before = Interface_Static.CVal_s("write.step.unit")
    Interface_Static.SetCVal_s("write.step.unit", "INCH")
    try:
        writer = STEPControl_Writer()
        writer.Transfer(shape, STEPControl_StepModelType.STEPControl_AsIs)
        writer.Write(str(tmp_path / "inch.step"))
    finally:
        Interface_Static.SetCVal_s("write.step.unit", before)
    part = load_step(tmp_path / "inch.step")
    assert np.ptp(part.surface.points, axis=0) == pytest.approx([0.040, 0.030, 0.014], rel=1e-9)
    assert {face.radius for face in part.faces if face.kind == "cylinder"} == {0.003, 0.005}


def test_one_solid_of_an_assembly_is_chosen_by_name_or_number(tmp_path):
    far = np.eye(4)
    far[:3, 3] = 0.1, 0.0, 0.0
    components = [Component("first", Plate(), np.eye(4)), Component("second", Plate(), far)]
    path = tmp_path / "two.step"
    write_step_assembly(components, path)
    with pytest.raises(MeshError, match=r"2 solids, choose one by name or number: 1: first .*mm³\), 2: second"):
        load_step(path)
    second = load_step(path, solid="second")
    assert second.surface.points[:, 0].min() == pytest.approx(0.1, abs=1e-9)
    assert {face.name for face in second.faces} == {"", "clamp", "pad"}
    assert load_step(path, solid="1").surface.points[:, 0].min() == pytest.approx(0.0, abs=1e-9)
    with pytest.raises(MeshError, match="no solid 'third'"):
        load_step(path, solid="third")


@pytest.mark.parametrize("content", ["", "solid x\nendsolid x\n", "ISO-10303-21;\nHEADER;\n"])
def test_what_is_no_step_file_is_refused(tmp_path, content):
    path = tmp_path / "part.step"
    path.write_text(content)
    with pytest.raises(MeshError, match=r"part\.step"):
        load_step(path)
    with pytest.raises(MeshError, match="no such file"):
        load_step(tmp_path / "missing.step")
