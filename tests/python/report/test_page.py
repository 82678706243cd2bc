"""The page in a real browser: silent, alone, and everything can be clicked."""

import csv
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import synthetic_run
from browser import open_browser, visit
from codesign.report import write_report
from codesign.report.details import FOLDER, save_detail
from codesign.report.page.what_if import what_if_models
from codesign.report.pareto import normalized
from codesign.report.reading import read_report_data
from synthetic_details import detail

STUDY = synthetic_run.Study()
PEAK = detail(synthetic_run.evaluate(synthetic_run.BASELINE)).parts["jetpack_bracket"].von_mises.max() / 1e6


def marker(page: Any, design: int) -> Any:
    """The mark of a best compromise in the chart, as it is drawn."""
    best = page.evaluate("designs.map((d, i) => i).filter(i => designs[i].front)")
    trace = page.locator("#front .scatterlayer .trace").filter(has=page.locator(f".point:nth-child({len(best)})"))
    counts = [trace.nth(k).locator(".point").count() for k in range(trace.count())]
    return trace.nth(counts.index(len(best))).locator(".point").nth(best.index(design))


def middle(mark: Any) -> tuple[float, float]:
    """Center of what is drawn [pixels]."""
    box = mark.bounding_box()
    return box["x"] + box["width"] / 2.0, box["y"] + box["height"] / 2.0


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    yield from open_browser()


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> str:
    folder: Path = tmp_path_factory.mktemp("report") / "run"
    synthetic_run.write_run(folder, synthetic_run.evaluations(200))
    run = read_report_data(folder, STUDY, synthetic_run.evaluate(synthetic_run.BASELINE))
    for evaluation in run.highlights.values():
        save_detail(folder / FOLDER, detail(evaluation))
    return write_report(folder, study=STUDY, figures=False).html.as_uri()


def test_the_chart_selects_on_click_rings_hovered_rows_and_changes_axes(browser, address):
    with visit(browser, address) as page:
        page.locator("#front").scroll_into_view_if_needed()
        page.wait_for_selector("#front .points path")
        selected = page.evaluate("designs[report.recommended].f.slice(0, 2)")
        assert page.evaluate("[element('front').data[5].x[0], element('front').data[5].y[0]]") == selected
        wanted = page.evaluate("designs.findIndex((d, i) => d.front && i !== report.recommended)")
        page.mouse.click(*middle(marker(page, wanted)))
        page.wait_for_function("i => state.selected === i", arg=wanted)
        name = f"Design {page.evaluate('i => designs[i].id', wanted)}"
        assert page.locator("#card h2").inner_text() == name
        assert name in page.locator("#parts-and-flight-title").inner_text()
        assert page.locator("#designs-body tr[aria-selected=true]").get_attribute("data-design") == str(wanted)
        row = page.locator("#designs-body tr").nth(2)
        row.scroll_into_view_if_needed()
        row.hover()
        hovered = int(row.get_attribute("data-design"))
        page.locator(f"#designs-body tr.hover[data-design='{hovered}']").wait_for()
        page.wait_for_timeout(300)
        ring = page.locator("#front .scatterlayer .point").last
        assert middle(ring) == pytest.approx(middle(marker(page, hovered)), abs=1.0)
        page.select_option("#axis-y", "2")
        assert page.locator("#front .ytitle").text_content() == "Thrust (N)"
        page.select_option("#axis-x", "2")
        assert page.evaluate("[front.x, front.y]") == [2, 0]


def test_weights_of_the_objectives_choose_another_design(browser, address):
    with visit(browser, address) as page:
        values = np.array(page.evaluate("report.choices.map(i => designs[i].f)"))
        for weights in ([10, 10, 10], [20, 3, 1], [0, 0, 20]):
            for k, weight in enumerate(weights):
                page.locator(f"#weight-{k}").fill(str(weight))
            losses = normalized(values) * weights
            wanted = int(np.argmin(losses.max(axis=1) + 1e-4 * losses.sum(axis=1)))
            chosen = page.locator("#weights-choice button")
            assert chosen.get_attribute("data-select") == str(page.evaluate("k => report.choices[k]", wanted))
        chosen.click()
        page.wait_for_function(
            "state.selected === Number(document.querySelector('#weights-choice button').dataset.select)"
        )
        assert page.locator("#weights b").all_inner_texts() == ["0 %", "0 %", "100 %"]
        page.locator("#weight-2").fill("0")
        assert page.locator("#weights-choice").inner_text() == "Give one of them a weight."


def test_the_table_sorts_filters_and_follows_the_arrow_keys(browser, address):
    with visit(browser, address) as page:
        page.click("[data-filter=feasible]")
        page.click("[data-column='5']")
        values = page.evaluate("table.rows.map(i => designs[i].f[0])")
        assert values == sorted(values)
        page.click("[data-column='5']")
        assert page.evaluate("table.rows.map(i => designs[i].f[0])") == values[::-1]
        assert page.locator("th[aria-sort=descending]").count() == 1
        rows = page.evaluate("table.rows")
        page.locator("#designs-body tr").first.click()
        page.keyboard.press("ArrowDown")
        assert page.evaluate("state.selected") == rows[1]


def test_parts_and_flight_are_drawn_for_designs_with_details_and_pointed_to_from_others(browser, address):
    with visit(browser, address) as page:
        page.evaluate("select(report.baseline)")
        page.locator("#solid-0").scroll_into_view_if_needed()
        page.wait_for_function("document.querySelector('#solid-0 canvas') !== null")
        assert page.locator("#parts .scale").first.inner_text().split()[-2:] == [f"{PEAK:.3g}", "MPa"]
        assert (
            len(Image.open(BytesIO(page.locator("#solid-0 canvas").first.screenshot())).convert("L").getcolors()) > 20
        )
        page.locator("#history-2").scroll_into_view_if_needed()
        page.wait_for_function("document.querySelectorAll('#history-2 .scatterlayer .trace').length === 4")
        page.evaluate("select(designs.findIndex(d => d.status === 0 && !report.details[d.detail]))")
        assert "kept for Design" in page.locator("#parts-absent").inner_text()
        page.locator("#parts-absent [data-select]").first.click()
        assert page.evaluate("state.selected === report.recommended")


def test_the_table_is_saved_as_csv(browser, address):
    with visit(browser, address) as page:
        with page.expect_download() as download:
            page.click("[data-save=table]")
        rows = list(csv.reader(Path(download.value.path()).read_text(encoding="utf-8-sig").splitlines()))
        assert len(rows) == 1 + page.evaluate("designs.length")
        assert rows[0][:3] == ["Status", "Design", "Bracket angle (°)"]
        assert {row[0] for row in rows[1:]} == {"feasible", "infeasible", "failed"}


def test_on_a_phone_the_menu_is_whole_and_the_table_says_that_it_continues(browser, address):
    with visit(browser, address, width=390) as page:
        assert page.locator("#designs-sideways").is_visible()
        last = page.locator("nav a").last.bounding_box()
        assert last["x"] + last["width"] < 390


def test_on_paper_everything_is_drawn_and_charts_fill_their_columns(browser, address):
    with visit(browser, address) as page:
        page.evaluate("window.dispatchEvent(new Event('beforeprint'))")
        page.emulate_media(media="print")
        page.wait_for_function("document.querySelectorAll('.history .main-svg').length > 0")
        sizes = page.evaluate(
            "[...document.querySelectorAll('.js-plotly-plot')].map(n => "
            "[n.querySelector('.main-svg')?.clientWidth, n.clientWidth])"
        )
        assert len(sizes) >= 6
        assert all(drawn is None or drawn == pytest.approx(room, abs=2) for drawn, room in sizes)
        assert page.locator("#parts .scale").first.is_visible()
        page.evaluate("window.dispatchEvent(new Event('afterprint'))")
        assert page.evaluate("document.documentElement.classList.contains('printing')") is False


def test_sliders_predict_what_the_models_in_python_predict(browser, address):
    run = read_report_data(Path(address.removeprefix("file://")).parent, STUDY)
    models = what_if_models(run)
    with visit(browser, address) as page:
        page.locator("#what-if").scroll_into_view_if_needed()
        page.wait_for_selector("#what-if-numbers .predicted")
        for grid in ((8, 10, 4, 33), (20, 2, 15, 7)):
            shown = page.evaluate("g => whatIf.numbers.map(model => predicted(model, g))", list(grid))
            for number, found in zip(models.numbers, shown, strict=True):
                expected = models.predict(grid)[number.key]
                width = expected.bands[1][1] - expected.bands[1][0]
                assert found["mean"] == pytest.approx(expected.mean, abs=0.01 * width)
                for ends, wanted in zip(found["bands"], expected.bands, strict=True):
                    assert ends == pytest.approx(wanted, abs=0.02 * width)
            assert page.evaluate("g => completes(g)", list(grid)) == pytest.approx(models.completes(grid), abs=1e-3)
        assert page.locator("#what-if-notes .notice").count() == 0
        page.evaluate("element('slider-0').value = 78")
        page.evaluate("element('slider-0').dispatchEvent(new Event('input', {bubbles: true}))")
        page.wait_for_selector("#what-if-notes .notice.bad")
        assert "outside of all designs" in page.locator("#what-if-notes").inner_text()
        assert page.locator("#what-if-numbers .band .wide").count() == 0
        page.click("#what-if-selected")
        assert "This design was evaluated" in page.locator("#what-if-notes").inner_text()
        assert page.locator("#what-if-numbers .predicted").first.inner_text().count("evaluated") == 1


@pytest.mark.parametrize(("dark", "width"), [(True, 1280), (False, 380)])
def test_the_page_fits_its_window_in_light_and_dark(browser, address, dark, width):
    with visit(browser, address, width=width, dark=dark) as page:
        assert page.evaluate("document.documentElement.dataset.theme") == ("dark" if dark else "light")
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        page.click("#theme")
        assert page.evaluate("document.documentElement.dataset.theme") == ("light" if dark else "dark")


@pytest.mark.parametrize("kind", ["none feasible", "one design", "empty"])
def test_odd_runs_open_without_errors(browser, tmp_path, kind):
    everything = synthetic_run.evaluations(80)
    chosen = {
        "none feasible": [e for e in everything if e.status != "feasible"],
        "one design": everything[-1:],
        "empty": [],
    }[kind]
    synthetic_run.write_run(tmp_path / "run", chosen)
    with visit(
        browser, write_report(tmp_path / "run", study=STUDY, compute=False, figures=False).html.as_uri()
    ) as page:
        assert page.locator("h1").inner_text() == STUDY.title
        assert page.locator("#provenance").count() == 1


def test_of_many_designs_those_in_view_are_drawn_and_the_front_whole(browser, tmp_path, monkeypatch):
    monkeypatch.setattr("codesign.surrogate.what_if.MOST_POINTS", 30)
    synthetic_run.write_run(tmp_path / "run", synthetic_run.evaluations(4000))
    written = write_report(tmp_path / "run", study=STUDY, figures=False, compute=False).html
    with visit(browser, written.as_uri()) as page:
        page.wait_for_selector("#front .points path")
        front, behind = page.evaluate("[points(d => d.front).length, points(d => !d.front && d !== original).length]")
        page.evaluate("Plotly.relayout('front', {'xaxis.autorange': true, 'yaxis.autorange': true})")
        page.locator("#front-thinned", has_text="designs in view").wait_for()
        drawn = page.evaluate("element('front').data.map(trace => trace.x.length)")
        assert drawn[2] == front
        assert drawn[0] + drawn[1] < behind
        left = behind - drawn[0] - drawn[1]
        assert page.locator("#front-thinned").inner_text().startswith(f"{left} of {behind} designs in view")
        page.locator("[data-filter=all]").click()
        assert page.locator("#designs-body tr[data-design]").count() < 400
        assert page.evaluate("table.height % 1") == 0.0  # else lines between rows jump by a pixel in the first column
        last = page.evaluate("select(table.rows.at(-1)), table.rows.at(-1)")
        row = page.locator(f"#designs-body tr[data-design='{last}'][aria-selected=true]")
        row.focus()
        page.keyboard.press("Home")
        page.locator("#designs-body tr:focus[data-design='0']").wait_for()
        page.keyboard.press("ArrowDown")
        page.locator("#designs-body tr:focus[data-design='1'][aria-selected=true]").wait_for()
