"""Primitives as closed triangle meshes whose triangles know the analytic face they belong to."""

from __future__ import annotations

from dataclasses import dataclass

import manifold3d
import numpy as np
import numpy.typing as npt

from codesign.geometry.profile import FULL_TURN, Resolution, Vector
from codesign.geometry.shape import Extrusion, Revolution, Shape

Indices = npt.NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class PrimitiveMesh:
    """A closed mesh in mm; triangle k lies on the primitive's face `face[k]`, called `face_names[face[k]]`."""

    points: Vector
    triangles: npt.NDArray[np.uint64]
    face: npt.NDArray[np.uint64]
    face_names: tuple[str, ...]


def tessellate(primitive: Shape, resolution: Resolution) -> PrimitiveMesh:
    """Mesh of an extrusion, a revolution or an imported solid in the coordinates it is written in."""
    if isinstance(primitive, Extrusion):
        return _extrusion(primitive, resolution)
    if isinstance(primitive, Revolution):
        return _revolution(primitive, resolution)
    if hasattr(primitive, "mesh"):
        mesh: PrimitiveMesh = primitive.mesh(resolution)
        return mesh
    raise TypeError(f"{type(primitive).__name__} is not a primitive")


def _extrusion(extrusion: Extrusion, resolution: Resolution) -> PrimitiveMesh:
    """Two caps (faces 0 and 1) and a face for each edge of the profile."""
    frame, loops = extrusion.frame, extrusion.profile.loops
    names = [extrusion.start_face, extrusion.end_face]
    contours, sides, faces = [], [], []
    first, count = 0, 0
    for number, loop in enumerate(loops):
        points, edge = loop.points(resolution)
        edge = edge + len(names)
        if number > 0:  # backwards round a hole, so that the material is on the left there too
            points, edge = points[::-1], np.roll(edge[::-1], -1)
        contours.append(points)
        here = first + np.arange(len(points))
        sides.append((here, np.roll(here, -1)))
        faces += [edge, edge]
        names += [e.face for e in loop.edges]
        first += len(points)
    count = first
    cap = np.asarray(manifold3d.triangulate(contours), dtype=np.int64)
    walls = [
        np.stack(corners, axis=1)
        for here, there in sides
        for corners in ((here, there, there + count), (here, there + count, here + count))
    ]
    base = np.array(frame.origin) + np.concatenate(contours) @ np.array([frame.x, frame.y])
    normal = np.array(frame.z)
    return _mesh(
        [base + extrusion.start * normal, base + extrusion.end * normal],
        [cap[:, ::-1], cap + count, *walls],
        [np.zeros(len(cap), np.int64), np.ones(len(cap), np.int64), *faces],
        names,
    )


def _revolution(revolution: Revolution, resolution: Resolution) -> PrimitiveMesh:
    """A face for each edge of the profile that does not lie on the axis; points on the axis are single."""
    frame, loop = revolution.frame, revolution.profile.outer
    outline, edge = loop.points(resolution)
    steps = resolution.arc_segments(revolution.divided_as or float(outline[:, 1].max()), FULL_TURN)
    on_axis = outline[:, 1] == 0.0
    size = np.where(on_axis, 1, steps)
    start = np.cumsum(size) - size
    angle = FULL_TURN * np.arange(steps) / steps
    row = np.repeat(np.arange(len(outline)), size)
    turn = np.arange(len(row)) - start[row]
    axial, radius = outline[row, 0], outline[row, 1]
    local = np.stack((axial, radius * np.cos(angle)[turn], radius * np.sin(angle)[turn]), axis=1)
    around = np.where(on_axis[:, None], 0, np.arange(steps))
    here = start[:, None] + around  # (points of the outline, steps)
    ahead = start[:, None] + np.roll(around, -1, axis=1)
    below, beside = np.roll(here, -1, axis=0), np.roll(ahead, -1, axis=0)
    strips = np.stack((np.stack((here, beside, ahead), axis=2), np.stack((here, below, beside), axis=2)), axis=1)
    off_axis = np.stack((~on_axis, ~np.roll(on_axis, -1)), axis=1)
    triangles = strips[off_axis].reshape(-1, 3)
    faces = np.repeat(np.stack((edge, edge), axis=1)[off_axis], steps)
    points = np.array(frame.origin) + local @ np.array([frame.x, frame.y, frame.z])
    return _mesh([points], [triangles], [faces], [e.face for e in loop.edges])


def _mesh(points: list[Vector], triangles: list[Indices], faces: list[Indices], names: list[str]) -> PrimitiveMesh:
    return PrimitiveMesh(
        np.concatenate(points),
        np.ascontiguousarray(np.concatenate(triangles), dtype=np.uint64),
        np.concatenate(faces).astype(np.uint64),
        tuple(names),
    )
