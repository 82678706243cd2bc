"""Figures of designs: parameters and objectives of chosen ones side by side, of all as parallel coordinates."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import Any

import numpy as np

from codesign.problem.evaluation import Evaluation
from codesign.report.data import ReportData
from codesign.report.figures import style
from codesign.report.figures.data import FigureData
from codesign.report.pareto import Matrix
from codesign.report.words import better_side, number

COLORS = (style.INK, style.BLUE, style.GREEN, style.ORANGE, style.PURPLE, style.SKY)


def chosen(data: FigureData) -> Any:
    """The highlighted designs: parameters over their bounds; below, objectives over the range of these designs."""
    shown = {role: e for role, e in data.run.highlights.items() if np.isfinite(data.run.vector(e)).all()}
    return draw_chosen(data.run, shown) if len(shown) > 1 else None


def draw_chosen(run: ReportData, shown: dict[str, Evaluation]) -> Any:
    """Designs by role, one line per parameter and objective; each line says where it starts and ends."""
    from matplotlib.figure import Figure

    rows = np.array([_row(run, evaluation) for evaluation in shown.values()])
    split, names = len(run.variables), _names(run)
    low = np.concatenate([[v.minimum for v in run.variables], rows[:, split:].min(axis=0)])
    high = np.concatenate([[v.maximum for v in run.variables], rows[:, split:].max(axis=0)])
    scaled = (rows - low) / np.where(high > low, high - low, 1.0)
    figure = Figure(figsize=(style.PAGE, 0.9 + 0.34 * len(names)))
    panels = np.atleast_1d(figure.subplots(2, 1, height_ratios=[split, len(names) - split]))
    for axes, part, title in zip(
        panels, (slice(0, split), slice(split, None)), ("Parameters", f"Objectives. {better_side(run)}"), strict=True
    ):
        _lines(axes, names[part], _ends(run, low, high)[part])
        axes.set_title(title)
        places = np.arange(len(names[part]))
        for (role, values), (color, size) in zip(zip(shown, scaled[:, part], strict=True), _looks(shown), strict=True):
            axes.scatter(values, places, 26.0 * size, color, "D" if role == "original" else "o", label=role, zorder=3,
                edgecolors="white", linewidths=0.5)  # fmt: skip
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure


def _ends(run: ReportData, low: Matrix, high: Matrix) -> list[tuple[str, str]]:
    """What stands at both ends of each axis: numbers, or the first and the last name of a choice."""
    ends = [(number(float(a), 4), number(float(b), 4)) for a, b in zip(low, high, strict=True)]
    count = len(run.variables)
    named = [v.bounds_text() if v.named else end for v, end in zip(run.variables, ends[:count], strict=True)]
    return named + ends[count:]


def _lines(axes: Any, names: Sequence[str], ends: Sequence[tuple[str, str]]) -> None:
    """A horizontal line for each name, from its lowest to its highest value."""
    places = np.arange(len(names))
    axes.hlines(places, 0.0, 1.0, color=style.LINE, linewidth=1.0, zorder=0)
    for place, (a, b) in zip(places, ends, strict=True):
        axes.text(-0.02, place, a, ha="right", va="center", fontsize=6, color=style.MUTED)
        axes.text(1.02, place, b, ha="left", va="center", fontsize=6, color=style.MUTED)
    axes.set_yticks(places, [textwrap.fill(name, 30) for name in names])
    axes.set(xlim=(-0.12, 1.12), ylim=(len(names) - 0.5, -0.5), xticks=[])
    axes.grid(visible=False)
    axes.tick_params(axis="y", length=0)
    for side in ("left", "bottom"):
        axes.spines[side].set_visible(False)


def parallel(data: FigureData) -> Any:
    """Every feasible design as a line over parameters and objectives; the first objective colors the front."""
    from matplotlib import colormaps
    from matplotlib.collections import LineCollection
    from matplotlib.figure import Figure

    run = data.run
    if len(run.front) < 2:
        return None
    names, low, high = _scales(run)
    figure = Figure(figsize=(style.PAGE, 2.9))
    axes = figure.subplots()
    places = np.arange(len(names), dtype=float).tolist()

    def lines(rows: Sequence[Matrix]) -> list[Matrix]:
        return [np.column_stack([places, (row - low) / (high - low)]) for row in rows]

    behind = [_row(run, run.entries[i].evaluation) for i in np.flatnonzero(run.feasible) if i not in set(run.front)]
    axes.add_collection(LineCollection(lines(behind), colors=style.DOT, linewidths=0.3, alpha=0.35, rasterized=True))
    order = np.argsort(run.values[run.front, 0])[::-1]
    first = run.values[run.front, 0][order]
    tint = colormaps[style.THIRD]((first - first.min()) / max(np.ptp(first), 1e-12))
    best = [_row(run, run.entries[run.front[i]].evaluation) for i in order]
    axes.add_collection(LineCollection(lines(best), colors=tint, linewidths=0.8))
    for name, evaluation in data.compared.items():
        if np.isfinite(run.vector(evaluation)).all():
            (line,) = lines([_row(run, evaluation)])
            color = style.ORIGINAL if name == "original" else style.INK
            axes.plot(*line.T, color=color, linewidth=2.0, label=name, clip_on=False)
    axes.set(xlim=(0, len(names) - 1), ylim=(-0.03, 1.03), yticks=[])
    axes.set_xticks(places, [style.wrapped(name, style.PAGE / len(names)) for name in names])
    axes.grid(visible=False, axis="y")
    axes.spines["left"].set_visible(False)
    axes.spines["bottom"].set_visible(False)
    for x, (a, b) in zip(places, _ends(run, low, high), strict=True):
        axes.axvline(x, color=style.MUTED, linewidth=0.6, zorder=0)
        for y, value, side in ((-0.03, a, "top"), (1.03, b, "bottom")):
            axes.text(x, y, value, ha="center", va=side, fontsize=6, color=style.MUTED)
    axes.tick_params(axis="x", length=0, pad=12)
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.06), ncols=2)
    return figure


def _row(run: ReportData, evaluation: Evaluation) -> Matrix:
    """Parameters and objectives of a design in one row."""
    return np.concatenate([[v.position(evaluation.design[v.name]) for v in run.variables], run.shown(evaluation)])


def _names(run: ReportData) -> list[str]:
    """Parameters and objectives with their units."""
    units = {v.name: "°" if v.unit == "deg" else v.unit for v in run.variables}
    named = [f"{run.label(v)} ({units[v.name]})" if v.unit else run.label(v) for v in run.variables]
    return named + [o.title for o in run.objectives]


def _scales(run: ReportData) -> tuple[list[str], Matrix, Matrix]:
    """Names and ranges of the axes: a parameter's bounds; an objective's range on the front and the original."""
    rows = [run.values[i] for i in run.front]
    if run.baseline_vector is not None:
        rows.append(run.baseline_vector)
    seen = run.signs * rows
    low = np.concatenate([[v.minimum for v in run.variables], seen.min(axis=0)])
    high = np.concatenate([[v.maximum for v in run.variables], seen.max(axis=0)])
    return _names(run), low, np.where(high > low, high, low + 1.0)


def _looks(chosen: dict[str, Evaluation]) -> list[tuple[str, float]]:
    """Color and line width of each role; the original and the recommended stand out."""
    colors = iter(COLORS[1:])
    special = {"recommended": (style.INK, 1.8), "original": (style.ORIGINAL, 1.8)}
    return [special.get(role) or (next(colors, style.MUTED), 1.1) for role in chosen]
