"""Reads the VTU files that codesign writes, with nothing of its writer."""

import base64
import zlib
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

TYPES = {"Float64": "<f8", "Int64": "<i8", "UInt8": "<u1"}


@dataclass
class Vtu:
    """Arrays, strings, units and component names by array name; which array is the active one of each kind."""

    points: np.ndarray
    cells: np.ndarray
    point_data: dict[str, np.ndarray]
    cell_data: dict[str, np.ndarray]
    strings: dict[str, str]
    units: dict[str, str]
    components: dict[str, list[str]]
    active: dict[str, str]


def read_vtu(path: Path) -> Vtu:
    """A file of one piece of quadratic tetrahedra with inline compressed arrays."""
    root = ElementTree.parse(path).getroot()
    assert root.get("compressor") == "vtkZLibDataCompressor"
    assert root.get("header_type") == "UInt64"
    piece = root.find("UnstructuredGrid/Piece")
    cells = _arrays(piece.find("Cells"))
    assert set(cells["types"]) == {24}
    np.testing.assert_array_equal(np.diff(cells["offsets"], prepend=0), 10)
    assert len(cells["offsets"]) == int(piece.get("NumberOfCells"))
    points = _arrays(piece.find("Points"))["Points"]
    assert len(points) == int(piece.get("NumberOfPoints"))
    strings = {
        array.get("Name"): bytes(int(code) for code in array.text.split()).rstrip(b"\0").decode()
        for array in root.findall("UnstructuredGrid/FieldData/Array")
    }
    fields = piece.findall("PointData/DataArray") + piece.findall("CellData/DataArray")
    return Vtu(
        points,
        cells["connectivity"].reshape(-1, 10),
        _arrays(piece.find("PointData")),
        _arrays(piece.find("CellData")),
        strings,
        {field.get("Name"): field.findtext("InformationKey") for field in fields},
        {f.get("Name"): [f.get(k) for k in sorted(f.keys()) if k.startswith("ComponentName")] for f in fields},
        dict(piece.find("PointData").attrib),
    )


def _arrays(element: ElementTree.Element) -> dict[str, np.ndarray]:
    arrays = {}
    for array in element.findall("DataArray"):
        text = array.text.strip()
        blocks, size, last, packed = np.frombuffer(base64.b64decode(text[:44]), dtype="<u8")
        assert (blocks, size) == (1, last)
        raw = zlib.decompress(base64.b64decode(text[44:])[: int(packed)])
        assert len(raw) == size
        values = np.frombuffer(raw, dtype=TYPES[array.get("type")])
        count = int(array.get("NumberOfComponents", "1"))
        arrays[array.get("Name")] = values.reshape(-1, count) if count > 1 else values
    return arrays
