"""The region that a new design may still win, cut into disjoint boxes; one to three objectives, all minimized."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

MOST_OBJECTIVES = 3


@dataclass(frozen=True, slots=True)
class Boxes:
    """Disjoint boxes that together hold all points below a reference point that no design of a front dominates.

    lower, upper: (boxes, objectives) corners; lower ones may be -inf.
    """

    lower: Array
    upper: Array

    @classmethod
    def beside(cls, front: Array, reference: Array) -> Boxes:
        """Those for designs (n, objectives) and a reference point (objectives,); designs beyond it count for nothing.

        In three objectives a plane sweeps along the last one: every design ends some strips of the plane's free region
        and begins at most two, so there are about twice as many boxes as designs.
        Raises: ValueError for more than three objectives.
        """
        count = len(reference)
        if not 1 <= count <= MOST_OBJECTIVES:
            raise ValueError(f"{count} objectives: boxes are made for 1 to {MOST_OBJECTIVES}")
        inside = front[(front < reference).all(axis=1)]
        if count == 1:
            return cls(np.full((1, 1), -np.inf), np.array([[min([reference[0], *inside[:, 0]])]]))
        sweep = _Sweep(float(reference[0]), float(reference[1]))
        for point in inside[np.argsort(inside[:, -1], kind="stable")]:
            sweep.add(float(point[0]), float(point[1]), float(point[2]) if count == MOST_OBJECTIVES else -np.inf)
        sweep.end(float(reference[2]) if count == MOST_OBJECTIVES else np.inf)
        corners = np.array(sweep.boxes)
        return cls(corners[:, 0, :count], corners[:, 1, :count])


@dataclass(slots=True)
class _Strip:
    """A part of the free region of the plane: left <= x < right, y < top; free since the height `since`."""

    left: float
    right: float
    top: float
    since: float


class _Sweep:
    """The free region of a plane that rises, as strips side by side whose tops fall to the right."""

    def __init__(self, right: float, top: float) -> None:
        self._strips = [_Strip(-np.inf, right, top, -np.inf)]
        self.boxes: list[tuple[tuple[float, float, float], tuple[float, float, float]]] = []

    def add(self, x: float, y: float, height: float) -> None:
        """A design at x, y; heights never fall."""
        changed = [strip for strip in self._strips if strip.right > x and strip.top > y]
        if not changed:
            return
        at = self._strips.index(changed[0])
        self._close(changed, height)
        left = changed[0].left
        beside = [_Strip(left, x, changed[0].top, height)] if left < x else []
        below = _Strip(max(left, x), changed[-1].right, y, height)
        self._strips[at : at + len(changed)] = [*beside, below]

    def end(self, height: float) -> None:
        """The last height."""
        self._close(self._strips, height)

    def _close(self, strips: list[_Strip], height: float) -> None:
        for strip in strips:
            if strip.since < height:
                lower = (strip.left, -np.inf, strip.since)
                self.boxes.append((lower, (strip.right, strip.top, height)))
