"""One look for all figures: column widths of a paper, quiet axes, colors that survive color blindness."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

COLUMN, PAGE = 3.5, 7.16  # inches: one and two columns of an IEEE page
INK, MUTED, LINE = "#17191d", "#5d626c", "#d9d9d4"
DOT, LOST = "#b3b6bc", "#c9cbd0"
# Okabe and Ito, "Color Universal Design" (2008)
BLUE, ORANGE, GREEN, PURPLE, VERMILION, SKY = "#0072b2", "#e69f00", "#009e73", "#cc79a7", "#d55e00", "#56b4e9"
SERIES = (BLUE, ORANGE, GREEN, PURPLE)
ORIGINAL = VERMILION
COMPARED = (PURPLE, ORANGE, GREEN, BLUE)  # fronts of other runs
PART = (0.0, 0.447, 0.698)
THIRD = "viridis"
STRESS = ("#e3e6e8", "#f4e3a1", "#f2ac42", "#d2601a", "#7a1616")  # lightness falls steadily
STRESS_STOPS = (0.0, 0.2, 0.45, 0.7, 1.0)
PIXELS_PER_INCH = 220
COLUMNS = 3  # of panels side by side
LETTER = 0.58  # width of a letter with its space, of the font size; on the safe side

SETTINGS: dict[str, Any] = {
    "font.size": 8, "axes.titlesize": 8, "axes.labelsize": 8, "xtick.labelsize": 7, "ytick.labelsize": 7,
    "legend.fontsize": 7, "legend.frameon": False, "legend.handlelength": 1.4,
    "axes.edgecolor": MUTED, "axes.labelcolor": INK, "axes.linewidth": 0.6, "axes.spines.top": False,
    "axes.spines.right": False, "axes.grid": True, "axes.axisbelow": True, "grid.color": LINE, "grid.linewidth": 0.5,
    "xtick.color": MUTED, "ytick.color": MUTED, "xtick.major.width": 0.6, "ytick.major.width": 0.6,
    "text.color": INK, "lines.linewidth": 1.2, "figure.dpi": 100, "savefig.dpi": PIXELS_PER_INCH,
    "pdf.fonttype": 42, "figure.constrained_layout.use": True, "axes.titlelocation": "left",
}  # fmt: skip


@contextmanager
def style() -> Iterator[None]:
    """Applies the look, without touching the user's settings."""
    import matplotlib as mpl

    settings: Any = {**mpl.rcParamsDefault, "backend": "agg", **SETTINGS}
    with mpl.rc_context(settings):
        yield


def panels(count: int, height: float, **options: Any) -> tuple[Any, list[Any]]:
    """A figure as wide as a page with `count` axes of a height [inches], at most COLUMNS of them side by side."""
    from matplotlib.figure import Figure

    columns = min(count, COLUMNS)
    rows = -(-count // columns)
    figure = Figure(figsize=(PAGE, rows * height + 0.5))
    axes = figure.subplots(rows, columns, squeeze=False, **options).ravel().tolist()
    for unused in axes[count:]:
        unused.remove()
    return figure, axes[:count]


def few_ticks(axes: Any, count: int = 4) -> None:
    """At most `count` intervals between ticks on both axes, without offset text: labels of small panels keep apart."""
    from matplotlib.ticker import MaxNLocator

    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(count))
        axis.get_major_formatter().set_useOffset(False)


def wrapped(text: str, width: float, size: float = 8.0) -> str:
    """Text broken into lines that fit `width` [inches] at a font size [points]; a unit in brackets stays whole."""
    letters = max(6, int(72.0 * width / (LETTER * size)))
    return "\n".join(textwrap.wrap(text.replace(" (", "\n("), letters, replace_whitespace=False))


def stress_colors() -> Any:
    """Color map of stresses: light and unloaded to dark and loaded."""
    from matplotlib.colors import LinearSegmentedColormap

    return LinearSegmentedColormap.from_list("stress", list(zip(STRESS_STOPS, STRESS, strict=True)))
