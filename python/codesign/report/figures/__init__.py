"""Publication figures of a run, as PNG and PDF."""

from __future__ import annotations

import logging
import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from codesign.errors import CodesignError
from codesign.report.figures import designs, flights, fronts, robustness, search, solids, style
from codesign.report.figures.data import FigureData

logger = logging.getLogger(__name__)

__all__ = ["FIGURES", "FigureData", "FigureKind", "write_figures"]


@dataclass(frozen=True, slots=True)
class FigureKind:
    """A figure that a run may have: file name, caption, what draws it (None: the run has not what it needs)."""

    name: str
    caption: str
    draw: Callable[[FigureData], Any]


FIGURES = (
    FigureKind("front", "All designs in two objectives; the third colours the best compromises.", fronts.front),
    FigureKind("projections", "All designs in every pair of objectives.", fronts.projections),
    FigureKind("spider", "Chosen designs: parameters over their bounds, objectives over their range.", designs.spider),
    FigureKind("parallel", "Parameters and objectives of all feasible designs.", designs.parallel),
    FigureKind("convergence", "Growth of the front, and outcomes, over the search.", search.convergence),
    FigureKind(
        "validation", "Change of each objective on flights that the search has not seen.", robustness.validation
    ),
    FigureKind("stress", "Stress on the parts of the original and the recommended design.", solids.stress),
    FigureKind("flight", "Flight of the recommended design; grey bands: the pilot commands.", flights.histories),
    FigureKind("snapshots", "The flight of the recommended design at equal times.", solids.snapshots),
    FigureKind("parts", "The parts on the robot: original and recommended.", solids.parts_on_robot),
)


def write_figures(data: FigureData, folder: Path, names: tuple[str, ...] | None = None) -> tuple[Path, ...]:
    """Draws the figures (all, or those named) that the run has data for; a figure that fails is logged and left out."""
    paths: list[Path] = []
    folder.mkdir(parents=True, exist_ok=True)
    with style.style():
        for kind in FIGURES:
            if names is not None and kind.name not in names:
                continue
            try:
                figure = kind.draw(data)
            except CodesignError as error:
                logger.warning("figure %s: %s", kind.name, error)
                continue
            if figure is not None:
                paths.append(_save(figure, folder / f"{kind.name}.png"))
                figure.set_layout_engine("none")  # as laid out for the PNG, which takes as long as drawing
                paths.append(_save(figure, folder / f"{kind.name}.pdf"))
    return tuple(paths)


def _save(figure: Any, path: Path) -> Path:
    beside = path.with_name(f".{path.stem}.{os.getpid()}{path.suffix}")
    try:
        figure.savefig(beside, metadata={"CreationDate": None} if path.suffix == ".pdf" else {"Software": None})
        beside.rename(path)
    finally:
        beside.unlink(missing_ok=True)
    return path
