"""Numbers beside circles of a drawing, where nothing else stands."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from codesign.geometry.profile import Vector
from codesign.parts.sheet import Sheet, Word

NEAREST, FARTHEST, STEP = 2.0, 40.0, 1.5  # mm from a circle to the end of its line
TURNS = np.radians([0, 30, -30, 60, -60, 90, -90, 120, -120, 150, -150, 180])  # from the way out
GAP = 0.4  # mm around a word


def label_circles(sheet: Sheet, circles: Mapping[str, tuple[Vector, float]], height: float) -> None:
    """Writes the name of each circle (center (2,), radius) beside it, with a line to it.

    It stands on the way out of the middle of all, or turned from it, as near as there is room: no other word, no circle
    is covered, and the line crosses no other circle. Without any room it stands on the way out, over what is there.
    """
    if not circles:
        return
    centers = np.array([center for center, _ in circles.values()])
    radii = np.array([radius for _, radius in circles.values()])
    taken = [word.box for word in sheet.words if word.text]
    inside = np.linalg.norm(centers[:, None] - centers, axis=2) < radii[:, None]
    empty = inside.sum(axis=1) == 1  # what lies in a large circle may have its number there
    taken += [(centers[k] - radii[k], centers[k] + radii[k]) for k in np.flatnonzero(empty)]
    middle = centers.mean(axis=0)
    names = list(circles)
    for k in sorted(range(len(names)), key=lambda k: (radii[k], *(-np.abs(centers[k] - middle)))):
        out = centers[k] - middle
        out = out / np.linalg.norm(out) if np.linalg.norm(out) > 1.0 else np.array([0.7, 0.7])
        others = np.arange(len(names)) != k
        first = last = None
        for edge, end in _lines(centers[k], radii[k], out):
            word = _word(names[k], end, end - centers[k], height)
            first = first or (edge, end, word)
            low, high = word.box
            lines = ((edge, end), (low, high)) if others.any() else ()
            if _free(word, taken) and all(_apart(*line, centers[others], radii[others]) for line in lines):
                last = (edge, end, word)
                break
        chosen = last or first
        assert chosen is not None  # there are lines in every direction
        edge, end, word = chosen
        sheet.line("dimension", tuple(edge.tolist()), tuple(end.tolist()))
        sheet.words.append(word)
        taken.append(word.box)


def _lines(center: Vector, radius: float, out: Vector) -> Iterator[tuple[Vector, Vector]]:
    """Lines from a circle to where a word may stand, the best first: where each begins and ends."""
    for distance in np.arange(NEAREST, FARTHEST, STEP):
        for turn in TURNS:
            way = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]) @ out
            way = way / np.linalg.norm(way)
            yield center + radius * way, center + (radius + distance) * way


def _word(text: str, end: Vector, way: Vector, height: float) -> Word:
    rightwards = way[0] >= 0.0
    x, y = (end + np.array([0.5 if rightwards else -0.5, -0.5 * height])).tolist()
    return Word(text, x, y, height, "left" if rightwards else "right")


def _free(word: Word, taken: list[tuple[Vector, Vector]]) -> bool:
    low, high = word.box
    lows, highs = (np.array(corners) for corners in zip(*taken, strict=True))
    return not bool((np.minimum(high + GAP, highs) > np.maximum(low - GAP, lows)).all(axis=1).any())


def _apart(start: Vector, end: Vector, centers: Vector, radii: Vector) -> bool:
    """Whether a line crosses no circle; it may lie in one."""
    along = end - start
    share = np.clip((centers - start) @ along / (along @ along), 0.0, 1.0)
    nearest = np.linalg.norm(start + share[:, None] * along - centers, axis=1)
    farthest = np.maximum(np.linalg.norm(start - centers, axis=1), np.linalg.norm(end - centers, axis=1))
    return bool(((nearest > radii) | (farthest < radii)).all())
