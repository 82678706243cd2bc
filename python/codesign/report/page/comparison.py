"""Runs side by side: a table under the chart of the trade-offs."""

from __future__ import annotations

from html import escape

import numpy as np

from codesign.report import words
from codesign.report.comparison import Reached, reached
from codesign.report.data import ReportData

HEADS = ("Run", "Designs", "Best compromises", "Beaten by no run")
MARK = '<path d="M7 1l6 11H1z" fill="var(--{color})"/>'
COLORS = ("series-4", "series-2", "series-3", "series-1")  # of the compared runs, in order; front.js has the same


def key_of_runs(run: ReportData) -> dict[str, str]:
    """Names of the compared runs and their marks in the chart."""
    return {
        f"best compromise of {other.name}": MARK.format(color=COLORS[k % len(COLORS)])
        for k, other in enumerate(run.compared)
    }


def comparison_table(run: ReportData) -> str:
    """HTML table of the run and those it is compared with; empty without any."""
    rows = reached(run)
    if not rows:
        return ""
    best = [f"{'Highest' if o.maximized else 'Lowest'} {o.label[:1].lower()}{o.label[1:]}" for o in run.objectives]
    heads = "".join(f'<th scope="col">{escape(head)}</th>' for head in (*HEADS, *best, "Hypervolume", "Of the gain"))
    body = "".join(_row(run, row) for row in rows)
    text = (
        "Hypervolume of a front together with the original, in the box that all fronts and the original span, a tenth "
        "wider where values are worst. Gain: what it exceeds that of the original alone by; shares are of this run’s."
    )
    return (
        f'<div class="sideways"><table class="plain" id="compared"><thead><tr>{heads}</tr></thead>'
        f'<tbody>{body}</tbody></table></div><p class="count">{text}</p>'
    )


def _row(run: ReportData, row: Reached) -> str:
    cells = [escape(row.name), f"{row.evaluated:,}", str(row.count), str(row.unbeaten)]
    original = run.baseline_vector
    for k, objective in enumerate(run.objectives):
        value = f"{words.number(row.best[k])} {escape(objective.unit)}"
        if original is not None and original[k] != 0.0:
            change = (row.best[k] - run.signs[k] * original[k]) / np.abs(original[k])
            value += f" <small>{words.percent(change)}</small>"
        cells.append(value)
    share = "–" if row.share is None else f"{100.0 * row.share:.0f}\u202f%"
    cells += [f"{row.volume:.4f}", share]
    return "<tr>" + "".join(f"<td>{cell}</td>" for cell in cells) + "</tr>"
