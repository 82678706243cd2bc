"""Figure of the validation: change of each objective from the original, flight by flight."""

from __future__ import annotations

import textwrap
from typing import Any

import numpy as np

from codesign.report.figures import style
from codesign.report.figures.data import FigureData
from codesign.report.pareto import Matrix as Array

ENOUGH = 4  # flights that make a distribution


def validation(data: FigureData) -> Any:
    """One panel an objective: violins and points of the disturbed flights, diamonds of the calm ones, by design."""
    from matplotlib.ticker import PercentFormatter

    flown = data.validation
    if flown is None:
        return None
    roles = [role for role in flown.roles if role != "original"]
    changes = {
        (o.key, role, wild): flown.change(role, o.key, wild)
        for o in data.run.objectives
        for role in roles
        for wild in (True, False)
    }
    if not any(changes.values()):
        return None
    figure, panels = style.panels(len(data.run.objectives), 0.6 + 0.42 * len(roles), sharey=True)
    spread = np.random.default_rng(1)  # across, so that points do not hide each other
    for axes, objective in zip(panels, data.run.objectives, strict=True):
        for y, role in enumerate(roles):
            disturbed = objective.sign * np.array(list(changes[objective.key, role, True].values()))
            calm = objective.sign * np.array(list(changes[objective.key, role, False].values()))
            _strip(axes, y, disturbed, calm, spread)
        axes.axvline(0.0, color=style.ORIGINAL, linewidth=1.0, label="original")
        axes.set_title(style.wrapped(objective.label, style.PAGE / style.COLUMNS - 0.4))
        style.few_ticks(axes, 3)
        axes.xaxis.set_major_formatter(PercentFormatter(1.0))
        axes.grid(visible=False, axis="y")
    panels[0].set_yticks(range(len(roles)), [textwrap.fill(role, 22) for role in roles])
    panels[0].set_ylim(len(roles) - 0.5, -0.5)
    keys = panels[0].get_legend_handles_labels()
    figure.legend(*keys, title="Change from the original", title_fontsize=8, loc="outside lower center", ncols=3)
    return figure


def _strip(axes: Any, y: int, disturbed: Array, calm: Array, spread: np.random.Generator) -> None:
    """Changes of one design in one objective, on the line `y`."""
    if len(disturbed) >= ENOUGH and np.ptp(disturbed) > 0:
        violin = axes.violinplot([disturbed], [y], vert=False, widths=0.75, showextrema=False)
        for body in violin["bodies"]:
            body.set(facecolor=style.SKY, alpha=0.3, linewidth=0)
    across = y + spread.uniform(-0.18, 0.18, len(disturbed))
    label = {"label": "disturbed flight"} if y == 0 else {}
    axes.scatter(disturbed, across, 5, style.BLUE, linewidths=0, alpha=0.6, **label)
    label = {"label": "calm flight, one per trajectory"} if y == 0 else {}
    place = np.full(len(calm), float(y))
    axes.scatter(calm, place, 18, style.INK, "D", edgecolors="white", linewidths=0.5, **label)
