"""The command line as a user meets it: exit codes, one JSON document, help with an example."""

import json
import os
import subprocess
import sys

import pytest
from typer.testing import CliRunner

from codesign import load_study
from codesign.cli.main import app, listing
from codesign.storage.runs import load_run

COMMANDS = (
    "evaluate", "fly", "optimize", "resume", "runs", "report", "validate", "view", "export", "stress", "new",
    "check", "doctor", "materials", "schema",
)  # fmt: skip
ORIGINAL = ("--set", "angle=15", "--set", "distance=42", "--set", "offset=80", "--set", "length=108")
PUBLISHED = ("--study", "ironcub_paper")


def codesign(*arguments: str, cwd=None) -> subprocess.CompletedProcess[str]:
    command = (sys.executable, "-m", "codesign.cli", *arguments)
    return subprocess.run(command, capture_output=True, text=True, check=False, cwd=cwd)


@pytest.mark.parametrize("command", COMMANDS)
def test_help_has_an_example(command):
    result = codesign(command, "--help")
    assert result.returncode == 0
    assert "Example" in result.stdout


def test_the_list_of_commands_is_that_of_the_commands_themselves():
    shown = [CliRunner().invoke(commands, ["--help"], prog_name="codesign").stdout for commands in (app, listing())]
    assert shown[0] == shown[1] and all(f" {command} " in shown[0] for command in COMMANDS)


@pytest.mark.parametrize(
    ("line", "offered"),
    [
        ("codesign eva", ["evaluate"]),
        ("codesign evaluate --study gimb", ["gimbal_quad"]),
        ("codesign check hexa", ["hexarotor"]),
        ("codesign evaluate --study hexarotor --set t", ["tilt=", "tube="]),
    ],
)
def test_shells_complete_commands_studies_and_variables(line, offered):
    request = {"_CODESIGN_COMPLETE": "complete_bash", "COMP_WORDS": line, "COMP_CWORD": str(len(line.split()) - 1)}
    command = (sys.executable, "-c", "import sys; sys.argv[0] = 'codesign'; from codesign.cli.main import main; main()")
    done = subprocess.run(command, capture_output=True, text=True, check=True, env=os.environ | request)
    assert done.stdout.split() == offered


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("evaluate", "--set", "angle=15"), "no value for design variable 'distance'"),
        (("evaluate", *PUBLISHED, *ORIGINAL, "--set", "wing=1"), "unknown design variable 'wing'"),
        (("evaluate", "--set", "angle"), "expected NAME=VALUE"),
        (("evaluate", "--study", "nowhere", *ORIGINAL), "no such study"),
        (("evaluate", *PUBLISHED, *ORIGINAL, "--trajectory", "loop"), "no trajectory 'loop'"),
        (("fly", "absent.urdf"), "absent.urdf"),
        (("resume", "absent"), "absent"),
        (("validate", "absent"), "absent"),
        (("view",), "either the folder of a run or a design"),
        (("optimize", "--color", "red"), "--color"),
        (("resume", "absent", "--evaluations", "-5"), "greater than or equal to 1"),
        (("runs", "absent"), "absent: there is no such folder"),
        (("runs", "."), "holds no run"),
    ],
)
def test_bad_input_is_exit_code_2_and_says_why(arguments, message, tmp_path):
    result = codesign(*arguments, cwd=tmp_path)
    assert result.returncode == 2, result.stderr
    assert message in " ".join(result.stderr.split())
    assert not list(tmp_path.iterdir())


def test_outputs_are_tried_before_anything_is_computed(tmp_path):
    arguments = ("stress", "absent.stl", "--fix", "near:0,0,0", "--load", "near:1,0,0: 0 0 1")
    for option in ("--vtu", "--png"):
        result = codesign(*arguments, option, str(tmp_path), "--json")
        assert result.returncode == 2, result.stderr
        assert json.loads(result.stdout)["error"] == {
            "type": "FileError",
            "message": f"{tmp_path}: is a folder; name a file in it",
        }


def test_errors_of_the_file_system_are_one_line(tmp_path):
    (tmp_path / "file").write_text("")
    result = codesign("new", "file/study", cwd=tmp_path)
    assert (result.returncode, result.stderr.strip()) == (2, "FileError: file/study: Not a directory")


def test_bad_input_with_json_is_one_document():
    result = codesign("evaluate", "--set", "angle=15", "--json")
    assert result.returncode == 2
    assert json.loads(result.stdout)["error"]["type"] == "DesignError"


def test_evaluate_prints_the_document():
    result = codesign("evaluate", *PUBLISHED, *ORIGINAL, "--json")
    assert result.returncode == 0, result.stderr
    document = json.loads(result.stdout)
    assert document["status"] == "feasible"
    assert document["design"] == {"angle": 15, "distance": 42, "offset": 80, "length": 108}
    assert json.loads(codesign("evaluate", *PUBLISHED, *ORIGINAL, "--json", "--no-cache").stdout)["flight"] != {}
    again = codesign("evaluate", *PUBLISHED, *ORIGINAL, "--json")
    assert "known from the cache" in again.stderr
    assert json.loads(again.stdout) == document


def test_evaluate_without_a_design_takes_the_baseline():
    result = codesign("evaluate", "--study", "gimbal_quad", "--json")
    assert result.returncode == 0, result.stderr
    assert json.loads(result.stdout)["design"] == {"reach": 200, "height": 30}


def test_a_lost_flight_is_exit_code_1():
    result = codesign(
        "evaluate",
        *PUBLISHED,
        *("--set", "angle=60", "--set", "distance=54", "--set", "offset=90", "--set", "length=74"),
    )
    assert result.returncode == 1
    assert "infeasible" in result.stdout


def test_fly_published_robot_gives_the_published_objectives(shared_data):
    result = codesign("fly", str(shared_data / "published" / "optim1.urdf"), *PUBLISHED, "--as-published", "--json")
    assert result.returncode == 0, result.stderr
    document = json.loads(result.stdout)
    parts = document["objective_parts"]["script"]  # shared/data/published/README.md
    assert parts["angular_momentum"] == pytest.approx(4.69508996, rel=1e-6)
    assert parts["linear_momentum"] == pytest.approx(106.07285930, rel=1e-6)
    assert document["objective_families"]["script"]["thrust"] == pytest.approx(656.84292784, rel=1e-6)


def test_new_study_runs_from_its_folder(tmp_path, monkeypatch):
    assert codesign("new", str(tmp_path / "mine")).returncode == 0
    monkeypatch.delenv("CODESIGN_CACHE", raising=False)  # a developer may have set it
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    arguments = ("--population", "4", "--generations", "2", "--original", "--out", str(tmp_path / "run"), "--json")
    result = codesign("optimize", "--study", str(tmp_path / "mine"), *arguments, cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    assert sorted(p.name for p in tmp_path.iterdir()) == ["cache", "mine", "run"]
    assert json.loads(result.stdout)["designs"] == 8
    assert load_run(tmp_path / "run").evaluations[0].design == dict(load_study(tmp_path / "mine").baseline)
    listed = codesign("runs", str(tmp_path), "--json")
    assert json.loads(listed.stdout)[0]["study"] == "gimbal_quad"
    again = codesign("resume", str(tmp_path / "run"), "--json")
    assert json.loads(again.stdout)["designs"] == 8


def test_doctor_knows_what_is_there():
    document = json.loads(codesign("doctor", "--json").stdout)
    assert document["problems"] == {}
    assert document["libraries"]["CGAL"]


def test_check_tells_what_a_study_varies_as_json_or_what_is_wrong():
    summary = json.loads(codesign("check", "gimbal_quad", "--json").stdout)
    assert summary["problems"] == []
    assert [v["levels"] for v in summary["variables"]] == [21, 14]
    assert summary["designs"] == 294
    assert summary["objectives"] == ["momentum", "joint_velocity", "thrust"]
    assert {"key": "safety_factor", "min": 10.0, "max": None}.items() <= summary["limits"][1].items()


def test_check_of_a_broken_study_ends_with_2(tmp_path):
    file = tmp_path / "study.toml"
    file.write_text("name = 'broken'\n[variable.x]\nmin = 1\n")
    result = codesign("check", str(file), "--json")
    assert result.returncode == 2
    assert any("did you mean 'variables'" in problem for problem in json.loads(result.stdout)["problems"])
