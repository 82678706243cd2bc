"""`codesign new --urdf`: studies of foreign robots that load, pass their checks and fly."""

import pytest

from codesign.chain.fly import fly_robot
from codesign.chain.study import load_study
from codesign.errors import StudyError, UrdfError
from codesign.robot.description import RobotDescription
from codesign.robot.mounts import mended, propellers, start_posture
from codesign.study.own_robot import study_of_robot
from robots import ERD, Robot


def link(name, mass=0.0, moment=0.01):
    inertia = f'<inertia ixx="{moment}" iyy="{moment}" izz="{moment}" ixy="0" ixz="0" iyz="0"/>'
    return f'<link name="{name}"><inertial><mass value="{mass}"/>{inertia}</inertial></link>'


def joint(name, parent, child, xyz="0 0 0", kind="fixed", more=""):
    ends = f'<parent link="{parent}"/><child link="{child}"/><origin xyz="{xyz}"/>'
    return f'<joint name="{name}" type="{kind}">{ends}{more}</joint>'


def limited(low, high):
    return f'<axis xyz="0 1 0"/><limit lower="{low}" upper="{high}" effort="20" velocity="5"/>'


WALKER = (
    '<robot name="walker"><link name="bare"/>'
    + link("trunk", 6.0, 0.1)
    + joint("floating", "bare", "trunk")
    + link("dummy", 1e-6, 0.0)
    + joint("dummy_joint", "trunk", "dummy")
    + link("left", 0.8)
    + joint("hip", "trunk", "left", "0.2 0.1 0", "revolute", limited(-0.5, 0.7))
    + link("right", 0.8)
    + joint("knee", "trunk", "right", "-0.2 -0.1 0", "revolute", limited(0.4, 1.4))
    + link("finger", 0.05, 0.001)
    + joint("slide", "right", "finger", "0.1 0 0", "prismatic", limited(-0.1, 0.1))
    + "</robot>"
)
QUAD = (
    '<robot name="quad">'
    + link("body", 1.2, 0.02)
    + "".join(
        link(f"prop_{k}", 0.02, 1e-5)
        + joint(f"spin_{k}", "body", f"prop_{k}", f"{x} {y} 0.03", "continuous", '<axis xyz="0 0 1"/>')
        for k, (x, y) in enumerate([(0.15, 0.15), (-0.15, -0.15), (0.15, -0.15), (-0.15, 0.15)])
    )
    + "</robot>"
)


@pytest.fixture
def file(tmp_path):
    def written(text, name="robot.urdf"):
        path = tmp_path / name
        path.write_text(text)
        return path

    return written


def flown(folder):
    study = load_study(folder)
    assert study.grounded is None
    return study, fly_robot(study, study.build_robot(study.baseline))


def test_a_robot_with_legs_gets_jets_around_it_and_flies(tmp_path, file):
    written = study_of_robot(tmp_path / "study", file(WALKER))
    study, flight = flown(tmp_path / "study")
    assert flight["status"] == "completed"
    (group,) = study.config.flight.joint_groups
    assert group.joints == ["hip", "knee"]
    assert group.initial_rad == [0.0, 0.9]  # inside of its range
    assert group.ranges_deg == [(-28, 40), (23, 80)]
    assert "slide" in (tmp_path / "study" / "study.toml").read_text()  # held, and said so
    assert study.controllability(study.baseline).rank == 6
    assert study.controllability(study.baseline).hover_margin == pytest.approx(2.0, rel=0.05)
    assert sorted(path.name for path in written.files) == ["arm.py", "robot.urdf", "study.schema.json", "study.toml"]


def test_jets_on_legs(tmp_path, file):
    study_of_robot(tmp_path / "study", file(WALKER), mounts=["left", "right", "trunk"])
    study = load_study(tmp_path / "study")
    assert study.config.flight.jets.frames == ["jet_1", "jet_2", "jet_3"]
    assert [place.link for place in study.config.parts[0].placements] == ["jet_arm_1", "jet_arm_2", "jet_arm_3"]


def test_a_multirotor_flies_on_its_own_propellers_with_new_arms(tmp_path, file):
    robot = RobotDescription.load(file(QUAD))
    assert propellers(robot) == ["prop_0", "prop_1", "prop_2", "prop_3"]
    study_of_robot(tmp_path / "study", tmp_path / "robot.urdf")
    study, flight = flown(tmp_path / "study")
    assert flight["status"] == "completed"
    jets = study.config.flight.jets
    around = ["prop_1", "prop_2", "prop_0", "prop_3"]  # by azimuth, so that neighbors turn in opposite senses
    assert jets.frames == around
    assert jets.reaction_n_m_per_n == [0.016, -0.016, 0.016, -0.016]
    poses = RobotDescription.from_text(study.build_robot(study.baseline)).frame_poses()
    for prop in around:
        before = robot.frame_poses()[prop]
        assert poses[prop][:3, :3] == pytest.approx(before[:3, :3], abs=1e-12)
        assert poses[prop][:2, 3] == pytest.approx(before[:2, 3], abs=5e-3)  # arms are whole centimeters long


def test_impossible_inertias_are_mended_where_nothing_hangs_on_them(file):
    text = WALKER.replace("</robot>", link("odd", 1e-6, 0.0).replace('ixx="0.0"', 'ixx="1e-6"') + "</robot>")
    text = text.replace("</robot>", joint("odd_joint", "trunk", "odd") + "</robot>")
    robot, names = mended(RobotDescription.load(file(text), as_published=True))
    assert names == ["odd"]
    assert robot.inertial("odd").mass == 1e-6
    heavy = text.replace('<mass value="6.0"/><inertia ixx="0.1"', '<mass value="6.0"/><inertia ixx="0.9"')
    with pytest.raises(UrdfError, match='"trunk"'):
        mended(RobotDescription.load(file(heavy), as_published=True))


def test_what_cannot_be_is_refused(tmp_path, file):
    robot = file(WALKER)
    with pytest.raises(UrdfError, match="no link 'wing'"):
        study_of_robot(tmp_path / "a", robot, mounts=["wing"])
    with pytest.raises(UrdfError, match="bare is the base"):
        study_of_robot(tmp_path / "b", robot, jets=["bare"])
    with pytest.raises(StudyError, match="either jets"):
        study_of_robot(tmp_path / "c", robot, jets=["left"], mounts=["right"])
    with pytest.raises(StudyError, match="not empty"):
        study_of_robot(tmp_path, robot)
    assert not [name for name in "abc" if (tmp_path / name).exists()]


def test_fixed_and_mimicking_joints_are_no_controls(file):
    text = WALKER.replace("</limit>", "")
    mimic = joint("toe", "left", "toe_link", "0 0 0", "revolute", limited(-1, 1) + '<mimic joint="hip"/>')
    robot = RobotDescription.load(file(text.replace("</robot>", link("toe_link", 0.01, 1e-5) + mimic + "</robot>")))
    assert list(start_posture(robot)) == ["hip", "knee"]


@pytest.mark.parametrize("path", ["go1_description/urdf/go1.urdf", "robots/iris.urdf", "hextilt_flying_arm_5.urdf"])
def test_public_robots_fly(tmp_path, path):
    study_of_robot(tmp_path / "study", Robot(path, "", ERD, path).file())
    _, flight = flown(tmp_path / "study")
    assert flight["status"] == "completed"
    assert flight["flight"]["max_com_error"] < 0.3
