"""A study without flight and robot: the parts alone are judged, from the file to objectives and limits."""

import shutil
import tomllib
from pathlib import Path

import numpy as np
import pytest

from codesign.chain.judge import limits
from codesign.chain.study import Study, load_study
from codesign.errors import StudyError
from codesign.report.scene import robot_scene
from codesign.report.study_words import flight_words
from codesign.study.checking.everything import find_problems
from codesign.study.loading import study_from

EXAMPLES = Path(__file__).parents[3] / "examples"
EXAMPLE = EXAMPLES / "parts_only"
DESIGN = {"reach": 60, "thickness": 10, "alloy": "6061-t6"}


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    return shutil.copytree(EXAMPLE, tmp_path_factory.mktemp("parts_only") / "study")


def changed(folder, **sections):
    path = folder / "study.toml"
    return study_from(tomllib.loads(path.read_text()) | sections, path, Study)


def test_the_example_is_sound_and_judged_by_its_parts(folder):
    assert find_problems(folder) == []
    study = load_study(folder)
    assert [limit.quantity.key for limit in limits(study.config)] == ["safety_factor"]
    assert "parts alone" in flight_words(study.config)
    evaluation = study.evaluate(DESIGN)
    assert evaluation.status == "feasible"
    assert evaluation.flight == {}
    assert evaluation.objective_families == {}
    assert evaluation.objectives == {
        "mass": evaluation.parts["bracket"]["mass"],
        "max_displacement": evaluation.parts["bracket"]["max_displacement"],
    }
    volume = 30.0 * (60.0 * 10.0 + 50.0 * 10.0) + 30.0 * 25.0 * (1.0 - 3.14159265 / 4.0)  # mm³, fillet included
    assert evaluation.objectives["mass"] == pytest.approx(volume * 1e-9 * 2700.0, rel=1e-3)
    evaluation.to_json()


def test_a_part_of_a_step_file_is_studied_like_one_of_the_part_language(tmp_path):
    study = load_study(shutil.copytree(EXAMPLES / "imported", tmp_path / "study"))
    evaluation = study.evaluate({"bore": 6, "place": 60})
    bar, bore = 80.0 * 16.0 * 12.0, np.pi / 4.0 * 6.0**2 * 12.0  # mm³
    assert evaluation.objectives["mass"] == pytest.approx(2700e-9 * (bar - bore), rel=1e-3)
    bending = 300.0 * 80.0 / (16.0 * 12.0**2 / 6.0)  # MPa, at the mount
    assert 276.0 / evaluation.parts["strut"]["safety_factor"] == pytest.approx(bending, rel=0.1)
    assert "safety factor" in study.evaluate({"bore": 10, "place": 10}).reason


def test_a_limit_that_is_missed_makes_it_infeasible(folder):
    evaluation = changed(folder, constraints={"safety_factor_min": 1e4}).evaluate(DESIGN)
    assert evaluation.status == "infeasible"
    assert evaluation.objectives
    assert "safety factor" in evaluation.reason


def test_the_part_stands_alone_in_its_picture(folder):
    scene = robot_scene(load_study(folder), DESIGN)
    assert [piece.part for piece in scene.pieces] == ["bracket"]
    assert scene.jets == ()


@pytest.mark.parametrize(
    ("sections", "message"),
    [
        ({"objectives": {}}, "'(momentum|joint_velocity|thrust)' needs the section"),
        ({"constraints": {"limits": {"flight.max_torque": {"max": 1.0}}}}, "'flight.max_torque' needs the section"),
        ({"trajectories": {"calm": {"windows": []}}}, "trajectories: needs the section"),
        ({"interference": {"bodies": ["none"]}}, "interference: needs the section"),
    ],
)
def test_what_needs_a_flight_is_refused(folder, sections, message):
    with pytest.raises(StudyError, match=message):
        changed(folder, **sections)


def test_no_trajectory_can_be_flown(folder):
    with pytest.raises(StudyError, match=r"a study of parts alone; this needs its section \[flight\]|no trajectory"):
        load_study(folder).evaluate(DESIGN, trajectory="calm")
