"""Parts of other CAD tools: files and build123d objects have mass, faces, files and strength as own parts."""

import hashlib
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from OCP.BRepTools import BRepTools

from codesign import fem
from codesign.errors import GeometryError
from codesign.fem.step import load_step
from codesign.geometry.brep import build_brep
from codesign.geometry.exact import imported
from codesign.geometry.shape import Shape, box, cylinder
from codesign.parts import Part, imported_file, parameter, write_step

EXAMPLES = Path(__file__).parents[3] / "examples" / "imported"


@dataclass(frozen=True)
class Own(Part):
    """A plate with a bore and a dome of a boss."""

    bore: float = parameter("mm", minimum=1)

    def through_holes(self) -> int:
        return 1

    def shape(self) -> Shape:
        plate = box((0, 0, 0), (40, 20, 8), z0="mount") + cylinder(6, 0, 15, end_face="seat").moved(10, 10)
        return plate - cylinder(self.bore / 2, -1, 9).moved(30, 10)


@dataclass(frozen=True)
class Foreign(Part):
    """The same from a file."""

    path: Path
    digest: str

    def through_holes(self) -> int:
        return 1

    def shape(self) -> Shape:
        return imported_file(self.path, sha256=self.digest)


OWN = Own(6.0, name="own", density=2700.0)


def digest(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()[:16]


@pytest.fixture(scope="module")
def foreign(tmp_path_factory) -> Foreign:
    path = tmp_path_factory.mktemp("files") / "own.step"
    write_step(OWN, path)
    return Foreign(path, digest(path), name="foreign", density=2700.0)


def test_mass_faces_and_surface_are_those_of_the_own_part(foreign):
    own, other = OWN.mass_properties(), foreign.mass_properties()
    assert other.mass == pytest.approx(own.mass, rel=1e-5)  # of the own part's extrapolation
    np.testing.assert_allclose(other.com, own.com, atol=1e-7)
    np.testing.assert_allclose(other.inertia, own.inertia, atol=5e-5 * np.abs(own.inertia).max())
    assert set(foreign.faces) == {"mount", "seat"}
    assert set(foreign.surface().face_names) >= {"mount", "seat"}
    assert build_brep(foreign.shape()).area("seat") == pytest.approx(np.pi * 36)
    mirrored = foreign.mirrored("x", "mirrored").mass_properties()
    np.testing.assert_allclose(mirrored.com, other.com * [-1, 1, 1], atol=1e-12)


def test_exact_mass_of_a_box():
    @dataclass(frozen=True)
    class Box(Part):
        def shape(self) -> Shape:
            return imported(build_brep(box((1, 2, 3), (11, 22, 33))).shape)

    properties = Box(name="box", density=1000.0).mass_properties()
    assert properties.mass == pytest.approx(6e-3, rel=1e-12)
    np.testing.assert_allclose(properties.com, [6e-3, 12e-3, 18e-3], rtol=1e-12)
    sides = np.array([0.01, 0.02, 0.03]) ** 2
    np.testing.assert_allclose(properties.inertia, np.diag(6e-3 / 12 * (sides.sum() - sides)), atol=1e-18)


def test_it_combines_with_own_shapes_and_is_written(foreign, tmp_path):
    @dataclass(frozen=True)
    class Drilled(Foreign):
        def through_holes(self) -> int:
            return 2

        def shape(self) -> Shape:
            return super().shape() - cylinder(2, -1, 9, end_face="").moved(20, 10)

    part = Drilled(foreign.path, foreign.digest, name="drilled", density=2700.0)
    removed = foreign.mass_properties().volume - part.mass_properties().volume
    assert removed == pytest.approx(np.pi * 4 * 8 * 1e-9, rel=1e-9)
    write_step(part, tmp_path / "drilled.step")
    again = load_step(tmp_path / "drilled.step")
    assert {face.name for face in again.faces} == {"", "mount", "seat"}
    part.write_stl(tmp_path / "drilled.stl")
    assert (tmp_path / "drilled.stl").stat().st_size > 1000


def test_strength_as_of_the_own_part(foreign):
    def stress(part):
        mesh = fem.tetrahedralize(part.fem_surface("full"), 3e-3)
        material = fem.Material("ergal", young_modulus=71.7e9, poisson_ratio=0.33, density=2810.0, yield_strength=503e6)
        load = fem.Force(fem.select_names("seat"), [100.0, 0.0, 0.0])
        return fem.solve_static(mesh, material, [fem.Support(fem.select_names("mount"))], [load])

    own, other = (stress(part) for part in (OWN, foreign))
    sag = [np.linalg.norm(result.displacement, axis=1).max() for result in (own, other)]
    assert sag[1] == pytest.approx(sag[0], rel=0.02)


def test_files_are_refused_with_what_is_wrong(foreign, tmp_path):
    with pytest.raises(GeometryError, match=f"it is '{foreign.digest}' now"):
        imported_file(foreign.path, sha256="0" * 16)
    with pytest.raises(GeometryError, match=r"none\.step: cannot be read: No such file"):
        imported_file(tmp_path / "none.step", sha256="0" * 16)
    with pytest.raises(GeometryError, match="no face 'top'; there are "):
        imported_file(foreign.path, sha256=foreign.digest, faces={"a": "top"})
    renamed = imported_file(foreign.path, sha256=foreign.digest, faces={"base": "mount", "side": 3})
    assert renamed.names == ("base", "side")
    with pytest.raises(GeometryError, match="2 solids instead of one"):
        imported(build_brep_of_two())
    with pytest.raises(GeometryError, match=r"builtins.str holds no OpenCASCADE shape .*imported_file"):
        imported("bracket.step")


def build_brep_of_two():
    from OCP.BRep import BRep_Builder
    from OCP.TopoDS import TopoDS_Compound

    builder, compound = BRep_Builder(), TopoDS_Compound()
    builder.MakeCompound(compound)
    for k in (0, 5):
        builder.Add(compound, build_brep(box((k, 0, 0), (k + 1, 1, 1))).shape)
    return compound


def test_brep_files(tmp_path):
    path = tmp_path / "own.brep"
    BRepTools.Write_s(build_brep(OWN.shape()).shape, str(path))
    shape = imported_file(path, sha256=digest(path), faces={"one": 1})
    assert shape.names == ("one",)
    assert build_brep(shape).volume == pytest.approx(build_brep(OWN.shape()).volume, rel=1e-12)
    assert shape == imported_file(path, sha256=digest(path), faces={"one": 1})
    assert shape != imported_file(path, sha256=digest(path), faces={"one": 2})
    path.write_text("no brep")
    with pytest.raises(GeometryError, match=r"own\.brep: is not a BREP file"):
        imported_file(path, sha256=digest(path))


def run(example: str, folder: Path) -> str:
    command = [sys.executable, EXAMPLES / example, folder]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def test_the_example_with_a_step_file(tmp_path):
    printed = run("step_strut.py", tmp_path)
    assert "40.56 g" in printed  # (80 * 16 - 9 pi) * 12 mm³ at 2700 kg/m³
    assert "mount" in printed
    assert load_step(tmp_path / "strut_bored.step").faces
