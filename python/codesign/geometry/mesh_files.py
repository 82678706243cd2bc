"""Triangle meshes in files: STL and 3MF for workshops (mm), GLB for viewers (m)."""

from __future__ import annotations

import io
import os
import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from codesign import __version__
from codesign.files import write_bytes
from codesign.geometry.layout import lay_out
from codesign.geometry.profile import Vector
from codesign.geometry.solid import Solid
from codesign.units import MILLIMETER

_Y_UP, _Z_UP = "y up", "z up"  # frames of a GLB scene
_STL_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def write_stl(solid: Solid, path: str | os.PathLike[str], title: str = "") -> None:
    """Binary STL in mm. `title` goes into the 80-byte header."""
    corners = solid.points[solid.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    records = np.zeros(len(corners), dtype=_STL_TRIANGLE)
    records["normal"] = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    records["corners"] = corners
    header = f"codesign {title} [mm]".encode("ascii", "replace")[:80].ljust(80)
    write_bytes(Path(path), header + np.uint32(len(records)).tobytes() + records.tobytes())


def obj_text(points: Vector, triangles: NDArray[Any]) -> str:
    """Wavefront OBJ of points (n, 3) and triangles (m, 3), in the points' unit; coordinates read back exactly."""
    vertices = [f"v {x!r} {y!r} {z!r}" for x, y, z in np.asarray(points, dtype=float).tolist()]
    faces = [f"f {a} {b} {c}" for a, b, c in (np.asarray(triangles, dtype=np.int64) + 1).tolist()]
    return "\n".join([*vertices, *faces, ""])


def write_3mf(
    solids: Mapping[str, Solid],
    path: str | os.PathLike[str],
    counts: Mapping[str, int] | None = None,
    title: str = "",
) -> None:
    """3MF in mm with one named object per solid; its copies lie side by side on the plane z = 0, turned as modeled.

    counts: how many of each are wanted; one if absent. title: of the whole file.
    """
    from xml.sax.saxutils import escape, quoteattr  # they load the whole of urllib

    counts = counts or {}
    resources, items = [], []
    copies = [(number, name) for number, name in enumerate(solids, start=1) for _ in range(counts.get(name, 1))]
    low = {name: solid.points.min(axis=0) for name, solid in solids.items()}
    size = {name: solid.points.max(axis=0) - low[name] for name, solid in solids.items()}
    corners = lay_out([(float(size[name][0]), float(size[name][1])) for _, name in copies])
    for number, (name, solid) in enumerate(solids.items(), start=1):
        vertices = "".join(f'<vertex x="{x:.7g}" y="{y:.7g}" z="{z:.7g}"/>' for x, y, z in solid.points.tolist())
        triangles = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in solid.triangles.tolist())
        mesh = f"<mesh><vertices>{vertices}</vertices><triangles>{triangles}</triangles></mesh>"
        resources.append(f'<object id="{number}" name={quoteattr(name)} type="model">{mesh}</object>')
    for (number, name), corner in zip(copies, corners, strict=True):
        x, y, z = np.array([*corner, 1e-4]) - low[name]  # above the plane whatever the rounding of the vertices
        items.append(f'<item objectid="{number}" transform="1 0 0 0 1 0 0 0 1 {x:.7g} {y:.7g} {z:.7g}"/>')
    metadata = "".join(
        f'<metadata name="{name}">{escape(text)}</metadata>'
        for name, text in (("Title", title), ("Application", f"codesign {__version__}"))
        if text
    )
    model = (
        '<?xml version="1.0" encoding="UTF-8"?>'
        '<model unit="millimeter" xml:lang="en-US" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">'
        f"{metadata}<resources>{''.join(resources)}</resources><build>{''.join(items)}</build></model>"
    )
    types = (
        '<?xml version="1.0" encoding="UTF-8"?>'
        '<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">'
        '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
        '<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>'
    )
    relations = (
        '<?xml version="1.0" encoding="UTF-8"?>'
        '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
        '<Relationship Target="/3D/3dmodel.model" Id="rel0" '
        'Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>'
    )
    package = io.BytesIO()
    with zipfile.ZipFile(package, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in (("[Content_Types].xml", types), ("_rels/.rels", relations), ("3D/3dmodel.model", model)):
            archive.writestr(name, text)
    write_bytes(Path(path), package.getvalue())


def write_glb(
    meshes: Mapping[str, Solid], nodes: Sequence[tuple[str, str, Vector]], path: str | os.PathLike[str]
) -> None:
    """Binary glTF 2.0 in meters: meshes by name, placed by nodes (name, mesh name, root_T_node (4, 4) [m]).

    glTF has y up: a root node turns z there. Without normals in the file, viewers shade every triangle flat.
    Raises: ValueError if two nodes have one name.
    """
    from trimesh import Scene, Trimesh
    from trimesh.visual import TextureVisuals
    from trimesh.visual.material import PBRMaterial

    names = [name for name, _, _ in nodes]
    if repeated := {name for name in names if names.count(name) > 1}:
        raise ValueError(f"nodes of a GLB file with the same name: {', '.join(sorted(repeated))}")
    color = [191, 194, 199, 255]
    metal = PBRMaterial("metal", baseColorFactor=color, metallicFactor=0.6, roughnessFactor=0.5)  # type: ignore[no-untyped-call]
    scene: Any = Scene(base_frame=_Y_UP)
    scene.graph.update(_Z_UP, _Y_UP, matrix=[[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
    for name, solid in meshes.items():
        visual = TextureVisuals(material=metal)  # type: ignore[no-untyped-call]
        scene.geometry[name] = Trimesh(solid.points * MILLIMETER, solid.triangles, process=False, visual=visual)
    for name, mesh, pose in nodes:
        scene.graph.update(name, _Z_UP, matrix=pose, geometry=mesh)
    content = scene.export(file_type="glb", include_normals=False, tree_postprocessor=_signed)
    write_bytes(Path(path), content)


def _signed(gltf: dict[str, Any]) -> None:
    gltf["asset"]["generator"] = f"codesign {__version__}"
