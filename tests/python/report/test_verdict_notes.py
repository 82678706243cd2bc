"""Notes on a design that may be built: what was not checked, which limits of the thrust its flight meets."""

import pytest

from codesign.problem.evaluation import Evaluation
from codesign.report.verdict import UNCHECKED, watch

CHECKED = {"body_clearance": 0.01}


def flown(**flight) -> Evaluation:
    """A feasible design with these numbers of its flight."""
    return Evaluation({"wall": 1.0}, "feasible", None, flight={"duration": 12.0, **flight})


def test_collisions_that_were_not_checked_are_said():
    assert watch(flown()) == [UNCHECKED]
    assert watch(flown(interference=CHECKED)) == []
    assert watch(Evaluation({"wall": 1.0}, "feasible", None)) == []  # parts alone


@pytest.mark.parametrize(("share", "said"), [(0.0101, True), (0.01, False)])
def test_a_thrust_that_is_often_at_its_limit_is_said(share, said):
    saturation = {"thrust_at_least": share, "thrust_at_most": 0.0}
    notes = watch(flown(interference=CHECKED, saturation=saturation, min_thrust=0.205))
    assert len(notes) == said
    if said:
        assert "1\u202f% of the flight" in notes[0]
        assert "smallest that is allowed (it reached 0.205\u202fN)" in notes[0]
