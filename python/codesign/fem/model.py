"""Where a finite-element model is held and loaded: selections and supports; loads.py has the loads.

Plain frozen values; the mesh they refer to is named only when a model is solved.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from codesign._core import fem as _core
from codesign._core.fem import Material as Material
from codesign._core.fem import TetMesh as TetMesh
from codesign.errors import ModelError

MAX_BEND_DEG = 30.0  # between two triangles of a smooth face

Predicate = Callable[[NDArray[np.float64]], NDArray[np.bool_]]


class Selection(Protocol):
    """A place on a mesh: a named face, triangles, nodes, or a rule that finds them."""

    def on(self, mesh: TetMesh) -> _core.Selection:
        """The faces, triangles and nodes of this mesh."""


Where = str | Selection


@dataclass(frozen=True)
class _Nodes:
    nodes: tuple[int, ...]

    def on(self, mesh: TetMesh) -> _core.Selection:  # noqa: ARG002 (the same for every mesh)
        return _core.Selection(nodes=self.nodes)


@dataclass(frozen=True)
class _Triangles:
    corners: NDArray[np.int64]

    def on(self, mesh: TetMesh) -> _core.Selection:
        known = {tuple(sorted(row)): i for i, row in enumerate(mesh.boundary[:, :3].tolist())}
        try:
            return _core.Selection(triangles=[known[tuple(sorted(row))] for row in self.corners.tolist()])
        except KeyError as error:
            raise ValueError(f"nodes {error.args[0]} are not the corners of a boundary triangle") from None


@dataclass(frozen=True)
class _Where:
    predicate: Predicate

    def on(self, mesh: TetMesh) -> _core.Selection:
        centroids = mesh.nodes[mesh.boundary[:, :3]].mean(axis=1)
        return _core.Selection(triangles=np.flatnonzero(self.predicate(centroids)).tolist())


@dataclass(frozen=True)
class _Rule:
    find: Callable[[TetMesh], list[int]]

    def on(self, mesh: TetMesh) -> _core.Selection:
        return _core.Selection(triangles=self.find(mesh))


@dataclass(frozen=True)
class _Names:
    faces: tuple[str, ...]

    def on(self, mesh: TetMesh) -> _core.Selection:  # noqa: ARG002 (the same for every mesh)
        return _core.Selection(faces=list(self.faces))


@dataclass(frozen=True)
class _Union:
    parts: tuple[Where, ...]

    def on(self, mesh: TetMesh) -> _core.Selection:
        parts = [resolve(mesh, part) for part in self.parts]
        return _core.Selection(
            faces=[f for p in parts for f in p.faces],
            triangles=[t for p in parts for t in p.triangles],
            nodes=[n for p in parts for n in p.nodes],
        )


def resolve(mesh: TetMesh | None, where: Where) -> _core.Selection:
    """The faces, triangles and nodes of a mesh that a name or a selection stands for.

    Raises: ModelError: without a mesh (a part that is yet to be meshed) only names of faces mean anything.
    """
    if isinstance(where, str):
        return _core.Selection(faces=[where])
    if isinstance(where, _Names):
        return _core.Selection(faces=list(where.faces))
    if mesh is None:
        raise ModelError("supports and loads of a part name its faces: other selections need the mesh")
    return where.on(mesh)


def select_nodes(nodes: ArrayLike) -> Selection:
    """Nodes (k,) by index."""
    return _Nodes(tuple(int(n) for n in np.asarray(nodes).ravel()))


def select_faces(triangles: ArrayLike | Predicate) -> Selection:
    """Boundary triangles: (k, 3) corner nodes in any order, or a predicate of centroids (k, 3) m -> (k,) bool."""
    if callable(triangles):
        return _Where(triangles)
    corners = np.asarray(triangles, dtype=np.int64)
    if corners.ndim != 2 or corners.shape[1] < 3:
        raise ValueError(f"triangles must have shape (k, 3), got {corners.shape}")
    return _Triangles(corners[:, :3])


def faces_near(point: ArrayLike, max_bend_deg: float = MAX_BEND_DEG) -> Selection:
    """The smooth face nearest to a point [m].

    It extends over the same named face until the surface leaves the plane, cylinder, cone or sphere of the nearest
    triangle, or bends by more than max_bend_deg between two triangles.
    """
    return _Rule(lambda mesh: _core.triangles_near(mesh, np.asarray(point, dtype=float), np.deg2rad(max_bend_deg)))


def faces_in_box(lower: ArrayLike, upper: ArrayLike) -> Selection:
    """Boundary triangles that lie in the box with all their nodes [m]."""
    lo, hi = np.asarray(lower, dtype=float), np.asarray(upper, dtype=float)
    return _Rule(lambda mesh: _core.triangles_in_box(mesh, lo, hi))


def faces_with_normal(normal: ArrayLike, angle_deg: float = 1.0) -> Selection:
    """Boundary triangles whose outward normal is within angle_deg of a direction (3,) of any length."""
    direction = np.asarray(normal, dtype=float)
    return _Rule(lambda mesh: _core.triangles_with_normal(mesh, direction, np.deg2rad(angle_deg)))


def select_names(*faces: str) -> Selection:
    """Faces by name; the only selection of several faces that means something before there is a mesh."""
    return _Names(faces)


def select_union(*parts: Where) -> Selection:
    """Everything that any of the parts selects."""
    return _Union(parts)


@dataclass(frozen=True)
class Support:
    """Fixes displacement components of a selection.

    Args:
        where: a face's name or a selection.
        axes: the components held, e.g. "xyz" or "z".
        displacement: prescribed displacement [m]: (3,), or (k, 3) for each node of `select_nodes`; zero if absent.
        symmetry: True for the cut plane of a half model, which is no clamp: the peak stress counts up to it.
    """

    where: Where
    axes: str = "xyz"
    displacement: ArrayLike | None = None
    symmetry: bool = False

    def native(self, mesh: TetMesh | None) -> _core.Support:
        """The native value on a mesh."""
        if not self.axes or set(self.axes) - set("xyz"):
            raise ValueError(f"axes must be letters of 'xyz', got {self.axes!r}")
        rows = np.zeros((0, 3)) if self.displacement is None else np.atleast_2d(np.asarray(self.displacement, float))
        return _core.Support(resolve(mesh, self.where), [a in self.axes for a in "xyz"], rows, self.symmetry)


def native_supports(mesh: TetMesh | None, supports: Sequence[Support]) -> list[_core.Support]:
    """Supports as the native solver takes them."""
    return [support.native(mesh) for support in supports]


def vector(value: ArrayLike, name: str) -> NDArray[np.float64]:
    """(3,) array. Raises: ValueError: another shape."""
    array = np.asarray(value, dtype=float)
    if array.shape != (3,):
        raise ValueError(f"{name} must have shape (3,), got {array.shape}")
    return array
