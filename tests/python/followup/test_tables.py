"""Tables of parts: what decides a part, and that a design whose parts are in the cache analyzes none."""

import dataclasses
import json
import shutil
from pathlib import Path

import pytest

from codesign.chain import chain
from codesign.chain.study import load_study
from codesign.chain.tables import deciding_variables, flies_for_strength
from codesign.cli.console import print_tables
from codesign.errors import StudyError
from codesign.followup.tables import PartStudy, load_part, tabulate
from codesign.storage.cache import open_cache

EXAMPLE = Path(__file__).parents[3] / "examples" / "parts_only"
SHORTENED = {
    "max = 120\nstep = 10": "max = 90\nstep = 30",
    "values = [4, 5, 6, 8, 10]": "values = [8, 10]",
    '["6061-t6", "s235", "ti-6al-4v"]': '["6061-t6", "s235"]',
}


@pytest.fixture
def small(tmp_path: Path) -> Path:
    """The example with two reaches, thicknesses and materials."""
    folder = shutil.copytree(EXAMPLE, tmp_path / "study")
    text = (folder / "study.toml").read_text()
    for many, few in SHORTENED.items():
        assert many in text
        text = text.replace(many, few)
    (folder / "study.toml").write_text(text)
    return folder


def test_a_part_is_decided_by_its_own_variables():
    study = load_study("ironcub_paper")
    assert deciding_variables(study, "jetpack_bracket") == ("angle", "distance")
    assert deciding_variables(study, "forearm_support") == ("offset", "length")
    assert not flies_for_strength(study, "forearm_support")
    strength = load_study("ironcub_strength")
    assert all(flies_for_strength(strength, part.name) for part in strength.config.parts)


def test_designs_of_tabulated_parts_analyze_nothing(small, tmp_path, monkeypatch):
    study, cache_file = load_study(small), tmp_path / "cache.sqlite"
    (table,) = tabulate(study, out=tmp_path / "tables", workers=2, cache=cache_file)
    assert table.variables == study.space.names
    assert [e.status for e in table.run.evaluations] == ["feasible"] * 8
    monkeypatch.setattr(chain._core, "analyze_part", None)
    with open_cache(cache_file, study.identity) as cache:
        for evaluation in table.run.evaluations:
            whole = study.evaluate(evaluation.design, cache=cache)
            assert whole.parts == evaluation.parts
            assert whole.objectives["mass"] == evaluation.objectives["mass"]
    (again,) = tabulate(study, out=tmp_path / "tables", workers=1, cache=cache_file)
    assert again.run.evaluations == table.run.evaluations


def test_a_part_of_a_study_is_loaded_again_by_workers():
    study = PartStudy(load_study("ironcub_paper"), "forearm_support", ("offset", "length"))
    again = load_part(study.source)
    assert (again.part, again.variables, again.hash) == (study.part, study.variables, study.hash)
    assert study.space.levels == (21, 51)
    assert study.hash != dataclasses.replace(study, part="jetpack_bracket").hash


def test_parts_that_no_table_can_spare_are_named(tmp_path, capsys):
    tables = tabulate(load_study("ironcub_strength"), ["forearm_support"], out=tmp_path)
    assert print_tables(tables, as_json=True) == 0
    (row,) = json.loads(capsys.readouterr().out)
    assert row["reason"] == "not tabulated: its strength depends on the flight of every design"
    assert (row["designs"], row["run"]) == (0, None)
    assert list(tmp_path.iterdir()) == []


def test_unknown_parts_and_too_large_tables_are_refused(tmp_path):
    study = load_study("ironcub_paper")
    with pytest.raises(StudyError, match="no part 'bracket'; did you mean 'jetpack_bracket'"):
        tabulate(study, ["bracket"], out=tmp_path)
    with pytest.raises(StudyError, match=r"jetpack_bracket has 2,449 designs \(angle, distance\); at most 1,000"):
        tabulate(study, out=tmp_path, most=1000)
