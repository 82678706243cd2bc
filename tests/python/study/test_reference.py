"""The study file's reference page and JSON Schema say what the configuration's classes say, of every key."""

import copy
import json
import tomllib
from pathlib import Path

import jsonschema
import pytest

from codesign.study import new_study
from codesign.study.loading import STUDIES
from codesign.study.meanings import MEANINGS
from codesign.study.reference import SCHEMA_FILE, meanings, reference_page, study_schema, tables, unit

PAGE = Path(__file__).parents[3] / "docs" / "study.md"


@pytest.mark.parametrize("table", tables(), ids=lambda table: table.cls.__name__)
def test_every_key_has_a_meaning(table):
    keys = {field.encode_name for field in table.fields}
    assert set(meanings(table)) == keys
    assert set(MEANINGS.get(table.cls.__name__, {})) <= keys
    for key in keys:
        assert len(meanings(table)[key]) > 3, key


def test_the_page_is_current():
    assert PAGE.read_text(encoding="utf-8") == reference_page(), "run: python scripts/study_reference.py"


@pytest.mark.parametrize(
    ("key", "expected"),
    [
        ("young_modulus_gpa", "GPa"), ("density_kg_m3", "kg/m³"), ("torque_rate_n_m_s", "N·m/s"), ("torque_n_m", "N·m"),
        ("max_thrust_rate_n_s", "N/s"), ("acceleration_m_s2", "m/s²"), ("joint_speed_deg_s", "°/s"), ("name", ""),
        ("reaction_n_m_per_n", "N·m/N"), ("forward_m_s", "m/s"), ("initial_rad", "rad"), ("joints", ""),
    ],
)  # fmt: skip
def test_units_are_those_that_the_keys_say(key, expected):
    assert unit(key) == expected


@pytest.mark.parametrize("study", ["ironcub_paper", "gimbal_quad", "hexarotor"])
def test_shipped_studies_match_the_schema_and_a_misspelt_key_does_not(study):
    schema = json.loads(json.dumps(study_schema()))
    jsonschema.Draft202012Validator.check_schema(schema)
    raw = json.loads(json.dumps(tomllib.loads((STUDIES / study / "study.toml").read_text())))
    judge = jsonschema.Draft202012Validator(schema)
    assert list(judge.iter_errors(raw)) == []
    wrong = copy.deepcopy(raw)
    wrong["fem"]["tolerence"] = 0.1
    assert [error.validator for error in judge.iter_errors(wrong)] == ["additionalProperties"]


def test_a_new_study_brings_the_schema_that_its_first_line_names(tmp_path):
    new_study(tmp_path / "study")
    first = (tmp_path / "study" / "study.toml").read_text().splitlines()[0]
    assert first == f"#:schema {SCHEMA_FILE}"
    assert json.loads((tmp_path / "study" / SCHEMA_FILE).read_text()) == json.loads(json.dumps(study_schema()))
