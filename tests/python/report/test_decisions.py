"""What the report says decides: ties within the noise of paired seeds, the load case, when and where."""

import pytest

from codesign.report.page.validation import _change_cell
from codesign.report.recommendation import decided
from codesign.report.validation import ORIGINAL, Disturbance, Flight, Validation


def validation(changes: list[float]) -> Validation:
    """The original and a design on disturbed flights of a seed each, where the design differs by these shares."""
    flights = []
    for seed, change in enumerate(changes):
        for role, value in ((ORIGINAL, 2.0), ("recommended", 2.0 * (1.0 + change))):
            flights.append(Flight(role, {}, "envelope", seed, True, None, {"momentum": value}, {}))
    return Validation(tuple(flights), Disturbance())


def test_the_noise_is_two_standard_errors_of_paired_changes() -> None:
    """Changes of -1, 0, 1 % have a deviation of 1 %: ± 2 · 1 % / √3; two pairs say nothing."""
    assert validation([-0.01, 0.0, 0.01]).noise("recommended", "momentum") == pytest.approx(2 * 0.01 / 3**0.5)
    assert validation([-0.01, 0.01]).noise("recommended", "momentum") is None


def test_a_change_within_the_noise_is_a_tie() -> None:
    """A mean of 0.1 % with a noise of 0.5 % is one, a mean of -2 % is not, and neither is any without known noise."""
    assert _change_cell([0.0, 0.002], 0.005).startswith("<td>tie")
    assert 'class="good"' in _change_cell([-0.021, -0.019], 0.005)
    assert "tie" not in _change_cell([0.0, 0.002], None)


def test_the_deciding_load_case_is_told_with_time_place_and_fatigue() -> None:
    """Case, instant, link, place in millimeters, flights to failure; nothing of a part with one case."""
    case = {"safety_factor": 12.0, "fatigue": {"damage": 1e-6, "flights": 1e6}}
    part = {
        "load_case": "flown", "time": 35.552, "link": "r_forearm", "peak_position": [0.001, 0.02, -0.0035],
        "cases": {"thrust": {"safety_factor": 15.0}, "flown": case},
    }  # fmt: skip
    told = decided(part)
    for words in ("of its 2 load cases flown decides", "35.55", "(1.0, 20.0, -3.5)", "1e+06 such flights"):
        assert words in told
    assert decided(part | {"cases": {"flown": case}}) == ""
