"""Quadratic tetrahedra as a Gmsh file (MSH 4.1, text): every face of the part is a physical group by its name."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from codesign.fem.model import TetMesh
from codesign.files import write_text

TRIANGLE, TETRAHEDRON = 9, 11  # Gmsh's numbers of both quadratic elements
TO_GMSH = [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]  # the last two mid-edge nodes are the other way round there
REST = "rest"  # group of the faces without name


def write_msh(mesh: TetMesh, path: str | os.PathLike[str], volume: str = "part") -> None:
    """Writes nodes [m], boundary triangles and tetrahedra; coordinates read back exactly.

    Physical groups: a surface for every face name ("rest": those without), and the volume, called `volume`.
    """
    numbers = np.unique(mesh.boundary_face)
    names = [mesh.face_names[k] or REST for k in numbers]
    surfaces = [mesh.boundary[mesh.boundary_face == k] for k in numbers]
    owner = np.full(len(mesh.nodes), len(surfaces) + 1)  # the entity whose block holds a node, from 1; the volume last
    for tag in range(len(surfaces), 0, -1):
        owner[surfaces[tag - 1]] = tag
    lines = [
        "$MeshFormat\n4.1 0 8\n$EndMeshFormat",
        *_names([*names, volume]),
        *_entities(mesh.nodes, surfaces),
        *_nodes(mesh.nodes, owner, len(surfaces)),
        *_elements(surfaces, mesh.tets[:, TO_GMSH]),
        "",
    ]
    write_text(Path(path), "\n".join(lines))


def _names(names: list[str]) -> list[str]:
    groups = [(2, tag, name) for tag, name in enumerate(names[:-1], start=1)] + [(3, len(names), names[-1])]
    quoted = [f'{dimension} {tag} "{name.replace(chr(34), chr(39))}"' for dimension, tag, name in groups]
    return ["$PhysicalNames", str(len(groups)), *quoted, "$EndPhysicalNames"]


def _entities(nodes: NDArray[np.float64], surfaces: list[NDArray[np.int32]]) -> list[str]:
    """One surface for each group, and the volume that they bound; boxes around both."""
    lines = ["$Entities", f"0 0 {len(surfaces)} 1"]
    for tag, triangles in enumerate(surfaces, start=1):
        lines.append(f"{tag} {_box(nodes[np.unique(triangles)])} 1 {tag} 0")
    bounding = " ".join(str(tag) for tag in range(1, len(surfaces) + 1))
    lines.append(f"1 {_box(nodes)} 1 {len(surfaces) + 1} {len(surfaces)} {bounding}")
    return [*lines, "$EndEntities"]


def _box(points: NDArray[np.float64]) -> str:
    return " ".join(repr(value) for value in (*points.min(axis=0).tolist(), *points.max(axis=0).tolist()))


def _nodes(nodes: NDArray[np.float64], owner: NDArray[np.int64], surfaces: int) -> list[str]:
    """Every node in the block of one entity."""
    lines = ["$Nodes", f"{len(np.unique(owner))} {len(nodes)} 1 {len(nodes)}"]
    for tag in np.unique(owner).tolist():
        held = np.flatnonzero(owner == tag)
        entity = f"2 {tag}" if tag <= surfaces else "3 1"
        lines.append(f"{entity} 0 {len(held)}")
        lines += [str(number) for number in (held + 1).tolist()]
        lines += [f"{x!r} {y!r} {z!r}" for x, y, z in nodes[held].tolist()]
    return [*lines, "$EndNodes"]


def _elements(surfaces: list[NDArray[np.int32]], tets: NDArray[np.int32]) -> list[str]:
    count = sum(map(len, surfaces)) + len(tets)
    lines = ["$Elements", f"{len(surfaces) + 1} {count} 1 {count}"]
    first = 1
    blocks = [(2, tag, TRIANGLE, triangles) for tag, triangles in enumerate(surfaces, start=1)]
    for dimension, tag, kind, elements in (*blocks, (3, 1, TETRAHEDRON, tets)):
        lines.append(f"{dimension} {tag} {kind} {len(elements)}")
        for number, element in enumerate((elements + 1).tolist(), start=first):
            lines.append(" ".join(map(str, (number, *element))))
        first += len(elements)
    return [*lines, "$EndElements"]
