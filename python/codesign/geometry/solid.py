"""First evaluator of the part language: a closed triangle mesh with tracked faces, by manifold3d's exact booleans."""

from __future__ import annotations

from dataclasses import dataclass

import manifold3d
import numpy as np

from codesign.errors import GeometryError
from codesign.geometry.profile import Resolution, Vector
from codesign.geometry.shape import Difference, Intersection, Moved, Shape, Union
from codesign.geometry.tessellate import Indices, PrimitiveMesh, tessellate


@dataclass(frozen=True, slots=True)
class Solid:
    """A closed, outward-oriented triangle mesh in mm.

    points (n, 3); triangles (m, 3); face (m,): the analytic face (plane, cylinder, fillet …) of each triangle, an
    index into `face_names`. Several faces may share a name, most have the name "".
    """

    points: Vector
    triangles: Indices
    face: Indices
    face_names: tuple[str, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """Names that occur on the surface, in order of creation, without ""."""
        present = [self.face_names[k] for k in np.unique(self.face)]
        return tuple(dict.fromkeys(name for name in present if name))

    def triangles_of(self, name: str) -> Indices:
        """Triangles (k, 3) of all faces called `name`."""
        wanted = np.array([face_name == name for face_name in self.face_names])
        chosen: Indices = self.triangles[wanted[self.face]]
        return chosen


def build_solid(shape: Shape, resolution: Resolution, genus: int | None = None) -> Solid:
    """Mesh of a shape. `genus`: the number of through holes it must have, if known.

    Raises: GeometryError if the result is empty, falls apart into several bodies or has another number of holes.
    """
    evaluator = _Evaluator(resolution)
    body = evaluator.evaluate(shape)
    if body.status() != manifold3d.Error.NoError:
        raise GeometryError(f"the shape is not a closed solid: {body.status().name}")
    if body.is_empty():
        raise GeometryError("the shape is empty")
    bodies = len(body.decompose())
    if bodies != 1:
        raise GeometryError(f"the shape falls apart into {bodies} bodies")
    if genus is not None and body.genus() != genus:
        raise GeometryError(f"the shape has {body.genus()} through holes instead of {genus}: features overlap")
    mesh = body.to_mesh64()
    merge = np.arange(len(mesh.vert_properties))
    merge[mesh.merge_from_vert] = mesh.merge_to_vert
    used, triangles = np.unique(merge[mesh.tri_verts], return_inverse=True)
    points = np.array(mesh.vert_properties[used, :3], dtype=np.float64)
    return Solid(points, triangles.reshape(-1, 3), np.array(mesh.face_id, dtype=np.int64), tuple(evaluator.face_names))


class _Evaluator:
    """One evaluation: gives every face of every primitive its number and remembers the names."""

    def __init__(self, resolution: Resolution) -> None:
        self.resolution = resolution
        self.face_names: list[str] = []
        self._meshes: dict[int, PrimitiveMesh] = {}  # by identity: the copies of a pattern share one primitive

    def evaluate(self, shape: Shape) -> manifold3d.Manifold:
        """The manifold of a shape, in the coordinates it is written in."""
        if isinstance(shape, Moved):
            # Evaluated before it is moved: bounding boxes of a pattern are tight, and apart, in its own axes.
            still = self.evaluate(shape.shape)
            still.num_tri()
            return still.transform(np.array(shape.matrix)[:3])
        if isinstance(shape, Union):
            return self._batch(shape.shapes, manifold3d.OpType.Add)
        if isinstance(shape, Difference):
            return self._batch((shape.base, *shape.tools), manifold3d.OpType.Subtract)
        if isinstance(shape, Intersection):
            return self._batch(shape.shapes, manifold3d.OpType.Intersect)
        return self._primitive(shape)

    def _batch(self, shapes: tuple[Shape, ...], operation: manifold3d.OpType) -> manifold3d.Manifold:
        return manifold3d.Manifold.batch_boolean([self.evaluate(shape) for shape in shapes], operation)

    def _primitive(self, shape: Shape) -> manifold3d.Manifold:
        mesh = self._meshes.get(id(shape))
        if mesh is None:
            mesh = self._meshes[id(shape)] = tessellate(shape, self.resolution)
        first = len(self.face_names)
        self.face_names += mesh.face_names
        tool = manifold3d.Manifold(
            manifold3d.Mesh64(
                vert_properties=mesh.points,
                tri_verts=mesh.triangles,
                run_index=np.array([0, mesh.triangles.size], dtype=np.uint64),
                run_original_id=np.array([manifold3d.Manifold.reserve_ids(1)], dtype=np.uint32),
                face_id=mesh.face + np.uint64(first),
            )
        )
        if tool.status() != manifold3d.Error.NoError or tool.volume() <= 0.0:
            reason = f"{tool.status().name}, volume {tool.volume():g} mm³"
            raise GeometryError(f"{type(shape).__name__} is not a solid: {reason}")
        return tool
