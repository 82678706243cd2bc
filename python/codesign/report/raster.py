"""Pictures of solids without a graphics card: orthographic, z-buffered, lit, with outlines as in technical drawings."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.floating[Any]]
Indices = NDArray[np.int64]

SUPERSAMPLING = 2  # per axis
LIGHT = np.array([-0.35, 0.75, 0.65])  # camera axes: from the left, above and behind the viewer
AMBIENT, DIFFUSE = 0.52, 0.5
CREASE = np.cos(np.radians(35.0))  # neighboring pixels whose normals differ more are an edge
OUTLINE = 0.45  # brightness of outlines
CLIFF = 12.0  # pixels: what lies farther behind its neighbor is behind an edge
ROWS = 300_000  # lines of triangles drawn at once


@dataclass(frozen=True, slots=True, eq=False)
class Body:
    """A triangle mesh: points (n, 3) [m], triangles (m, 3); colors (3,) or (n, 3), 0 … 1; unlit bodies glow."""

    points: Array
    triangles: Indices
    colors: Array
    lit: bool = True


@dataclass(frozen=True, slots=True)
class View:
    """An orthographic camera, world z up: where it stands as seen from `center` [m], and the picture's `height` [m]."""

    azimuth_deg: float
    elevation_deg: float
    center: tuple[float, float, float]
    height: float

    def axes(self) -> Array:
        """(3, 3) rows: right, up, towards the viewer, in world axes."""
        azimuth, elevation = np.radians([self.azimuth_deg, self.elevation_deg])
        towards = np.array(
            [np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)]
        )
        right = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
        return np.stack([right, np.cross(towards, right), towards])


def fitting_view(bodies: Sequence[Body], azimuth_deg: float, elevation_deg: float, aspect: float) -> View:
    """The view that shows all bodies with a small margin; aspect: width over height of the picture."""
    points = np.concatenate([body.points for body in bodies])
    axes = View(azimuth_deg, elevation_deg, (0.0, 0.0, 0.0), 1.0).axes()
    seen = points @ axes.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    x, y, z = ((low + high) / 2.0) @ axes
    width, height = high[:2] - low[:2]
    return View(azimuth_deg, elevation_deg, (float(x), float(y), float(z)), 1.06 * max(height, width / aspect))


def render(bodies: Sequence[Body], view: View, width: int, height: int) -> NDArray[np.uint8]:
    """Picture (height, width, 4) RGBA of closed bodies; transparent where there is nothing."""
    wide, tall = SUPERSAMPLING * width, SUPERSAMPLING * height
    points = np.concatenate([body.points for body in bodies])
    offsets = np.cumsum([0, *(len(body.points) for body in bodies)])
    triangles = np.concatenate([body.triangles + offset for body, offset in zip(bodies, offsets, strict=False)])
    owner = np.repeat(np.arange(len(bodies)), [len(body.triangles) for body in bodies])
    seen = (points - np.array(view.center)) @ view.axes().T * (tall / view.height)
    normals = np.cross(seen[triangles[:, 1]] - seen[triangles[:, 0]], seen[triangles[:, 2]] - seen[triangles[:, 0]])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    facing = normals[:, 2] > 1e-6
    triangles, owner, normals = triangles[facing], owner[facing], normals[facing]
    screen = np.stack([seen[:, 0] + wide / 2.0, tall / 2.0 - seen[:, 1], -seen[:, 2]], axis=1)
    triangle, depth = _visible(screen[triangles], wide, tall)
    drawn = np.flatnonzero(triangle >= 0)
    hit = triangle[drawn]
    weights = _barycentric(screen[triangles[hit]], drawn % wide + 0.5, drawn // wide + 0.5)
    colors = np.concatenate([np.broadcast_to(body.colors, (len(body.points), 3)) for body in bodies])
    lit = np.array([body.lit for body in bodies])[owner[hit]]
    light = AMBIENT + DIFFUSE * np.clip(normals @ (LIGHT / np.linalg.norm(LIGHT)), 0.0, None)
    shade = np.where(lit, light[hit], 1.0)
    edges = _outlines(triangle.reshape(tall, wide), depth.reshape(tall, wide), normals, owner).ravel()[drawn]
    shade[edges & lit] *= OUTLINE
    image = np.zeros((tall * wide, 4))
    image[drawn, :3] = np.clip(np.einsum("nc,ncd->nd", weights, colors[triangles[hit]]) * shade[:, None], 0.0, 1.0)
    image[drawn, 3] = 1.0
    small = image.reshape(height, SUPERSAMPLING, width, SUPERSAMPLING, 4).mean(axis=(1, 3))
    small[..., :3] /= np.maximum(small[..., 3:], 1e-9)
    return np.asarray(np.rint(small * 255.0), dtype=np.uint8)


def _visible(corners: Array, wide: int, tall: int) -> tuple[Indices, Array]:
    """Of each pixel (tall · wide): the nearest of the triangles (t, 3, 3) or -1, and its depth."""
    triangle = np.full(tall * wide, -1, dtype=np.int64)
    nearest = np.full(tall * wide, np.inf)
    for index, pixel, depth in _fragments(corners, wide, tall):
        np.minimum.at(nearest, pixel, depth)
        front = depth == nearest[pixel]
        triangle[pixel[front]] = index[front]
    return triangle, nearest


def _fragments(corners: Array, wide: int, tall: int) -> Iterator[tuple[Indices, Indices, Array]]:
    """Pixels whose centers the triangles (t, 3, 3) cover: (triangle, pixel, depth), in batches."""
    slope = _depth_slopes(corners)
    top = np.clip(np.ceil(corners[..., 1].min(axis=1) - 0.5), 0, tall).astype(np.int64)
    bottom = np.clip(np.ceil(corners[..., 1].max(axis=1) - 0.5), 0, tall).astype(np.int64)
    rows = np.where(np.isfinite(slope).all(axis=1), bottom - top, 0)
    ends = np.cumsum(rows)
    starts = np.searchsorted(ends, np.arange(0, ends[-1] if len(ends) else 0, ROWS))
    for first, last in zip(starts, [*starts[1:], len(rows)], strict=True):
        members = np.arange(first, last)
        index, row = _expanded(members, top[members], rows[members])
        left, right = _span(corners[index], row + 0.5)
        begin = np.clip(np.ceil(left - 0.5), 0, wide).astype(np.int64)
        end = np.clip(np.ceil(right - 0.5), 0, wide).astype(np.int64)
        line, x = _expanded(np.arange(len(index)), begin, np.maximum(end - begin, 0))
        triangle, y = index[line], row[line]
        corner, gradient = corners[triangle, 0], slope[triangle]
        depth = corner[:, 2] + gradient[:, 0] * (x + 0.5 - corner[:, 0]) + gradient[:, 1] * (y + 0.5 - corner[:, 1])
        yield triangle, y * wide + x, depth


def _expanded(items: Indices, first: Indices, counts: Indices) -> tuple[Indices, Indices]:
    """Each item `counts` times, with the numbers from `first` on."""
    repeated = np.repeat(items, counts)
    ends = np.cumsum(counts)
    return repeated, np.arange(len(repeated)) - np.repeat(ends - counts - first, counts)


def _span(corners: Array, y: Array) -> tuple[Array, Array]:
    """Where the lines at heights y (n,) enter and leave the triangles (n, 3, 3)."""
    left, right = np.full(len(y), np.inf), np.full(len(y), -np.inf)
    for a, b in ((0, 1), (1, 2), (2, 0)):
        (xa, ya), (xb, yb) = corners[:, a, :2].T, corners[:, b, :2].T
        crossing = (ya <= y) != (yb <= y)
        x = xa + (y - ya) * (xb - xa) / np.where(crossing, yb - ya, 1.0)
        left = np.where(crossing, np.minimum(left, x), left)
        right = np.where(crossing, np.maximum(right, x), right)
    return np.where(np.isfinite(left), left, 0.0), np.where(np.isfinite(right), right, 0.0)


def _depth_slopes(corners: Array) -> Array:
    """Change (t, 2) of depth along x and y over the triangles; not finite for those seen edge-on."""
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
        x = (u[:, 2] * v[:, 1] - v[:, 2] * u[:, 1]) / area
        y = (v[:, 2] * u[:, 0] - u[:, 2] * v[:, 0]) / area
    return np.stack([x, y], axis=1)


def _barycentric(corners: Array, x: Array, y: Array) -> Array:
    """Weights (n, 3) of the corners (n, 3, 3) at the points x, y (n,)."""
    a, b, c = corners[:, 0, :2], corners[:, 1, :2], corners[:, 2, :2]
    u, v, p = b - a, c - a, np.stack([x, y], axis=1) - a
    area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    area = np.where(area == 0.0, 1.0, area)
    second = (p[:, 0] * v[:, 1] - p[:, 1] * v[:, 0]) / area
    third = (u[:, 0] * p[:, 1] - u[:, 1] * p[:, 0]) / area
    return np.clip(np.stack([1.0 - second - third, second, third], axis=1), 0.0, 1.0)


def _outlines(triangle: Indices, depth: Array, normals: Array, owner: Indices) -> NDArray[np.bool_]:
    """Pixels at silhouettes, between bodies and at creases."""
    edges = np.zeros(triangle.shape, dtype=bool)
    for step in (1, triangle.shape[1]):  # to the right, downwards
        flat, far, marks = triangle.ravel(), depth.ravel(), edges.ravel()
        here = np.flatnonzero(flat[:-step] != flat[step:])
        there = here + step
        a, b = flat[here], flat[there]
        both = (a >= 0) & (b >= 0)
        crease = both & (np.einsum("nd,nd->n", normals[a], normals[b]) < CREASE)
        with np.errstate(invalid="ignore"):
            crease |= both & ((owner[a] != owner[b]) | (np.abs(far[here] - far[there]) > CLIFF))
        marks[here[crease | (a >= 0) & ~both]] = True
        marks[there[(b >= 0) & ~both]] = True
    return edges
