"""Tolerances that programs can read (semantic PMI of AP242): diameters of bores, datum, flatness of named faces."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from OCP.Bnd import Bnd_Box
from OCP.BRepBndLib import BRepBndLib
from OCP.collections import Sequence_TDF_Label
from OCP.TCollection import TCollection_ExtendedString, TCollection_HAsciiString
from OCP.TDataStd import TDataStd_NamedData
from OCP.TDF import TDF_Label
from OCP.TDocStd import TDocStd_Document
from OCP.TopoDS import TopoDS_Shape
from OCP.XCAFDimTolObjects import (
    XCAFDimTolObjects_DatumObject,
    XCAFDimTolObjects_DimensionObject,
    XCAFDimTolObjects_DimensionType,
    XCAFDimTolObjects_GeomToleranceObject,
    XCAFDimTolObjects_GeomToleranceType,
)
from OCP.XCAFDoc import XCAFDoc_Datum, XCAFDoc_Dimension, XCAFDoc_DocumentTool, XCAFDoc_GeomTolerance

from codesign.errors import GeometryError
from codesign.geometry.brep import Brep
from codesign.geometry.features import cylinders, flats
from codesign.parts.tolerances import GENERAL, bore_fit, general_flatness, general_length

FITTED = 1e-6  # mm: a bore of this diameter


def add_tolerances(
    document: TDocStd_Document,
    product: TDF_Label,
    brep: Brep,
    fits: Mapping[float, str],
    positions: Mapping[str, float],
    label: Callable[[TopoDS_Shape], TDF_Label],
) -> None:
    """Adds diameters of bores, a datum, flatness, positions and the general tolerance to a product.

    Bores have their fit or the general tolerance; the largest named flat face is datum A; named flat faces have the
    flatness of the general tolerance, which is also a property of the product.

    fits: diameter [mm] -> class of ISO 286. positions: face -> width [mm] of the zone about its place against datum A.
    label: of a face of the product.
    Raises: GeometryError for the position of what is no named flat face, or is the datum.
    """
    tool = XCAFDoc_DocumentTool.DimTolTool_s(document.Main())
    for cylinder in cylinders(brep):
        if cylinder.hollow:
            _add_diameter(tool, label(cylinder.face), 2.0 * cylinder.radius, fits)
    named = [(plane.face, name) for plane in flats(brep) for face, name in brep.named_faces if face.IsSame(plane.face)]
    datum = _add_datum(tool, label(named[0][0])) if named else None
    for name in positions:
        if name not in {other for _, other in named[1:]}:
            raise GeometryError(f"position of {name!r}: the part has no flat face of that name beside its datum")
    for number, (face, name) in enumerate(named):
        flat = XCAFDimTolObjects_GeomToleranceType.XCAFDimTolObjects_GeomToleranceType_Flatness
        _add_form(tool, label(face), flat, general_flatness(_size(face)))
        if number and name in positions:
            place = XCAFDimTolObjects_GeomToleranceType.XCAFDimTolObjects_GeomToleranceType_Position
            tool.SetDatumToGeomTol(datum, _add_form(tool, label(face), place, positions[name]))
    data = TDataStd_NamedData.Set_s(product)
    data.SetString(TCollection_ExtendedString("general tolerance"), TCollection_ExtendedString(GENERAL))


def _add_diameter(tool: object, face: TDF_Label, diameter: float, fits: Mapping[float, str]) -> None:
    fit = next((fit for size, fit in fits.items() if abs(size - diameter) < FITTED), None)
    general = general_length(diameter)
    lower, upper = (-general, general) if fit is None else bore_fit(diameter, fit)
    dimension = tool.AddDimension()  # type: ignore[attr-defined]
    tool.SetDimension(face, dimension)  # type: ignore[attr-defined]
    item = XCAFDimTolObjects_DimensionObject()
    item.SetType(XCAFDimTolObjects_DimensionType.XCAFDimTolObjects_DimensionType_Size_Diameter)
    item.SetValue(diameter)
    item.SetUpperTolValue(upper)
    item.SetLowerTolValue(-lower)  # the writer turns the sign
    XCAFDoc_Dimension.Set_s(dimension).SetObject(item)


def _add_form(tool: object, face: TDF_Label, kind: XCAFDimTolObjects_GeomToleranceType, value: float) -> TDF_Label:
    """A geometric tolerance of a face."""
    tolerance = tool.AddGeomTolerance()  # type: ignore[attr-defined]
    tool.SetGeomTolerance(face, tolerance)  # type: ignore[attr-defined]
    item = XCAFDimTolObjects_GeomToleranceObject()
    item.SetType(kind)
    item.SetValue(value)
    XCAFDoc_GeomTolerance.Set_s(tolerance).SetObject(item)
    return tolerance


def _add_datum(tool: object, face: TDF_Label) -> TDF_Label:
    datum = tool.AddDatum()  # type: ignore[attr-defined]
    faces = Sequence_TDF_Label()
    faces.Append(face)
    tool.SetDatum(faces, datum)  # type: ignore[attr-defined]
    item = XCAFDimTolObjects_DatumObject()
    item.SetName(TCollection_HAsciiString("A"))
    item.SetPosition(1)
    XCAFDoc_Datum.Set_s(datum).SetObject(item)
    return datum


def _size(face: TopoDS_Shape) -> float:
    """Longest side [mm] of the box around a face."""
    box = Bnd_Box()
    BRepBndLib.Add_s(face, box)
    low, high = box.CornerMin(), box.CornerMax()
    return float(np.max([high.X() - low.X(), high.Y() - low.Y(), high.Z() - low.Z()]))
