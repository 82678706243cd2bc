"""Loads on named faces: pressed along the mean normal, or by a vector; what makes no sense is refused."""

import numpy as np
import pytest

from codesign import _core
from codesign.chain.chain import stress_settings
from codesign.chain.study import load_study
from codesign.errors import ModelError, StudyError
from codesign.geometry.profile import Resolution
from codesign.geometry.shape import Frame, cylinder
from codesign.geometry.solid import build_solid
from codesign.parts.load_case import PressedFace, PushedFace, face_force, part_case, pressing_direction
from codesign.parts.surface import surface_mesh
from codesign.study import new_study

PRESSED = '{ face = "seat", pressing_n = 250.0 }'
BORE = '- cylinder(8.0, -60.0, 60.0, Frame((self.reach, 0.0, 0.0)), face="bore")'


def surface(shape):
    return surface_mesh(build_solid(shape, Resolution(48)).tidied())


def study_with_bore(folder, load):
    """The template study, the strut's seat bored through and loaded there."""
    new_study(folder)
    file, part = folder / "study.toml", folder / "strut.py"
    part.write_text(part.read_text().replace("across) + seat", f"across) + seat {BORE}"))
    file.write_text(file.read_text().replace(PRESSED, load))
    return file


def test_a_face_is_pressed_against_its_mean_normal():
    rod = surface(cylinder(5.0, 0.0, 20.0, Frame((0.0, 0.0, 0.0)), start_face="foot", face="side"))
    assert pressing_direction(rod, "foot") == pytest.approx([0, 0, 1], abs=1e-9)
    with pytest.raises(ModelError, match=r"'side': its normals cancel.*force_n = \[x, y, z\]"):
        pressing_direction(rod, "side")
    with pytest.raises(ModelError, match="rod: pressing_n on face 'side': its normals cancel"):
        face_force(rod, PressedFace("side", 250.0), "rod")
    with pytest.raises(ModelError, match="the force on face 'side' is zero"):
        face_force(rod, PushedFace("side", (0.0, 0.0, 0.0)), "rod")
    with pytest.raises(StudyError, match=r"rod: no face 'sides'.*side"):
        face_force(rod, PushedFace("sides", (1.0, 0.0, 0.0)), "rod")


def test_a_whole_bore_cannot_be_pressed(tmp_path):
    """Round-off gave a random direction: safety factors 21, 91 and 20 for reaches of 200, 210 and 220 mm."""
    file = study_with_bore(tmp_path / "study", '{ face = "bore", pressing_n = 250.0 }')
    with pytest.raises(
        StudyError, match=r"parts\.strut\.loads: pressing_n on face 'bore': its normals cancel.*force_n"
    ):
        load_study(file)


def test_a_bore_is_loaded_by_a_vector(tmp_path):
    study = load_study(study_with_bore(tmp_path / "study", '{ face = "bore", force_n = [0.0, 0.0, 250.0] }'))
    factors = []
    for reach in (200.0, 210.0, 220.0):
        part = study.build_parts({"reach": reach, "height": 30.0})["strut"]
        case = part_case(part, stress_settings(study.config, "strut"))
        factors.append(_core.analyze_part(case).result.safety_factor)
    assert np.all(np.diff(factors) < 0.0)  # a longer arm is weaker
    assert factors[2] == pytest.approx(factors[0] * 200.0 / 220.0, rel=0.05)


@pytest.mark.parametrize(
    ("load", "message"),
    [
        ('{ face = "seat" }', "exactly one of pressing_n, force_n"),
        ('{ face = "seat", pressing_n = 250.0, force_n = [0.0, 0.0, 1.0] }', "exactly one of pressing_n, force_n"),
        ('{ face = "seat", pressing_n = 0.0 }', "of a load is zero"),
        ('{ face = "seat", force_n = [0.0, 0.0, 0.0] }', "of a load is zero"),
    ],
)
def test_a_load_has_one_force(tmp_path, load, message):
    with pytest.raises(StudyError, match=message):
        load_study(study_with_bore(tmp_path / "study", load))
