"""Named load cases of a part: one factorization, each with its own limit, all of them in the result."""

import numpy as np
import pytest

from codesign import _core, fem
from codesign.chain.chain import stress_settings
from codesign.chain.judge import limits
from codesign.chain.loads import case_settings
from codesign.chain.study import load_study
from codesign.errors import StudyError
from codesign.parts.load_case import PressedFace, PushedFace, part_case
from codesign.study import new_study
from codesign.study.load_config import LoadConfig, part_load

LOADS = 'loads = [{ face = "seat", pressing_n = 250.0 }]'
THRUST = '{ name = "thrust", loads = [{ face = "seat", pressing_n = 250.0 }] }'
PUSH, FALL = '{ face = "seat", force_n = [0.0, 60.0, -400.0] }', "{ acceleration_m_s2 = [0.0, 0.0, -30.0] }"
LANDING = f'{{ name = "landing", safety_factor_min = 2.0, loads = [{PUSH}, {FALL}] }}'
CASES = f"cases = [{THRUST}, {LANDING}]"
DESIGN = {"reach": 200.0, "height": 30.0}


def study_with(folder, loads):
    new_study(folder)
    file = folder / "study.toml"
    text = file.read_text()
    assert LOADS in text
    file.write_text(text.replace(LOADS, loads))
    return file


def case_of(study):
    part = study.build_parts(DESIGN)["strut"]
    return part_case(part, stress_settings(study.config, "strut"))


def test_cases_solve_like_each_alone_and_the_one_nearest_to_its_limit_governs(tmp_path):
    study = load_study(study_with(tmp_path / "study", CASES))
    both = _core.analyze_part(case_of(study))
    assert both.case_names == ["thrust", "landing"]
    alone = []
    for name, load in (("a", THRUST), ("b", LANDING)):
        single = load_study(study_with(tmp_path / name, f"cases = [{load}]"))
        alone.append(_core.analyze_part(case_of(single)).result)
    for result, reference in zip(both.results, alone, strict=True):
        np.testing.assert_array_equal(result.displacement, reference.displacement)
        assert result.safety_factor == reference.safety_factor
    reserve = [result.safety_factor / least for result, least in zip(both.results, (10.0, 2.0), strict=True)]
    assert both.governing == int(np.argmin(reserve))
    assert both.result.safety_factor == both.results[both.governing].safety_factor


def test_every_case_is_in_the_document_and_has_its_own_limit(tmp_path):
    study = load_study(study_with(tmp_path / "study", CASES))
    evaluation = study.evaluate(DESIGN)
    strut = evaluation.parts["strut"]
    assert set(strut["cases"]) == {"thrust", "landing"}
    assert strut["load_case"] in strut["cases"]
    assert strut["safety_factor"] == strut["cases"][strut["load_case"]]["safety_factor"]
    asked = {limit.quantity.key: limit.least for limit in limits(study.config)}
    assert asked["parts.strut.cases.thrust.safety_factor"] == 10.0
    assert asked["parts.strut.cases.landing.safety_factor"] == 2.0
    landing = strut["cases"]["landing"]["safety_factor"]
    assert evaluation.constraints["parts.strut.cases.landing.safety_factor"] == landing


def test_a_case_that_misses_its_limit_is_named(tmp_path):
    strict = CASES.replace("safety_factor_min = 2.0", "safety_factor_min = 500.0")
    evaluation = load_study(study_with(tmp_path / "study", strict)).evaluate(DESIGN)
    assert evaluation.status == "infeasible"
    assert "strut, load case landing: safety factor" in (evaluation.reason or "")
    assert evaluation.parts["strut"]["load_case"] == "landing"


def test_one_vocabulary_of_loads():
    assert part_load(LoadConfig(face="seat", pressing_n=5.0)) == PressedFace("seat", 5.0)
    assert part_load(LoadConfig(face="seat", force_n=(0.0, 1.0, 0.0))) == PushedFace("seat", (0.0, 1.0, 0.0))
    assert part_load(LoadConfig(face="seat", pressure_mpa=2.0)) == fem.Pressure("seat", 2e6)
    assert part_load(LoadConfig(face="seat", traction_mpa=(0.0, 0.0, 1.0))) == fem.Traction("seat", (0.0, 0.0, 1e6))
    assert part_load(LoadConfig(acceleration_m_s2=(0.0, 0.0, -9.81))) == fem.Acceleration((0.0, 0.0, -9.81))
    remote = part_load(LoadConfig(face="seat", force_n=(0.0, 0.0, 1.0), point_mm=(10.0, 0.0, 0.0)))
    assert remote == fem.AffineTraction("seat", (0.0, 0.0, 1.0), (0.01, 0.0, 0.0), (0.0, 0.0, 0.0))


def test_a_study_without_own_limits_keeps_its_constraint():
    config = load_study("gimbal_quad").config
    assert "safety_factor" in [limit.quantity.key for limit in limits(config)]
    assert case_settings(config.parts[0], config)[0].safety_factor_min is None


@pytest.mark.parametrize(
    ("loads", "message"),
    [
        (LOADS + "\n" + CASES, "either loads .* or cases"),
        (CASES.replace('"landing"', '"thrust"'), "two load cases have the name 'thrust'"),
        (CASES.replace('"seat", force_n', '"seta", force_n'), r"cases\[landing\].loads: no face 'seta'.*seat"),
        ('loads = [{ face = "seat", pressing_n = 5.0, force_n = [1.0, 0.0, 0.0] }]', "exactly one of"),
        ('loads = [{ face = "seat", pressing_n = 5.0, point_mm = [1.0, 0.0, 0.0] }]', "belong to force_n"),
        ("loads = [{ pressing_n = 5.0 }]", "names its face"),
        ('loads = [{ face = "seat", acceleration_m_s2 = [0.0, 0.0, 1.0] }]', "acts on the whole part"),
        ("loads = []", "nothing would load the part"),
    ],
)
def test_load_cases_that_make_no_sense_are_refused(tmp_path, loads, message):
    with pytest.raises(StudyError, match=message):
        load_study(study_with(tmp_path / "study", loads))
