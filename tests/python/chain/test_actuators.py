"""Propellers as study data: lag, drag torque, own limits and axes, without a change of the engine."""

import msgspec
import numpy as np
import pytest

from codesign import dynamics as dyn
from codesign.chain.flight import actuators
from codesign.chain.fly import fly_robot
from codesign.chain.study import load_study
from codesign.errors import StudyError
from codesign.study import new_study


def with_jets(folder, text):
    """A copy of the template study whose [flight.jets] has more lines."""
    new_study(folder)
    file = folder / "study.toml"
    file.write_text(file.read_text().replace("[flight.jets]\n", f"[flight.jets]\n{text}\n", 1))
    return file


def test_propellers_with_drag_torque_fly(tmp_path):
    senses = "reaction_n_m_per_n = [0.02, -0.02, 0.02, -0.02]\nlag_s = [0.03, 0.03, 0.04, 0.04]"
    study = load_study(with_jets(tmp_path / "study", senses))
    made = actuators(study.config.flight, "lag")
    assert [a.reaction for a in made] == [0.02, -0.02, 0.02, -0.02]
    assert [a.dynamics.time for a in made] == [0.03, 0.03, 0.04, 0.04]
    flown = fly_robot(study, study.build_robot(study.baseline), jets="lag")
    calm = fly_robot(study, study.build_robot(study.baseline), jets="integrator")
    assert flown["status"] == calm["status"] == "completed"
    thrusts = [document["objectives"]["thrust"] for document in (flown, calm)]
    assert thrusts[0] == pytest.approx(thrusts[1], rel=0.02)
    assert thrusts[0] != thrusts[1]


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("lag_s = [0.03, 0.03]", "flight.jets.lag_s: needs one number, or 4"),
        ("axes = [[0.0, 0.0, -2.0], [0.0, 0.0, -1.0], [0.0, 0.0, -1.0], [0.0, 0.0, -1.0]]", "is no unit vector"),
        ("axes = [[0.0, 0.0, -1.0]]", "needs 4 vectors"),
        ('reaction_n_m_per_n = "left"', "reaction_n_m_per_n"),
    ],
)
def test_lists_that_do_not_fit_are_refused(tmp_path, line, message):
    with pytest.raises(StudyError, match=message):
        load_study(with_jets(tmp_path / "study", line))


def test_every_jet_has_its_own_limits():
    flight = load_study("gimbal_quad").config.flight
    jets = msgspec.structs.replace(flight.jets, max_thrust_n=[90.0, 91.0, 92.0, 93.0], min_thrust_n=1.0)
    made = actuators(msgspec.structs.replace(flight, jets=jets), "integrator")
    assert [a.thrust_max for a in made] == [90.0, 91.0, 92.0, 93.0]
    assert all(a.thrust_min == 1.0 and isinstance(a.dynamics, dyn.RateIntegrator) for a in made)
    np.testing.assert_array_equal(made[0].axis, [0.0, 0.0, -1.0])
