"""Lazy runs: the same front as whole ones, the same rows whatever workers and cache do."""

import json

import pytest

from codesign.problem.evaluation import Evaluation
from codesign.problem.pareto import rival_of
from codesign.search.optimization import optimize, resume
from codesign.search.rivals import Rivals
from fake_study import LazyStudy, study


def rows(run):
    return [record.identity() for record in run.records]


def lazy(**options):
    return LazyStudy(json.dumps(options))


@pytest.mark.parametrize("algorithm", ["nsga2", "random"])
def test_the_front_is_that_of_a_whole_run(tmp_path, algorithm):
    settings = {"algorithm": algorithm, "evaluations": 40, "cache": None, "workers": 1}
    whole = optimize(lazy(), out=tmp_path / "whole", **settings)
    run = optimize(lazy(), out=tmp_path / "lazy", lazy=True, **settings)
    assert run.counts.get("skipped", 0) >= 5
    assert "skipped" not in whole.counts
    for record in run.records:
        if record.evaluation.status == "skipped":
            assert record.evaluation.constraints == {}
            number = int(record.evaluation.reason.split()[-1])
            better = run.records[number].evaluation
            assert better.status == "feasible"
            assert all(better.objectives[k] <= v for k, v in record.evaluation.objectives.items())
    if algorithm == "random":  # the same designs
        assert [r.grid for r in run.front] == [r.grid for r in whole.front]
    assert all(r.evaluation.constraints for r in run.front)


@pytest.mark.parametrize(("algorithm", "part", "total"), [("surrogate", 14, 22), ("nsga2", 20, 30)])
def test_workers_interruptions_and_a_warm_cache_change_no_row(tmp_path, algorithm, part, total):
    fake = lazy(jitter=0.01, execution={"lazy": None if algorithm == "surrogate" else True})
    settings = {"algorithm": algorithm, "population": 10, "evaluations": total}
    one = optimize(fake, out=tmp_path / "one", workers=1, cache=None, **settings)
    assert one.settings["lazy"]  # the surrogate search prefers it
    optimize(fake, out=tmp_path / "part", workers=2, cache=None, **settings | {"evaluations": part})
    resumed = resume(tmp_path / "part", evaluations=total, workers=2)
    cache = tmp_path / "cache"
    optimize(fake, out=tmp_path / "fill", workers=1, cache=cache, **settings, lazy=False)
    warm = optimize(fake, out=tmp_path / "warm", workers=2, cache=cache, **settings)
    assert rows(resumed) == rows(one)
    assert rows(warm) == rows(one)
    assert any(record.cached for record in warm.records)
    assert warm.counts.get("skipped", 0) > 0 or algorithm == "surrogate"


def test_the_study_has_the_last_word(tmp_path):
    said = lazy(execution={"lazy": False})
    run = optimize(said, out=tmp_path / "a", algorithm="surrogate", evaluations=12, workers=1, cache=None)
    assert not run.settings["lazy"]
    run = optimize(study(), out=tmp_path / "b", algorithm="nsga2", evaluations=12, workers=1, cache=None)
    assert not run.settings["lazy"]


def test_rivals_are_the_front_of_what_was_told():
    def told(*pairs):
        return [Evaluation({}, "feasible", objectives={"a": a, "b": b}) for a, b in pairs]

    rivals = Rivals(("a", "b"))
    rivals.add(0, [Evaluation.failure({}, "x"), *told((1.0, 3.0), (3.0, 1.0))])
    rivals.add(3, told((2.0, 2.0), (3.0, 3.0), (0.5, 2.5)))
    assert [number for number, _ in rivals.front] == [2, 3, 5]
    assert rival_of(rivals.front, (2.0, 2.0)) == 3
    assert rival_of(rivals.front, (1.9, 2.0)) is None
