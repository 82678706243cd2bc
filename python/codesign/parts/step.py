"""STEP files (ISO 10303-21, mm): exact solids with named faces, alone or placed in an assembly."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from OCP.APIHeaderSection import APIHeaderSection_MakeHeader
from OCP.gp import gp_Trsf
from OCP.IFSelect import IFSelect_ReturnStatus
from OCP.Interface import Interface_Static
from OCP.Quantity import Quantity_Color, Quantity_TypeOfColor
from OCP.StepBasic import StepBasic_ProductDefinitionFormation
from OCP.STEPCAFControl import STEPCAFControl_Controller, STEPCAFControl_Writer
from OCP.STEPConstruct import STEPConstruct
from OCP.STEPControl import STEPControl_StepModelType
from OCP.TCollection import TCollection_ExtendedString, TCollection_HAsciiString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label
from OCP.TDocStd import TDocStd_Document
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Shape
from OCP.XCAFApp import XCAFApp_Application
from OCP.XCAFDoc import XCAFDoc_ColorType, XCAFDoc_DocumentTool

from codesign import __version__
from codesign.errors import GeometryError
from codesign.files import replacing
from codesign.geometry.brep import Brep, build_brep, moved
from codesign.geometry.occt import silent
from codesign.geometry.profile import Vector
from codesign.geometry.shape import reflection
from codesign.parts.component import Component, distinct_parts
from codesign.parts.part import MirroredPart, Part
from codesign.parts.pmi import add_tolerances
from codesign.units import MILLIMETER

BODY = (170, 176, 184)
PALETTE = ((61, 122, 199), (199, 92, 41), (64, 150, 96), (158, 84, 163), (196, 160, 44), (74, 160, 170))
SCHEMAS = {"AP214": "AP214IS", "AP242": "AP242DIS"}


@dataclass(frozen=True, slots=True)
class Origin:
    """Where a STEP file comes from: `revision` is the version of its products, `organization` stands in its header."""

    revision: str = ""
    organization: str = ""


def part_breps(parts: Sequence[Part]) -> dict[Part, Brep]:
    """Exact solids of parts; a mirrored part is the reflection of its original, which is built once."""
    breps: dict[Part, Brep] = {}

    def brep(part: Part) -> Brep:
        if part not in breps:
            if isinstance(part, MirroredPart):
                breps[part] = moved(brep(part.original), reflection(part.axis))
            else:
                breps[part] = build_brep(part.shape())
        return breps[part]

    return {part: brep(part) for part in parts}


def write_step(
    part: Part,
    path: str | os.PathLike[str],
    schema: str = "AP242",
    brep: Brep | None = None,
    origin: Origin = Origin(),
) -> None:
    """One part as a solid with its name, the names and colors of its faces; `brep`: its exact solid, if already built.

    In AP242 with tolerances that programs read: diameters of bores with the part's `fits`, flatness of named
    faces, their `positions`.
    """
    document = _Document()
    solid = brep or part_breps([part])[part]
    product = document.add_part(part.name, solid)
    document.add_colors(product, solid)
    if schema == "AP242":
        document.add_tolerances(product, solid, part.fits(), part.positions())
    document.write(path, schema, origin)


def write_step_assembly(
    components: Sequence[Component],
    path: str | os.PathLike[str],
    name: str = "assembly",
    schema: str = "AP242",
    breps: Mapping[Part, Brep] | None = None,
    origin: Origin = Origin(),
) -> None:
    """Placed parts as one assembly; components that share a part share its solid. `breps`: from `part_breps`."""
    breps = breps or part_breps(distinct_parts(components))
    document = _Document()
    labels = {part: document.add_part(part.name, breps[part]) for part in distinct_parts(components)}
    document.add_assembly(name, [(c.name, labels[c.part], c.pose) for c in components])
    document.write(path, schema, origin)


class _Document:
    """A STEP model under construction: products with names and sub-shapes."""

    def __init__(self) -> None:
        self._document = TDocStd_Document(TCollection_ExtendedString("BinXCAF"))
        XCAFApp_Application.GetApplication_s().InitDocument(self._document)
        self._shapes = XCAFDoc_DocumentTool.ShapeTool_s(self._document.Main())
        self._solids: list[tuple[TopoDS_Shape, str]] = []

    def add_part(self, name: str, brep: Brep) -> TDF_Label:
        """A product made of one solid."""
        label = self._shapes.AddShape(brep.shape, False)
        _set_name(label, name)
        self._solids.append((brep.shape, name))
        for face, face_name in brep.named_faces:
            _set_name(self._shapes.AddSubShape(label, face), face_name)
        return label

    def add_colors(self, product: TDF_Label, brep: Brep) -> None:
        """A color for the solid and one for each name of its faces, for programs that read colors but no names."""
        tool = XCAFDoc_DocumentTool.ColorTool_s(self._document.Main())
        tool.SetColor(product, _color(BODY), XCAFDoc_ColorType.XCAFDoc_ColorSurf)
        names = list(dict.fromkeys(name for _, name in brep.named_faces))
        for face, name in brep.named_faces:
            color = _color(PALETTE[names.index(name) % len(PALETTE)])
            tool.SetColor(self._face(product, face), color, XCAFDoc_ColorType.XCAFDoc_ColorSurf)

    def add_tolerances(
        self, product: TDF_Label, brep: Brep, fits: Mapping[float, str], positions: Mapping[str, float]
    ) -> None:
        """Semantic tolerances, as `pmi.add_tolerances` says."""
        add_tolerances(self._document, product, brep, fits, positions, lambda face: self._face(product, face))

    def _face(self, product: TDF_Label, face: TopoDS_Shape) -> TDF_Label:
        """Label of a face, made if it has none."""
        found = TDF_Label()
        return found if self._shapes.FindSubShape(product, face, found) else self._shapes.AddSubShape(product, face)

    def add_assembly(self, name: str, components: Sequence[tuple[str, TDF_Label, Vector]]) -> None:
        """A product made of placed products: name, product, pose (4, 4) [m]."""
        assembly = self._shapes.NewShape()
        _set_name(assembly, name)
        for component_name, part, pose in components:
            rows = pose[:3].copy()
            rows[:, 3] /= MILLIMETER
            motion = gp_Trsf()
            motion.SetValues(*rows.ravel().tolist())
            _set_name(self._shapes.AddComponent(assembly, part, TopLoc_Location(motion)), component_name)
        self._shapes.UpdateAssemblies()

    def write(self, path: str | os.PathLike[str], schema: str, origin: Origin) -> None:
        """Writes the file whole or not at all."""
        if schema not in SCHEMAS:
            raise ValueError(f"schema = {schema!r}: must be one of {', '.join(SCHEMAS)}")
        with silent(), replacing(path) as temporary:
            STEPCAFControl_Controller.Init_s()
            Interface_Static.SetCVal_s("write.step.schema", SCHEMAS[schema])
            Interface_Static.SetCVal_s("write.stepcaf.subshapes.name", "On")
            Interface_Static.SetCVal_s("write.step.unit", "MM")
            writer = STEPCAFControl_Writer()
            writer.SetNameMode(True)
            if not writer.Transfer(self._document, STEPControl_StepModelType.STEPControl_AsIs):
                raise GeometryError(f"{path}: OpenCASCADE could not translate the shape to STEP")
            self._name_solids(writer)
            _set_revision(writer, origin.revision)
            header = APIHeaderSection_MakeHeader(writer.ChangeWriter().Model())
            header.SetName(TCollection_HAsciiString(Path(path).name))
            header.SetOriginatingSystem(TCollection_HAsciiString(f"codesign {__version__}"))
            header.SetAuthorValue(1, TCollection_HAsciiString(""))
            header.SetOrganizationValue(1, TCollection_HAsciiString(origin.organization))
            if writer.Write(os.fspath(temporary)) != IFSelect_ReturnStatus.IFSelect_RetDone:
                raise OSError(f"{path}: OpenCASCADE could not write the STEP file")

    def _name_solids(self, writer: STEPCAFControl_Writer) -> None:
        """Gives the solids themselves the names of their products: OpenCASCADE names the products only."""
        finder = writer.ChangeWriter().WS().TransferWriter().FinderProcess()
        for solid, name in self._solids:
            STEPConstruct.FindEntity_s(finder, solid).SetName(TCollection_HAsciiString(name))


def _color(rgb: tuple[int, int, int]) -> Quantity_Color:
    return Quantity_Color(*(value / 255.0 for value in rgb), Quantity_TypeOfColor.Quantity_TOC_sRGB)


def _set_revision(writer: STEPCAFControl_Writer, revision: str) -> None:
    """The version of every product in the file."""
    model = writer.ChangeWriter().Model()
    for number in range(1, model.NbEntities() + 1):
        entity = model.Value(number)
        if isinstance(entity, StepBasic_ProductDefinitionFormation):
            entity.SetId(TCollection_HAsciiString(revision))


def _set_name(label: TDF_Label, name: str) -> None:
    TDataStd_Name.Set_s(label, TCollection_ExtendedString(name, True))  # from UTF-8
