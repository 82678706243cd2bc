"""Solids laid out side by side, as on the plate of a machine."""

from __future__ import annotations

import math
from collections.abc import Sequence

GAP = 5.0  # mm between bounding boxes
Size = tuple[float, float]


def lay_out(sizes: Sequence[Size], gap: float = GAP) -> list[Size]:
    """Lower corners (x, y) of rectangles (width, depth) in rows from the origin, `gap` apart; about as wide as deep.

    The deepest come first, so that little of a row is left free; the result keeps the order of `sizes`.
    """
    if not sizes:
        return []
    area = sum((width + gap) * (depth + gap) for width, depth in sizes)
    limit = max(math.sqrt(area), *(width for width, _ in sizes))
    corners: list[Size] = [(0.0, 0.0)] * len(sizes)
    x = y = row = 0.0
    for k in sorted(range(len(sizes)), key=lambda k: (-sizes[k][1], -sizes[k][0], k)):
        width, depth = sizes[k]
        if x > 0.0 and x + width > limit:
            x, y, row = 0.0, y + row + gap, 0.0
        corners[k] = (x, y)
        x += width + gap
        row = max(row, depth)
    return corners
