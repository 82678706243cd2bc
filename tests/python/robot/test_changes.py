"""Lengths of the robot as design variables: possible bodies, what hangs on a link, the effect on the whole."""

from functools import cache

import numpy as np
import pytest

from codesign import dynamics as dyn
from codesign import load_study
from codesign.chain.flight import find_trajectory, flight_settings
from codesign.errors import UrdfError
from codesign.robot import description
from codesign.robot.changes import RobotChange, Stretch, change_robot, inertial_of, pseudo_inertia
from codesign.robot.description import RobotDescription
from codesign.robot.inertial import Inertial
from codesign.robot.urdf_xml import normalized

VARIABLES = ("height", "shoulder_width", "hip_distance", "ankle_height", "foot_length")
RANGES = {"height": (-40, 60), "shoulder_width": (-20, 60), "hip_distance": (-10, 60), "ankle_height": (-10, 60)}
RANGES |= {"foot_length": (-60, 60)}


@cache
def base() -> RobotDescription:
    study = load_study("ironcub_whole")
    return RobotDescription.from_text(study.build_robot(study.baseline))


@cache
def changes() -> tuple[RobotChange, ...]:
    return tuple(load_study("ironcub_whole").config.robot.changes)


def changed(**values: float) -> RobotDescription:
    return change_robot(base(), changes(), dict.fromkeys(VARIABLES, 0.0) | values)


def whole(robot: RobotDescription) -> tuple[float, np.ndarray, np.ndarray]:
    """Mass, center of mass and inertia about it at the zero posture, axes of the root link."""
    model = dyn.load_urdf(robot.to_text(), joints=[])
    inertia = dyn.locked_inertia(model, np.eye(4), np.zeros(0))
    return robot.total_mass, dyn.center_of_mass(model, np.eye(4), np.zeros(0)), inertia[-3:, -3:]


def test_pseudo_inertia_goes_there_and_back() -> None:
    body = Inertial(
        2.0, np.array([0.1, -0.2, 0.3]), np.diag([0.03, 0.04, 0.05]) + 0.002 * (np.ones((3, 3)) - np.eye(3))
    )
    back = inertial_of(pseudo_inertia(body))
    assert back.mass == body.mass
    np.testing.assert_allclose(back.com, body.com, atol=1e-15)
    np.testing.assert_allclose(back.inertia, body.inertia, atol=1e-15)


def test_a_stretched_beam_is_the_longer_beam() -> None:
    def beam(length: float) -> Inertial:
        mass, width = 3.0 * length, 0.04
        along, across = mass * width**2 / 6.0, mass * (length**2 + width**2) / 12.0
        return Inertial(mass, np.array([0.5 * length, 0.0, 0.0]), np.diag([along, across, across]))

    change = RobotChange(variable="v", link="beam", direction=(1.0, 0.0, 0.0), from_m=0.0, to_m=0.5)
    stretched = Stretch(change, 0.2).inertial(beam(0.5))
    assert stretched.mass == pytest.approx(beam(0.7).mass)
    np.testing.assert_allclose(stretched.com, beam(0.7).com, atol=1e-15)
    np.testing.assert_allclose(stretched.inertia, beam(0.7).inertia, atol=1e-14)


# value [mm]: mass [kg], height of the center of mass [mm], inertia xx, yy, zz [kg m²], sole [m]; None: not given.
EFFECTS = [
    ("height", 0, 66.317, -2.9, 7.156, 6.418, 1.198, -0.6326),
    ("height", -40, 66.317, -6.4, 7.019, None, None, None),
    ("height", 60, 66.317, 2.2, 7.393, None, None, None),
    ("shoulder_width", -20, 66.246, -3.7, None, None, 1.153, None),
    ("shoulder_width", 60, 66.528, -0.5, None, None, 1.346, None),
    ("hip_distance", -10, 66.158, None, None, None, 1.179, None),
    ("hip_distance", 60, 67.270, None, None, None, 1.345, None),
    ("ankle_height", -10, 66.083, -0.6, 7.051, None, None, -0.6226),
    ("ankle_height", 60, 67.716, -17.3, 7.825, None, None, -0.6926),
    ("foot_length", -60, 65.355, 5.8, 6.804, None, None, None),
    ("foot_length", 60, 67.278, -11.5, 7.498, None, None, None),
]


@pytest.mark.parametrize(("variable", "value", "mass", "height", "xx", "yy", "zz", "sole"), EFFECTS)
def test_effect_on_the_whole_robot(variable, value, mass, height, xx, yy, zz, sole) -> None:
    robot = changed(**{variable: value})
    total, com, inertia = whole(robot)
    assert total == pytest.approx(mass, abs=1.5e-3)
    assert height is None or 1e3 * com[2] == pytest.approx(height, abs=0.1)
    for wanted, axis in ((xx, 0), (yy, 1), (zz, 2)):
        assert wanted is None or inertia[axis, axis] == pytest.approx(wanted, abs=1.5e-3)
    assert sole is None or robot.frame_poses()["l_sole"][2, 3] == pytest.approx(sole, abs=1e-4)


def test_a_change_of_zero_touches_nothing() -> None:
    assert changed().to_text() == base().to_text()


@pytest.mark.parametrize("seed", range(5))
def test_random_changes_leave_possible_bodies_and_sides_alike(seed: int) -> None:
    rng = np.random.default_rng(seed)
    for _ in range(40):
        values = {name: float(rng.uniform(*RANGES[name])) for name in VARIABLES}
        robot = changed(**values)
        sides = {name: robot.inertial(name) for name in robot.link_names if name.startswith(("l_", "r_"))}
        for name in robot.link_names:
            inertial = robot.inertial(name)
            if inertial is None:
                continue
            assert np.linalg.eigvalsh(pseudo_inertia(inertial)).min() > 0.0, name
            moments = np.linalg.eigvalsh(inertial.inertia)
            assert moments[2] <= moments[0] + moments[1] + 1e-12, name
        for name, left in sides.items():
            right = sides.get(f"r_{name[2:]}")
            if not name.startswith("l_") or left is None or right is None:
                continue
            before = base().inertial(name).mass / base().inertial(f"r_{name[2:]}").mass
            assert left.mass / right.mass == pytest.approx(before, rel=1e-12)
        poses, old = robot.frame_poses(), base().frame_poses()
        for name in ("sole", "arm_jet_turbine", "shoulder_2"):
            asymmetry = old[f"l_{name}"][:3, 3] * [1, -1, 1] - old[f"r_{name}"][:3, 3]
            now = poses[f"l_{name}"][:3, 3] * [1, -1, 1] - poses[f"r_{name}"][:3, 3]
            np.testing.assert_allclose(now, asymmetry, atol=1e-4)


def test_shapes_and_joints_follow_their_link() -> None:
    robot = changed(hip_distance=40.0)
    for side, sign in (("l", 1), ("r", -1)):
        before = base().joint_origin(f"{side}_hip_pitch")[:3, 3]
        moved = robot.joint_origin(f"{side}_hip_pitch")[:3, 3] - before
        share = min(abs(before[1]) / 0.0405, 1.0)  # the hips lie within or beyond the ends of what is stretched
        np.testing.assert_allclose(moved, [0.0, sign * 0.02 * share, 0.0], atol=1e-12)
    old, new = (r.link("root_link").collisions[0].geometry.box.size for r in (base(), robot))
    np.testing.assert_allclose(np.subtract(new, old), [0.0, 0.04, 0.0], atol=1e-12)


def test_what_would_shrink_to_nothing_is_refused() -> None:
    with pytest.raises(UrdfError, match="shortens it by 90 mm of 81 mm"):
        change_robot(base(), [c for c in changes() if c.variable == "hip_distance"], {"hip_distance": -90.0})


def test_the_flown_model_and_the_description_agree() -> None:
    robot = changed(height=20.0, shoulder_width=35.0, hip_distance=25.0, ankle_height=15.0, foot_length=-30.0)
    read = RobotDescription.from_text(robot.to_text())
    model = dyn.load_urdf(robot.to_text(), joints=[])
    for name, pose in read.frame_poses().items():
        np.testing.assert_allclose(dyn.frame_pose(model, np.eye(4), np.zeros(0), name), pose, atol=1e-12)


@pytest.mark.parametrize("seed", range(20))
def test_changed_robots_hover_above_the_ground(seed: int) -> None:
    """200 of them; their frames are those of the model that flies."""
    study = load_study("ironcub_whole")
    settings = flight_settings(study.config.flown, find_trajectory(study.config, "route"))
    settings.duration, settings.path = settings.step, dyn.WaypointPath()
    rng = np.random.default_rng(100 + seed)
    for _ in range(10):
        robot = changed(**{name: float(rng.uniform(*RANGES[name])) for name in VARIABLES})
        model = dyn.load_urdf(robot.to_text(), joints=settings.joints)
        posture = np.zeros(len(settings.joints))
        for name, pose in robot.frame_poses().items():
            np.testing.assert_allclose(dyn.frame_pose(model, np.eye(4), posture, name), pose, atol=1e-12)
        log = dyn.simulate_flight(model, settings)
        assert log.completed
        assert log.min_clearance > 0.09
        assert 0.1 < log.measures.hover_margin < 0.3


def test_changes_read_single_elements_of_a_robot_that_is_read(monkeypatch: pytest.MonkeyPatch) -> None:
    values = {"height": 20.0, "shoulder_width": 35.0, "hip_distance": 25.0, "ankle_height": 15.0, "foot_length": -30.0}
    sizes: list[int] = []
    monkeypatch.setattr(description, "normalized", lambda xml: sizes.append(len(xml)) or normalized(xml))
    robot = changed(**values)
    known = {name: robot.link(name) for name in robot.link_names}
    assert set(sizes) == {1}
    again = RobotDescription.from_text(robot.to_text())
    assert robot.link_names == again.link_names and robot.joint_names == again.joint_names
    for name, link in known.items():
        assert repr(link) == repr(again.link(name))
    for name in robot.joint_names:
        assert repr(robot.joint(name)) == repr(again.joint(name))
