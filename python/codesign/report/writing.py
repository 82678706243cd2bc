"""Writes the report of a run: details that are missing, the page, the figures."""

from __future__ import annotations

import io
import logging
from collections.abc import Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from codesign.errors import CodesignError, StoreError
from codesign.files import write_text
from codesign.interrupts import native_threads
from codesign.problem.design_space import DesignValue
from codesign.problem.evaluation import Evaluation
from codesign.report.data import ReportData
from codesign.report.details import FOLDER, Detail, detail_key, load_details, save_detail
from codesign.report.figures import FigureData, drawing
from codesign.report.figures.solids import hero
from codesign.report.link_meshes import absence_in_words, absent_meshes, package_paths
from codesign.report.page.encode import page_detail
from codesign.report.page.html import render
from codesign.report.reading import read_report_data, same_study, study_of
from codesign.report.validation import load_validation

logger = logging.getLogger(__name__)

PAGE = "report.html"
FIGURE_FOLDER = "figures"


@dataclass(frozen=True, slots=True)
class ReportPaths:
    """What a report consists of: the page; the figures, each as PNG and as PDF."""

    html: Path
    figures: tuple[Path, ...] = ()


def write_report(
    run_directory: str | Path,
    *,
    study: Any = None,
    compute: bool = True,
    figures: bool = True,
    compare: Sequence[str | Path] = (),
) -> ReportPaths:
    """Writes `report.html` into a run's folder, and the figures (PNG and PDF) into its folder `figures`.

    Args:
        run_directory: the run's folder.   study: its study, by default loaded from where the run found it.
        compute: whether to evaluate the original design and to compute stress fields and flight histories of a handful
            of designs, where the run does not have them yet; they are kept beside the run.
        figures: whether to draw the figures.
        compare: folders of runs with the same objectives, whose fronts are shown beside this one's.
    Raises: StoreError if there is no run, one to compare has other objectives, or the folder cannot be written.
    """
    directory = Path(run_directory)
    study = study if study is not None else study_of(directory)
    current = study if same_study(directory, study) else None
    run = read_report_data(directory, study, compare=[Path(other) for other in compare])
    if compute and current is not None:
        run = compute_details(current, run)
    details = load_details(directory)
    run = with_absent_meshes(run, study)
    data = FigureData(run, details, current, load_validation(directory))
    shown = {key: page_detail(detail) for key, detail in _shown(run, details).items()}
    meanwhile: AbstractContextManager[list[Path]] = nullcontext([])
    if figures:
        meanwhile = drawing(data, directory / FIGURE_FOLDER)
    with meanwhile as drawn:
        page = _write(directory / PAGE, render(run, shown, picture=_picture(data), validation=data.validation))
    return ReportPaths(page, tuple(drawn))


def compute_details(study: Any, run: ReportData) -> ReportData:
    """Computes and keeps details of the highlighted designs that have none; a failure is logged, not raised.

    Returns: the run, with its baseline if it had none.
    """
    known = load_details(run.directory)
    missing = [e for e in run.highlights.values() if detail_key(e) not in known and e.status != "failed"]
    wanted = [(e.design, e.flight.get("trajectory")) for e in missing]
    unknown = run.baseline is None and study.baseline is not None
    if unknown:
        wanted.append((study.baseline.to_dict(), None))
    if not wanted:
        return run
    from codesign.report.compute import compute_detail

    def compute(asked: tuple[dict[str, DesignValue], str | None]) -> Evaluation | None:
        try:
            detail = compute_detail(study, *asked)
        except CodesignError as error:
            logger.warning("no details of design %s: %s", asked[0], error)
            return None
        try:
            save_detail(run.directory / FOLDER, detail)
        except OSError as error:
            logger.warning("details of design %s are not kept: %s", asked[0], error)
        return detail.evaluation

    with native_threads(len(wanted)) as pool:  # a handful; the native chain releases the GIL
        evaluations = list(pool.map(compute, wanted))
    return replace(run, baseline=evaluations[-1]) if unknown else run


def with_absent_meshes(run: ReportData, study: Any, packages: tuple[Path, ...] | None = None) -> ReportData:
    """The run with a note on meshes of the robot that the pictures lack, which is logged too."""
    if study is None:
        return run
    note = absence_in_words(absent_meshes(study.base_robot, package_paths() if packages is None else packages))
    if not note:
        return run
    logger.warning(note)
    return replace(run, notes=(*run.notes, note))


def _picture(data: FigureData) -> bytes | None:
    """PNG of the robot, None where it cannot be drawn."""
    from PIL import Image

    try:
        picture = hero(data)
    except CodesignError as error:
        logger.warning("no picture of the robot: %s", error)
        return None
    if picture is None:
        return None
    stream = io.BytesIO()
    Image.fromarray(picture).quantize(128, method=Image.Quantize.FASTOCTREE).save(stream, "PNG", optimize=True)
    return stream.getvalue()


def _shown(run: ReportData, details: dict[str, Detail]) -> dict[str, Detail]:
    """Details of designs that the page shows."""
    designs: list[Evaluation] = [entry.evaluation for entry in run.entries]
    if run.baseline is not None:
        designs.append(run.baseline)
    keys = {detail_key(evaluation) for evaluation in designs}
    return {key: detail for key, detail in details.items() if key in keys}


def _write(path: Path, text: str) -> Path:
    try:
        return write_text(path, text)
    except OSError as error:
        raise StoreError(f"{path}: cannot be written: {error.strerror or error}") from error
