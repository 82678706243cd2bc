"""Studies without what the configuration leaves optional: they fly, are shown and reported, or are refused in words."""

import json
import sys

import numpy as np
import pytest

from codesign import dynamics as dyn
from codesign.chain.flight import flight_settings, joint_names
from codesign.chain.fly import fly_robot
from codesign.chain.study import Study, load_study
from codesign.cli import main
from codesign.cli.commands.design import fly
from codesign.cli.commands.study import check
from codesign.errors import ExecutionError
from codesign.execution.cluster import DaskExecutor
from codesign.execution.pool import Limits, StudyRef
from codesign.report.compute import history
from codesign.report.page.encode import _flight as page_of_flight
from codesign.study import new_study
from codesign.viewer.viewer import Viewer


def edited(folder, *replacements: tuple[str, str]) -> Study:
    """The template study with a flight of 1.6 s, after text replacements."""
    new_study(folder)
    file = folder / "study.toml"
    text = file.read_text().replace("duration_s = 20.0", "duration_s = 1.6")
    for old, new in replacements:
        assert old in text
        text = text.replace(old, new, 1)
    file.write_text(text)
    return load_study(folder)


def without_ground(folder) -> Study:
    edited(folder)
    file = folder / "study.toml"
    text = file.read_text()
    start, end = text.index("[flight.ground]"), text.index("# A command acts")
    file.write_text(text[:start] + text[end:])
    return load_study(folder)


def test_a_robot_without_ground_contacts_flies_on_the_command_line(tmp_path, capsys):
    study = without_ground(tmp_path / "study")
    assert fly(study.path.parent / "robot.urdf", study=str(study.path)) == 0
    rows = dict(line.split(maxsplit=1) for line in capsys.readouterr().out.splitlines())
    assert rows["min_clearance"].strip() == "-"
    assert float(rows["max_thrust"]) > 0.0


def test_a_robot_without_moving_joints_flies(tmp_path):
    study = edited(tmp_path / "study")
    text = study.path.read_text()
    start, end = text.index("[[flight.joint_groups]]"), text.index("[flight.jets]")
    study.path.write_text(text[:start] + text[end:])
    rigid = load_study(study.path)
    document = fly_robot(rigid, study.path.parent / "robot.urdf")
    assert document["status"] == "completed"
    assert document["objectives"]["joint_velocity"] == 0.0
    assert document["flight"]["max_torque"] == 0.0
    thrust = document["objectives"]["thrust"]  # four equal jets lift the robot: the weight is what they push with
    model = dyn.load_urdf(study.path.parent / "robot.urdf", joints=[])
    assert thrust == pytest.approx(9.81 * model.total_mass, rel=0.05)


def test_a_flight_that_is_lost_at_once_is_a_json_document(tmp_path):
    study = edited(tmp_path / "study", ("com_error_m = 2.0", "com_error_m = 1e-9"))
    document = fly_robot(study, study.path.parent / "robot.urdf")
    assert document["status"] == "lost"
    json.dumps(document, allow_nan=False)


def test_histories_of_a_study_that_weights_no_joints(tmp_path):
    study = edited(tmp_path / "study", ("velocity_weight = 1.0", ""))
    flight = study.config.flight
    trajectory = study.config.trajectories[flight.trajectory]
    robot = dyn.load_urdf(study.path.parent / "robot.urdf", joints=joint_names(flight))
    log = dyn.simulate_flight(robot, flight_settings(flight, trajectory))
    shown = history(flight, flight.trajectory, log)
    assert shown["joint_velocity_error"].shape == (len(shown["time"]), 0)
    assert [chart["label"] for chart in page_of_flight(shown)["charts"]] == [
        "Tracking error", "Attitude error", "Thrusts",
    ]  # fmt: skip
    weighted = history(load_study("gimbal_quad").config.flight, flight.trajectory, log)
    assert weighted["joint_velocity_error"].shape == (len(shown["time"]), 1)
    np.testing.assert_array_equal(weighted["com_error"], shown["com_error"])


def test_without_viser_the_viewer_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "viser", None)
    with pytest.raises(ExecutionError, match=r"pip install 'codesign\[view\]'"):
        Viewer(None, [], {}, None, None, "127.0.0.1", 8080, None)


def test_without_dask_a_cluster_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(ExecutionError, match=r"pip install 'codesign\[cluster\]'"):
        DaskExecutor(StudyRef("gimbal_quad", ""), "local:1", Limits(), None)


def test_square_brackets_of_a_message_are_printed(tmp_path, monkeypatch, capsys):
    folder = tmp_path / "my[bold]study"
    folder.mkdir()
    (folder / "file").write_text("x")
    monkeypatch.setattr(sys, "argv", ["codesign", "new", str(folder)])
    with pytest.raises(SystemExit) as end:
        main.main()
    assert end.value.code == 2
    assert f"{folder}: exists and is not empty" in capsys.readouterr().err


def test_an_edited_study_is_loaded_anew(tmp_path):
    first = edited(tmp_path / "study")
    assert load_study(first.path) is load_study(first.path)
    first.path.write_text(first.path.read_text().replace("max_thrust_n = 250.0", "max_thrust_n = 260.0"))
    second = load_study(first.path)
    assert second.config.flight.jets.max_thrust_n == 260.0
    assert second.hash != first.hash
    (first.path.parent / "robot.toml").unlink()  # the URDF is no longer made from it
    robot = first.path.parent / "robot.urdf"
    robot.write_text(robot.read_text().replace("</robot>", "<!-- edited --></robot>"))
    assert load_study(first.path).hash != second.hash


def test_check_tells_all_problems_at_once_or_what_varies(tmp_path, capsys):
    file = edited(tmp_path / "study").path
    assert check(str(file)) == 0
    told = capsys.readouterr().out
    assert "reach" in told and "120 … 320 by 10 mm" in told and "294 designs" in told and "momentum" in told
    sound = file.read_text()
    file.write_text(
        sound.replace("population = 16", "poulation = 16").replace("max_thrust_n = 250.0", 'max_thrust_n = "a"')
    )
    assert check(str(file)) == 2
    told = capsys.readouterr().out
    assert "unknown key 'poulation'; did you mean 'population'?" in told and "flight.jets.max_thrust_n: 'a'" in told
    assert len(told.splitlines()) == 2
    file.write_text(sound.replace('"mount"]', '"mont"]').replace('"skid_front"', '"skid_frond"'))
    assert check(str(file)) == 2
    told = capsys.readouterr().out
    assert "did you mean 'mount'" in told and "did you mean 'skid_front'" in told
