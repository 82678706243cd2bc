"""Picture of `codesign stress`: the part colored by stress, clamps in one color, loads as arrows."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from codesign import fem
from codesign._core import fem as _core
from codesign.cli.stress_places import CaughtPlace
from codesign.fem.model import resolve
from codesign.files import replacing
from codesign.report.compute import stress_field
from codesign.report.figures import style
from codesign.report.figures.solids import PART_VIEW, on_screen, show_picture, stress_bar, stress_tint
from codesign.report.raster import Body, View, fitting_view, render

CLAMP = (0.30, 0.33, 0.40)  # of held faces
ARROW = "#c2185b"  # of loads
ARROW_SHARE = 0.22  # length of an arrow over the height of the picture
VIEWS = 8  # azimuths tried, so that the places are in front
ASPECT = 1.5
INNER = 4  # flat triangles that a side of an element is drawn with


def write_stress_picture(
    mesh: fem.TetMesh, result: fem.StaticResult, places: Sequence[CaughtPlace], name: str, path: Path
) -> Path:
    """PNG of a part colored by von Mises stress up to its peak, clamps dark, an arrow for each load."""
    from matplotlib.figure import Figure

    bodies = _bodies(mesh, result, places)
    view = _view(bodies, places)
    with style.style():
        figure = Figure(figsize=(style.COLUMN * 1.4, style.COLUMN))
        axes = figure.subplots()
        show_picture(axes, render(bodies, view, 660, 440), view)
        for place in places:
            if place.asked.load is not None:
                _draw_arrow(axes, view, place, float(np.ptp(mesh.nodes, axis=0).max()))
        factor = result.safety_factor
        axes.set_title(f"{name}: safety factor {factor:.3g}" if np.isfinite(factor) else f"{name}: not stressed")
        axes.plot([], [], "s", color=CLAMP, label="clamp")
        axes.plot([], [], "-", color=ARROW, label="load")
        axes.legend(loc="lower left", fontsize=6, frameon=False)
        stress_bar(figure, axes, result.peak_stress)
        with replacing(path) as beside:
            figure.savefig(beside, format="png", metadata={"Software": None})
    return path


def _bodies(mesh: fem.TetMesh, result: fem.StaticResult, places: Sequence[CaughtPlace]) -> list[Body]:
    """The free surface in the colors of its stress, and the clamps."""
    field = stress_field(mesh, result)
    held = np.zeros(len(mesh.boundary), dtype=bool)
    for place in places:
        if place.asked.load is None:
            held[_core.selected_triangles(mesh, resolve(mesh, place.selection))] = True
    drawn = np.tile(held, INNER)
    tint = stress_tint(field.von_mises, result.peak_stress)
    free = Body(field.points, field.triangles[~drawn], tint)
    return [free, Body(field.points, field.triangles[drawn], np.array(CLAMP))]


def _view(bodies: Sequence[Body], places: Sequence[CaughtPlace]) -> View:
    """The usual view of parts, or the nearest one that shows more of the places."""
    best, most = PART_VIEW[0], -1.0
    for turn in sorted((360.0 / VIEWS * k for k in range(VIEWS)), key=lambda turn: min(turn, 360.0 - turn)):
        towards = View(PART_VIEW[0] + turn, PART_VIEW[1], (0.0, 0.0, 0.0), 1.0).axes()[2]
        shown = sum(float(np.dot(place.found.normal, towards)) > 0.2 for place in places)
        if shown > most:
            best, most = PART_VIEW[0] + turn, shown
    return fitting_view(bodies, best, PART_VIEW[1], aspect=ASPECT)


def _draw_arrow(axes: Any, view: View, place: CaughtPlace, size: float) -> None:
    """An arrow along the force: it ends on the place if it presses, and starts there if it pulls."""
    force = place.force
    magnitude = float(np.linalg.norm(force))
    if magnitude == 0.0:
        return  # a pressure all around
    along = force / magnitude
    where = np.array(place.found.centroid)
    pulls = float(along @ np.array(place.found.normal)) > 0.0
    ends = np.stack([where, where + ARROW_SHARE * size * along * (1.0 if pulls else -1.0)])
    here, there = _screen(view, ends)
    start, end = (here, there) if pulls else (there, here)
    arrow = {"arrowstyle": "-|>", "color": ARROW, "linewidth": 1.4, "shrinkA": 0.0, "shrinkB": 0.0}
    axes.annotate("", xy=tuple(end), xytext=tuple(start), arrowprops=arrow, annotation_clip=False)
    axes.annotate(f"{magnitude:.4g} N", tuple(there), (3, 3), textcoords="offset points", fontsize=6, color=ARROW)


def _screen(view: View, points: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(on_screen(view, points), dtype=np.float64)
