"""Numbers of the report stand in the units that are written beside them."""

import re
from dataclasses import replace
from pathlib import Path

import pytest

from codesign.problem.design_space import Variable
from codesign.problem.evaluation import Evaluation
from codesign.problem.quantities import quantity
from codesign.report.comparison import ComparedRun
from codesign.report.data import Entry, ReportData
from codesign.report.page.comparison import comparison_table
from codesign.report.page.document import page_document
from codesign.report.page.summary import summary
from codesign.report.recommendation import left_out, passed_over, price
from codesign.report.words import better_side, caveats, gained, searched
from codesign.search.progress import Progress, describe

KEYS = ("mass", "max_displacement")


def designs(*objectives: tuple[float, ...]) -> ReportData:
    """A run of designs with masses [kg] and displacements [m]."""
    return ReportData(
        directory=Path("run"),
        title="Bracket",
        description="",
        variables=(Variable("wall", 1, 9, 1, "mm"),),
        objectives=tuple(quantity(key) for key in KEYS[: len(objectives[0])]),
        entries=tuple(
            Entry(k, Evaluation({"wall": k + 1}, "feasible", None, dict(zip(KEYS, values, strict=False))))
            for k, values in enumerate(objectives)
        ),
    )


def test_a_displacement_in_millimeters_is_millimeters_everywhere():
    run = designs((0.08, 0.0008015), (0.09, 0.0006))
    run = replace(run, baseline=run.entries[1].evaluation)
    assert run.values[:, 1] == pytest.approx([0.8015, 0.6])
    assert run.baseline_vector == pytest.approx([0.09, 0.6])
    low, high = run.view(1)
    assert low < 0.6 and high > 0.8015 and high < 1.0
    document = page_document(run)
    assert document["objectives"][1]["unit"] == "mm"
    assert [row["f"] for row in document["designs"]] == [[0.08, 0.8015], [0.09, 0.6]]
    assert ">0.8015</dd><dd><p>mm</p>" in summary(replace(run, entries=run.entries[:1], baseline=None))


def test_a_text_of_a_quantity_has_its_unit():
    assert quantity("max_displacement").text(0.0008015) == "0.8015 mm"
    assert quantity("parts.arm.max_displacement").text(0.0008015) == "0.8015 mm"
    assert quantity("-first_frequency").text(-80.0) == "80 Hz"
    assert quantity("safety_factor").text(2.7) == "2.7"


def test_a_better_design_that_is_passed_over_is_named_in_the_headline():
    run = designs((0.08799,), (0.08944,), (0.095,))
    better, *others = run.entries
    doubtful = replace(better.evaluation, parts={"arm": {"tolerance_reached": False}})
    run = replace(run, entries=(replace(better, evaluation=doubtful), *others))
    assert run.recommended == 1
    told = passed_over(run)
    assert told.startswith(
        "Design 0 has less, 0.08799 kg instead of 0.08944 kg, and is passed over: the stress of the arm"
    )
    page = summary(run)
    assert "Candidate: design 1" in page and "Build design" not in page
    assert page.index(told[:40]) < page.index('class="values"')
    assert left_out(run).startswith("Design 0, among the best found, was left out: the stress of the arm")


def test_the_best_of_a_single_objective_is_recommended():
    run = designs((0.09,), (0.08799,), (0.095,))
    assert run.recommended == 1
    assert passed_over(run) == ""
    assert "Build design 1" in summary(run)
    assert "No design that may be built has less: 0.08799 kg." in summary(run)


def test_a_search_with_one_objective_tells_its_best_value():
    state = Progress(3, 0, 0, 0, 9, 3, 1.0, hypervolume=1.0027, best=quantity("mass").text(0.08799))
    assert "best 0.08799 kg" in describe(state) and "hypervolume" not in describe(state)
    assert "hypervolume 1.0027" in describe(replace(state, best=None))


@pytest.mark.parametrize("width", [80, 60, 40, 24])
def test_a_narrow_line_of_progress_is_not_cut(width):
    """What is done and the time left stay, what matters least goes first."""
    state = Progress(31, 2, 1, 2, 200, 34, 120.0, cached=3, skipped=4, hypervolume=1.0027)
    told = describe(state, width)
    assert len(told) <= width
    assert told.startswith("38/200") and "left " in told
    assert ("/s" in told) == (len(describe(state)) <= width)


def test_a_search_that_was_stopped_before_its_budget_says_so():
    run = replace(designs((0.09,), (0.08,)), planned=34, stopped="wall time of 540 s used up")
    (said, *_) = caveats(run)
    assert "2 of 34 designs were evaluated (wall time of 540 s used up). codesign resume run makes the others" in said


def test_a_maximized_number_reads_forward():
    """Stored as -80 and -100 Hz, it is said to rise from 80 to 100, by a quarter, and is highest at its best."""
    run = designs((1.0, -100.0), (0.9, -80.0), (1.2, -110.0))
    run = replace(run, objectives=(quantity("mass"), quantity("-first_frequency")))
    keyed = [{"mass": mass, "-first_frequency": f} for mass, f in ((1.0, -100.0), (0.9, -80.0), (1.2, -110.0))]
    entries = tuple(
        replace(e, evaluation=replace(e.evaluation, objectives=values))
        for e, values in zip(run.entries, keyed, strict=True)
    )
    run = replace(run, entries=entries, baseline=replace(entries[1].evaluation, design={"wall": 9}))
    run = replace(run, entries=entries[:1])
    assert "to lower mass of the parts, and raise first natural frequency" in searched(run)
    assert gained(run).startswith(
        "Compared with the original, the recommended design raises first natural frequency by 25"
    )
    page = summary(run)
    assert "+25.0\u202f%" in page
    assert "80 → 100 Hz" in page
    assert "validate" not in page and "other flights" not in page  # parts alone
    assert "−" not in re.sub(r"<(script|style).*?</\1>", "", page, flags=re.S)
    both = replace(run, entries=entries, baseline=None)
    assert "first natural frequency" in price(both)
    assert "below the highest among them" in price(both)
    document = page_document(run)
    (first, second) = document["objectives"]
    assert (first["sign"], second["sign"], second["label"]) == (1.0, -1.0, "First natural frequency")
    assert document["designs"][0]["f"] == [1.0, 100.0]
    low, high = second["view"]
    assert 0.0 < low < 80.0 and 100.0 < high < 120.0
    assert better_side(run) == "Lower is better, of first natural frequency higher"
    other = ComparedRun("other", 3, (4,), run.values[:1] * [1.0, 1.2])
    compared = comparison_table(replace(run, compared=(other,)))
    assert "Highest first natural frequency" in compared and "120 Hz <small>+50" in compared
