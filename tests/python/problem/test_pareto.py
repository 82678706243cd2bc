"""Fronts: against their definition, equal rows and missing numbers included."""

import numpy as np
import pytest
from numpy.typing import NDArray

from codesign.problem.pareto import FrontTracker, Hypervolume, joined, non_dominated


def by_definition(values: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Row by row."""
    return np.array([not any((other <= row).all() and (other < row).any() for other in values) for row in values], bool)


def samples() -> list[NDArray[np.float64]]:
    """Small integers, so that equal numbers and equal rows are frequent; some with missing numbers."""
    random = np.random.default_rng(1)
    found = []
    for case in range(200):
        values = random.integers(0, random.integers(2, 30), (random.integers(0, 40), random.integers(1, 5))).astype(
            float
        )
        if case % 5 == 0 and len(values):
            values[random.integers(len(values)), 0] = np.nan
        found.append(values)
    return found


def test_a_front_is_what_no_other_row_dominates() -> None:
    for values in samples():
        assert non_dominated(values).tolist() == by_definition(values).tolist()


def test_a_sum_that_rounding_makes_equal_hides_no_dominated_row() -> None:
    values = np.array([[1.0, 1e-30], [1.0, 0.0], [0.0, 1.0]])
    assert non_dominated(values).tolist() == [False, True, True]


def test_a_front_and_new_rows_join_to_the_front_of_all() -> None:
    for values in samples():
        half = len(values) // 2
        first = values[:half][by_definition(values[:half])]
        masks = joined(first, values[half:])
        assert np.concatenate(masks).tolist() == by_definition(np.vstack([first, values[half:]])).tolist()


def test_the_tracked_hypervolume_is_that_of_all_that_was_added() -> None:
    values = np.random.default_rng(2).random((300, 3))
    tracker, box = FrontTracker(["a", "b", "c"]), Hypervolume(values[:10])
    for end in range(10, 301, 10):
        assert tracker.add_values(values[end - 10 : end]) == pytest.approx(box.of(values[:end]), rel=1e-12)
