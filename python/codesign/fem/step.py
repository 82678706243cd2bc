"""STEP files (ISO 10303-21) as surfaces to mesh: one solid with the names, colors and kinds of its faces.

The only file of this wing that sees OpenCASCADE; it is imported when a STEP file is read.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepGProp import BRepGProp
from OCP.collections import Sequence_TDF_Label
from OCP.GeomAbs import GeomAbs_SurfaceType
from OCP.GProp import GProp_GProps
from OCP.IFSelect import IFSelect_ReturnStatus
from OCP.Interface import Interface_Static
from OCP.Quantity import Quantity_Color, Quantity_TypeOfColor
from OCP.STEPCAFControl import STEPCAFControl_Reader
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_Orientation, TopAbs_ShapeEnum
from OCP.TopExp import TopExp_Explorer
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS, TopoDS_Face, TopoDS_Shape
from OCP.XCAFApp import XCAFApp_Application
from OCP.XCAFDoc import XCAFDoc_ColorType, XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

from codesign._core.fem import SurfaceMesh
from codesign.errors import GeometryError, MeshError
from codesign.geometry.occt import silent
from codesign.geometry.triangulate import triangulate
from codesign.units import MILLIMETER

CHORD = 3e-5  # m: triangles stay this near to the exact faces
ANGLE = 0.35  # rad between neighboring chords of a curve: 18 on a full circle at least
KINDS = {
    GeomAbs_SurfaceType.GeomAbs_Plane: "plane",
    GeomAbs_SurfaceType.GeomAbs_Cylinder: "cylinder",
    GeomAbs_SurfaceType.GeomAbs_Cone: "cone",
    GeomAbs_SurfaceType.GeomAbs_Sphere: "sphere",
    GeomAbs_SurfaceType.GeomAbs_Torus: "torus",
}


@dataclass(frozen=True, slots=True)
class StepFace:
    """A face of the exact solid.

    name: from the file, "" if it has none. kind: plane, cylinder, cone, sphere, torus or free. radius: [m] of a
    cylinder, sphere or (its tube) torus. hollow: a cylinder or cone around which material lies, as a hole's wall.
    area: [m²]. color: `#rrggbb` as a screen shows it, None without.
    """

    number: int
    name: str
    kind: str
    radius: float | None
    hollow: bool
    area: float
    color: str | None


@dataclass(frozen=True)
class StepPart:
    """One solid of a STEP file.

    name: of the solid or its product. surface: triangles [m]; faces that are named in the file keep their names, faces
    of one name are one. faces: of the exact solid. triangle_face: (m,) the face that each triangle lies on.
    """

    name: str
    surface: SurfaceMesh
    faces: tuple[StepFace, ...]
    triangle_face: NDArray[np.int64]

    def by_face(self) -> SurfaceMesh:
        """The surface with every face of the solid by name: its own, or `face N` by number."""
        names = [face.name or f"face {face.number}" for face in self.faces]
        labels = list(dict.fromkeys(names))
        index = np.array([labels.index(name) for name in names])
        return SurfaceMesh(self.surface.points, self.surface.triangles, index[self.triangle_face].tolist(), labels)


def load_step(path: str | os.PathLike[str], *, solid: str | None = None, chord: float = CHORD) -> StepPart:
    """One solid of a STEP file as a closed surface; lengths in meters whatever the file's unit.

    Args:
        path: STEP file of any schema. solid: its name, or its number from 1, where the file holds several.
        chord: largest distance of the triangles from the exact faces [m].
    Raises: MeshError: not a readable STEP file, no solid, several of them and none chosen.
    """
    found = list(_solids(_read(Path(path))))
    name, shape, names, colors = _chosen(found, solid, Path(path))
    faces = [TopoDS.Face(face) for face in _explore(shape, TopAbs_ShapeEnum.TopAbs_FACE)]
    described = tuple(
        _describe(i + 1, face, _of_same(names, face) or "", _of_same(colors, face)) for i, face in enumerate(faces)
    )
    try:
        points, triangles, owner = triangulate(shape, faces, chord / MILLIMETER, ANGLE)
    except GeometryError as error:
        raise MeshError(f"{path}: {error}") from error
    labels = list(dict.fromkeys(face.name for face in described))
    index = np.array([labels.index(face.name) for face in described])
    surface = SurfaceMesh(points * MILLIMETER, triangles, index[owner].tolist(), labels)
    return StepPart(name, surface, described, owner)


def read_solid(path: str | os.PathLike[str], solid: str | None = None) -> tuple[TopoDS_Shape, dict[int, str]]:
    """One exact solid of a STEP file in mm, and the names of its faces by their place in it; errors as `load_step`."""
    _, shape, names, _ = _chosen(list(_solids(_read(Path(path)))), solid, Path(path))
    faces = _explore(shape, TopAbs_ShapeEnum.TopAbs_FACE)
    return shape, {number: _of_same(names, face) or "" for number, face in enumerate(faces)}


def _read(path: Path) -> TDocStd_Document:
    if not path.is_file():
        raise MeshError(f"{path}: no such file")
    document = TDocStd_Document(TCollection_ExtendedString("BinXCAF"))
    XCAFApp_Application.GetApplication_s().InitDocument(document)
    reader = STEPCAFControl_Reader()
    before = Interface_Static.IVal_s("read.stepcaf.subshapes.name")
    Interface_Static.SetIVal_s("read.stepcaf.subshapes.name", 1)
    try:
        with silent():
            read = reader.ReadFile(str(path)) == IFSelect_ReturnStatus.IFSelect_RetDone and reader.Transfer(document)
        if not read:
            raise MeshError(f"{path}: is not a STEP file that OpenCASCADE can read")
    finally:
        Interface_Static.SetIVal_s("read.stepcaf.subshapes.name", before)
    return document


Solid = tuple[str, TopoDS_Shape, list[tuple[TopoDS_Shape, str]], list[tuple[TopoDS_Shape, str]]]


def _solids(document: TDocStd_Document) -> Iterator[Solid]:
    """Name, placed solid, names and colors of its faces, for every solid of the document."""
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    colors = XCAFDoc_DocumentTool.ColorTool_s(document.Main())
    free = Sequence_TDF_Label()
    shapes.GetFreeShapes(free)
    for label in _items(free):
        yield from _solids_of(label, TopLoc_Location(), colors, _name(label))


def _solids_of(label: TDF_Label, location: TopLoc_Location, colors: object, name: str) -> Iterator[Solid]:
    if XCAFDoc_ShapeTool.IsAssembly_s(label):
        components = Sequence_TDF_Label()
        XCAFDoc_ShapeTool.GetComponents_s(label, components)
        for component in _items(components):
            referred = TDF_Label()
            XCAFDoc_ShapeTool.GetReferredShape_s(component, referred)
            placed = location.Multiplied(XCAFDoc_ShapeTool.GetLocation_s(component))
            yield from _solids_of(referred, placed, colors, _name(component) or _name(referred))
        return
    shape = XCAFDoc_ShapeTool.GetShape_s(label)
    parts = Sequence_TDF_Label()
    XCAFDoc_ShapeTool.GetSubShapes_s(label, parts)
    named = [(XCAFDoc_ShapeTool.GetShape_s(part), part) for part in _items(parts)]
    solids = list(_explore(shape, TopAbs_ShapeEnum.TopAbs_SOLID))
    for solid in solids:
        own = next((_name(part) for other, part in named if other.IsSame(solid) and _name(part)), "")
        title = (own or name) if len(solids) > 1 else (name or own)
        whole = _color(colors, solid) or _color(colors, shape)
        names, tints = [], []
        for face in _explore(solid, TopAbs_ShapeEnum.TopAbs_FACE):
            placed_face = face.Moved(location)
            label_name = next((_name(part) for other, part in named if other.IsSame(face)), "")
            names.append((placed_face, label_name))
            tints.append((placed_face, _color(colors, face) or whole))
        yield title, solid.Moved(location), names, [(face, tint) for face, tint in tints if tint]


def _chosen(found: list[Solid], wanted: str | None, path: Path) -> Solid:
    if not found:
        raise MeshError(f"{path}: the file holds no solid (surfaces without volume cannot be analyzed)")
    if wanted is None and len(found) == 1:
        return found[0]
    listed = ", ".join(
        f"{i + 1}: {name or 'without name'} ({_volume(shape):.4g} mm³)" for i, (name, shape, *_) in enumerate(found)
    )
    if wanted is None:
        raise MeshError(f"{path}: {len(found)} solids, choose one by name or number: {listed}")
    for number, solid in enumerate(found, 1):
        if wanted in (solid[0], str(number)):
            return solid
    raise MeshError(f"{path}: no solid {wanted!r}; there are {listed}")


def _describe(number: int, face: TopoDS_Face, name: str, color: str | None) -> StepFace:
    surface = BRepAdaptor_Surface(face)
    kind = KINDS.get(surface.GetType(), "free")
    radius = {
        "cylinder": lambda: surface.Cylinder().Radius(),
        "sphere": lambda: surface.Sphere().Radius(),
        "torus": lambda: surface.Torus().MinorRadius(),
    }.get(kind, lambda: None)()
    # An elementary surface's own normal points away from its axis; a reversed face has material around it.
    hollow = kind in ("cylinder", "cone") and face.Orientation() == TopAbs_Orientation.TopAbs_REVERSED
    properties = GProp_GProps()
    BRepGProp.SurfaceProperties_s(face, properties)
    return StepFace(
        number,
        name,
        kind,
        None if radius is None else float(f"{radius:.9g}") * MILLIMETER,
        hollow,
        properties.Mass() * MILLIMETER**2,
        color,
    )


def _explore(shape: TopoDS_Shape, kind: TopAbs_ShapeEnum) -> Iterator[TopoDS_Shape]:
    explorer = TopExp_Explorer(shape, kind)
    while explorer.More():
        yield explorer.Current()
        explorer.Next()


def _items(sequence: Sequence_TDF_Label) -> list[TDF_Label]:
    return [sequence.Value(i + 1) for i in range(sequence.Length())]


def _name(label: TDF_Label) -> str:
    if not label.IsAttribute(TDataStd_Name.GetID_s()):
        return ""
    attribute = TDataStd_Name()
    label.FindAttribute(TDataStd_Name.GetID_s(), attribute)
    return str(attribute.Get().ToExtString())


def _color(colors: object, shape: TopoDS_Shape) -> str | None:
    color = Quantity_Color()
    for kind in (XCAFDoc_ColorType.XCAFDoc_ColorSurf, XCAFDoc_ColorType.XCAFDoc_ColorGen):
        if colors.GetColor(shape, kind, color):  # type: ignore[attr-defined]
            rgb = color.Values(Quantity_TypeOfColor.Quantity_TOC_sRGB)
            return "#" + "".join(f"{round(255 * max(0.0, min(1.0, c))):02x}" for c in rgb)
    return None


def _of_same(pairs: list[tuple[TopoDS_Shape, str]], face: TopoDS_Shape) -> str | None:
    return next((value for other, value in pairs if other.IsSame(face)), None)


def _volume(shape: TopoDS_Shape) -> float:
    properties = GProp_GProps()
    BRepGProp.VolumeProperties_s(shape, properties)
    return float(properties.Mass())
