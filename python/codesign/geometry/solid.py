"""First evaluator of the part language: a closed triangle mesh with tracked faces, by manifold3d's exact booleans."""

from __future__ import annotations

from dataclasses import dataclass

import manifold3d
import numpy as np

from codesign.errors import GeometryError
from codesign.geometry.cavities import check_cavities
from codesign.geometry.profile import Resolution, Vector
from codesign.geometry.shape import Difference, Intersection, Moved, Shape, Union
from codesign.geometry.tessellate import Indices, tessellate
from codesign.geometry.tidy import tidy, without_unused


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

    def __post_init__(self) -> None:
        for array in (self.points, self.triangles, self.face):  # meshes are shared
            array.flags.writeable = False

    def mirrored(self, axis: str) -> Solid:
        """The mirror image in the plane through the origin normal to "x", "y" or "z"."""
        signs = np.where(np.arange(3) == "xyz".index(axis), -1.0, 1.0)
        return Solid(self.points * signs, self.triangles[:, ::-1].copy(), self.face, self.face_names)

    def tidied(self) -> Solid:
        """The same surface without the tiny edges and flat triangles that booleans leave; see `tidy`."""
        return Solid(*tidy(self.points, self.triangles, self.face), self.face_names)


def build_solid(shape: Shape, resolution: Resolution, genus: int | None = None) -> Solid:
    """Mesh of a shape, of several closed surfaces if it has sealed cavities. `genus`: its through holes, if known.

    Raises: GeometryError if the result is empty, falls apart into several bodies, has another number of holes, or a
        cavity closed by nothing but a skin.
    """
    evaluator = _Evaluator(resolution)
    body = evaluator.evaluate_whole(shape)
    if body.status() != manifold3d.Error.NoError:
        raise GeometryError(f"the shape is not a closed solid: {body.status().name}")
    if body.is_empty():
        raise GeometryError("the shape is empty")
    shells = body.decompose()
    bodies = [shell for shell in shells if shell.volume() > 0.0]
    if len(bodies) != 1:
        raise GeometryError(f"the shape falls apart into {len(bodies)} bodies")
    check_cavities(bodies[0], [shell for shell in shells if shell.volume() <= 0.0])
    holes = sum(shell.genus() for shell in shells)  # the genus of a body with cavities lacks one for each of them
    if genus is not None and holes != genus:
        raise GeometryError(f"the shape has {holes} through holes instead of {genus}: features overlap")
    mesh = body.to_mesh64()
    merge = np.arange(len(mesh.vert_properties))
    merge[mesh.merge_from_vert] = mesh.merge_to_vert
    points, triangles = without_unused(mesh.vert_properties[:, :3].astype(np.float64), merge[mesh.tri_verts])
    return Solid(points, triangles, np.array(mesh.face_id, dtype=np.int64), tuple(evaluator.face_names))


def mesh_volume(shape: Shape, resolution: Resolution) -> float:
    """Volume [mm³] of the mesh of a shape, whatever its number of bodies."""
    return float(_Evaluator(resolution).evaluate_whole(shape).volume())


class _Evaluator:
    """One evaluation: gives every face of every primitive its number and remembers the names."""

    def __init__(self, resolution: Resolution) -> None:
        self.resolution = resolution
        self.face_names: list[str] = []
        self._done: dict[int, manifold3d.Manifold] = {}  # by identity: the copies of a pattern share one primitive

    def evaluate_whole(self, shape: Shape) -> manifold3d.Manifold:
        """The manifold of the outermost shape.

        Its tools that are placed at an angle are cut in their own frame, where bounding boxes are far more selective
        (three times faster at 45 degrees). Only here: the way there and back rounds coordinates by 1e-14, which inner
        solids that share a plane with others would not survive.
        """
        if not isinstance(shape, Difference):
            return self.evaluate(shape)
        straight = tuple(tool for tool in shape.tools if not _is_tilted(tool))
        body = self.evaluate(Difference(shape.base, straight))
        frames: dict[tuple[tuple[float, ...], ...], list[Shape]] = {}
        for tool in shape.tools:
            if isinstance(tool, Moved) and _is_tilted(tool):
                frames.setdefault(tool.matrix, []).append(tool.shape)
        for matrix, tools in frames.items():
            forth = np.array(matrix)
            seen = self._now(body.transform(np.linalg.inv(forth)[:3]))
            cut = manifold3d.Manifold.batch_boolean([seen, *map(self.evaluate, tools)], manifold3d.OpType.Subtract)
            body = self._now(cut).transform(forth[:3])
        return body

    def evaluate(self, shape: Shape) -> manifold3d.Manifold:
        """The manifold of a shape, in the coordinates it is written in."""
        if isinstance(shape, Moved):
            # Evaluated before it is moved: bounding boxes of a pattern are tight, and apart, in its own axes.
            return self._now(self.evaluate(shape.shape)).transform(np.array(shape.matrix)[:3])
        if isinstance(shape, Union):
            return self._batch(shape.shapes, manifold3d.OpType.Add)
        if isinstance(shape, Intersection):
            return self._batch(shape.shapes, manifold3d.OpType.Intersect)
        if isinstance(shape, Difference):
            return self._batch((shape.base, *shape.tools), manifold3d.OpType.Subtract)
        done = self._done.get(id(shape))
        if done is None:
            done = self._done[id(shape)] = self._primitive(shape)
        return done

    def _batch(self, shapes: tuple[Shape, ...], operation: manifold3d.OpType) -> manifold3d.Manifold:
        return manifold3d.Manifold.batch_boolean([self.evaluate(shape) for shape in shapes], operation)

    @staticmethod
    def _now(manifold: manifold3d.Manifold) -> manifold3d.Manifold:
        """Evaluates at once what manifold3d would put off and rearrange."""
        manifold.num_tri()
        return manifold

    def _primitive(self, shape: Shape) -> manifold3d.Manifold:
        mesh = tessellate(shape, self.resolution)
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


def _is_tilted(shape: Shape) -> bool:
    """Whether a shape is placed at an angle to the part's axes."""
    if not isinstance(shape, Moved):
        return False
    rotation = np.abs(np.array(shape.matrix)[:3, :3])
    return bool((np.minimum(rotation, 1.0 - rotation) > 1e-9).any())
