"""Structured tetrahedral meshes for tests: a box split into tetrahedra, mapped to any shape."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from codesign import fem

# Kuhn's split of a cube into six tetrahedra; corner i has bits x y z.
KUHN = np.array([[0, 1, 3, 7], [0, 1, 5, 7], [0, 2, 3, 7], [0, 2, 6, 7], [0, 4, 5, 7], [0, 4, 6, 7]])


def box_tets(nx: int, ny: int, nz: int) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Ten-node tetrahedra of the unit cube: nodes (n, 3) on the doubled grid, tets (m, 10)."""
    shape = (2 * nx + 1, 2 * ny + 1, 2 * nz + 1)
    grid = np.stack(np.meshgrid(*(np.arange(s) for s in shape), indexing="ij"), axis=-1).reshape(-1, 3)
    cells = np.stack(np.meshgrid(np.arange(nx), np.arange(ny), np.arange(nz), indexing="ij"), axis=-1).reshape(-1, 3)
    offsets = np.array([[(c >> a) & 1 for a in range(3)] for c in range(8)])
    corners = 2 * (cells[:, None, None, :] + offsets[KUHN][None])  # (cells, 6, 4, 3)
    corners = corners.reshape(-1, 4, 3)
    edges = [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]
    middles = np.stack([(corners[:, a] + corners[:, b]) // 2 for a, b in edges], axis=1)
    all10 = np.concatenate([corners, middles], axis=1)
    index = np.ravel_multi_index(np.moveaxis(all10, -1, 0), shape)
    used, tets = np.unique(index, return_inverse=True)
    return grid[used] / (np.array(shape) - 1), tets.reshape(-1, 10)


def box_mesh(
    divisions: tuple[int, int, int], map_: Callable[[NDArray[np.float64]], NDArray[np.float64]] | None = None
) -> fem.TetMesh:
    """The unit cube, its nodes (mid-edge nodes too) moved by map_: (n, 3) -> (n, 3)."""
    nodes, tets = box_tets(*divisions)
    return fem.TetMesh(np.ascontiguousarray(nodes if map_ is None else map_(nodes)), tets.astype(np.int32))
