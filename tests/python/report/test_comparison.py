"""Two runs in one report: shares of the gain over the original, one chart, one table."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import synthetic_run
from browser import open_browser, visit
from codesign.errors import StoreError
from codesign.problem.quantities import quantity
from codesign.report import write_report
from codesign.report.comparison import ComparedRun, load_comparison, reached, shares_in_words
from codesign.report.data import Entry, ReportData
from codesign.report.figures import FigureData, fronts
from codesign.report.reading import read_report_data
from codesign.storage.runs import load_run

STUDY = synthetic_run.Study()


@pytest.fixture(scope="module")
def folders(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    base = tmp_path_factory.mktemp("runs")
    other = synthetic_run.evaluations(80, seed=2)
    return (
        synthetic_run.write_run(base / "long", synthetic_run.evaluations(200)),
        synthetic_run.write_run(base / "short", other),
    )


@pytest.fixture(scope="module")
def run(folders: tuple[Path, Path]) -> ReportData:
    return read_report_data(folders[0], STUDY, synthetic_run.evaluate(synthetic_run.BASELINE), compare=[folders[1]])


def squares(*compared: float, own: float = 0.0, original: float = 1.0) -> ReportData:
    """A run with one best design at (own, own), others with one at (x, x), the original at (original, original)."""

    def evaluation(value: float) -> Any:
        return replace(
            synthetic_run.evaluate(synthetic_run.BASELINE), status="feasible", objectives={"a": value, "b": value}
        )

    return ReportData(
        directory=Path(),
        title="",
        description="",
        variables=synthetic_run.SPACE.variables,
        objectives=(quantity("a"), quantity("b")),
        entries=(Entry(0, evaluation(own)),),
        baseline=evaluation(original),
        compared=tuple(ComparedRun(f"run {x}", 1, (0,), np.array([[x, x]])) for x in compared),
    )


def test_shares_are_those_of_squares() -> None:
    """The box ends at 1.1: the original dominates 0.1², the run 1.1², the other 0.6² of it."""
    found = reached(squares(0.5))
    assert [each.volume for each in found] == pytest.approx([1.0, 0.36 / 1.21])
    assert [each.share for each in found] == pytest.approx([1.0, 0.35 / 1.2])
    assert [each.unbeaten for each in found] == [1, 0]
    assert shares_in_words(squares(0.5)).endswith("gains over the original, 29\u202f% is reached by run 0.5 alone.")


def test_a_better_run_reaches_more_than_all() -> None:
    shares = [each.share for each in reached(squares(0.25, 0.0, own=0.5))]
    assert shares[0] == 1.0
    assert shares[1] is not None and shares[2] is not None and 1.0 < shares[1] < shares[2]


def test_without_a_gain_there_are_no_shares() -> None:
    assert [each.share for each in reached(squares(0.5, own=1.0))] == [None, None]
    assert "gains no hypervolume" in shares_in_words(squares(0.5, own=1.0))
    assert reached(squares()) == [] and shares_in_words(squares()) == ""


def test_the_front_of_the_other_run_is_as_stored(run: ReportData, folders: tuple[Path, Path]) -> None:
    (other,) = run.compared
    assert other.name == "short"  # of the same study: its folder
    assert other.evaluated == 80
    stored = {record.number: record.evaluation.objectives for record in load_run(folders[1]).front}
    assert {i: dict(zip(run.keys, row, strict=True)) for i, row in zip(other.ids, other.values, strict=True)} == stored
    low, high = run.view(0)
    assert low < other.values[:, 0].min() and other.values[:, 0].max() < high
    assert load_comparison(folders[1], run, "another study").name == "synthetic"


def test_runs_that_cannot_be_compared_are_refused(run: ReportData, folders: tuple[Path, Path], tmp_path: Path) -> None:
    fewer = replace(run, objectives=run.objectives[:2], compared=())
    with pytest.raises(StoreError, match="runs with different objectives cannot be compared"):
        load_comparison(folders[1], fewer)
    lost = [e for e in synthetic_run.evaluations(60) if e.status != "feasible"]
    with pytest.raises(StoreError, match="no feasible design"):
        load_comparison(synthetic_run.write_run(tmp_path / "lost", lost), run)


def test_the_figure_names_both_fronts(run: ReportData) -> None:
    figure = fronts.front(FigureData(run))
    (legend,) = figure.legends
    assert "best compromise of short" in [text.get_text() for text in legend.get_texts()]
    drawn = next(c for c in figure.axes[0].collections if c.get_label() == "best compromise of short")
    np.testing.assert_array_equal(drawn.get_offsets(), run.compared[0].values[:, :2])


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    yield from open_browser()


def test_the_page_shows_the_other_front_and_its_share(browser: Any, folders: tuple[Path, Path]) -> None:
    page_file = write_report(folders[0], study=STUDY, figures=False, compute=False, compare=[folders[1]]).html
    with visit(browser, page_file.as_uri()) as page:
        page.locator("#front").scroll_into_view_if_needed()
        page.wait_for_selector("#front .points path")
        assert "best compromise of short" in page.locator(".key").inner_text()
        assert page.locator("#compared tbody tr").count() == 2
        count = page.evaluate("report.compared[0].f.length")
        assert page.locator("#front .scatterlayer .trace").last.locator(".point").count() == count
        before = page.evaluate("state.selected")
        page.evaluate(
            "element('front').emit('plotly_click', {points: [{customdata: undefined}]});"
            "element('front').emit('plotly_hover', {points: [{customdata: undefined}]})"
        )
        assert page.evaluate("state.selected") == before
