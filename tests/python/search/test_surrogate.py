"""The search with models: better than others at equal evaluations, out of bad starts, the same whatever happens."""

import math

import numpy as np
import pytest

from codesign.problem.design_space import DesignSpace, Variable
from codesign.problem.evaluation import Evaluation
from codesign.problem.pareto import Hypervolume, objective_rows
from codesign.search.optimization import optimize, resume
from codesign.search.settings import Settings
from codesign.search.surrogate_search import SurrogateSearch, last_refit
from fake_study import study

GRID = DesignSpace(tuple(Variable(name, 0.0, 29.0, 1.0) for name in "abc"))


def bowls(x):
    return {"near": float(((x - 0.2) ** 2).sum()), "far": float(((x - 0.8) ** 2).sum())}


def evaluated(objectives, margins=None, status=None):
    margins = margins or {}
    feasible = all(margin >= 0 for margin in margins.values())
    violations = {key: max(0.0, -margin) for key, margin in margins.items()}
    status = status or ("feasible" if feasible else "infeasible")
    return Evaluation({}, status, objectives=objectives, margins=margins, violations=violations)


def searched(problem, space=GRID, evaluations=60, names=("near", "far"), **settings):
    """Evaluations of a search, in its order; `problem`: unit coordinates -> evaluation."""
    given = Settings(**{"algorithm": "surrogate", "population": 12, "seed": 1, "evaluations": evaluations} | settings)
    search, found = given.search(space, names), []
    top = np.array(space.levels) - 1
    while len(found) < evaluations:
        grids = search.ask(min(4 if found else given.population, evaluations - len(found)))
        results = [problem(np.array(grid) / top) for grid in grids]
        search.tell(grids, results)
        found += results
        if not grids:
            break
    return search, found


@pytest.mark.parametrize(
    "problem",
    [
        lambda x: evaluated(bowls(x)),
        lambda x: evaluated(bowls(x), {"band": 0.15 - abs(x[0] - x[1] ** 2)}),
        lambda x: evaluated({}, {"lost": x[0] - 0.5}) if x[0] < 0.5 else evaluated(bowls(x), {"lost": 0.0}),
    ],
    ids=["free", "constrained", "half of it lost"],
)
def test_with_equal_evaluations_it_finds_more_than_others(problem):
    fronts = {
        name: objective_rows(searched(problem, algorithm=name, evaluations=40)[1], ("near", "far"))
        for name in ("surrogate", "nsga2", "random")
    }
    box = Hypervolume(np.vstack(list(fronts.values())))
    found = {name: box.of(values) for name, values in fronts.items()}
    assert found["surrogate"] > 1.01 * max(found["nsga2"], found["random"])


def test_a_start_without_any_feasible_design_gets_out():
    def problem(x):
        margin = 0.12 - np.linalg.norm(x - np.array([0.02, 0.98, 0.5]))
        return evaluated(bowls(x), {"ball": margin})

    _, found = searched(problem, evaluations=32)
    assert not any(result.status == "feasible" for result in found[:12])
    assert sum(result.status == "feasible" for result in found[12:]) >= 5


def test_without_any_flown_design_it_goes_where_flights_last_longer():
    def problem(x):
        missed = max(0.0, float(np.linalg.norm(x - np.array([0.02, 0.98, 0.5]))) - 0.12)
        return evaluated({} if missed else bowls(x), {"missed": -missed})

    _, found = searched(problem, evaluations=32)
    assert not any(result.objectives for result in found[:12])
    assert sum(bool(result.objectives) for result in found[12:]) >= 5


def test_failed_designs_are_avoided():
    def problem(x):
        return evaluated(bowls(x)) if x[1] < 0.6 else evaluated({}, status="failed")

    _, found = searched(problem, evaluations=60)
    assert sum(result.status == "failed" for result in found[:12]) >= 3
    assert sum(result.status == "failed" for result in found[20:]) <= 4


def test_all_failed_or_without_numbers_it_goes_on():
    _, found = searched(lambda _: evaluated({}, status="failed"), evaluations=24)
    assert len(found) == 24
    nothing = {"near": math.nan, "far": math.nan}
    _, found = searched(lambda x: evaluated(nothing if x[0] > 0.5 else bowls(x), status="failed"), evaluations=24)
    assert len(found) == 24


def test_one_objective():
    def problem(x):
        return evaluated({"only": float((x[0] - 0.37) ** 2 + 0.3 * (x[1] - 0.8) ** 2 + 0.1 * math.cos(7 * x[2]))})

    _, found = searched(problem, evaluations=40, names=("only",))
    whole = min(
        problem(np.array([a, b, c]) / 29).objectives["only"] for a in (10, 11) for b in (23, 24) for c in range(30)
    )
    assert min(result.objectives["only"] for result in found) == pytest.approx(whole, abs=1e-12)


def test_five_objectives():
    names = tuple("vwxyz")

    def problem(x):
        goals = np.linspace(0.1, 0.9, 5)
        return evaluated({name: float(((x - goal) ** 2).sum()) for name, goal in zip(names, goals, strict=True)})

    found = {
        name: objective_rows(searched(problem, names=names, algorithm=name, evaluations=40)[1], names)
        for name in ("surrogate", "random")
    }
    box = Hypervolume(np.vstack(list(found.values())))
    assert box.of(found["surrogate"]) > 1.02 * box.of(found["random"])


def test_the_ends_of_the_front_are_found_where_they_are_dear():
    """The best of `far` has a value of `near` that is worse than the median design's."""

    def problem(x):
        return evaluated({"near": float(np.exp(6 * x[0]) + x[1] + x[2]), "far": float(1 - x[0] + x[1] + x[2])})

    for seed in (1, 2, 3):
        _, found = searched(problem, evaluations=40, seed=seed)
        near, far = (min(result.objectives[name] for result in found) for name in ("near", "far"))
        assert (near, far) == pytest.approx((1.0, 0.0), abs=1e-12)


def test_constant_objectives_and_constraints_change_nothing():
    _, plain = searched(lambda x: evaluated(bowls(x)), evaluations=32)
    _, more = searched(
        lambda x: evaluated(bowls(x) | {"same": 0.1 * 3}, {"holds": 0.1, "exactly": 0.0}),
        evaluations=32,
        names=("near", "far", "same"),
    )
    assert [r.objectives["near"] for r in more] == [r.objectives["near"] for r in plain]


def test_names_have_no_order():
    space = DesignSpace((Variable("a", 0.0, 19.0, 1.0), Variable.listed("alloy", list("mnopqrst"))))
    offsets = [0.9, 0.1, 0.8, 0.5, 0.7, 0.02, 0.6, 0.95]

    def problem(x):
        offset = offsets[round(x[1] * 7)]
        return evaluated({"near": x[0] ** 2 + offset, "far": (x[0] - 1) ** 2 + offset})

    search, found = searched(problem, space, evaluations=40)
    assert {grid[1] for grid in search.population()} == {5}
    assert len(search.population()) >= 15
    assert len({tuple(r.objectives.values()) for r in found}) == 40


def test_a_small_grid_ends_up_evaluated_whole():
    space = DesignSpace(tuple(Variable(name, 0.0, 3.0, 1.0) for name in "ab"))
    _, found = searched(lambda x: evaluated(bowls(x)), space, evaluations=50, population=5)
    assert len(found) == 16


def test_lengths_are_fitted_ever_less_often():
    assert [last_refit(now) for now in (1, 12, 30)] == [1, 12, 30 - 1]
    assert last_refit(10**6) > 0.92 * 10**6
    assert len({last_refit(now) for now in range(1, 201)}) < 60


def test_workers_and_interruptions_change_no_row(tmp_path, monkeypatch):
    fake = study(jitter=0.01, faults={"3,3,3": "raise"})
    settings = {"algorithm": "surrogate", "population": 10, "evaluations": 26, "cache": None}
    one = optimize(fake, out=tmp_path / "one", workers=1, **settings)
    two = optimize(fake, out=tmp_path / "two", workers=2, **settings)
    part = {**settings, "evaluations": 16}
    optimize(fake, out=tmp_path / "part", workers=2, **part)
    proposals = []
    propose = SurrogateSearch._propose
    monkeypatch.setattr(SurrogateSearch, "_propose", lambda self, n: proposals.append(n) or propose(self, n))
    resumed = resume(tmp_path / "part", evaluations=26, workers=2)
    rows = [record.identity() for record in one.records]
    assert [record.identity() for record in two.records] == rows
    assert [record.identity() for record in resumed.records] == rows
    assert proposals == [4, 4, 4]  # those from the designs 14, 18 and 22 on: stored batches are not made again
    assert len(one.front) > 5


def test_steady_state_takes_what_is_pending_for_what_it_predicts(tmp_path):
    fake = study(jitter=0.01)
    settings = {"algorithm": "surrogate", "population": 10, "evaluations": 18, "cache": None, "steady": True, "lag": 4}
    one = optimize(fake, out=tmp_path / "one", workers=1, **settings)
    two = optimize(fake, out=tmp_path / "two", workers=2, **settings)
    assert [record.identity() for record in one.records] == [record.identity() for record in two.records]
    assert len({record.grid for record in one.records}) == 18


def test_the_budget_is_its_own_unless_told():
    fake = study(optimizer={"algorithm": "surrogate"})
    from codesign.search.optimization import _budget

    assert _budget(fake, "surrogate", 8, None) == 200
    assert _budget(fake, "surrogate", 8, 3) == 24
    assert _budget(fake, "nsga2", 8, None) == 40
    assert _budget(study(optimizer={"evaluations": 77}), "surrogate", 8, None) == 77


def test_wrong_options_are_refused():
    with pytest.raises(ValueError, match="batch = 0"):
        Settings(algorithm="surrogate", options={"batch": 0}).plan(GRID, ("near",))
