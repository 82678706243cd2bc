"""Studies made from a study. Robust: mean and worst over tasks, violations of the worst, parts analyzed once."""

import json

import msgspec
import pytest

from codesign.chain.flight import find_trajectory, flight_settings
from codesign.chain.study import load_study
from codesign.errors import DesignError, StudyError
from codesign.followup.derived import coarse, load_coarse
from codesign.followup.robust import aggregate, load_robust, robust
from codesign.problem.evaluation import Evaluation
from codesign.search.optimization import optimize, sweep
from codesign.study.flight_config import DisturbancesConfig
from fake_study import FakeStudy, study


def evaluation(momentum: float, violation: float = 0.0, reason: str | None = None) -> Evaluation:
    return Evaluation(
        design={"a": 1},
        status="infeasible" if violation else "feasible",
        reason=reason,
        objectives={"momentum": momentum},
        objective_families={"rms": {"momentum": momentum, "thrust": 10 * momentum}},
        constraints={"safety_factor": 12.0, "flight_missed_share": violation},
        violations={"flight_missed_share": violation},
        seconds={"flight": 0.5},
    )


def test_mean_worst_and_both() -> None:
    results = {"hover": evaluation(1.0), "walk": evaluation(4.0), "turn": evaluation(1.0)}
    assert aggregate(results, "mean").objectives == {"momentum": 2.0}
    assert aggregate(results, "worst").objectives == {"momentum": 4.0}
    both = aggregate(results, "both")
    assert both.objectives == {"momentum_mean": 2.0, "momentum_worst": 4.0}
    assert both.objective_families["rms"]["thrust_worst"] == 40.0
    assert both.seconds == {"flight": 1.5}
    assert both.flight["objectives"]["walk"] == {"momentum": 4.0}


def test_one_violation_makes_the_design_infeasible() -> None:
    results = {"hover": evaluation(1.0), "walk": evaluation(4.0, 0.25, "lost"), "turn": evaluation(1.0, 0.125)}
    result = aggregate(results, "worst")
    assert result.status == "infeasible"
    assert result.violations == {"flight_missed_share": 0.25}
    assert result.constraints == {
        "safety_factor": 12.0,
        "flight_missed_share@hover": 0.0,
        "flight_missed_share@walk": 0.25,
        "flight_missed_share@turn": 0.125,
    }
    assert result.reason == "walk: lost"


def test_one_failure_fails_the_design() -> None:
    results = {"hover": evaluation(1.0), "walk": Evaluation.failure({"a": 1}, "SolverError: singular")}
    result = aggregate(results, "mean")
    assert (result.status, result.reason) == ("failed", "walk: SolverError: singular")


def test_optimizes_like_any_study_and_loads_again_in_workers(tmp_path) -> None:
    fake = study(by_trajectory=True)
    both = robust(fake, ["hover", "walk"], seeds=(1, 2), statistic="both")
    assert both.trajectories == ("hover@1", "hover@2", "walk@1", "walk@2")
    assert load_robust(both.source).hash == both.hash != fake.hash
    run = optimize(both, out=tmp_path / "run", cache=None, generations=2)
    assert run.objectives == ("near_mean", "near_worst", "far_mean", "far_worst")
    assert len(run.evaluations) == 16
    for result in run.evaluations:
        if result.status == "feasible":
            singles = [fake.evaluate(result.design, trajectory=name).objectives["near"] for name in both.trajectories]
            assert result.objectives["near_worst"] == max(singles)
            assert result.objectives["near_mean"] == pytest.approx(sum(singles) / 4, rel=1e-12)


def test_parts_are_analyzed_once_for_all_tasks() -> None:
    class Counting(FakeStudy):
        analyses = 0

        def evaluate(self, design, trajectory=None, cache=None):
            if cache.get("part") is None:
                Counting.analyses += 1
                cache.put("part", {"mass": 1.0})
            return super().evaluate(design, trajectory)

    counting = Counting(json.dumps({}))
    robust(counting, ["hover", "walk", "turn"]).evaluate(counting.space.from_indices((1, 1, 1)))
    assert Counting.analyses == 1


def test_wrong_settings_are_refused() -> None:
    with pytest.raises(ValueError, match="at least one trajectory"):
        robust(study(), [])
    with pytest.raises(ValueError, match="statistic"):
        robust(study(), ["hover"], statistic="median")


def test_coarse_study_is_the_study_on_part_of_its_grid(tmp_path) -> None:
    fake = study(levels=[21, 11, 6])
    part = coarse(fake, (5, 3, 2))
    assert part.space.levels == (5, 3, 2)
    assert load_coarse(part.source).hash == part.hash != fake.hash
    run = sweep(part, (5, 3, 2), out=tmp_path / "run", cache=None)
    assert len(run.evaluations) == 30
    for result in run.evaluations:
        assert result.objectives == fake.evaluate(result.design).objectives
    with pytest.raises(
        DesignError, match=r"a: 4 evenly spaced values are not possible, but \[2, 3, 5, 6, 11, 21\] are"
    ):
        coarse(fake, (4, 3, 2))


def test_seed_in_a_trajectory_name_redraws_its_disturbances() -> None:
    config = load_study("ironcub_paper").config
    calm = config.trajectories["envelope"]
    gusty = msgspec.structs.replace(
        calm, disturbances=DisturbancesConfig(gust_deviation_n=(5.0, 5.0, 2.0), mass_deviation=0.01, seed=3)
    )
    config = msgspec.structs.replace(config, trajectories={"envelope": calm, "gusty": gusty})
    seeds = [
        flight_settings(config.flight, find_trajectory(config, name)).disturbances.seed for name in ("gusty", "gusty@8")
    ]
    assert seeds == [3, 8]
    settings = flight_settings(config.flight, find_trajectory(config, "gusty@8")).disturbances
    assert settings.gust_deviation.tolist() == [5.0, 5.0, 2.0]
    assert settings.mass_deviation == 0.01
    for name, reason in (("windy@1", "no trajectory 'windy'"), ("gusty@x", "must be a whole number")):
        with pytest.raises(StudyError, match=reason):
            find_trajectory(config, name)
