"""What `codesign check` says of numbers that are texts, and of numbers that a study does not have."""

import msgspec

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
