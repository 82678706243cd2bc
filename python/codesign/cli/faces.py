"""Faces of a STEP file, for `codesign faces`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from rich.table import Table

from codesign.cli.console import out
from codesign.fem.holes import holes
from codesign.fem.step import load_step
from codesign.units import MILLIMETER


def face_documents(path: Path) -> list[dict[str, Any]]:
    """One document a face in the file's order, SI units: selection, type, radius, area, center of its triangles.

    type: hole is a hollow cylinder that closes, alone or with others. Raises: MeshError: as `load_step`.
    """
    part = load_step(path)
    surface = part.by_face()
    walls = {surface.face_names[index] for index in holes(surface)}
    a, b, c = (surface.points[surface.triangles[:, k]] for k in range(3))
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    documents = []
    for face in part.faces:
        own = part.triangle_face == face.number - 1
        name = face.name or f"face {face.number}"
        documents.append(
            {
                "selection": f"face:{face.name or face.number}",
                "type": "hole" if name in walls else face.kind,
                "radius": face.radius,
                "area": face.area,
                "center": (areas[own] @ ((a + b + c)[own] / 3.0) / areas[own].sum()).tolist(),
            }
        )
    return documents


def print_faces(documents: list[dict[str, Any]]) -> None:
    """As a table, lengths in mm."""
    table = Table(box=None, pad_edge=False)
    for heading in ("selection", "type", "radius mm", "area mm²", "middle mm"):
        table.add_column(heading, justify="left" if heading in ("selection", "type") else "right")
    for face in documents:
        radius = "" if face["radius"] is None else f"{face['radius'] / MILLIMETER:.4g}"
        x, y, z = (value / MILLIMETER for value in face["center"])
        area = face["area"] / MILLIMETER**2
        table.add_row(face["selection"], face["type"], radius, f"{area:.4g}", f"{x:.2f}, {y:.2f}, {z:.2f}")
    out.print(table)
