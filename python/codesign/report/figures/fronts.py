"""Figures of objectives: the front in two axes, all pairs of objectives."""

from __future__ import annotations

from itertools import combinations
from typing import Any

import numpy as np

from codesign.report.data import ReportData
from codesign.report.figures import style
from codesign.report.figures.data import FigureData


def front(data: FigureData) -> Any:
    """All designs in the first two objectives, the front colored by the third."""
    from matplotlib.figure import Figure

    run = data.run
    if not run.front or len(run.objectives) < 2:
        return None
    figure = Figure(figsize=(style.COLUMN * 1.35, style.COLUMN * 1.05))
    axes = figure.subplots()
    dots = draw_projection(axes, run, 0, 1, color=2 if len(run.objectives) > 2 else None)
    if dots is not None and len(run.objectives) > 2:
        bar = figure.colorbar(dots, ax=axes, aspect=32, pad=0.02)
        bar.set_label(style.wrapped(run.objectives[2].title, style.COLUMN * 0.9))
        bar.outline.set_visible(False)
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=3, columnspacing=1.2)
    return figure


def projections(data: FigureData) -> Any:
    """All pairs of objectives side by side."""
    run = data.run
    pairs = list(combinations(range(len(run.objectives)), 2))
    if not run.front or len(pairs) < 2:
        return None
    figure, panels = style.panels(len(pairs), style.PAGE / style.COLUMNS + 0.1)
    for axes, (x, y) in zip(panels, pairs, strict=False):
        draw_projection(axes, run, x, y)
        style.few_ticks(axes)
        width = style.PAGE / style.COLUMNS - 0.6
        axes.set_xlabel(style.wrapped(run.objectives[x].title, width))
        axes.set_ylabel(style.wrapped(run.objectives[y].title, width))
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=5)
    return figure


def draw_projection(axes: Any, run: ReportData, x: int, y: int, color: int | None = None) -> Any:
    """Designs in objectives `x` and `y`; the front's markers are colored by objective `color`. Returns them."""
    values = run.signs * run.values
    known = np.isfinite(values).all(axis=1)
    skipped = known & (run.statuses == "skipped")
    infeasible = known & ~run.feasible & ~skipped
    behind = run.feasible | skipped
    behind[run.front] = False
    if infeasible.any():
        axes.scatter(
            values[infeasible, x], values[infeasible, y], 9, style.LOST, "x", linewidths=0.6, label="infeasible"
        )
    name = "feasible, or not computed" if skipped.any() else "feasible"
    axes.scatter(values[behind, x], values[behind, y], 6, style.DOT, linewidths=0, label=name)
    tint = style.BLUE if color is None else values[run.front, color]
    dots = axes.scatter(
        values[run.front, x], values[run.front, y], 20, tint, cmap=None if color is None else style.THIRD,
        edgecolors="white", linewidths=0.4, label="best compromise", zorder=3,
    )  # fmt: skip
    for k, other in enumerate(run.compared):
        tint = style.COMPARED[k % len(style.COMPARED)]
        axes.scatter(
            *(run.signs * other.values)[:, [x, y]].T, 16, tint, marker="^", edgecolors="white", linewidths=0.3,
            label=f"best compromise of {other.name}", zorder=3,
        )  # fmt: skip
    if run.baseline_vector is not None:
        axes.scatter(
            *(run.signs * run.baseline_vector)[[x, y]],
            34,
            style.ORIGINAL,
            marker="D",
            edgecolors="white",
            label="original",
            zorder=4,
        )
    if run.recommended is not None:
        axes.scatter(
            *values[run.recommended, [x, y]],
            75,
            style.INK,
            "*",
            edgecolors="white",
            linewidths=0.5,
            label="recommended",
            zorder=5,
        )
    axes.set(xlabel=run.objectives[x].title, ylabel=run.objectives[y].title, xlim=run.view(x), ylim=run.view(y))
    return dots
