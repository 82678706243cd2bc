"""Lists and named choices as design variables: materials, sections of a catalog, from the file to the numbers."""

import copy
import json
import tomllib

import pytest

from codesign.chain.chain import stress_settings
from codesign.chain.study import Study
from codesign.cli.options import parse_design
from codesign.errors import DesignError, StudyError
from codesign.study import new_study
from codesign.study.checking.everything import find_problems
from codesign.study.loading import study_from

VARIABLES = """
[variables.reach]
values = [150, 200, 280]
unit = "mm"

[variables.alloy]
label = "alloy"
choices = ["ergal", "ti-6al-4v", "pa12-sls", "316l"]
sets = ["parts.strut.material"]

[variables.section]
unit = "mm"
[variables.section.choices]
low = { height = 20, "flight.gains.attitude_proportional" = 50.0 }
high = { height = 32, "flight.gains.attitude_proportional" = 60.0 }
"""


@pytest.fixture(scope="module")
def template(tmp_path_factory):
    folder = tmp_path_factory.mktemp("choices") / "study"
    new_study(folder)
    path = folder / "study.toml"
    raw = tomllib.loads(path.read_text())
    raw["variables"] = tomllib.loads(VARIABLES)["variables"]
    raw["parts"][0]["parameters"]["height"] = "section.height"
    raw["baseline"] = {"reach": 200, "alloy": "ergal", "section": "high"}
    return raw, path


@pytest.fixture(scope="module")
def study(template):
    return study_from(*template, Study)


def test_a_choice_of_names_sets_the_material(study):
    for name, density in (("ergal", 2810.0), ("ti-6al-4v", 4430.0), ("316l", 8000.0)):
        design = study.space.design({"reach": 200, "alloy": name, "section": "high"})
        config = study.configured(design)
        assert stress_settings(config, "strut").material.name == name
        assert study.build_parts(design)["strut"].density == density


def test_a_choice_of_numbers_sets_parameters_and_places(study):
    low, high = ({"reach": 150, "alloy": "ergal", "section": name} for name in ("low", "high"))
    assert [study.build_parts(design)["strut"].height for design in (low, high)] == [20.0, 32.0]
    gains = [study.configured(study.space.design(design)).flight.gains for design in (low, high)]
    assert [gain.attitude_proportional for gain in gains] == [50.0, 60.0]


def test_a_design_is_given_by_names_and_evaluated(study):
    design = parse_design(["reach=200", "alloy=ti-6al-4v", "section=high"])
    evaluation = study.evaluate(design)
    assert evaluation.design == {"reach": 200, "alloy": "ti-6al-4v", "section": "high"}
    assert evaluation.status in ("feasible", "infeasible")
    lighter = study.evaluate(study.baseline)
    assert evaluation.parts["strut"]["mass"] / lighter.parts["strut"]["mass"] == pytest.approx(4430.0 / 2810.0)
    assert json.loads(evaluation.to_json())["design"]["alloy"] == "ti-6al-4v"
    with pytest.raises(DesignError, match=r"did you mean 'ti-6al-4v'\?"):
        study.evaluate({"reach": 200, "alloy": "ti6al4v", "section": "high"})


@pytest.mark.parametrize(
    ("place", "value", "message"),
    [
        (("alloy", "choices"), ["ergal"], "alloy.choices: 'ergal' alone is no choice"),
        (("alloy", "choices"), ["ergal", "ergal"], "alloy.choices: ergal is listed twice"),
        (("alloy", "choices"), ["ergal", "pla", "ergl", "petg"], "'ergl' is neither .* did you mean 'ergal'"),
        (("alloy", "sets"), ["parts.strut.materal"], "did you mean 'parts.strut.material'"),
        (("alloy", "sets"), ["parts.strut.loads.0.pressing_n"], "not a text"),
        (("alloy", "unit"), "mm", "names have no unit"),
        (("reach", "values"), [200, 150], "values: must ascend"),
        (("reach", "min"), 5.0, "either min, max and step, or values, or choices"),
        (("section", "choices", "low"), {"height": 20}, "must set the same keys"),
        (("section", "choices", "low", "height"), "tall", "not a number"),
        (("section", "sets"), ["flight.step_s"], "without sets"),
    ],
)
def test_what_cannot_be_chosen_is_refused(template, place, value, message):
    raw, path = template
    wrong = copy.deepcopy(raw)
    node = wrong["variables"]
    for key in place[:-1]:
        node = node[key]
    node[place[-1]] = value
    with pytest.raises(StudyError, match=message):
        study_from(wrong, path, Study)


def test_a_part_takes_a_number_of_a_choice_not_the_choice(template):
    raw, path = template
    part = raw["parts"][0]
    for given, message in (
        ("section", "is a choice of names; there are section.height"),
        ("section.heigt", r"did you mean 'section\.height'\?"),
    ):
        wrong = raw | {"parts": [part | {"parameters": part["parameters"] | {"height": given}}]}
        with pytest.raises(StudyError, match=message):
            study_from(wrong, path, Study)


def test_the_start_of_a_study_has_no_problems(template):
    assert find_problems(template[1]) == []
