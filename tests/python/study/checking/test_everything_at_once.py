"""`codesign check` tells all mistakes of a study at once, and what decides nothing."""

import json

import pytest

from codesign.chain.chain import stress_settings
from codesign.chain.study import load_study
from codesign.cli.commands.study import check
from codesign.errors import ModelError
from codesign.parts.load_case import part_case
from codesign.study import new_study
from codesign.study.checking.everything import find_problems

PLATE = """
from dataclasses import KW_ONLY, dataclass
from codesign.geometry.profile import Path
from codesign.geometry.shape import Extrusion, cylinder
from codesign.parts import Part, parameter


@dataclass(frozen=True)
class Plate(Part):
    thickness: float = parameter("mm", minimum=2.0)
    _: KW_ONLY
    name: str = "plate"
    density: float = 2700.0

    def through_holes(self):
        return 1

    def shape(self):
        outline = Path(-20.0, -20.0).line(20.0, -20.0).line(20.0, 20.0).line(-20.0, 20.0).close(face="sides")
        hole = cylinder(5.0, -1.0, self.thickness + 1.0, face="bore")
        return Extrusion(outline, 0.0, self.thickness) - hole
"""
STUDY = """
name = "plate"
[variables.thickness]
min = 4
max = 8
step = 1
unit = "mm"
[[parts]]
name = "plate"
shape = "plate:Plate"
parameters = { thickness = "thickness" }
material = "6061-t6"
supports = ["sides"]
loads = [{ face = "bore", bearing_n = [0.0, 100.0, 0.0] }]
[fem]
geometry = "full"
[objectives]
minimize = ["mass"]
"""


@pytest.fixture
def plate(tmp_path):
    def written(*changes):
        (tmp_path / "plate.py").write_text(PLATE)
        text = STUDY
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        (tmp_path / "study.toml").write_text(text)
        return tmp_path

    return written


@pytest.fixture
def quad(tmp_path):
    def written(*changes):
        new_study(tmp_path / "study")
        file = tmp_path / "study" / "study.toml"
        text = file.read_text()
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        file.write_text(text)
        return file

    return written


def test_wrong_keys_texts_names_and_faces_are_told_together(quad):
    file = quad(
        ("population = 16", "poulation = 16"),
        ("max_thrust_n = 250.0", 'max_thrust_n = "250"'),
        ('"mount"]', '"mont"]'),
        ('"skid_front"', '"skid_frond"'),
        ('minimize = ["momentum", "joint_velocity", "thrust"]', 'minimize = ["parts.strut.max_bend", "thrust"]'),
    )
    told = "\n".join(found := find_problems(file))
    assert "unknown key 'poulation'" in told
    assert "max_thrust_n: '250' is a text; write the number without quotes" in told
    assert "no face 'mont'; did you mean 'mount'?" in told
    assert "no link 'skid_frond'; did you mean 'skid_front'?" in told
    assert "no number 'parts.strut.max_bend'" in told
    assert len(found) == 5, told


def test_what_had_to_be_left_out_gives_no_problems_of_its_own(plate):
    folder = plate(("min = 4", 'min = "four"'), ('"sides"]', '"side"]'))
    told = find_problems(folder)
    assert len(told) == 1, told
    assert "'four' is a text" in told[0]
    folder = plate(('"plate:Plate"', '"plait:Plate"'), ('["mass"]', '["parts.plate.mass", "parts.plat.mass"]'))
    told = find_problems(folder)
    assert len(told) == 2, told
    assert "ModuleNotFoundError" in told[0]
    assert "no part 'plat'" in told[1]


def test_a_part_without_material_still_has_its_faces_judged(plate):
    told = "\n".join(find_problems(plate(('face = "bore"', 'face = "bor"'), ("[fem]", "[fem]\ntolerence = 1"))))
    assert "no face 'bor'; did you mean 'bore'?" in told
    assert "unknown key 'tolerence'" in told


@pytest.mark.parametrize(
    ("name", "hint"),
    [
        ("parts.plate.zzz", "there are mass, com.N"),
        ("parts.plate.max_displacment", "did you mean 'parts.plate.max_displacement'?"),
        ("parts.plate.cases.load.saftey_factor", "did you mean 'parts.plate.cases.load.safety_factor'?"),
        ("parts.plate.cases.lod.safety_factor", "no load case 'lod' of plate; did you mean 'load'?"),
        ("sum(parts.*.wirk)", "did you mean 'parts.*.work'?"),
    ],
)
def test_numbers_that_no_part_has_are_refused(plate, name, hint):
    (told,) = find_problems(plate(('["mass"]', json.dumps(["mass", name]))))
    assert hint in told


def test_what_no_pin_can_do_is_refused_with_part_and_case(plate):
    folder = plate()
    assert find_problems(folder) == []
    study = load_study(folder)
    axial = plate(("[0.0, 100.0, 0.0]", "[0.0, 0.0, 100.0]"))
    (told,) = find_problems(axial)
    assert "parts.plate.loads: bearing_n on face 'bore': 100 N of it are along the face (the axis of a bore)" in told
    settings = stress_settings(study.config, "plate")
    (case,) = settings.cases
    (load,) = case.loads
    wrong = type(case)(case.name, (type(load)(load.where, (0.0, 30.0, 40.0)),))
    (part,) = study.build_parts({"thickness": 4}).values()
    with pytest.raises(ModelError, match="plate, load case load: bearing_n on face 'bore': 40 N"):
        part_case(part, type(settings)(**{**{n: getattr(settings, n) for n in settings.__slots__}, "cases": (wrong,)}))


def test_limits_name_where_they_come_from(plate, capsys):
    assert check(str(plate())) == 0
    assert "Safety factor ≥ 10 (constraints.safety_factor_min, its default)" in capsys.readouterr().out
    given = (
        "[objectives]",
        "[constraints]\nsafety_factor_min = 3\n[constraints.limits]\nmass = { max = 1 }\n[objectives]",
    )
    assert check(str(plate(given))) == 0
    told = capsys.readouterr().out
    assert "Safety factor ≥ 3 (constraints.safety_factor_min)" in told
    assert "Mass of the parts ≤ 1 kg (constraints.limits)" in told


def test_numbers_that_never_change_are_noted(capsys, tmp_path):
    new_study(tmp_path / "hexa", "hexarotor")
    file = tmp_path / "hexa" / "study.toml"
    limits = "[constraints.limits]\n"
    file.write_text(file.read_text().replace(limits, f'{limits}"flight.max_torque" = {{ max = 50.0 }}\n'))
    assert check(str(file)) == 0
    told = capsys.readouterr().out
    assert "note: constraints.limits: 'flight.max_torque' is 0 for every design: the robot moves no joints" in told


@pytest.mark.parametrize(
    ("thrust", "landing", "idle"),
    [
        ("force_n = [0.0, 12.0, 0.0] }], safety_factor_min = 4.0", "force_n = [0.0, 60.0, 0.0] }]", "thrust"),
        ("force_n = [0.0, 12.0, 0.0] }], safety_factor_min = 9.0", "force_n = [0.0, 60.0, 0.0] }]", "landing"),
        ("force_n = [0.0, 12.0, 0.0] }]", "force_n = [9.0, 60.0, 0.0] }]", None),
        ("force_n = [0.0, 12.0, 0.0] }]", "force_n = [0.0, -60.0, 0.0] }]", None),
        ("force_n = [0.0, 12.0, 0.0] }]", "bearing_n = [0.0, 60.0, 0.0] }]", None),
    ],
)
def test_a_load_case_that_another_outdoes_is_noted(plate, thrust, landing, idle, capsys):
    cases = "".join(
        f'{{ name = "{name}", loads = [{{ face = "bore", {load} }},'
        for name, load in (("thrust", thrust), ("landing", landing))
    )
    folder = plate(
        ('loads = [{ face = "bore", bearing_n = [0.0, 100.0, 0.0] }]', f"cases = [{cases}]"),
        ("[objectives]", "[constraints]\nsafety_factor_min = 1.5\n[objectives]"),
    )
    assert check(str(folder)) == 0
    told = capsys.readouterr().out
    if idle is None:
        assert "decides nothing" not in told
    else:
        assert f"note: parts.plate.cases[{idle}]: decides nothing" in told
        assert told.count("decides nothing") == 1


def test_time_measures_several_designs_and_names_what_was_the_same(plate, capsys):
    limit = '[constraints.limits]\n"parts.plate.nodes" = { max = 1e9 }\n"costs:fixed" = { max = 3.0 }\n[objectives]'
    folder = plate(("[objectives]", limit))
    (folder / "costs.py").write_text("def fixed(document):\n    return 2.5\n")
    assert check(str(folder), time=True, as_json=True) == 0
    document = json.loads(capsys.readouterr().out)
    designs = document["evaluation"]["designs"]
    assert [design["design"]["thickness"] for design in designs] == [6, 4, 8]
    assert all(design["cpu_seconds"] > 0.0 for design in designs)
    assert document["evaluation"]["constant"] == {"costs:fixed": 2.5}
