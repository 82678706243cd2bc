"""What a robot weighs stands in one place; where it stands in two, `check` compares them."""

import msgspec
import numpy as np
import pytest

from codesign.chain.study import load_study
from codesign.cli.commands.study import check
from codesign.errors import StudyError
from codesign.robot.changes import RobotChange, change_robot
from codesign.robot.description import RobotDescription
from codesign.robot.table import generated_urdf
from codesign.study import new_study
from codesign.study.checking.everything import find_problems
from codesign.study.loading import STUDIES

DESIGN = {"propeller": "10in", "tilt": 25, "tube": "18x2"}


def edited(folder, file, old, new):
    text = (folder / file).read_text()
    assert old in text
    (folder / file).write_text(text.replace(old, new))


@pytest.fixture
def hexa(tmp_path):
    new_study(tmp_path / "hexa", "hexarotor")
    return tmp_path / "hexa"


def test_a_table_is_read_without_a_urdf_beside_it(hexa):
    assert not (hexa / "robot.urdf").exists()
    before = load_study(hexa)
    light = RobotDescription.from_text(before.build_robot(DESIGN)).total_mass
    edited(hexa, "robot.toml", "mass = 1.9", "mass = 2.4")
    after = load_study(hexa)
    assert RobotDescription.from_text(after.build_robot(DESIGN)).total_mass == pytest.approx(light + 0.5)
    assert after.hash != before.hash
    edited(hexa, "robot.toml", "mass = 2.4", 'mass = "2.4"')
    (told,) = find_problems(hexa)
    assert "robot.toml" in told and "mass" in told


def test_a_motor_is_as_heavy_for_the_flight_as_for_the_arm(hexa):
    study = load_study(hexa)
    robot = RobotDescription.from_text(study.build_robot(DESIGN))
    base = {link: study.base_robot.inertial(link) for link in robot.link_names}
    assert base["rotor_1"] is None
    (mass,) = study.configured(study.space.design(DESIGN)).parts[0].masses
    for k in range(1, 7):
        body = robot.inertial(f"rotor_{k}")
        assert body.mass == mass.mass_kg
        np.testing.assert_allclose(1e3 * body.com, mass.point_mm, atol=1e-12)
        np.testing.assert_allclose(np.diag(body.inertia), mass.inertia_kg_m2)


def test_the_same_motor_with_two_masses_is_noted_with_both(hexa, capsys):
    heavier = 'name = "rotor_1"\nmass = 0.14\ncom = [0.0, 0.0, 0.01725]\n'
    heavier += "inertia = { xx = 0.0000451, yy = 0.0000451, zz = 0.0000701, xy = 0.0, xz = 0.0, yz = 0.0 }"
    edited(hexa, "robot.toml", 'name = "rotor_1"', heavier)
    assert check(str(hexa)) == 0
    told = "note: parts.arm.masses: what hangs on 'motor' has another mass than the robot's link 'rotor_1'"
    assert f"{told} (0.0971 and 0.14 kg)" in capsys.readouterr().out
    edited(hexa, "robot.toml", "mass = 0.14", "mass = 0.0971")
    assert check(str(hexa)) == 0
    assert "note:" not in capsys.readouterr().out


def test_a_urdf_that_is_not_that_of_its_table_is_refused_with_the_command(tmp_path):
    new_study(tmp_path / "quad")
    assert find_problems(tmp_path / "quad") == []
    table = tmp_path / "quad" / "robot.toml"
    mass = next(line for line in table.read_text().splitlines() if line.startswith("mass = "))
    edited(tmp_path / "quad", "robot.toml", mass, "mass = 7.25")
    (told,) = find_problems(tmp_path / "quad")
    urdf = tmp_path / "quad" / "robot.urdf"
    assert f"robot.urdf is not that of robot.toml: python -m codesign.robot.table {table} {urdf}" in told
    with pytest.raises(StudyError, match=r"robot\.urdf is not that of robot\.toml"):
        load_study(tmp_path / "quad")
    urdf.write_text(generated_urdf(table))
    assert find_problems(tmp_path / "quad") == []


def test_a_scaled_link_is_a_similar_body():
    robot = RobotDescription.load(STUDIES / "gimbal_quad" / "robot.urdf")
    link = next(name for name in robot.link_names if robot.inertial(name) and robot.link(name).visuals)
    change = RobotChange(variable="size", link=link, reference_mm=100.0)
    assert change_robot(robot, [change], {"size": 100.0}).to_text() == robot.to_text()
    larger = change_robot(robot, [change], {"size": 150.0})
    body, grown = robot.inertial(link), larger.inertial(link)
    assert grown.mass == pytest.approx(1.5**3 * body.mass)
    np.testing.assert_allclose(grown.com, 1.5 * body.com)
    np.testing.assert_allclose(grown.inertia, 1.5**5 * body.inertia)
    for joint in robot.joint_names:
        factor = 1.5 if robot.joint_parent(joint) == link else 1.0
        np.testing.assert_allclose(larger.joint_origin(joint)[:3, 3], factor * robot.joint_origin(joint)[:3, 3])


@pytest.mark.parametrize(
    ("written", "scale"), [("", "1.5 1.5 1.5"), ('scale="0.001 0.001 0.002"', "0.0015 0.0015 0.003")]
)
def test_meshes_of_a_scaled_link_are_scaled_once(written, scale):
    shape = f'<geometry><mesh filename="a.stl" {written}/></geometry>'
    robot = RobotDescription.from_text(f'<robot name="r"><link name="a"><visual>{shape}</visual></link></robot>')
    change = RobotChange(variable="size", link="a", reference_mm=100.0)
    assert f'scale="{scale}"' in change_robot(robot, [change], {"size": 150.0}).to_text()


def test_a_change_says_what_it_is():
    for wrong, why in (
        ({"joint": "a", "reference_mm": 3.0}, "scales a link"),
        ({"link": "a", "reference_mm": 3.0, "direction": [1, 0, 0]}, "scales a link"),
        ({"link": "a", "from_m": 0.0, "to_m": 1.0}, "needs its direction"),
    ):
        with pytest.raises(msgspec.ValidationError, match=why):
            msgspec.convert({"variable": "size"} | wrong, RobotChange)
