"""Closed triangle meshes of exact solids, by OpenCASCADE."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from OCP.BRep import BRep_Tool
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.TopAbs import TopAbs_Orientation
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Face, TopoDS_Shape

from codesign.errors import GeometryError

MERGE = 1e-6  # mm: points of neighboring faces this close are one


def triangulate(
    shape: TopoDS_Shape, faces: Sequence[TopoDS_Face], chord: float, angle: float
) -> tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.int64]]:
    """Points (n, 3) [mm], triangles (m, 3) counter-clockwise from outside, face of each triangle (m,).

    chord: largest distance of triangles from the faces [mm]; angle: between neighboring chords of a curve [rad].
    Raises: GeometryError for a face that has no triangles.
    """
    BRepMesh_IncrementalMesh(shape, chord, False, angle, False)
    points: list[NDArray[np.float64]] = []
    triangles: list[NDArray[np.int64]] = []
    owner: list[NDArray[np.int64]] = []
    count = 0
    for index, face in enumerate(faces):
        location = TopLoc_Location()
        mesh = BRep_Tool.Triangulation_s(face, location)
        if mesh is None:
            raise GeometryError(f"face {index + 1} of the solid cannot be triangulated: it is degenerate or damaged")
        move = location.Transformation()
        nodes = [mesh.Node(i + 1).Transformed(move) for i in range(mesh.NbNodes())]
        corners = np.array([mesh.Triangle(i + 1).Get() for i in range(mesh.NbTriangles())], dtype=np.int64) - 1
        if face.Orientation() == TopAbs_Orientation.TopAbs_REVERSED:
            corners = corners[:, ::-1]
        points.append(np.array([(p.X(), p.Y(), p.Z()) for p in nodes]))
        triangles.append(corners + count)
        owner.append(np.full(len(corners), index))
        count += len(nodes)
    return _merged(np.vstack(points), np.vstack(triangles), np.concatenate(owner))


def _merged(
    points: NDArray[np.float64], triangles: NDArray[np.int64], owner: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.int64]]:
    """One point where faces meet; triangles that shrink to an edge (poles) are dropped."""
    _, first, inverse = np.unique(np.round(points / MERGE), axis=0, return_index=True, return_inverse=True)
    joined = inverse.ravel()[triangles]
    whole = (joined[:, 0] != joined[:, 1]) & (joined[:, 1] != joined[:, 2]) & (joined[:, 2] != joined[:, 0])
    return points[first], joined[whole].astype(np.int32), owner[whole]
