"""Controllability at the start posture: closed forms, finite differences, and words for what cannot fly."""

import numpy as np
import pytest

from codesign import dynamics as dyn
from codesign.chain.controllability import (
    GRAVITY,
    _jets,
    _joint_map,
    controllability,
    grounded,
    study_controllability,
)
from codesign.chain.flight import find_trajectory, flight_settings, joint_names
from codesign.chain.study import load_study
from codesign.errors import StudyError
from codesign.search.optimization import optimize
from codesign.study import new_study

MASS, ARM, MOST = 2.0, 0.3, 8.0


def star(count, tilt=0.0, mass=MASS):
    """URDF of a disc with `count` frames around it, turned by ±tilt [rad] about their arms; z is a jet's axis."""
    links, joints = "", ""
    for k in range(count):
        azimuth = 2.0 * np.pi * k / count
        x, y = ARM * np.cos(azimuth), ARM * np.sin(azimuth)
        links += f'<link name="jet_{k}"/>'
        joints += (
            f'<joint name="fixed_{k}" type="fixed"><parent link="body"/><child link="jet_{k}"/>'
            f'<origin xyz="{x} {y} 0" rpy="{tilt * (-1) ** k} 0 {azimuth}"/></joint>'
        )
    inertia = '<inertia ixx="0.02" iyy="0.02" izz="0.04" ixy="0" ixz="0" iyz="0"/>'
    body = f'<link name="body"><inertial><mass value="{mass}"/>{inertia}</inertial></link>'
    return f'<robot name="star">{body}{links}{joints}</robot>'


def judged(count, tilt=0.0, mass=MASS, reaction=0.0, least=0.0):
    settings = dyn.FlightSettings()
    settings.actuators = [
        dyn.Actuator(
            frame=f"jet_{k}", axis=np.array([0.0, 0.0, 1.0]), reaction=reaction * (-1) ** k,
            dynamics=dyn.RateIntegrator(), thrust_min=least, thrust_max=MOST, thrust_rate=100.0,
        )
        for k in range(count)
    ]  # fmt: skip
    return controllability(dyn.load_urdf(star(count, tilt, mass), joints=[]), settings)


def test_four_parallel_jets_give_no_yaw():
    found = judged(4)
    assert found.rank == 3
    assert found.missing == ("forward force", "sideways force", "yaw moment")
    reason = "cannot hold its attitude: the 4 jets are parallel, have no drag torque and give no yaw moment"
    assert found.reason == reason


def test_drag_torque_gives_a_quadrotor_its_yaw():
    found = judged(4, reaction=0.016)
    assert (found.rank, found.reason) == (4, None)
    assert found.hover_margin == pytest.approx(4 * MOST / (MASS * GRAVITY), rel=1e-9)
    assert found.notes == (
        "no forward force and no sideways force without banking, which the momentum controller does not do",
    )


def test_tilted_rotors_reach_everything():
    tilt = 0.4
    found = judged(6, tilt=tilt)
    assert (found.rank, found.missing, found.reason, found.notes) == (6, (), None, ())
    assert found.hover_margin == pytest.approx(6 * MOST * np.cos(tilt) / (MASS * GRAVITY), rel=1e-9)
    assert found.condition > judged(6, tilt=0.8).condition  # more tilt, more force sideways


def test_what_is_too_heavy_or_out_of_balance_cannot_hover():
    weak = judged(6, tilt=0.4, mass=5.0)
    assert weak.hover_margin == pytest.approx(6 * MOST * np.cos(0.4) / (5.0 * GRAVITY), rel=1e-9)
    assert (
        weak.reason
        == f"cannot hover: at the start posture full thrust carries {weak.hover_margin:.2g} times its weight"
    )
    idle = judged(6, tilt=0.4, mass=0.5, least=2.0)
    assert idle.reason == "cannot hover: at the start posture the least thrust carries 2.3 times its weight"
    assert judged(1).reason == "cannot hold its attitude: the only jet gives no roll moment and no yaw moment"


def test_joints_turn_and_shift_the_jets_as_finite_differences_say():
    study = load_study("ironcub_paper")
    config = study.config
    settings = flight_settings(config.flight, find_trajectory(config, config.flight.trajectory))
    model = dyn.load_urdf(study.build_robot(study.baseline), joints=joint_names(config.flight))
    thrusts = np.array([120.0, 90.0, 150.0, 170.0])

    def wrench(joints):
        com = dyn.center_of_mass(model, settings.base_pose, joints)
        total = np.zeros(6)
        for jet, thrust in zip(settings.actuators, thrusts, strict=True):
            pose = dyn.frame_pose(model, settings.base_pose, joints, jet.frame)
            axis = pose[:3, :3] @ jet.axis
            total += thrust * np.concatenate([axis, np.cross(pose[:3, 3] - com, axis) + jet.reaction * axis])
        return total

    expected = np.zeros((6, len(settings.joints)))
    step = 1e-6
    for j in range(len(settings.joints)):
        change = np.zeros(len(settings.joints))
        change[j] = step
        difference = wrench(settings.initial_joints + change) - wrench(settings.initial_joints - change)
        expected[:, j] = difference / (2.0 * step)
    found = _joint_map(model, settings, _jets(model, settings), thrusts)
    np.testing.assert_allclose(found, expected, atol=1e-6)


def test_shipped_studies_can_fly():
    for name in ("ironcub_paper", "ironcub", "gimbal_quad", "hexarotor"):
        study = load_study(name)
        found = study_controllability(study, study.baseline)
        assert (found.rank, found.reason) == (6, None)
        assert found.hover_margin > 1.2
        assert study.grounded is None


def test_a_search_for_designs_that_cannot_fly_is_refused(tmp_path):
    new_study(tmp_path / "weak")
    file = tmp_path / "weak" / "study.toml"
    file.write_text(file.read_text().replace("max_thrust_n = 250.0", "max_thrust_n = 50.0"))
    study = load_study(tmp_path / "weak")
    assert grounded(study).startswith("cannot hover: at the start posture full thrust carries 0.5")
    with pytest.raises(StudyError, match="cannot hover"):
        optimize(study, out=tmp_path / "run", generations=1, workers=1)
    assert not (tmp_path / "run").exists()
