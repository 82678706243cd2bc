"""Choices on a front of designs whose objectives are all minimized: compromise point, spread, growth of the front."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from codesign.problem.pareto import Hypervolume

Matrix = NDArray[np.float64]
Mask = NDArray[np.bool_]


def dominates(a: Matrix, b: Matrix) -> bool:
    """Whether `a` (m,) is nowhere worse than `b` (m,) and somewhere better."""
    return bool((a <= b).all() and (a < b).any())


def normalized(values: Matrix) -> Matrix:
    """`values` (n, m) with each column mapped to 0 (its best) … 1 (its worst); a constant column becomes 0."""
    low, high = values.min(axis=0), values.max(axis=0)
    span = np.where(high > low, high - low, 1.0)
    return np.asarray((values - low) / span)


def knee_distances(front: Matrix, baseline: Matrix | None = None) -> Matrix:
    """Distances (n,) of the rows of the front (n, m) from the best value of every objective at once; the least: knee.

    Distances are Euclidean after each objective is scaled to its range on the front. Where some rows are nowhere worse
    than `baseline` (m,), the others get infinity: a recommended design should not trade away what the robot has.
    """
    distance = np.linalg.norm(normalized(front), axis=1)
    if baseline is not None:
        better = (front <= baseline).all(axis=1)
        if better.any():
            distance = np.where(better, distance, np.inf)
    return np.asarray(distance)


def spread(front: Matrix, count: int) -> list[int]:
    """Up to `count` rows of the front (n, m), far from each other: the extremes first, then farthest-point sampling."""
    scaled = normalized(front)
    chosen = list(dict.fromkeys(int(i) for i in np.argmin(scaled, axis=0)))[:count]
    while len(chosen) < min(count, len(front)):
        distance = np.linalg.norm(scaled[:, None] - scaled[chosen][None], axis=2).min(axis=1)
        farthest = int(np.argmax(distance))
        if distance[farthest] == 0.0:
            break
        chosen.append(farthest)
    return chosen


def late_growth(values: Matrix, usable: Mask, front: Sequence[int], share: float = 0.25) -> tuple[float, int]:
    """What the last `share` of a search added to its front: part of the hypervolume, number of the front's rows.

    values (n, m): objectives in the order of evaluation; front: its usable rows that no other beats. The hypervolume is
    taken in the box that the front spans, so that outliers do not hide its growth.
    """
    if not front:
        return 0.0, 0
    early = np.arange(len(values)) < (1.0 - share) * len(values)
    box = Hypervolume(values[front])
    growth = 1.0 - box.of(values[early & usable]) / box.of(values[front], front=True)
    return growth, int((~early[front]).sum())


def hypervolume_history(values: Matrix, usable: Mask) -> Matrix:
    """Hypervolume (n,) of the usable among the first 1 … n rows of `values` (n, m), in the box that all usable span."""
    history = np.zeros(len(values))
    if not usable.any():
        return history
    box = Hypervolume(values[usable])
    front = np.empty((0, values.shape[1]))
    volume = 0.0
    for i, row in enumerate(values):
        if usable[i] and not (front <= row).all(axis=1).any():
            front = np.vstack([front[~(front >= row).all(axis=1)], row])
            volume = box.of(front, front=True)
        history[i] = volume
    return history
