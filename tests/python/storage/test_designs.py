"""Whole evaluations in the cache: what one run or command has evaluated, no other evaluates again."""

from codesign.followup.reevaluate import revisit
from codesign.problem.evaluation import Evaluation
from codesign.search.optimization import optimize
from codesign.storage.cache import MemoryCache, default_cache_path, open_cache
from codesign.storage.designs import evaluate_once, keep_evaluation, known_evaluation
from fake_study import study


def test_a_design_of_a_run_is_known_to_everything_else(tmp_path):
    fake = study(log=str(tmp_path / "log"), by_trajectory=True)
    run = optimize(fake, out=tmp_path / "run", workers=1, generations=1, cache=tmp_path / "cache")
    design = run.records[3].evaluation.design
    with open_cache(tmp_path / "cache", fake.identity.program) as cache:
        found, known = evaluate_once(fake, design, cache)
        assert known
        assert found.objectives == run.records[3].evaluation.objectives
        first, known = evaluate_once(fake, design, cache, "loop_2")
        assert not known
        second, known = evaluate_once(fake, design, cache, "loop_2")
        assert known
        assert first.objectives == second.objectives != found.objectives
    evaluated = len((tmp_path / "log").read_text().splitlines())
    (record,) = revisit(tmp_path / "run", ["loop_2"], [design], study=fake, workers=1, cache=tmp_path / "cache")
    assert record.cached
    assert record.evaluation.objectives == first.objectives
    revisit(tmp_path / "run", ["loop_3"], [design], study=fake, workers=1, cache=tmp_path / "cache")
    with open_cache(tmp_path / "cache", fake.identity.program) as cache:
        assert evaluate_once(fake, design, cache, "loop_3")[1]
    assert len((tmp_path / "log").read_text().splitlines()) == evaluated + 1


def test_failed_evaluations_are_not_kept():
    fake, cache = study(), MemoryCache()
    keep_evaluation(fake, (0, 0, 0), Evaluation.failure({}, "no mesh"), cache)
    assert known_evaluation(fake, (0, 0, 0), cache) is None
    assert known_evaluation(fake, (0, 0, 0), None) is None


def test_tests_have_a_cache_of_their_own():
    assert "pytest" in str(default_cache_path("ironcub_paper"))
