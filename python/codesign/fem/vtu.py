"""Stress fields as VTU files: what was analyzed, in which units, and where the peak stress is not read."""

from __future__ import annotations

import base64
import os
import zlib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np
import numpy.typing as npt

from codesign.fem.model import TetMesh
from codesign.fem.static import StaticResult
from codesign.files import write_text

QUADRATIC_TETRA = 24  # VTK's number of the cell type; its nodes have the order of TetMesh
MIRRORED_NODES = [0, 2, 1, 3, 6, 5, 4, 7, 9, 8]  # of an element whose mirror image is to have a positive volume
VOIGT = ([0, 1, 2, 0, 1, 2], [0, 1, 2, 1, 2, 0])  # rows and columns of xx yy zz xy yz zx
Array = npt.NDArray[Any]

_TYPES = {"float64": "Float64", "int64": "Int64", "uint8": "UInt8"}


@dataclass(frozen=True)
class Field:
    """Values at nodes or in elements, with a unit and names of the components.

    tensor: "scalar", "vector" or "symmetric" (xx yy zz xy yz zx), which says how a mirror image looks.
    """

    name: str
    values: Array
    unit: str
    tensor: str = "scalar"

    @property
    def components(self) -> tuple[str, ...]:
        """Names of the components."""
        return {"scalar": (), "vector": ("x", "y", "z"), "symmetric": ("xx", "yy", "zz", "xy", "yz", "zx")}[self.tensor]

    def mirrored(self, normal: Array, antisymmetric: bool = False) -> Array:
        """Values of the mirror image in a plane with this unit normal; antisymmetric: of the opposite sign."""
        if self.tensor == "scalar":
            return self.values
        turn = np.eye(3) - 2.0 * np.outer(normal, normal)
        sign = -1.0 if antisymmetric else 1.0
        if self.tensor == "vector":
            return np.asarray(sign * self.values @ turn)
        tensors = np.empty((len(self.values), 3, 3))
        rows, columns = VOIGT
        tensors[:, rows, columns] = tensors[:, columns, rows] = self.values
        return np.asarray(sign * (turn @ tensors @ turn)[:, rows, columns])


@dataclass(frozen=True)
class StressModel:
    """Quadratic tetrahedra with the fields of an analysis; nodes (n, 3) [m], tets (m, 10)."""

    nodes: Array
    tets: Array
    at_nodes: tuple[Field, ...]
    in_elements: tuple[Field, ...]

    @classmethod
    def of(cls, mesh: TetMesh, result: StaticResult) -> StressModel:
        """The analyzed model.

        At the nodes displacement, stress, von Mises stress and `counts_for_peak`: 0 where the peak stress, and with it
        the safety factor, is not read. In the elements `error`: how far their own stress is from the recovered one.
        """
        return cls(
            np.array(mesh.nodes),
            np.array(mesh.tets, dtype=np.int64),
            (
                Field("displacement", np.array(result.displacement), "m", "vector"),
                Field("stress", np.array(result.stress), "Pa", "symmetric"),
                Field("von_mises", np.array(result.von_mises), "Pa"),
                Field("counts_for_peak", np.array(result.counts_for_peak, dtype=np.uint8), "1"),
            ),
            (Field("error", np.array(result.element_error), "Pa"),),
        )

    def with_mirror_image(self, point: Array, normal: Array, antisymmetric: bool = False) -> StressModel:
        """The whole of which this is one half, cut by a plane: a point [m], a unit normal; nodes on it are shared.

        antisymmetric: the load of the other half is the mirror image of this one's with the opposite sign.
        """
        distance = (self.nodes - point) @ normal
        on_plane = np.abs(distance) < 1e-7 * np.ptp(self.nodes, axis=0).max()
        away = np.flatnonzero(~on_plane)
        image = np.arange(len(self.nodes))
        image[away] = len(self.nodes) + np.arange(len(away))
        nodes = np.concatenate((self.nodes, (self.nodes - 2.0 * np.outer(distance, normal))[away]))
        tets = np.concatenate((self.tets, image[self.tets][:, MIRRORED_NODES]))
        at_nodes = [
            replace(f, values=np.concatenate((f.values, f.mirrored(normal, antisymmetric)[away])))
            for f in self.at_nodes
        ]
        in_elements = [replace(f, values=np.concatenate((f.values, f.mirrored(normal)))) for f in self.in_elements]
        return StressModel(nodes, tets, tuple(at_nodes), tuple(in_elements))


def write_vtu(model: StressModel, path: str | os.PathLike[str], notes: Mapping[str, str] | None = None) -> Path:
    """Writes a model for ParaView; `notes` become strings in the field data. Coordinates in m, fields in SI units."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    units = "; ".join(["coordinates m", *(f"{f.name} {f.unit}" for f in (*model.at_nodes, *model.in_elements))])
    strings = "".join(_string(name, text) for name, text in {**(notes or {}), "units": units}.items())
    cells = {
        "connectivity": model.tets.ravel(),
        "offsets": model.tets.shape[1] * np.arange(1, len(model.tets) + 1),
        "types": np.full(len(model.tets), QUADRATIC_TETRA, dtype=np.uint8),
    }
    active = {"Scalars": "von_mises", "Vectors": "displacement", "Tensors": "stress"}
    present = {field.name for field in model.at_nodes}
    attributes = "".join(f' {kind}="{name}"' for kind, name in active.items() if name in present)
    text = (
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        '<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64"'
        ' compressor="vtkZLibDataCompressor">\n<UnstructuredGrid>\n'
        f"<FieldData>\n{strings}</FieldData>\n"
        f'<Piece NumberOfPoints="{len(model.nodes)}" NumberOfCells="{len(model.tets)}">\n'
        f"<Points>\n{_array(Field('Points', model.nodes, 'm', 'vector'))}</Points>\n"
        f"<Cells>\n{_arrays(Field(name, values, '') for name, values in cells.items())}</Cells>\n"
        f"<PointData{attributes}>\n{_arrays(model.at_nodes)}</PointData>\n"
        f"<CellData>\n{_arrays(model.in_elements)}</CellData>\n"
        "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n"
    )
    return write_text(path, text)


def _arrays(fields: Iterable[Field]) -> str:
    return "".join(_array(field) for field in fields)


def _array(field: Field) -> str:
    """An array as compressed base64, with the names of its components and its unit where VTK keeps them."""
    values = np.ascontiguousarray(field.values)
    components = "".join(f' ComponentName{k}="{name}"' for k, name in enumerate(field.components))
    count = f' NumberOfComponents="{len(field.components)}"' if field.components else ""
    unit = f'<InformationKey name="UNITS_LABEL" location="vtkDataArray">{field.unit}</InformationKey>\n'
    return (
        f'<DataArray type="{_TYPES[values.dtype.name]}" Name={quoteattr(field.name)}{count}{components}'
        f' format="binary">\n{_packed(values)}\n{unit if field.unit else ""}</DataArray>\n'
    )


def _packed(values: Array) -> str:
    """One compressed block behind its header: number of blocks, size, size of the last, compressed size."""
    raw = values.astype(values.dtype.newbyteorder("<")).tobytes()
    block = zlib.compress(raw)
    header = np.array([1, len(raw), len(raw), len(block)], dtype="<u8").tobytes()
    return base64.b64encode(header).decode() + base64.b64encode(block).decode()


def _string(name: str, text: str) -> str:
    """A string of the field data: the numbers of its bytes, ended by zero."""
    codes = " ".join(str(byte) for byte in (*text.encode(), 0))
    return f'<Array type="String" Name={quoteattr(name)} NumberOfTuples="1" format="ascii">\n{codes}\n</Array>\n'
