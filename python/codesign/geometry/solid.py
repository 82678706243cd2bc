"""First evaluator of the part language: a closed triangle mesh with tracked faces, by manifold3d's exact booleans."""

from __future__ import annotations

from dataclasses import dataclass

import manifold3d
import numpy as np

from codesign.errors import GeometryError
from codesign.geometry.cavities import check_cavities
from codesign.geometry.evaluate import Primitive, evaluate
from codesign.geometry.profile import Resolution, Vector
from codesign.geometry.shape import Shape
from codesign.geometry.tessellate import Indices
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
    piece = evaluate(shape, resolution)
    body = piece.manifold
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
    return _solid(body.to_mesh64(), piece.primitives)


def _solid(mesh: manifold3d.Mesh64, primitives: tuple[Primitive, ...]) -> Solid:
    """The mesh with the triangles in the order of their primitives, whose faces are numbered one after the other."""
    names: list[str] = []
    first: dict[Shape, int] = {}  # face of a primitive; equal ones, the copies of a pattern, share theirs
    for primitive in primitives:
        if primitive.shape not in first:
            first[primitive.shape] = len(names)
            names += primitive.face_names
    start_of = {primitive.number: first[primitive.shape] for primitive in primitives}
    ends = np.array(mesh.run_index, dtype=np.int64) // 3
    starts = [start_of[number] for number in mesh.run_original_id]
    order = np.argsort(starts, kind="stable")
    rows = np.concatenate([np.arange(ends[run], ends[run + 1]) for run in order])
    face = np.array(mesh.face_id, dtype=np.int64) + np.repeat(starts, np.diff(ends))
    merge = np.arange(len(mesh.vert_properties))
    merge[mesh.merge_from_vert] = mesh.merge_to_vert
    corners = merge[mesh.tri_verts[rows]]
    points, triangles = without_unused(mesh.vert_properties[:, :3].astype(np.float64), corners)
    return Solid(points, triangles, face[rows], tuple(names))


def mesh_volume(shape: Shape, resolution: Resolution) -> float:
    """Volume [mm³] of the mesh of a shape, whatever its number of bodies."""
    return float(evaluate(shape, resolution).manifold.volume())
