"""Figures of the search: what it had found after each evaluation, and what came of the designs it asked for."""

from __future__ import annotations

from typing import Any

import numpy as np

from codesign.report.figures import style
from codesign.report.figures.data import FigureData

STATUSES = {"feasible": style.BLUE, "infeasible": style.SKY, "skipped": style.LOST, "failed": style.VERMILION}
BATCHES = 40


def convergence(data: FigureData) -> Any:
    """Hypervolume by evaluation, and outcomes in equal batches of evaluations."""
    from matplotlib.figure import Figure
    from matplotlib.ticker import PercentFormatter

    run = data.run
    if len(run.entries) < 2 or not run.front:
        return None
    figure = Figure(figsize=(style.COLUMN * 1.2, style.COLUMN * 1.1))
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=[2, 1])
    count = np.arange(1, len(run.entries) + 1)
    upper.step(count, run.hypervolume / run.hypervolume[-1], where="post", color=style.BLUE)
    upper.set(ylabel="hypervolume,\nof the final one", ylim=(0.0, 1.04))
    upper.yaxis.set_major_formatter(PercentFormatter(1.0, decimals=0))
    edges = np.linspace(0, len(run.entries), min(BATCHES, len(run.entries)) + 1)
    bottom = np.zeros(len(edges) - 1)
    statuses = {entry.evaluation.status for entry in run.entries}
    for status, color in ((status, color) for status, color in STATUSES.items() if status in statuses):
        at = [k + 0.5 for k, entry in enumerate(run.entries) if entry.evaluation.status == status]
        share = np.histogram(at, edges)[0] / np.maximum(np.diff(edges), 1e-9)
        lower.bar(edges[:-1], share, np.diff(edges), bottom, align="edge", color=color, linewidth=0, label=status)
        bottom += share
    lower.set(ylabel="designs", xlabel="designs evaluated", ylim=(0.0, 1.0), xlim=(0, len(run.entries)))
    lower.yaxis.set_major_formatter(PercentFormatter(1.0, decimals=0))
    figure.legend(*lower.get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure
