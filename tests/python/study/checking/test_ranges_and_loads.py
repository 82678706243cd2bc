"""`codesign check`: values that a part refuses, and loads of a case that cancel."""

import itertools
import json
from pathlib import Path

import pytest

from codesign.chain.study import load_study
from codesign.cli.commands.study import check
from codesign.cli.study_summary import notes, typical
from codesign.errors import StudyError
from codesign.study import new_study
from codesign.study.checking import ranges
from codesign.study.checking.ranges import refused_values

LOADS = 'loads = [{ face = "seat", pressing_n = 250.0 }]'
DOWN, UP = '{ face = "seat", force_n = [0.0, 0.0, -250.0] }', '{ face = "seat", force_n = [0.0, 0.0, 250.0] }'
SIDE = '{ face = "seat", force_n = [50.0, 0.0, 0.0] }'
TWICE = '{ face = "seat", pressing_n = 500.0 }'  # upwards: the seat looks down
OTHER_BODY = """
    def check(self) -> None:
        self.limit("height", maximum=self.reach / 4.0, because="slender enough")
"""


def study_with(folder: Path, *replaced: tuple[str, str]) -> Path:
    new_study(folder)
    text = (folder / "study.toml").read_text()
    for old, new in replaced:
        assert old in text
        text = text.replace(old, new)
    (folder / "study.toml").write_text(text)
    return folder / "study.toml"


def reach(least: float, most: float) -> tuple[str, str]:
    """Replaces the range of the strut's reach, whose own limits are 80 and 500 mm."""
    return "min = 120\nmax = 320", f"min = {least:g}\nmax = {most:g}"


def told(file: Path) -> list[ranges.Refusal]:
    study = load_study(file)
    return list(refused_values(study, typical(study)))


def test_values_beyond_a_limit_are_named_with_their_reason(tmp_path: Path) -> None:
    low, high = told(study_with(tmp_path / "study", reach(60, 520)))
    assert (low.key, high.key) == ("variables.reach", "variables.reach")
    assert low.reason.startswith("60 … 70 mm (2 of 47 values) give no strut, whatever the other values are: ")
    assert "reach = 60 mm is below its limit 80 mm" in low.reason
    assert high.reason.startswith("510 … 520 mm (2 of 47 values)")
    assert "reach = 510 mm is above its limit 500 mm" in high.reason
    assert not low.every and not high.every


def test_combinations_that_a_part_refuses_are_counted(tmp_path: Path) -> None:
    file = study_with(tmp_path / "study")
    assert told(file) == []
    part = file.parent / "strut.py"
    part.write_text(part.read_text().replace("    def shape(self)", OTHER_BODY.lstrip("\n") + "\n    def shape(self)"))
    (found,) = told(file)
    space = load_study(file).space
    values = [[float(v.value(i)) for i in range(v.levels)] for v in space.variables]
    refused = [pair for pair in itertools.product(*values) if pair[1] > pair[0] / 4.0]
    assert found.key == "parts.strut"
    assert found.reason.startswith(
        f"{len(refused)} of {len(values[0]) * len(values[1])} combinations of reach, height give no"
    )
    assert "(slender enough)" in found.reason


def test_of_many_combinations_every_value_is_tried(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ranges, "MOST_TRIALS", 10)
    (low,) = told(study_with(tmp_path / "study", reach(70, 500)))
    assert low.reason.startswith("70 mm gives no strut")


def test_a_part_that_no_values_give_is_wrong(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = study_with(tmp_path / "study", reach(600, 700), ("reach = 200\n", "reach = 650\n"))
    assert check(str(file)) == 2
    assert "no combination of reach, height gives a part" in " ".join(capsys.readouterr().out.split())


@pytest.mark.parametrize(
    "loads",
    [f"{DOWN}, {UP}", f"{TWICE}, {DOWN}, {DOWN}", f'{SIDE}, {{ face = "seat", force_n = [-50.0, 0.0, 0.0] }}'],
    ids=["forces", "pressed", "shear"],
)
def test_a_case_whose_loads_cancel_is_refused(tmp_path: Path, loads: str) -> None:
    file = study_with(tmp_path / "study", (LOADS, f"loads = [{loads}]"))
    with pytest.raises(StudyError, match=r"parts\.strut\.loads: its loads cancel: on 'seat' they add up to nothing"):
        load_study(file)


def test_loads_that_cancel_beside_others_are_noted(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    fall = "{ acceleration_m_s2 = [0.0, 0.0, -9.81] }"
    file = study_with(tmp_path / "study", (LOADS, f"loads = [{DOWN}, {UP}, {fall}]"))
    told = dict(notes(load_study(file)))
    assert told["parts.strut.loads"] == "2 loads on 'seat' (force_n) cancel: they change nothing"
    assert check(str(file), as_json=True) == 0
    assert any("cancel" in note for note in json.loads(capsys.readouterr().out)["notes"])


@pytest.mark.parametrize("other", [SIDE, "{ acceleration_m_s2 = [0.0, 0.0, 9.81] }"])
def test_loads_that_do_not_cancel_are_left_alone(tmp_path: Path, other: str) -> None:
    file = study_with(tmp_path / "study", (LOADS, f"loads = [{DOWN}, {other}]"))
    assert [note for note in notes(load_study(file)) if "cancel" in note[1]] == []
