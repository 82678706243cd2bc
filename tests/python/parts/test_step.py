"""STEP files: read back with OpenCASCADE and with gmsh; silence; nothing half-written."""

import re
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.collections import Sequence_TDF_Label
from OCP.GeomAbs import GeomAbs_SurfaceType as Kind
from OCP.Interface import Interface_Static
from OCP.STEPCAFControl import STEPCAFControl_Reader
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopoDS import TopoDS
from OCP.XCAFApp import XCAFApp_Application
from OCP.XCAFDimTolObjects import XCAFDimTolObjects_DimensionType, XCAFDimTolObjects_GeomToleranceType
from OCP.XCAFDoc import (
    XCAFDoc_Dimension,
    XCAFDoc_DocumentTool,
    XCAFDoc_GeomTolerance,
    XCAFDoc_ShapeTool,
)

from codesign.errors import GeometryError
from codesign.fem.step import load_step
from codesign.geometry.brep import Brep, build_brep, explore
from codesign.geometry.features import flats
from codesign.geometry.shape import Shape, box
from codesign.parts.component import Component
from codesign.parts.part import Part
from codesign.parts.step import Origin, write_step, write_step_assembly
from codesign.parts.tolerances import bore_fit, general_flatness, general_length
from codesign.studies.ironcub.bracket import JetpackBracket
from codesign.studies.ironcub.forearm import ForearmJetSupport

BRACKET, FOREARM = JetpackBracket(15, 42), ForearmJetSupport(80, 108)
RIGHT_FOREARM = FOREARM.mirrored("z", "r_forearm_support")
ANALYTIC = {Kind.GeomAbs_Plane, Kind.GeomAbs_Cylinder, Kind.GeomAbs_Cone, Kind.GeomAbs_Torus}
PARTS: list[Part] = [BRACKET, JetpackBracket(79, 100), JetpackBracket(37, 78), FOREARM, RIGHT_FOREARM]


@dataclass(frozen=True)
class Hollow(Part):
    """A box in a box."""

    def shape(self) -> Shape:
        return box((0, 0, 0), (20, 20, 20), z0="fußplatte") - box((5, 5, 5), (15, 15, 15))


class StepFile:
    """A STEP file read back, with the names in it."""

    def __init__(self, path: Path, tolerances: bool = False) -> None:
        self.document = TDocStd_Document(TCollection_ExtendedString("BinXCAF"))
        XCAFApp_Application.GetApplication_s().InitDocument(self.document)
        reader = STEPCAFControl_Reader()
        Interface_Static.SetCVal_s("read.stepcaf.subshapes.name", "On")
        reader.SetNameMode(True)
        reader.SetGDTMode(tolerances)
        reader.ReadFile(str(path))
        reader.Transfer(self.document)
        self.shapes = XCAFDoc_DocumentTool.ShapeTool_s(self.document.Main())

    def roots(self) -> list[TDF_Label]:
        labels = Sequence_TDF_Label()
        self.shapes.GetFreeShapes(labels)
        return [labels.Value(k + 1) for k in range(labels.Length())]


def name_of(label: TDF_Label) -> str:
    name = TDataStd_Name()
    return name.Get().ToExtString() if label.FindAttribute(TDataStd_Name.GetID_s(), name) else ""


def components_of(label: TDF_Label) -> list[TDF_Label]:
    labels = Sequence_TDF_Label()
    XCAFDoc_ShapeTool.GetComponents_s(label, labels)
    return [labels.Value(k + 1) for k in range(labels.Length())]


@pytest.mark.parametrize("part", PARTS, ids=repr)
def test_part_read_back_is_a_valid_exact_named_solid(part: Part, tmp_path: Path) -> None:
    write_step(part, tmp_path / "part.step")
    file = StepFile(tmp_path / "part.step")
    (label,) = file.roots()
    assert name_of(label) == part.name
    (solid,) = explore(XCAFDoc_ShapeTool.GetShape_s(label), TopAbs_ShapeEnum.TopAbs_SOLID)
    assert BRepCheck_Analyzer(solid).IsValid()
    faces = [TopoDS.Face(face) for face in explore(solid, TopAbs_ShapeEnum.TopAbs_FACE)]
    assert {BRepAdaptor_Surface(face).GetType() for face in faces} <= ANALYTIC
    assert 40 < len(faces) < 70
    assert Brep(solid).volume == pytest.approx(part.mass_properties().volume * 1e9, rel=5e-6)
    labels = Sequence_TDF_Label()
    XCAFDoc_ShapeTool.GetSubShapes_s(label, labels)
    names = Counter(name_of(labels.Value(k + 1)) for k in range(labels.Length()))
    assert set(names) == set(part.faces)
    assert names["seat"] == 1


@pytest.mark.parametrize(("part", "faces"), [(BRACKET, 42), (FOREARM, 55), (RIGHT_FOREARM, 55)], ids=str)
def test_faces_have_no_seams_and_solids_have_names(part: Part, faces: int, tmp_path: Path) -> None:
    write_step(part, tmp_path / "part.step")
    text = (tmp_path / "part.step").read_text()
    assert text.count("ADVANCED_FACE(") == faces
    assert f"MANIFOLD_SOLID_BREP('{part.name}'," in text


def test_faces_of_two_names_stay_two() -> None:
    """Two slabs side by side make one top face, unless their tops have names of their own."""

    def slabs(first: str, second: str) -> Brep:
        return build_brep(box((0, 0, 0), (10, 10, 5), z1=first) + box((10, 0, 0), (20, 10, 5), z1=second))

    for first, second, count in (("", "", 6), ("top", "top", 6), ("top", "", 7), ("left", "right", 7)):
        brep = slabs(first, second)
        assert len(explore(brep.shape, TopAbs_ShapeEnum.TopAbs_FACE)) == count
        assert brep.volume == pytest.approx(1000.0, rel=1e-12)
        present = sorted(name for _, name in brep.named_faces)
        assert present == sorted({first, second} - {""})
        if first:
            assert brep.area(first) == pytest.approx(200.0 if first == second else 100.0, rel=1e-12)


def test_cavity_origin_and_names_in_any_language(tmp_path: Path) -> None:
    part = Hollow(name="träger's 箱", density=1000.0)
    component = Component("links, groß", part, np.eye(4))
    write_step_assembly([component], tmp_path / "a.step", "gerät", origin=Origin("rev 7", "workshop"))
    text = (tmp_path / "a.step").read_text()
    assert "BREP_WITH_VOIDS('träger''s 箱'," in text
    assert text.count("PRODUCT_DEFINITION_FORMATION('rev 7',") == 2
    assert "'workshop'" in text
    file = StepFile(tmp_path / "a.step")
    (root,) = file.roots()
    assert name_of(root) == "gerät"
    (placed,) = components_of(root)
    assert name_of(placed) == "links, groß"
    (solid,) = explore(XCAFDoc_ShapeTool.GetShape_s(placed), TopAbs_ShapeEnum.TopAbs_SOLID)
    assert Brep(solid).volume == pytest.approx(7000.0, rel=1e-9)
    assert len(explore(solid, TopAbs_ShapeEnum.TopAbs_SHELL)) == 2


def test_named_faces_of_the_file_have_the_exact_area() -> None:
    assert build_brep(BRACKET.shape()).area("seat") == pytest.approx(np.pi * (23**2 - 6 * 1.6**2), rel=1e-12)
    assert build_brep(FOREARM.shape()).area("seat") == pytest.approx(FOREARM.seat_area * 1e6, rel=1e-9)


@pytest.mark.parametrize(("schema", "words"), [("AP214", "AUTOMOTIVE_DESIGN"), ("AP242", "AP242_MANAGED_MODEL")])
def test_schema_is_the_one_asked_for(schema: str, words: str, tmp_path: Path) -> None:
    write_step(BRACKET, tmp_path / "part.step", schema=schema)
    text = (tmp_path / "part.step").read_text()
    assert words in text.partition("ENDSEC")[0]
    assert "SI_UNIT(.MILLI.,.METRE.)" in text
    with pytest.raises(ValueError, match="schema = 'AP203'"):
        write_step(BRACKET, tmp_path / "other.step", schema="AP203")
    assert [file.name for file in tmp_path.iterdir()] == ["part.step"]


def test_assembly_places_shared_parts(tmp_path: Path) -> None:
    moved = np.eye(4)
    moved[:3, :3] = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
    moved[:3, 3] = [0.1, -0.2, 0.3]
    poses = {"l_bracket": np.eye(4), "r_bracket": moved, "l_forearm": moved, "r_forearm": np.linalg.inv(moved)}
    parts = {"l_bracket": BRACKET, "r_bracket": BRACKET, "l_forearm": FOREARM, "r_forearm": RIGHT_FOREARM}
    components = [Component(name, part, poses[name]) for name, part in parts.items()]
    write_step_assembly(components, tmp_path / "assembly.step", name="interfaces")
    text = (tmp_path / "assembly.step").read_text()
    assert text.count("MANIFOLD_SOLID_BREP(") == 3  # the bracket is stored once
    file = StepFile(tmp_path / "assembly.step")  # labels live as long as their document
    (root,) = file.roots()
    assert name_of(root) == "interfaces"
    assert [name_of(label) for label in components_of(root)] == list(poses)
    for label, name in zip(components_of(root), poses, strict=True):
        placed = XCAFDoc_ShapeTool.GetLocation_s(label).Transformation()
        read = np.array([[placed.Value(i, j) for j in range(1, 5)] for i in range(1, 4)])
        read[:, 3] *= 1e-3
        np.testing.assert_allclose(read, poses[name][:3], atol=1e-12)
        (solid,) = explore(XCAFDoc_ShapeTool.GetShape_s(label), TopAbs_ShapeEnum.TopAbs_SOLID)
        assert Brep(solid).volume == pytest.approx(parts[name].mass_properties().volume * 1e9, rel=5e-6)


def test_a_second_reader_sees_the_same_solid(tmp_path: Path) -> None:
    import gmsh

    write_step(RIGHT_FOREARM, tmp_path / "part.step")
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        entities = gmsh.model.occ.importShapes(str(tmp_path / "part.step"))
        gmsh.model.occ.synchronize()
        assert [dimension for dimension, _ in entities] == [3]
        volume = gmsh.model.occ.getMass(*entities[0])
        kinds = {gmsh.model.getType(2, tag) for _, tag in gmsh.model.getEntities(2)}
    finally:
        gmsh.finalize()
    assert volume == pytest.approx(RIGHT_FOREARM.mass_properties().volume * 1e9, rel=5e-6)
    assert kinds <= {"Plane", "Cylinder", "Cone", "Torus", "Trimmed cylinder"}


def test_writing_is_silent_and_a_failure_leaves_nothing(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    write_step(BRACKET, tmp_path / "part.step")
    with pytest.raises(FileNotFoundError):
        write_step(BRACKET, tmp_path / "missing" / "part.step")
    assert capfd.readouterr() == ("", "")
    assert [file.name for file in tmp_path.iterdir()] == ["part.step"]


def read_tolerances(path: Path) -> tuple[Counter[tuple[float, float, float]], Counter[float]]:
    """(diameter, lower, upper) of the dimensions, values of the flatness tolerances.

    OpenCASCADE turns the sign of lower deviations.
    """
    file = StepFile(path, tolerances=True)
    tool = XCAFDoc_DocumentTool.DimTolTool_s(file.document.Main())
    found = []
    for get in (tool.GetDimensionLabels, tool.GetGeomToleranceLabels):
        labels = Sequence_TDF_Label()
        get(labels)
        found.append([labels.Value(k + 1) for k in range(labels.Length())])
    dimensions = [XCAFDoc_Dimension.Set_s(label).GetObject() for label in found[0]]
    tolerances = [XCAFDoc_GeomTolerance.Set_s(label).GetObject() for label in found[1]]
    kind = XCAFDimTolObjects_DimensionType.XCAFDimTolObjects_DimensionType_Size_Diameter
    assert {item.GetType() for item in dimensions} <= {kind}
    flatness = XCAFDimTolObjects_GeomToleranceType.XCAFDimTolObjects_GeomToleranceType_Flatness
    assert {item.GetType() for item in tolerances} <= {flatness}
    return (
        Counter(
            (round(d.GetValue(), 6), round(-d.GetLowerTolValue(), 6), round(d.GetUpperTolValue(), 6))
            for d in dimensions
        ),
        Counter(round(t.GetValue(), 6) for t in tolerances),
    )


def test_tolerances_are_read_back(tmp_path: Path) -> None:
    """Every bore has a diameter, the dowel's with its fit; the mount is datum A; mount and seat are flat."""
    write_step(BRACKET, tmp_path / "bracket.step")
    dimensions, flatness = read_tolerances(tmp_path / "bracket.step")
    assert dimensions == {
        (3.2, -0.1, 0.1): 6,
        (6.0, -0.1, 0.1): 6,
        (4.0, 0.0, 0.012): 1,  # H7
        (8.4, -0.2, 0.2): 2,
        (14.0, -0.2, 0.2): 2,
        (46.0, -0.3, 0.3): 1,
    }
    brep = build_brep(BRACKET.shape())
    named = [plane for plane in flats(brep) if any(face.IsSame(plane.face) for face, _ in brep.named_faces)]
    assert flatness.total() == len(named) > 0
    assert set(flatness) <= {0.1, 0.2}
    text = (tmp_path / "bracket.step").read_text()
    assert re.findall(r"= DATUM\('','',#\d+,\.F\.,'(\w+)'\)", text) == ["A"]  # OpenCASCADE reads none that is not used
    assert len(re.findall(r"= ?PRODUCT\(", text)) == 1
    assert "ISO 2768-mK" in text
    assert "(-0.1," in text
    assert "LIMITS_AND_FITS" not in text  # OpenCASCADE writes a wrong grade
    write_step(BRACKET, tmp_path / "old.step", "AP214")
    assert read_tolerances(tmp_path / "old.step") == (Counter(), Counter())


def test_colors_tell_named_faces_apart(tmp_path: Path) -> None:
    write_step(BRACKET, tmp_path / "bracket.step")
    colors: dict[str, set[str | None]] = {}
    for face in load_step(tmp_path / "bracket.step").faces:
        colors.setdefault(face.name, set()).add(face.color)
    assert all(len(found) == 1 for found in colors.values())
    assert len({next(iter(found)) for found in colors.values()}) == len(colors) > 1


@pytest.mark.parametrize(
    ("diameter", "fit", "upper"),
    [(3, "H7", 0.010), (4, "H7", 0.012), (10, "H8", 0.022), (18, "H6", 0.011), (120, "H9", 0.087)],
)
def test_basic_holes_of_iso_286(diameter: float, fit: str, upper: float) -> None:
    assert bore_fit(diameter, fit) == (0.0, pytest.approx(upper))


def test_fits_that_are_not_known() -> None:
    for diameter, fit in ((10, "f7"), (10, "H5"), (200, "H7"), (10, "H")):
        with pytest.raises(GeometryError, match=f"fit '{fit}' of a bore of {diameter} mm: only H6 to H9"):
            bore_fit(diameter, fit)


def test_general_tolerances() -> None:
    assert [general_length(size) for size in (1, 5, 6.5, 30, 31, 400)] == [0.1, 0.1, 0.2, 0.2, 0.3, 0.5]
    assert [general_flatness(size) for size in (10, 11, 100, 250)] == [0.05, 0.1, 0.2, 0.4]


class Placed(JetpackBracket):
    """A bracket whose seat has a place."""

    def positions(self) -> dict[str, float]:
        return {"seat": 0.2}


def test_the_position_of_a_face_is_read_back(tmp_path: Path) -> None:
    """One position, of the seat, against datum A; none where the part says nothing."""
    write_step(Placed(15, 42), tmp_path / "placed.step")
    text = (tmp_path / "placed.step").read_text().replace("\n", "")
    assert len(re.findall(r"POSITION_TOLERANCE", text)) == 1
    file = StepFile(tmp_path / "placed.step", tolerances=True)
    tool = XCAFDoc_DocumentTool.DimTolTool_s(file.document.Main())
    labels = Sequence_TDF_Label()
    tool.GetGeomToleranceLabels(labels)
    kind = XCAFDimTolObjects_GeomToleranceType.XCAFDimTolObjects_GeomToleranceType_Position
    all_ = [labels.Value(k + 1) for k in range(labels.Length())]
    (label,) = [one for one in all_ if XCAFDoc_GeomTolerance.Set_s(one).GetObject().GetType() == kind]
    assert XCAFDoc_GeomTolerance.Set_s(label).GetObject().GetValue() == 0.2
    datums = Sequence_TDF_Label()
    tool.GetDatumOfTolerLabels_s(label, datums)
    assert datums.Length() == 1


class Misplaced(JetpackBracket):
    """The position of what is no face."""

    def positions(self) -> dict[str, float]:
        return {"lid": 0.2}


def test_the_position_of_no_face_is_refused(tmp_path: Path) -> None:
    with pytest.raises(GeometryError, match="position of 'lid': the part has no flat face of that name"):
        write_step(Misplaced(15, 42), tmp_path / "part.step")
