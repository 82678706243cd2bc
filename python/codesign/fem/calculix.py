"""CalculiX (and Abaqus) input: one deck per model with named sets, supports and any number of load cases.

Loads are written as the consistent nodal forces of this project's solver, so another program solves the same system.
Format: CalculiX CrunchiX 2.20 manual. It reads 20 characters of a number and 16 entries of a line; what is longer is
cut without a message.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from codesign._core import fem as _core
from codesign.fem.loads import Load, native_loads
from codesign.fem.model import Material, Support, TetMesh, native_supports, resolve
from codesign.files import replacing

PER_LINE = 16  # entries
LONGEST_NAME = 80  # characters of a set
# Sides of a ten-node tetrahedron in CalculiX's numbers (node k opposite to face _FACE[k]).
_FACE = {3: 1, 2: 2, 0: 3, 1: 4}


def write_inp(
    path: str | Path,
    mesh: TetMesh,
    material: Material,
    supports: Sequence[Support],
    cases: Mapping[str, Sequence[Load]],
    title: str = "",
) -> None:
    """Writes a static model; SI units (m, N, Pa), one step per load case.

    Args:
        path: replaced when the deck is complete. mesh: ten-node tetrahedra; their order of nodes is CalculiX's own.
        material: linear elastic; a density above zero is written. supports: what holds the part.
        cases: name -> loads. title: in the heading.

    Sets: NALL, PART (elements); for each named face a node set and a surface of its name in capitals.
    Raises: ValueError: no load case, a selection that makes no sense.
    """
    if not cases:
        raise ValueError("write_inp: at least one load case is needed")
    native_supports(mesh, supports)  # refuses what makes no sense before anything is written
    vectors = {name: _core.load_vector(mesh, material, native_loads(mesh, loads)) for name, loads in cases.items()}
    with replacing(Path(path)) as beside, beside.open("w", encoding="ascii", errors="replace") as file:
        file.writelines(f"{line}\n" for line in _model(mesh, material, supports, title))
        for name, vector in vectors.items():
            file.writelines(f"{line}\n" for line in _step(name, np.asarray(vector).reshape(-1, 3)))


def _model(mesh: TetMesh, material: Material, supports: Sequence[Support], title: str) -> Iterator[str]:
    yield "*HEADING"
    yield f"{title or 'linear elastic part'}; units m, N, Pa, kg"
    yield "*NODE, NSET=NALL"
    for i, (x, y, z) in enumerate(np.asarray(mesh.nodes).tolist()):
        yield f"{i + 1}, {_number(x)}, {_number(y)}, {_number(z)}"
    yield "*ELEMENT, TYPE=C3D10, ELSET=PART"
    for e, tet in enumerate((np.asarray(mesh.tets) + 1).tolist()):
        yield ", ".join(map(str, (e + 1, *tet)))
    yield from _named_faces(mesh)
    yield f"*MATERIAL, NAME={_name(material.name) or 'MATERIAL'}"
    yield "*ELASTIC"
    yield f"{_number(material.young_modulus)}, {_number(material.poisson_ratio)}"
    if material.density > 0.0:
        yield "*DENSITY"
        yield _number(material.density)
    yield f"*SOLID SECTION, ELSET=PART, MATERIAL={_name(material.name) or 'MATERIAL'}"
    yield "*BOUNDARY"
    for (node, axis), value in sorted(_held(mesh, supports).items()):
        yield f"{node + 1}, {axis + 1}, {axis + 1}, {_number(value)}"


def _named_faces(mesh: TetMesh) -> Iterator[str]:
    sides = _element_sides(mesh)
    faces = np.asarray(mesh.boundary_face)
    for index, name in enumerate(mesh.face_names):
        rows = np.flatnonzero(faces == index)
        if not name or not len(rows):
            continue
        yield f"*NSET, NSET=N_{_name(name)}"
        yield from _lines(np.unique(np.asarray(mesh.boundary)[rows]) + 1)
        yield f"*SURFACE, NAME=S_{_name(name)}, TYPE=ELEMENT"
        for row in rows:
            element, side = sides[row]
            yield f"{element + 1}, S{side}"


def _element_sides(mesh: TetMesh) -> list[tuple[int, int]]:
    """Element and CalculiX's number of its side, for each boundary triangle."""
    tets, boundary = np.asarray(mesh.tets)[:, :4], np.sort(np.asarray(mesh.boundary)[:, :3], axis=1)
    side_of: dict[tuple[int, ...], tuple[int, int]] = {}
    for corner, number in _FACE.items():
        others = np.sort(np.delete(tets, corner, axis=1), axis=1)
        side_of |= {tuple(row): (e, number) for e, row in enumerate(others.tolist())}
    return [side_of[tuple(row)] for row in boundary.tolist()]


def _held(mesh: TetMesh, supports: Sequence[Support]) -> dict[tuple[int, int], float]:
    """Prescribed displacement [m] by node and axis."""
    held: dict[tuple[int, int], float] = {}
    for support in supports:
        nodes = _core.selected_nodes(mesh, resolve(mesh, support.where))
        given = 0.0 if support.displacement is None else np.asarray(support.displacement, dtype=float)
        values = np.broadcast_to(given, (len(nodes), 3))
        for node, value in zip(nodes, values.tolist(), strict=True):
            held |= {(node, axis): value[axis] for axis, letter in enumerate("xyz") if letter in support.axes}
    return held


def _step(name: str, force: NDArray[np.float64]) -> Iterator[str]:
    yield f"** LOAD CASE {name}"
    yield "*STEP"
    yield "*STATIC"
    yield "*CLOAD, OP=NEW"
    for node, axis in zip(*np.nonzero(force), strict=True):
        yield f"{node + 1}, {axis + 1}, {_number(force[node, axis])}"
    yield "*NODE PRINT, NSET=NALL"
    yield "U"
    yield "*EL PRINT, ELSET=PART"
    yield "S"
    yield "*NODE FILE"
    yield "U, RF"
    yield "*EL FILE"
    yield "S"
    yield "*END STEP"


def _lines(numbers: Iterable[int]) -> Iterator[str]:
    """Numbers of a set, as many as a line may hold; all but the last line end with a comma."""
    entries = [str(number) for number in numbers]
    for start in range(0, len(entries), PER_LINE):
        line = ", ".join(entries[start : start + PER_LINE])
        yield line + ("," if start + PER_LINE < len(entries) else "")


def _number(value: float) -> str:
    """At most 19 characters: `.13e` of a negative number with a three-digit exponent would be cut."""
    return f"{value:.12e}"


def _name(name: str) -> str:
    """A set's name: capitals, no blanks, a letter first."""
    kept = "".join(c if c.isascii() and (c.isalnum() or c == "_") else "_" for c in name.upper())
    return kept[: LONGEST_NAME - 2]
