"""Figures of designs: parameters and objectives of chosen ones as a spider plot, of all as parallel coordinates."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from codesign.problem.evaluation import Evaluation
from codesign.report.data import ReportData
from codesign.report.figures import style
from codesign.report.figures.data import FigureData
from codesign.report.pareto import Matrix
from codesign.report.words import number

COLOURS = (style.INK, style.BLUE, style.GREEN, style.ORANGE, style.PURPLE, style.SKY)


def spider(data: FigureData) -> Any:
    """Parameters over their bounds and objectives over their range on the front, of the highlighted designs."""
    from matplotlib.figure import Figure

    run = data.run
    chosen = {role: e for role, e in run.highlights.items() if np.isfinite(run.vector(e)).all()}
    if len(chosen) < 2:
        return None
    names, low, high = _scales(run)
    angles = np.linspace(0.0, 2.0 * np.pi, len(names), endpoint=False)
    figure = Figure(figsize=(style.COLUMN * 1.5, style.COLUMN * 1.3))
    axes: Any = figure.add_subplot(projection="polar")
    axes.set_theta_offset(np.pi / 2.0)
    axes.set_theta_direction(-1)
    for (role, evaluation), (colour, width) in zip(chosen.items(), _looks(chosen), strict=True):
        scaled = (_row(run, evaluation) - low) / (high - low)
        closed = np.append(scaled, scaled[0])
        axes.plot(
            np.append(angles, angles[0]), closed, color=colour, linewidth=width, marker="o", markersize=2.5, label=role
        )
        axes.fill(angles, scaled, color=colour, alpha=0.04)
    axes.set(ylim=(-0.15, 1.0), yticks=[0.0, 0.5, 1.0], yticklabels=[])
    axes.set_xticks(angles, [f"{n}\n{number(a, 3)} … {number(b, 3)}" for n, a, b in zip(names, low, high, strict=True)])
    axes.tick_params(axis="x", pad=6)
    for text, angle in zip(axes.get_xticklabels(), angles, strict=True):
        sideways = np.sin(angle)  # labels on the right start at their point, on the left they end there
        text.set_horizontalalignment("center" if abs(sideways) < 0.1 else "left" if sideways > 0 else "right")
    axes.spines["polar"].set_visible(False)
    figure.legend(loc="outside lower center", ncols=3)
    return figure


def parallel(data: FigureData) -> Any:
    """Every feasible design as a line over parameters and objectives; the first objective colours the front."""
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
            colour = style.ORIGINAL if name == "original" else style.INK
            axes.plot(*line.T, color=colour, linewidth=2.0, label=name, clip_on=False)
    axes.set(xlim=(0, len(names) - 1), ylim=(-0.03, 1.03), yticks=[])
    axes.set_xticks(places, [name.replace(" (", "\n(") for name in names])
    axes.grid(visible=False, axis="y")
    axes.spines["left"].set_visible(False)
    axes.spines["bottom"].set_visible(False)
    for x, a, b in zip(places, low, high, strict=True):
        axes.axvline(x, color=style.MUTED, linewidth=0.6, zorder=0)
        for y, value, side in ((-0.03, a, "top"), (1.03, b, "bottom")):
            axes.text(x, y, number(float(value), 4), ha="center", va=side, fontsize=6, color=style.MUTED)
    axes.tick_params(axis="x", length=0, pad=12)
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.06), ncols=2)
    return figure


def _row(run: ReportData, evaluation: Evaluation) -> Matrix:
    """Parameters and objectives of a design in one row."""
    return np.concatenate([[evaluation.design[v.name] for v in run.variables], run.vector(evaluation)])


def _scales(run: ReportData) -> tuple[list[str], Matrix, Matrix]:
    """Names and ranges of the axes: a parameter's bounds; an objective's range on the front and the original."""
    names = [
        f"{run.label(v)} ({'°' if v.unit == 'deg' else v.unit})" if v.unit else run.label(v) for v in run.variables
    ]
    rows = [run.values[i] for i in run.front]
    if run.baseline_vector is not None:
        rows.append(run.baseline_vector)
    seen = np.array(rows)
    low = np.concatenate([[v.minimum for v in run.variables], seen.min(axis=0)])
    high = np.concatenate([[v.maximum for v in run.variables], seen.max(axis=0)])
    return names + [o.title for o in run.objectives], low, np.where(high > low, high, low + 1.0)


def _looks(chosen: dict[str, Evaluation]) -> list[tuple[str, float]]:
    """Colour and line width of each role; the original and the recommended stand out."""
    colours = iter(COLOURS[1:])
    special = {"recommended": (style.INK, 1.8), "original": (style.ORIGINAL, 1.8)}
    return [special.get(role) or (next(colours, style.MUTED), 1.1) for role in chosen]
