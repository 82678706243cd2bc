"""Makes a triangle soup a closed, oriented surface where only small faults of the file prevent it.

Arrays throughout: points (n, 3) in meters, triangles (m, 3) indices. Nothing is invented: holes wider than the
tolerance stay open.
"""

from __future__ import annotations

from collections import deque
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
Triangles = NDArray[np.int64]
_ROUNDS = 10  # of splitting and merging, each may uncover the next place


def edges_of(triangles: Triangles) -> Triangles:
    """(3 m, 2) directed edges: first those from corner 0 to 1 of all triangles, then 1 to 2, then 2 to 0."""
    return np.concatenate([triangles[:, [k, (k + 1) % 3]] for k in range(3)])


def uses_of(edges: Triangles) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """(e,) number of the undirected edge of each edge (e, 2); (undirected edges,) how many triangles use each."""
    low, high = edges.min(axis=1), edges.max(axis=1)
    _, number, uses = np.unique(low * (high.max(initial=0) + 1) + high, return_inverse=True, return_counts=True)
    return number.ravel(), uses


def open_edges(triangles: Triangles) -> tuple[Triangles, NDArray[np.int64]]:
    """(k, 2) edges that one triangle uses alone, and that triangle (k,)."""
    edges = edges_of(triangles)
    number, uses = uses_of(edges)
    lonely = np.flatnonzero(uses[number] == 1)
    return edges[lonely], lonely % len(triangles)


def is_closed(triangles: Triangles) -> bool:
    """Whether exactly two triangles use each edge, in opposite directions."""
    edges = edges_of(triangles)
    return bool((uses_of(edges)[1] == 2).all() and len(np.unique(edges, axis=0)) == len(edges))


def count_pieces(triangles: Triangles) -> int:
    """Pieces connected by common points."""
    used, number = np.unique(triangles, return_inverse=True)
    corners = number.reshape(triangles.shape)
    ends = np.concatenate([corners[:, :2], corners[:, 1:]])
    return _groups(ends[:, 0], ends[:, 1], len(used))[0]


def without_flat(points: Points, triangles: Triangles, height: float) -> Triangles:
    """The triangles that use three points and are higher than `height` [m]."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    longest = np.max([np.linalg.norm(side, axis=1) for side in (b - a, c - b, a - c)], axis=0)
    kept: Triangles = triangles[np.linalg.norm(np.cross(b - a, c - a), axis=1) > height * longest]
    return kept


def without_doubled(triangles: Triangles) -> Triangles:
    """Each triangle once. Two of opposite sides are a wall without thickness, and go, unless they close the surface."""
    _, first, group = np.unique(np.sort(triangles, axis=1), axis=0, return_index=True, return_inverse=True)
    if len(first) == len(triangles):
        return triangles
    a, b, c = triangles.T
    side = np.where((a < b) ^ (b < c) ^ (a < c), 1, -1)
    kept, both_sides = triangles[first], np.bincount(group.ravel(), weights=side) == 0
    while True:  # from the rim of a wall inward
        number, uses = uses_of(edges_of(kept))
        loose = (uses[number] % 2 == 1).reshape(3, -1).any(axis=0) & both_sides
        if not loose.any():
            break
        kept, both_sides = kept[~loose], both_sides[~loose]
    return kept


def split_t_junctions(points: Points, triangles: Triangles, tolerance: float) -> tuple[Triangles, int]:
    """Splits triangles where the corner of another lies on an open edge, within `tolerance` [m].

    Returns: the triangles, and how many corners were found on edges.
    """
    from scipy.spatial import cKDTree  # a quarter of a second to import, needed for damaged surfaces only

    junctions = 0
    for _ in range(_ROUNDS):
        edges, owners = open_edges(triangles)
        if len(edges) == 0:
            break
        corners = np.unique(edges)
        start, end = points[edges[:, 0]], points[edges[:, 1]]
        reach = 0.5 * np.linalg.norm(end - start, axis=1) + tolerance
        near = cKDTree(points[corners]).query_ball_point(0.5 * (start + end), reach)
        busy: set[int] = set()  # one edge of a triangle in a round
        removed, added = [], []
        for (a, b), owner, found in zip(edges.tolist(), owners.tolist(), near, strict=True):
            between = _between(points, a, b, corners[found], tolerance)
            if between and owner not in busy:
                busy.add(owner)
                (tip,) = set(triangles[owner].tolist()) - {a, b}
                chain = [a, *between, b]
                added += [(p, q, tip) for p, q in pairwise(chain) if tip not in (p, q)]
                removed.append(owner)
                junctions += len(between)
        if not removed:
            break
        triangles = np.concatenate([np.delete(triangles, removed, axis=0), np.array(added, dtype=np.int64)])
    return triangles, junctions


def _between(points: Points, a: int, b: int, candidates: NDArray[np.int64], tolerance: float) -> list[int]:
    """The candidates on the edge from a to b, from a on."""
    candidates = candidates[(candidates != a) & (candidates != b)]
    along = points[b] - points[a]
    length = float(np.linalg.norm(along))
    if length <= tolerance or len(candidates) == 0:
        return []
    offset = points[candidates] - points[a]
    place = offset @ along / length
    aside = np.linalg.norm(offset - np.outer(place / length, along), axis=1)
    on = (place > tolerance) & (place < length - tolerance) & (aside <= tolerance)
    order = np.argsort(place[on], kind="stable")
    return [int(p) for p in candidates[on][order]]


def merge_open_points(points: Points, triangles: Triangles, tolerance: float) -> tuple[Triangles, int]:
    """Merges points of open edges that lie within `tolerance` [m] of each other. Returns: triangles, points merged."""
    from scipy.spatial import cKDTree

    corners = np.unique(open_edges(triangles)[0])
    if len(corners) == 0:
        return triangles, 0
    pairs = cKDTree(points[corners]).query_pairs(tolerance, output_type="ndarray")
    if len(pairs) == 0:
        return triangles, 0
    groups, group = _groups(pairs[:, 0], pairs[:, 1], len(corners))
    kept = np.full(groups, -1)
    kept[group[::-1]] = corners[::-1]  # the first of each group
    to = np.arange(len(points))
    to[corners] = kept[group]
    moved = to[triangles]
    distinct = (moved != np.roll(moved, 1, axis=1)).all(axis=1)
    return moved[distinct], len(corners) - groups


def oriented(triangles: Triangles) -> tuple[Triangles, int]:
    """Neighbors turned the same way, each piece like its first triangle. Returns: triangles, how many were turned."""
    directed = edges_of(triangles)
    if len(np.unique(directed, axis=0)) == len(directed):
        return triangles, 0
    first, second, same = _neighbors(triangles)
    beside: list[list[tuple[int, bool]]] = [[] for _ in triangles]
    for s, t, turned in zip(first.tolist(), second.tolist(), same.tolist(), strict=True):
        beside[s].append((t, turned))
        beside[t].append((s, turned))
    turn = np.full(len(triangles), -1)
    for seed in range(len(triangles)):
        if turn[seed] >= 0:
            continue
        turn[seed] = 0
        queue = deque([seed])
        while queue:
            s = queue.popleft()
            for t, turned in beside[s]:
                if turn[t] < 0:
                    turn[t] = turn[s] ^ turned
                    queue.append(t)
    flipped = turn == 1
    result = triangles.copy()
    result[flipped] = triangles[flipped][:, ::-1]
    return result, int(flipped.sum())


def shells_of(triangles: Triangles) -> NDArray[np.int64]:
    """(m,) number of the shell of each triangle (m, 3): what is connected through edges of exactly two triangles."""
    first, second, _ = _neighbors(triangles)
    return _groups(first, second, len(triangles))[1]


def _groups(first: NDArray[np.int64], second: NDArray[np.int64], count: int) -> tuple[int, NDArray[np.int64]]:
    """How many groups `count` things are, joined in pairs, and the group of each."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    graph = coo_array((np.ones(len(first)), (first, second)), shape=(count, count))
    groups, group = connected_components(graph, directed=False)
    return int(groups), group.astype(np.int64)


def _neighbors(triangles: Triangles) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.bool_]]:
    """Pairs of triangles at edges that exactly two use, and whether both run along it in the same direction."""
    edges = edges_of(triangles)
    number, uses = uses_of(edges)
    order = np.argsort(number, kind="stable")
    order = order[uses[number[order]] == 2].reshape(-1, 2)
    same = edges[order[:, 0], 0] == edges[order[:, 1], 0]
    return order[:, 0] % len(triangles), order[:, 1] % len(triangles), same
