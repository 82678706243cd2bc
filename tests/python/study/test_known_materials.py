"""A study's parts may be of a material that is known by name; the study's own table goes first."""

import tomllib

import pytest

from codesign.chain.chain import stress_settings
from codesign.chain.study import Study
from codesign.errors import StudyError
from codesign.study import new_study
from codesign.study.loading import study_from


@pytest.fixture(scope="module")
def template(tmp_path_factory):
    folder = tmp_path_factory.mktemp("materials") / "study"
    new_study(folder)
    path = folder / "study.toml"
    return tomllib.loads(path.read_text()), path


def with_material(raw, name, **own):
    part = raw["parts"][0] | {"material": name}
    return {key: value for key, value in raw.items() if key != "materials"} | {"parts": [part]} | own


def test_a_known_material_needs_no_table(template):
    raw, path = template
    study = study_from(with_material(raw, "ti-6al-4v"), path, Study)
    material = stress_settings(study.config, "strut").material
    assert (material.young_modulus, material.yield_strength, material.density) == (113.8e9, 880e6, 4430.0)
    assert study.build_parts({"reach": 200, "height": 30})["strut"].density == 4430.0


def test_the_study_s_own_material_goes_first(template):
    raw, path = template
    own = raw["materials"]["ergal"] | {"yield_strength_mpa": 800.0}
    study = study_from(with_material(raw, "ti-6al-4v", materials={"ti-6al-4v": own}), path, Study)
    assert stress_settings(study.config, "strut").material.yield_strength == 800e6


def test_an_unknown_material_is_answered_by_the_nearest(template):
    raw, path = template
    with pytest.raises(StudyError, match=r"parts\.strut\.material: '7075-T6' is neither .* did you mean '7075-t6'\?"):
        study_from(with_material(raw, "7075-T6"), path, Study)
