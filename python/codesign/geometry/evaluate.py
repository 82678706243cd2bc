"""Shapes as manifolds of manifold3d, whose triangles know the primitive and its face that they lie on.

Tools and added bodies are mostly the same from one design to the next, so their manifolds are kept. What comes out does
not depend on what was kept.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from weakref import WeakValueDictionary

import manifold3d
import numpy as np

from codesign.errors import GeometryError
from codesign.geometry.profile import Resolution, Vector
from codesign.geometry.shape import Difference, Intersection, Moved, Shape, Union, union
from codesign.geometry.tessellate import tessellate

KEPT = 128  # manifolds: four meshes of a few tools for each of several parts, about 0.1 MB each
REPEATED = 32  # primitives: a shape's pattern repeats the same one


@dataclass(frozen=True, eq=False)
class Primitive:
    """What triangles come from. number: manifold3d's `original_id`. face_names: of its faces, which count from 0."""

    number: int
    shape: Shape
    face_names: tuple[str, ...]


# One primitive made anew keeps its number as long as a kept manifold has it: triangles are ordered by it.
_primitives: WeakValueDictionary[tuple[Shape, Resolution], Primitive] = WeakValueDictionary()


@dataclass(frozen=True, slots=True)
class Piece:
    """A manifold [mm] and the primitives that it was made from, in order of first use."""

    manifold: manifold3d.Manifold
    primitives: tuple[Primitive, ...]

    @staticmethod
    def joined(pieces: Sequence[Piece], operation: manifold3d.OpType) -> Piece:
        """All of them by one operation."""
        primitives = {primitive.number: primitive for piece in pieces for primitive in piece.primitives}
        whole = manifold3d.Manifold.batch_boolean([piece.manifold for piece in pieces], operation)
        return Piece(whole, tuple(primitives.values()))

    def moved(self, matrix: Vector) -> Piece:
        """In another place; matrix (4, 4) [mm]."""
        return Piece(self.now().manifold.transform(matrix[:3]), self.primitives)

    def now(self) -> Piece:
        """Evaluates at once what manifold3d would put off and rearrange."""
        self.manifold.num_tri()
        return self


def evaluate(shape: Shape, resolution: Resolution) -> Piece:
    """The manifold of an outermost shape.

    Its tools that are placed at an angle are cut in their own frame, where bounding boxes are far more selective
    (three times faster at 45 degrees). Only here: the way there and back rounds coordinates by 1e-14, which inner
    solids that share a plane with others would not survive.
    """
    if not isinstance(shape, Difference):
        return _inner(shape, resolution)
    straight = tuple(tool for tool in shape.tools if not _is_tilted(tool))
    body = _cut(_inner(shape.base, resolution), straight, resolution)
    frames: dict[tuple[tuple[float, ...], ...], list[Shape]] = {}
    for tool in shape.tools:
        if isinstance(tool, Moved) and _is_tilted(tool):
            frames.setdefault(tool.matrix, []).append(tool.shape)
    for matrix, tools in frames.items():
        forth = np.array(matrix)
        body = _cut(body.moved(np.linalg.inv(forth)).now(), tools, resolution).moved(forth)
    return body


def _inner(shape: Shape, resolution: Resolution) -> Piece:
    """The manifold of a shape, in the coordinates it is written in."""
    if isinstance(shape, Moved):
        # Evaluated before it is moved: bounding boxes of a pattern are tight, and apart, in its own axes.
        return _inner(shape.shape, resolution).moved(np.array(shape.matrix))
    if isinstance(shape, Union):
        first, *others = shape.shapes
        pieces = [_inner(first, resolution), *(_kept(other, resolution) for other in others)]
        return Piece.joined(pieces, manifold3d.OpType.Add)
    if isinstance(shape, Intersection):
        return Piece.joined([_inner(part, resolution) for part in shape.shapes], manifold3d.OpType.Intersect)
    if isinstance(shape, Difference):
        return _cut(_inner(shape.base, resolution), shape.tools, resolution)
    return _primitive(shape, resolution)


def _cut(body: Piece, tools: Sequence[Shape], resolution: Resolution) -> Piece:
    """A body without tools."""
    if not tools:
        return body
    return Piece.joined([body, _kept(union(*tools), resolution)], manifold3d.OpType.Subtract)


@lru_cache(maxsize=KEPT)
def _kept(shape: Shape, resolution: Resolution) -> Piece:
    return _inner(shape, resolution).now()


@lru_cache(maxsize=REPEATED)
def _primitive(shape: Shape, resolution: Resolution) -> Piece:
    mesh = tessellate(shape, resolution)
    primitive = _primitives.get((shape, resolution))
    if primitive is None:
        primitive = Primitive(manifold3d.Manifold.reserve_ids(1), shape, mesh.face_names)
        _primitives[shape, resolution] = primitive
    tool = manifold3d.Manifold(
        manifold3d.Mesh64(
            vert_properties=mesh.points,
            tri_verts=mesh.triangles,
            run_index=np.array([0, mesh.triangles.size], dtype=np.uint64),
            run_original_id=np.array([primitive.number], dtype=np.uint32),
            face_id=mesh.face,
        )
    )
    if tool.status() != manifold3d.Error.NoError or tool.volume() <= 0.0:
        reason = f"{tool.status().name}, volume {tool.volume():g} mm³"
        raise GeometryError(f"{type(shape).__name__} is not a solid: {reason}")
    return Piece(tool, (primitive,))


def _is_tilted(shape: Shape) -> bool:
    """Whether a shape is placed at an angle to the part's axes."""
    if not isinstance(shape, Moved):
        return False
    rotation = np.abs(np.array(shape.matrix)[:3, :3])
    return bool((np.minimum(rotation, 1.0 - rotation) > 1e-9).any())
