"""A sheet of paper with lines and words in mm, written as PDF or DXF; it knows nothing of what it shows."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from codesign.errors import LibraryError
from codesign.files import replacing
from codesign.geometry.profile import Vector

WIDE = 0.95  # of a letter's height: the width of most letters and digits, with what is between them
POINT = 72.0 / 25.4  # typographic points of a mm


@dataclass(frozen=True)
class Pen:
    """A kind of line: width and dashes (drawn, left out, …) in mm, DXF color and line type."""

    width: float
    dashes: tuple[float, ...]
    color: int
    linetype: str


PENS = {
    "visible": Pen(0.5, (), 7, "CONTINUOUS"),
    "hidden": Pen(0.25, (3.0, 1.5), 8, "DASHED"),
    "center": Pen(0.18, (6.0, 1.2, 1.2, 1.2), 1, "CENTER"),
    "dimension": Pen(0.18, (), 5, "CONTINUOUS"),
    "frame": Pen(0.7, (), 7, "CONTINUOUS"),
    "text": Pen(0.25, (), 7, "CONTINUOUS"),
}


@dataclass(frozen=True, eq=False)
class Line:
    """Points (n, 2) of a polyline. circle: center x, y and radius, if it is a full one."""

    points: Vector
    pen: str
    circle: tuple[float, float, float] | None = None


@dataclass(frozen=True)
class Word:
    """Text on a base line; height of its capitals [mm]; anchor: which end of it is at the point, or center."""

    text: str
    x: float
    y: float
    height: float = 2.5
    anchor: str = "left"
    degrees: float = 0.0

    @property
    def box(self) -> tuple[Vector, Vector]:
        """Lower left and upper right corner (2,) [mm] of what it covers, rather too wide."""
        width = WIDE * self.height * len(self.text)
        start = {"left": 0.0, "center": -0.5 * width, "right": -width}[self.anchor]
        turn = np.radians(self.degrees)
        along, across = np.array([np.cos(turn), np.sin(turn)]), np.array([-np.sin(turn), np.cos(turn)])
        corners = [u * along + v * across for u in (start, start + width) for v in (0.0, self.height)]
        at = np.array([self.x, self.y])
        return at + np.min(corners, axis=0), at + np.max(corners, axis=0)


@dataclass(eq=False)
class Sheet:
    """A page of width and height [mm], origin in its lower left corner."""

    width: float
    height: float
    title: str = ""
    lines: list[Line] = field(default_factory=list)
    words: list[Word] = field(default_factory=list)

    def line(self, pen: str, *points: tuple[float, float]) -> None:
        """A polyline."""
        self.lines.append(Line(np.array(points, dtype=float), pen))

    def rectangle(self, pen: str, x0: float, y0: float, x1: float, y1: float) -> None:
        """A frame."""
        self.line(pen, (x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0))

    def write(
        self, text: str, x: float, y: float, height: float = 2.5, anchor: str = "left", degrees: float = 0
    ) -> None:
        """A word."""
        self.words.append(Word(text, x, y, height, anchor, degrees))

    def arrow(self, x: float, y: float, dx: float, dy: float, size: float = 2.5) -> None:
        """A head at a point, that points along (dx, dy)."""
        length = float(np.hypot(dx, dy))
        ux, uy = dx / length * size, dy / length * size
        for side in (0.17, -0.17):
            self.line("dimension", (x, y), (x - ux - side * uy, y - uy + side * ux))


def write_pdf(sheet: Sheet, path: str | os.PathLike[str]) -> None:
    """One page at true size; the same bytes for the same sheet."""
    from matplotlib.backends.backend_pdf import FigureCanvasPdf
    from matplotlib.collections import LineCollection
    from matplotlib.figure import Figure
    from matplotlib.font_manager import FontProperties

    figure = Figure(figsize=(sheet.width / 25.4, sheet.height / 25.4))
    FigureCanvasPdf(figure)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0), xlim=(0, sheet.width), ylim=(0, sheet.height))
    axes.axis("off")
    for name, pen in PENS.items():
        lines = [line.points for line in sheet.lines if line.pen == name]
        style = "solid" if not pen.dashes else (0.0, [d / pen.width for d in pen.dashes])
        axes.add_collection(
            LineCollection(lines, colors="black", linewidths=pen.width * POINT, linestyles=[style], capstyle="butt")
        )
    font = FontProperties(family="DejaVu Sans")
    for word in sheet.words:
        place: dict[str, Any] = {"ha": word.anchor, "va": "baseline", "rotation": word.degrees}
        place |= {"rotation_mode": "anchor", "parse_math": False}
        size = word.height * POINT / 0.73  # capitals of the font are so high
        axes.text(word.x, word.y, word.text, fontproperties=font, fontsize=size, **place)
    metadata = {"Title": sheet.title, "Creator": "codesign", "CreationDate": None, "ModDate": None}
    with replacing(path) as temporary:
        figure.savefig(temporary, format="pdf", metadata=metadata)


def write_dxf(sheet: Sheet, path: str | os.PathLike[str]) -> None:
    """DXF (R2010, mm) with a layer for each kind of line.

    Raises: LibraryError if ezdxf is not installed.
    """
    try:
        from ezdxf import filemanagement, units
        from ezdxf.enums import TextEntityAlignment
    except ImportError as error:
        raise LibraryError("DXF needs ezdxf, which is not installed: pip install 'codesign[drawing]'") from error
    document = filemanagement.new("R2010", setup=True)
    document.units = units.MM
    document.header["$LTSCALE"] = 2.5
    space = document.modelspace()
    for name, pen in PENS.items():
        layer = document.layers.add(name.upper(), color=pen.color, linetype=pen.linetype)
        layer.dxf.lineweight = round(100 * pen.width)
    for line in sheet.lines:
        on = {"layer": line.pen.upper()}
        if line.circle is not None:
            x, y, radius = line.circle
            space.add_circle((x, y), radius, on)
        elif len(line.points) == 2:
            start, end = line.points.tolist()
            space.add_line(start, end, on)
        else:
            space.add_lwpolyline(line.points.tolist(), dxfattribs=on)
    align = {
        "left": TextEntityAlignment.LEFT,
        "center": TextEntityAlignment.CENTER,
        "right": TextEntityAlignment.RIGHT,
    }
    for word in sheet.words:
        text = space.add_text(word.text, height=word.height, rotation=word.degrees, dxfattribs={"layer": "TEXT"})
        text.set_placement((word.x, word.y), align=align[word.anchor])
    with replacing(path) as temporary:
        document.saveas(Path(temporary))


def moved(lines: Iterator[Line], scale: float, x: float, y: float) -> Iterator[Line]:
    """Lines scaled about the origin, which comes to (x, y)."""
    for line in lines:
        circle = line.circle and (scale * line.circle[0] + x, scale * line.circle[1] + y, scale * line.circle[2])
        yield Line(scale * line.points + np.array([x, y]), line.pen, circle)
