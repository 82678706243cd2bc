"""Searches as a whole: determinism, duplicates, stopping, what runs hold."""

import sys

import numpy as np
import pymoo.algorithms.moo
import pytest

from codesign.errors import ExecutionError, StudyError
from codesign.problem.evaluation import Evaluation
from codesign.problem.pareto import non_dominated
from codesign.search.optimization import evaluate_designs, optimize, resume, sweep
from codesign.search.registry import BUILT_IN
from codesign.search.sampling import RandomSearch, start_points, sub_grid
from codesign.search.settings import Settings
from codesign.storage.runs import Run
from evolution_checks import WITH_NUMBA, check_evolution, tell_all
from fake_study import study


def identities(run: Run) -> list[dict]:
    return [record.identity() for record in run.search_records]


@pytest.mark.parametrize("algorithm", sorted(set(BUILT_IN) - {"random", "listed", "surrogate"} - WITH_NUMBA))
@pytest.mark.parametrize("batch", [12, 1])
def test_evolution_is_deterministic_and_never_asks_twice(algorithm: str, batch: int) -> None:
    check_evolution(algorithm, batch)


@pytest.mark.parametrize("algorithm", sorted(WITH_NUMBA))
def test_a_search_names_the_package_that_it_lacks(algorithm: str, monkeypatch: pytest.MonkeyPatch) -> None:
    for module in ("age", "age2"):
        monkeypatch.delitem(sys.modules, f"pymoo.algorithms.moo.{module}", raising=False)
        monkeypatch.delattr(pymoo.algorithms.moo, module, raising=False)
    monkeypatch.setitem(sys.modules, "numba", None)
    fake = study()
    with pytest.raises(ExecutionError, match=rf"{algorithm} needs the package numba \(pip install 'codesign\[age\]'\)"):
        Settings(algorithm, population=12).search(fake.space, fake.objectives)


def test_another_seed_gives_another_search() -> None:
    fake = study()
    starts = {tuple(start_points(fake.space, 8, "sobol", seed)) for seed in range(5)}
    assert len(starts) == 5
    plain = {tuple(start_points(fake.space, 8, "sobol-plain", seed)) for seed in range(5)}
    assert len(plain) == 1


def test_small_grid_is_evaluated_whole_and_once() -> None:
    fake = study(levels=[5, 4, 3])
    search = Settings(population=10).search(fake.space, fake.objectives)
    asked = tell_all(search, fake, 1000, 10)
    assert len(asked) == len(set(asked)) == 60


def test_start_points_are_distinct_and_cover_tiny_grids() -> None:
    fake = study(levels=[2, 2, 1])
    assert sorted(start_points(fake.space, 25, "sobol", 1)) == sub_grid(fake.space, (2, 2, 1))


def test_random_search_covers_the_grid_without_repetition() -> None:
    fake = study(levels=[9, 7, 5])
    asked = RandomSearch(fake.space, 4).ask(10_000)
    assert len(asked) == len(set(asked)) == 9 * 7 * 5


def test_failed_and_infeasible_designs_do_not_steer_by_numbers() -> None:
    """The search is the same whatever objectives infeasible designs carry, and goes on when all designs fail."""
    fake = study()

    def run(objective: float) -> list[tuple[int, ...]]:
        search = Settings(population=10).search(fake.space, fake.objectives)
        asked = []
        for _ in range(8):
            grids = search.ask(10)
            asked += grids
            results = []
            for grid in grids:
                if sum(grid) % 3 == 0:
                    values = dict.fromkeys(fake.objectives, objective)
                    results.append(Evaluation({}, "infeasible", objectives=values, violations={"g": 0.1 * sum(grid)}))
                elif sum(grid) % 3 == 1:
                    results.append(Evaluation.failure({}, "broken"))
                else:
                    results.append(fake.evaluate(fake.space.from_indices(grid)))
            search.tell(grids, results)
        return asked

    assert run(-1e9) == run(1e9)
    corners = Settings(population=10, first=tuple(sub_grid(fake.space, (2, 5, 1))))
    search = corners.search(fake.space, fake.objectives)
    for _ in range(3):
        grids = search.ask(10)
        assert len(grids) == 10
        search.tell(grids, [Evaluation.failure({}, "broken")] * 10)
    assert search.population() == []


def test_one_worker_equals_four_in_any_finishing_order(tmp_path) -> None:
    one = optimize(study(hash="h"), out=tmp_path / "one", workers=1, cache=None, generations=4)
    four = optimize(study(hash="h", jitter=0.02), out=tmp_path / "four", workers=4, cache=None, generations=4)
    assert identities(one) == identities(four)
    assert one.generations == four.generations
    assert len({record.worker for record in four.records}) == 4


def test_steady_state_is_as_deterministic_as_generations(tmp_path) -> None:
    settings = {"cache": None, "steady": True, "evaluations": 60, "lag": 5}
    one = optimize(study(hash="h"), out=tmp_path / "one", workers=1, **settings)
    four = optimize(study(hash="h", jitter=0.02), out=tmp_path / "four", workers=4, **settings)
    generational = optimize(study(hash="h"), out=tmp_path / "other", workers=2, cache=None, evaluations=60)
    assert identities(one) == identities(four) != identities(generational)


def test_front_is_what_brute_force_says(tmp_path) -> None:
    fake = study(levels=[8, 6, 3])
    run = sweep(fake, (8, 6, 3), out=tmp_path / "run", cache=None)
    values = [[e.objectives[name] for name in fake.objectives] for e in run.evaluations if e.status == "feasible"]
    best = [v for v in values if not any(all(np.less_equal(w, v)) and any(np.less(w, v)) for w in values)]
    assert len(run.evaluations) == 8 * 6 * 3
    assert sorted(best) == sorted([r.evaluation.objectives[n] for n in fake.objectives] for r in run.front)


@pytest.mark.parametrize("steady", [False, True])
def test_cache_makes_the_second_run_identical_without_evaluations(tmp_path, steady: bool) -> None:
    fake = study(log=str(tmp_path / "log"))
    first = optimize(fake, out=tmp_path / "a", cache=tmp_path / "cache.sqlite", steady=steady)
    lines = (tmp_path / "log").read_text().splitlines()
    second = optimize(fake, out=tmp_path / "b", cache=tmp_path / "cache.sqlite", steady=steady)
    assert (tmp_path / "log").read_text().splitlines() == lines
    assert len(lines) == len(set(lines)) == 40
    assert identities(first) == identities(second)
    assert all(record.cached for record in second.records)


def test_what_the_caller_leaves_out_is_the_studys(tmp_path) -> None:
    own = study(optimizer={"algorithm": "random", "seed": 7, "population": 4, "generations": 2})
    run = optimize(own, out=tmp_path / "own", cache=None, workers=1)
    wanted = {"algorithm": "random", "seed": 7, "population": 4, "evaluations": 8}
    assert {key: run.settings[key] for key in wanted} == wanted
    given = optimize(own, out=tmp_path / "given", cache=None, workers=1, algorithm="nsga2", seed=3, evaluations=4)
    assert (given.settings["algorithm"], given.settings["seed"]) == ("nsga2", 3)
    with pytest.raises(StudyError, match=r"optimizer.algorithm = 'nsga4': no such search; did you mean 'nsga"):
        optimize(study(optimizer={"algorithm": "nsga4"}), out=tmp_path / "none")
    assert not (tmp_path / "none").exists()


def test_given_designs_open_the_start_population(tmp_path) -> None:
    original = {"a": 3.0, "b": 2.5, "c": 1.0}
    run = optimize(study(), out=tmp_path / "run", cache=None, generations=1, first=[original])
    assert run.evaluations[0].design == original
    assert len(run.evaluations) == 8


def test_stops_when_the_hypervolume_stalls(tmp_path) -> None:
    run = optimize(study(levels=[4, 4, 4]), out=tmp_path / "run", cache=None, generations=8, stall_generations=2)
    assert len(run.evaluations) < 64
    assert "stalled" in run.sessions[-1]["outcome"]


def test_stops_after_wall_time(tmp_path) -> None:
    run = optimize(study(seconds=0.05), out=tmp_path / "run", cache=None, generations=999, wall_time=1.0)
    assert 8 <= len(run.evaluations) < 400
    assert run.finished


def test_what_the_wall_time_left_out_is_told_and_made_up_for(tmp_path) -> None:
    run = optimize(study(seconds=0.05), out=tmp_path / "run", cache=None, evaluations=24, wall_time=0.01)
    assert run.missing == 24 - len(run.evaluations) > 0
    assert run.finished
    again = resume(tmp_path / "run")
    assert (again.missing, len(again.evaluations), again.outcome) == (0, 24, "budget used up")
    assert again.evaluations[: len(run.evaluations)] == run.evaluations


def test_evaluates_listed_designs(tmp_path) -> None:
    designs = [{"a": 1.0, "b": 0.5, "c": 0.0}, {"a": 2.0, "b": 0.5, "c": 0.0}]
    run = evaluate_designs(study(), designs, out=tmp_path / "run", cache=None)
    assert [e.design for e in run.evaluations] == designs


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"algorithm": "nsga"}, "algorithm"),
        ({"start": "best"}, "start"),
        ({"population": 1}, "population"),
        ({"lag": -1}, "lag"),
        ({"wall_time": float("nan")}, "wall_time"),
        ({"wall_time": float("inf")}, "wall_time"),
    ],
)
def test_wrong_settings_are_refused_before_anything_is_written(tmp_path, settings, message) -> None:
    with pytest.raises(ValueError, match=message):
        optimize(study(), out=tmp_path / "run", cache=None, **settings)
    assert not (tmp_path / "run").exists()


def test_non_dominated_keeps_equal_rows() -> None:
    values = np.array([[0.0, 1.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [0.5, 0.5]])
    assert non_dominated(values).tolist() == [True, True, True, False, True]
