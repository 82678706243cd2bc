"""The table of numbers is that of evaluations, and the page that of the table."""

from pathlib import Path

import pytest

from codesign.chain.documents import FLIGHT_NUMBERS
from codesign.chain.study import load_study
from codesign.problem.numbers import NUMBERS, known_number, number_names
from codesign.problem.quantities import OF_A_PART, QUANTITIES
from codesign.study.number_page import numbers_page

PAGE = Path(__file__).parents[3] / "docs" / "numbers.md"


def number_paths(node, path=""):
    """Paths of all numbers, and of those that are missing, in a document."""
    if isinstance(node, dict | list | tuple):
        for name, child in node.items() if isinstance(node, dict) else enumerate(node):
            yield from number_paths(child, f"{path}.{name}" if path else str(name))
    elif not isinstance(node, bool | str):
        yield path


@pytest.mark.parametrize(
    ("name", "design"),
    [
        ("gimbal_quad", {"reach": 200, "height": 30}),
        ("hexarotor", {"propeller": "8in", "tilt": 25, "tube": "12x2"}),
    ],
)
def test_every_number_of_an_evaluation_is_known_and_every_known_one_is_there(name, design):
    study = load_study(name)
    evaluation = study.evaluate(design)
    sections = {key: getattr(evaluation, key) for key in ("parts", "flight", "objective_families")}
    paths = [path for path in number_paths(sections) if not path.endswith("left_out")]
    assert [path for path in paths if known_number(path) is None] == []
    unmatched = {n.path for n in NUMBERS if not n.needs and not any(map(n.matches, paths))}
    refined = {"parts.PART.refinements", "parts.PART.change", "parts.PART.cases.CASE.change"}
    assert unmatched == {*refined, "flight.failure_time"}


def test_numbers_with_short_names_and_those_of_the_flight_are_known():
    assert [key for key in QUANTITIES if known_number(key) is None] == []
    assert {f"flight.{name}" for name in FLIGHT_NUMBERS} <= set(number_names("flight."))
    assert {f"parts.PART.{name}" for name in OF_A_PART} <= set(number_names("parts.PART."))
    for family in ("rms", "script", "paper"):
        assert len(number_names(f"objective_families.{family}.")) == 3


def test_the_page_is_current():
    assert PAGE.read_text(encoding="utf-8") == numbers_page(), "run: python scripts/study_reference.py"
    assert all(f"`{number.path}`" in PAGE.read_text(encoding="utf-8") for number in NUMBERS)
