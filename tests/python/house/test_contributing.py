"""What CONTRIBUTING.md shows works as it stands there."""

import importlib.util
import re
import sys
import tomllib
from pathlib import Path
from typing import Any

import pytest

import fake_study
from codesign.chain.study import Study
from codesign.search.optimization import optimize
from codesign.study import new_study
from codesign.study.loading import study_from

PAGE = (Path(__file__).resolve().parents[3] / "CONTRIBUTING.md").read_text(encoding="utf-8")
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def block(language: str, start: str) -> str:
    """The example of a language that begins with some text."""
    (text,) = [text for found, text in BLOCK.findall(PAGE) if found == language and text.startswith(start)]
    return text


def merged(table: dict[str, Any], other: dict[str, Any]) -> dict[str, Any]:
    """Tables joined, the other's values first."""
    both = {key: merged(table[key], other[key]) for key in table.keys() & other.keys() if isinstance(other[key], dict)}
    return table | other | both


@pytest.fixture
def template(tmp_path: Path) -> tuple[dict[str, Any], Path]:
    new_study(tmp_path / "study")
    path = tmp_path / "study" / "study.toml"
    return tomllib.loads(path.read_text()), path


def test_a_search_is_one_file(tmp_path, monkeypatch):
    (tmp_path / "outward.py").write_text(block("python", "# outward.py"))
    monkeypatch.syspath_prepend(str(tmp_path))
    study = fake_study.study(levels=[5, 4, 3])
    run = optimize(study, algorithm="outward:OUTWARD", population=4, generations=3, out=tmp_path / "run", cache=None)
    grids = [record.grid for record in run.search_records]
    assert len(set(grids)) == 12
    assert grids[0] == (2, 1, 1)
    sys.modules.pop("outward", None)
    assert importlib.util.find_spec("outward") is not None


def test_objectives_and_limits_are_lines_of_the_study(template):
    raw, path = template
    study = study_from(merged(raw, tomllib.loads(block("toml", "[objectives]"))), path, Study)
    evaluation = study.evaluate(study.baseline)
    assert evaluation.status == "feasible", evaluation.reason
    assert evaluation.objectives["sum(parts.*.mass)"] == pytest.approx(
        sum(part["mass"] for part in evaluation.parts.values())
    )
    assert {"flight.max_torque", "parts.strut.max_displacement"} <= evaluation.constraints.keys()


def test_propellers_are_data_of_the_study(template):
    raw, path = template
    propellers = tomllib.loads(block("toml", "[flight]"))
    propellers["flight"]["jets"]["frames"] = raw["flight"]["jets"]["frames"]
    propellers["flight"]["jets"] |= {"axes": 4 * [[0, 0, -1]], "max_thrust_n": 250.0}
    study = study_from(merged(raw, propellers), path, Study)
    assert study.config.flown.jet_model == "lag"
    assert list(study.config.flown.jets.reaction_n_m_per_n) == [0.016, -0.016, 0.016, -0.016]
