"""Predictions for people: honest bands, warnings outside of the sample, what is not modeled."""

import numpy as np
import pytest
from threadpoolctl import threadpool_info, threadpool_limits

import synthetic_run
from codesign.search.settings import Settings
from codesign.surrogate import gaussian_process
from codesign.surrogate.likelihood import fit
from codesign.surrogate.what_if import MOST_POINTS, WhatIf, chosen

OBJECTIVES = ("momentum", "joint_velocity", "thrust")
RUN = synthetic_run.evaluations(160)


@pytest.fixture(scope="module")
def models() -> WhatIf:
    found = WhatIf.of(synthetic_run.SPACE, RUN, [], OBJECTIVES, ("safety_factor",))
    assert found is not None
    return found


def test_bands_hold_as_many_new_designs_as_they_say(models):
    rng = np.random.default_rng(5)
    inside = {share: [] for share in (0, 1)}
    for grid in rng.integers(0, (25, 31, 21, 51), (150, 4)):
        truth = synthetic_run.objectives(*synthetic_run.SPACE.from_indices(grid).values_)
        for key, prediction in models.predict(tuple(grid)).items():
            if key in truth:
                for share, (low, high) in enumerate(prediction.bands):
                    inside[share].append(low <= truth[key] <= high)
    assert np.mean(inside[1]) > 0.85
    assert 0.4 < np.mean(inside[0]) < np.mean(inside[1])


def test_every_number_is_told_with_what_leaving_out_says(models):
    assert [number.key for number in models.numbers] == [*OBJECTIVES, "safety_factor"]
    for number in models.numbers:
        assert number.quality.explained == pytest.approx(1.0 - number.quality.error**2)
        assert number.quality.explained > 0.85
        assert not number.quality.poor


def test_lost_flights_are_foreseen(models):
    assert models.completes((5, 10, 10, 10)) > 0.9
    assert models.completes((50, 10, 10, 10)) < 0.3


def test_outside_of_the_sample_there_is_no_band(models):
    beyond = (78, 10, 10, 10)  # flights are lost there: no design has objectives
    assert not models.inside(beyond)
    assert all(prediction.bands == () for prediction in models.predict(beyond).values())
    assert models.inside((10, 10, 10, 10))


def test_an_evaluated_design_is_its_own_neighbor(models):
    grid = tuple(models.grids[7])
    assert models.nearest(grid) == (models.entries[7], 0)
    assert models.nearest((grid[0] + 1, *grid[1:]))[1] == 1


def test_few_designs_and_numbers_that_hardly_vary_are_not_modeled():
    assert WhatIf.of(synthetic_run.SPACE, RUN[:10], [], OBJECTIVES, ()) is None
    found = WhatIf.of(synthetic_run.SPACE, RUN, [], OBJECTIVES, ("flight_missed_share",))
    assert found is not None
    assert "flight_missed_share" not in [number.key for number in found.numbers]


def test_of_many_designs_the_front_is_kept():
    entries = chosen(5000, list(range(4000, 4100)))
    assert len(entries) == MOST_POINTS
    assert set(range(4000, 4100)) <= set(entries)
    assert entries[0] == 0
    assert chosen(3, [1]) == (0, 1, 2)


def test_linear_algebra_has_one_thread(monkeypatch):
    threads = set()

    def watched(squares, values):
        threads.update(pool["num_threads"] for pool in threadpool_info() if pool["user_api"] == "blas")
        return fit(squares, values)

    monkeypatch.setattr(gaussian_process, "fit", watched)
    search = Settings(algorithm="surrogate", population=12).search(synthetic_run.SPACE, OBJECTIVES)
    with threadpool_limits(2, "blas"):
        assert WhatIf.of(synthetic_run.SPACE, RUN[:40], [], OBJECTIVES[:1], ()) is not None
        search.tell(search.ask(12), RUN[:12])
        assert len(search.ask(1)) == 1
    assert threads == {1}
