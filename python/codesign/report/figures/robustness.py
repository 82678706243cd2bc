"""Figure of the validation: change of each objective from the original, flight by flight."""

from __future__ import annotations

import textwrap
from typing import Any

import numpy as np

from codesign.report.figures import style
from codesign.report.figures.data import FigureData

ENOUGH = 4  # flights that make a distribution


def validation(data: FigureData) -> Any:
    """One panel an objective: violins and points of the disturbed flights, diamonds of the calm ones, by design."""
    from matplotlib.figure import Figure
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
    figure = Figure(figsize=(style.PAGE, 2.9))
    spread = np.random.default_rng(1)  # sideways, so that points do not hide each other
    for axes, objective in zip(
        np.atleast_1d(figure.subplots(1, len(data.run.objectives))), data.run.objectives, strict=True
    ):
        for x, role in enumerate(roles):
            disturbed = np.array(list(changes[objective.key, role, True].values()))
            calm = np.array(list(changes[objective.key, role, False].values()))
            if len(disturbed) >= ENOUGH and np.ptp(disturbed) > 0:
                violin = axes.violinplot([disturbed], [x], widths=0.75, showextrema=False)
                for body in violin["bodies"]:
                    body.set(facecolor=style.SKY, alpha=0.3, linewidth=0)
            sideways = x + spread.uniform(-0.18, 0.18, len(disturbed))
            label = {"label": "disturbed flight"} if x == 0 else {}
            axes.scatter(sideways, disturbed, 5, style.BLUE, linewidths=0, alpha=0.6, **label)
            label = {"label": "calm flight, one a trajectory"} if x == 0 else {}
            axes.scatter(
                np.full(len(calm), float(x)), calm, 18, style.INK, "D", edgecolors="white", linewidths=0.5, **label
            )
        axes.axhline(0.0, color=style.ORIGINAL, linewidth=1.0, label="original")
        axes.set_title(objective.label)
        axes.set_xticks(range(len(roles)), [textwrap.fill(role, 14) for role in roles], fontsize=6)
        axes.yaxis.set_major_formatter(PercentFormatter(1.0))
        axes.grid(visible=False, axis="x")
    figure.supylabel("change from the original", fontsize=8)
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure
