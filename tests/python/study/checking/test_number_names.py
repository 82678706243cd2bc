"""What `codesign check` says of numbers that are texts, and of numbers that a study does not have."""

import re

import msgspec

from codesign.chain.study import load_study
from codesign.study.checking.everything import find_problems
from codesign.study.checking.numbers import unknown_number
from codesign.study.config import StudyConfig
from codesign.study.conversion import readable

RAW = {
    "name": "arm",
    "variables": {"wall": {"min": "4", "max": 9, "step": 1, "unit": "mm"}},
    "parts": [
        {"name": "arm", "shape": "arm:Arm", "supports": ["base"], "parameters": {"wall": "wall"}, "material": "7075-t6"}
    ],
    "objectives": {"minimize": ["mass"]},
}


def test_a_number_in_quotes_is_told_once_in_plain_words():
    assert readable(RAW).problems == ["variables.wall.min: '4' is a text; write the number without quotes"]


def test_an_unknown_number_names_those_that_a_study_of_parts_has():
    raw = RAW | {"variables": {"wall": {"min": 4, "max": 9, "step": 1, "unit": "mm"}}}
    told = unknown_number(msgspec.convert(raw, StudyConfig), "arm.max_bend") or ""
    assert "nearest of those that this study has: parts.arm.m" in told
    assert "momentum" not in told and "flight" not in told


def test_numbers_that_are_offered_are_there():
    """Clearances need [interference]: they are not offered to a study that has none."""
    config = load_study("hexarotor").config
    told = unknown_number(msgspec.structs.replace(config, interference=None), "body_clearence") or ""
    assert "nearest of those" in told
    assert "body_clearance" not in told.partition("nearest of those")[2]


def test_a_wrong_face_is_told_beside_an_unknown_material(tmp_path):
    source = load_study("hexarotor").path.parent
    for file in source.glob("*.*"):
        text = file.read_text()
        if file.name == "study.toml":
            text = re.sub(r'(?m)^material = "[^"]*"', 'material = "unobtainium"', text)
            text = text.replace('supports = ["mount"]', 'supports = ["mounted"]')
            assert "unobtainium" in text and '"mounted"' in text
        (tmp_path / file.name).write_text(text)
    told = "\n".join(find_problems(tmp_path))
    assert "'unobtainium' is neither in [materials] nor a known material" in told
    assert "'mounted'" in told
