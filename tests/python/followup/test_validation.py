"""Validation: which designs, the same disturbances for all of them, comparisons flight by flight."""

from pathlib import Path

import numpy as np
import pytest

import synthetic_run
from codesign.chain.flight import disturbed, find_trajectory
from codesign.chain.fly import fly_robot
from codesign.chain.study import load_study
from codesign.errors import DesignError, StoreError, StudyError
from codesign.followup.validation import disturbance_of, select, validate
from codesign.report.page.validation import strips, validation_tables
from codesign.report.reading import read_report_data
from codesign.report.validation import Disturbance, Flight, Validation, load_validation
from codesign.storage.runs import load_run

STUDY = synthetic_run.Study()
LIGHT = {"angle": 1, "distance": 48, "offset": 88, "length": 50}


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory):
    folder: Path = tmp_path_factory.mktemp("validation") / "run"
    synthetic_run.write_run(folder, synthetic_run.evaluations(120))
    return read_report_data(folder, STUDY, synthetic_run.evaluate(synthetic_run.BASELINE))


def flight(role: str, trajectory: str, seed: int | None, momentum: float | None) -> Flight:
    objectives = {} if momentum is None else {"momentum": momentum, "joint_velocity": 0.26, "thrust": 660.0}
    return Flight(role, LIGHT, trajectory, seed, momentum is not None, None if momentum else "lost", objectives, {})


def test_designs_are_chosen_by_role_number_and_spread(run):
    number = str(run.entries[run.front[0]].id)
    chosen = select(run, ["knee", number, "original"])
    assert list(chosen) == ["recommended", f"design {number}"]
    assert chosen["recommended"] == run.entries[run.recommended].evaluation.design
    assert len(select(run, ["front"])) == len(run.front)
    assert len(select(run, ["spread:4"])) == 4


def test_a_design_chosen_twice_is_flown_once(run):
    both = select(run, ["recommended", "best", "front"])
    assert len({tuple(d.values()) for d in both.values()}) == len(both) == len(run.front)
    assert next(iter(both)) == "recommended"


@pytest.mark.parametrize("selector", ["fastest", "spread:", "99999", "-3", "spread:x"])
def test_unknown_designs_are_refused(run, selector):
    with pytest.raises(DesignError):
        select(run, [selector])


def test_changes_compare_the_same_flight_only():
    flights = (
        flight("original", "a", None, 2.0),
        flight("original", "b", None, None),
        flight("original", "a", 1, 4.0),
        flight("new", "a", None, 1.0),
        flight("new", "b", None, 1.0),
        flight("new", "a", 1, None),
        flight("new", "a", 2, 1.0),
    )
    validation = Validation(flights, Disturbance())
    assert validation.change("new", "momentum") == {("a", None): -0.5}
    assert validation.change("new", "momentum", disturbed=True) == {}


def test_a_validation_comes_back_from_its_file(tmp_path):
    validation = Validation((flight("original", "a", None, 1 / 3), flight("new", "a", 3, None)), Disturbance(gust=0.1))
    assert Validation.from_json(validation.to_json()) == validation
    assert load_validation(tmp_path) is None
    (tmp_path / "validation.json").write_text('{"half')
    assert load_validation(tmp_path) is None


def test_the_page_shows_means_and_lost_flights(run):
    flights = (
        flight("original", "a", None, 2.0),
        flight("original", "b", None, 2.0),
        flight("new", "a", None, 1.5),
        flight("new", "b", None, None),
    )
    validation = Validation(flights, Disturbance())
    tables = validation_tables(run, validation)
    assert "−25.0\u202f%" in tables
    assert "1 of 2" in tables
    assert "lost" in tables
    assert strips(run, validation)["objectives"][0]["calm"] == [{"role": 0, "flight": "new, A", "change": -0.25}]


def momentum(trajectory: str) -> float:
    """Momentum error of a light design's robot, without the parts' analysis."""
    study = load_study("ironcub_paper")
    value: float = fly_robot(study, study.build_robot(LIGHT), trajectory=trajectory)["objectives"]["momentum"]
    return value


def test_disturbances_differ_by_seed_and_matter():
    calm, small = momentum("trajectory_1"), {"gust_deviation_n": 1.0, "mass_deviation": 0.002}
    drawn = [momentum(disturbed("trajectory_1", seed, small)) for seed in (1, 2, 1)]
    assert len({calm, *drawn}) == 3 and drawn[0] == drawn[2]
    none = dict.fromkeys(("gust_deviation_n", "mass_deviation", "thrust_deviation"), 0.0)
    assert momentum(disturbed("trajectory_1", 1, none)) == calm


@pytest.mark.parametrize("name", ["trajectory_1@x", "trajectory_1@1:gusts=3", "trajectory_1@1:mass_deviation=9", "t@1"])
def test_wrong_disturbances_are_refused(name):
    with pytest.raises(StudyError, match="trajectory"):
        find_trajectory(load_study("ironcub_paper").config, name)


@pytest.fixture
def real_run(tmp_path: Path) -> Path:
    """A run whose rows are made up but whose study is the shipped one, so that its designs can be flown."""
    return synthetic_run.write_run(tmp_path / "run", synthetic_run.evaluations(40), study=load_study("ironcub_paper"))


def test_validate_flies_chosen_designs_isolated_and_keeps_the_flights(real_run):
    told: list[tuple[int, int]] = []
    result = validate(
        real_run, ["recommended"], ["trajectory_1"], seeds=2, workers=2, progress=lambda *n: told.append(n)
    )
    assert result.roles == ("original", "recommended")
    assert [f.seed for f in result.of("original")] == [None, 1, 2]
    assert all(f.completed for f in result.flights), [f.reason for f in result.flights]
    assert len({f.objectives["momentum"] for f in result.of("original")}) == 3
    assert load_validation(real_run) == result
    assert np.isfinite(list(result.change("recommended", "momentum").values())).all()
    assert told[-1] == (6, 6)
    stored = {(r.trajectory, r.worker != "") for r in load_run(real_run).records if r.trajectory}
    assert len(stored) == 3 and all(worker for _, worker in stored)
    assert validate(real_run, ["recommended"], ["trajectory_1"], seeds=2, workers=1, progress=None) == result


def test_validate_refuses_unknown_trajectories_and_folders_without_a_run(real_run, tmp_path):
    with pytest.raises(StudyError, match="no trajectory"):
        validate(real_run, ["recommended"], ["loop"], workers=1)
    with pytest.raises(StoreError, match="no run here"):
        validate(tmp_path / "nothing", study=STUDY)


def test_validation_strays_as_far_as_the_studys_own_flights():
    assert disturbance_of(load_study("ironcub_paper")) == Disturbance()
    assert disturbance_of(load_study("ironcub")) == Disturbance(gust=5.0, gust_time=1.0, mass=0.01, thrust=0.01)
