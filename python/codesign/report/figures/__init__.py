"""Publication figures of a run, as PNG and PDF."""

from __future__ import annotations

import logging
import multiprocessing
import os
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from codesign.errors import CodesignError
from codesign.files import replacing
from codesign.report.figures import designs, flights, fronts, robustness, search, solids, style
from codesign.report.figures.data import FigureData

logger = logging.getLogger(__name__)

__all__ = ["FIGURES", "FigureData", "FigureKind", "drawing", "write_figures"]


@dataclass(frozen=True, slots=True)
class FigureKind:
    """A figure that a run may have: file name, caption, what draws it (None: the run has not what it needs)."""

    name: str
    caption: str
    draw: Callable[[FigureData], Any]


FIGURES = (
    FigureKind("front", "All designs in two objectives; the third colors the best compromises.", fronts.front),
    FigureKind("projections", "All designs in every pair of objectives.", fronts.projections),
    FigureKind("chosen", "Chosen designs: parameters over their bounds, objectives over their range.", designs.chosen),
    FigureKind("parallel", "Parameters and objectives of all feasible designs.", designs.parallel),
    FigureKind("convergence", "Growth of the front, and outcomes, over the search.", search.convergence),
    FigureKind(
        "validation", "Change of each objective on flights that the search has not seen.", robustness.validation
    ),
    FigureKind("stress", "Stress on the parts of the original and the recommended design.", solids.stress),
    FigureKind("flight", "Flight of the recommended design; gray bands: the pilot commands.", flights.histories),
    FigureKind("snapshots", "The flight of the recommended design at equal times.", solids.snapshots),
    FigureKind("parts", "The parts on the robot: original and recommended.", solids.parts_on_robot),
)


def write_figures(data: FigureData, folder: Path, names: tuple[str, ...] | None = None) -> tuple[Path, ...]:
    """Draws the figures (all, or those named) that the run has data for; a figure that fails is logged and left out."""
    with drawing(data, folder, names) as paths:
        pass
    return tuple(paths)


@contextmanager
def drawing(data: FigureData, folder: Path, names: tuple[str, ...] | None = None) -> Iterator[list[Path]]:
    """Draws figures as `write_figures` does, in copies of this process, while the body runs; then fills the list."""
    wanted = [k for k, kind in enumerate(FIGURES) if names is None or kind.name in names]
    folder.mkdir(parents=True, exist_ok=True)
    paths: list[Path] = []
    fork = multiprocessing.get_context("fork")
    with ProcessPoolExecutor(os.cpu_count(), fork, initializer=_inherit, initargs=(data, folder)) as pool:
        drawn = pool.map(_draw, wanted)
        yield paths
        for files, problem in drawn:
            paths += files
            if problem is not None:
                logger.warning(problem)


_inherited: tuple[FigureData, Path]  # of a drawing process


def _inherit(data: FigureData, folder: Path) -> None:
    global _inherited
    _inherited = data, folder


def _draw(number: int) -> tuple[list[Path], str | None]:
    """One figure's files, or why there are none."""
    data, folder = _inherited
    kind = FIGURES[number]
    try:
        with style.style():
            figure = kind.draw(data)
            if figure is None:
                return [], None
            png = _save(figure, folder / f"{kind.name}.png")
            figure.set_layout_engine("none")  # as laid out for the PNG, which takes as long as drawing
            return [png, _save(figure, folder / f"{kind.name}.pdf")], None
    except CodesignError as error:
        return [], f"figure {kind.name}: {error}"


def _save(figure: Any, path: Path) -> Path:
    with replacing(path) as beside:
        figure.savefig(beside, metadata={"CreationDate": None} if path.suffix == ".pdf" else {"Software": None})
    return path
