"""What a matplotlib figure writes and where, as its renderer places it."""

from collections.abc import Iterator
from itertools import combinations
from typing import Any

from matplotlib.backends.backend_agg import FigureCanvasAgg

TOUCH = 0.5  # pixels that boxes of text may share


def texts(figure: Any) -> Iterator[Any]:
    """Every text that is drawn: of ticks inside the view, labels, titles, notes and legends."""
    figure.canvas.draw()
    yield from (*figure.texts, *(t for legend in figure.legends for t in legend.get_texts()))
    for axes in figure.axes:
        legend = axes.get_legend()
        yield from axes.texts
        yield from legend.get_texts() if legend else ()
        if not axes.axison:
            yield axes.title
            continue
        yield from (axes.title, axes._left_title, axes._right_title, axes.xaxis.label, axes.yaxis.label)
        for axis in (axes.xaxis, axes.yaxis):
            low, high = sorted(axis.get_view_interval())
            margin = 1e-9 * (high - low)
            for tick in axis.get_major_ticks():
                if low - margin <= tick.get_loc() <= high + margin:
                    yield from (tick.label1, tick.label2)
            yield axis.offsetText


def boxes(figure: Any) -> list[tuple[str, Any]]:
    """Texts and their boxes [pixels]."""
    FigureCanvasAgg(figure)
    renderer = figure.canvas.get_renderer()
    shown = {id(t): t for t in texts(figure) if t.get_visible() and t.get_text().strip()}
    return [(t.get_text(), t.get_window_extent(renderer)) for t in shown.values()]


def overlaps(figure: Any) -> list[tuple[str, str]]:
    """Pairs of texts that overlap."""
    return [(a, b) for (a, first), (b, second) in combinations(boxes(figure), 2) if _shared(first, second) > TOUCH]


def outside(figure: Any) -> list[str]:
    """Texts that the figure's edge cuts."""
    wide, high = figure.bbox.width, figure.bbox.height
    return [
        text
        for text, box in boxes(figure)
        if box.x0 < -TOUCH or box.y0 < -TOUCH or box.x1 > wide + TOUCH or box.y1 > high + TOUCH
    ]


def _shared(a: Any, b: Any) -> float:
    """Smaller side of what two boxes share; negative if they are apart."""
    return float(min(min(a.x1, b.x1) - max(a.x0, b.x0), min(a.y1, b.y1) - max(a.y0, b.y0)))
