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

from codesign.geometry.brep import Brep
from codesign.geometry.features import cylinders, flats
from codesign.parts.tolerances import GENERAL, bore_fit, general_flatness, general_length

FITTED = 1e-6  # mm: a bore of this diameter


def add_tolerances(
    document: TDocStd_Document,
    product: TDF_Label,
    brep: Brep,
    fits: Mapping[float, str],
    label: Callable[[TopoDS_Shape], TDF_Label],
) -> None:
    """Adds diameters of bores, a datum, flatness and the general tolerance to a product.

    Bores have their fit or the general tolerance; the largest named flat face is datum A; named flat faces have the
    flatness of the general tolerance, which is also a property of the product.

    fits: diameter [mm] -> class of ISO 286. label: of a face of the product.
    """
    tool = XCAFDoc_DocumentTool.DimTolTool_s(document.Main())
    for cylinder in cylinders(brep):
        if cylinder.hollow:
            _add_diameter(tool, label(cylinder.face), 2.0 * cylinder.radius, fits)
    datum = None
    for plane in flats(brep):
        if not any(face.IsSame(plane.face) for face, _ in brep.named_faces):
            continue
        if datum is None:
            datum = _add_datum(tool, label(plane.face))
        _add_flatness(tool, label(plane.face), general_flatness(_size(plane.face)))
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


def _add_flatness(tool: object, face: TDF_Label, value: float) -> None:
    tolerance = tool.AddGeomTolerance()  # type: ignore[attr-defined]
    tool.SetGeomTolerance(face, tolerance)  # type: ignore[attr-defined]
    item = XCAFDimTolObjects_GeomToleranceObject()
    item.SetType(XCAFDimTolObjects_GeomToleranceType.XCAFDimTolObjects_GeomToleranceType_Flatness)
    item.SetValue(value)
    XCAFDoc_GeomTolerance.Set_s(tolerance).SetObject(item)


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
