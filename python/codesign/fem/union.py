"""Shells of a closed surface as bodies: which way they face, which lie in which, and their union."""

from __future__ import annotations

import manifold3d
import numpy as np
from numpy.typing import NDArray

from codesign.errors import MeshError
from codesign.fem.stitching import Points, Triangles, shells_of


def shell_volumes(points: Points, triangles: Triangles) -> NDArray[np.float64]:
    """Volume of each shell [m³], in the order of their numbers; negative for cavities."""
    origin = points[triangles].reshape(-1, 3).mean(axis=0)
    a, b, c = (points[triangles[:, k]] - origin for k in range(3))
    six = np.einsum("ij,ij->i", a, np.cross(b, c))
    volumes: NDArray[np.float64] = np.bincount(shells_of(triangles), weights=six) / 6.0
    return volumes


def faced_outward(points: Points, triangles: Triangles) -> tuple[Triangles, int]:
    """Shells that are inside-out, turned; those inside others are cavities and stay.

    Returns: the triangles (m, 3), and how many shells were turned.
    """
    turned = 0
    shell = shells_of(triangles)
    volumes = shell_volumes(points, triangles)
    if volumes.sum() < 0.0:
        triangles, volumes, turned = triangles[:, ::-1], -volumes, len(volumes)
    result = triangles.copy()
    for s in np.flatnonzero(volumes < 0.0).tolist():
        if len(volumes) > 1 and _owner(points, triangles, shell, volumes, s) is None:
            result[shell == s] = triangles[shell == s][:, ::-1]
            turned += 1
    return result, turned


def united(points: Points, triangles: Triangles) -> tuple[Points, Triangles]:
    """The union of all bodies, each with its cavities: points (n, 3) [m] and triangles (m, 3).

    Raises: MeshError: a body is not closed.
    """
    shell = shells_of(triangles)
    volumes = shell_volumes(points, triangles)
    owner = np.arange(len(volumes))
    for s in np.flatnonzero(volumes <= 0.0).tolist():
        found = _owner(points, triangles, shell, volumes, s)
        owner[s] = -1 if found is None else found
    bodies = [solid(points, triangles[owner[shell] == s]) for s in np.flatnonzero(volumes > 0.0)]
    return arrays_of(manifold3d.Manifold.batch_boolean(bodies, manifold3d.OpType.Add))


def simplified(points: Points, triangles: Triangles, tolerance: float) -> tuple[Points, Triangles]:
    """Fewer triangles, no farther than `tolerance` [m] from the surface. Raises: MeshError: not closed."""
    return arrays_of(solid(points, triangles).simplify(tolerance))


def solid(points: Points, triangles: Triangles) -> manifold3d.Manifold:
    """The body of manifold3d bounded by triangles (m, 3) of points (n, 3). Raises: MeshError: they bound none."""
    used, number = np.unique(triangles, return_inverse=True)
    mesh = manifold3d.Mesh64(
        vert_properties=np.ascontiguousarray(points[used]),
        tri_verts=np.ascontiguousarray(number.reshape(triangles.shape), dtype=np.uint64),
    )
    body = manifold3d.Manifold(mesh)
    if body.status() != manifold3d.Error.NoError:
        raise MeshError(f"the triangles bound no solid ({body.status().name})")
    return body


def arrays_of(body: manifold3d.Manifold) -> tuple[Points, Triangles]:
    """Points (n, 3) and triangles (m, 3) of a body of manifold3d."""
    mesh = body.to_mesh64()
    return np.array(mesh.vert_properties[:, :3], dtype=float), np.array(mesh.tri_verts, dtype=np.int64)


def _owner(
    points: Points, triangles: Triangles, shell: NDArray[np.int64], volumes: NDArray[np.float64], inner: int
) -> int | None:
    """The smallest body that holds a shell; None if it lies in none."""
    place = points[triangles[shell == inner][0]].mean(axis=0)
    bodies = np.flatnonzero(volumes > 0.0)
    for s in bodies[np.argsort(volumes[bodies], kind="stable")]:
        if _winds_around(points[triangles[shell == s]], place):
            return int(s)
    return None


def _winds_around(corners: NDArray[np.float64], place: NDArray[np.float64]) -> bool:
    """Whether closed triangles (m, 3, 3) hold a point: the solid angle they fill, seen from it."""
    lower, upper = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    if ((place < lower) | (place > upper)).any():
        return False
    a, b, c = (corners[:, k] - place for k in range(3))
    la, lb, lc = (np.linalg.norm(v, axis=1) for v in (a, b, c))
    triple = np.einsum("ij,ij->i", a, np.cross(b, c))
    dots = la * lb * lc + (a * b).sum(axis=1) * lc + (b * c).sum(axis=1) * la + (c * a).sum(axis=1) * lb
    return bool(abs(2.0 * np.arctan2(triple, dots).sum()) > 2.0 * np.pi)
