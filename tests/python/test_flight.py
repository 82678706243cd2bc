"""Flight: reproduction of the published robots."""

from pathlib import Path

import numpy as np
import pytest

import ironcub_flight
from codesign import dynamics as dyn

# Script objectives of the published robots (shared/data/published/README.md):
# |E_w|, |E_l|, torso, left arm, right arm, thrust [N].
PUBLISHED = {
    "optim1": (4.69508996, 106.07285930, 67.55456783, 301.37911992, 294.10473992, 656.84292784),
    "optim3": (6.98706386, 107.58307995, 66.44305356, 278.23660247, 274.27670015, 659.81837134),
}


@pytest.mark.parametrize("robot", PUBLISHED)
def test_published_robot_gives_the_published_objectives(shared_data: Path, robot: str) -> None:
    urdf = (shared_data / "published" / f"{robot}.urdf").read_text()
    model = dyn.load_urdf(urdf, joints=ironcub_flight.JOINTS, as_published=True)
    log = dyn.simulate_flight(model, ironcub_flight.settings(1))
    assert log.completed and log.failure_reason is None and log.qp_failures == 0
    parts = log.script_parts
    got = [parts.angular_momentum, parts.linear_momentum, *parts.joint_velocity, log.script.thrust]
    np.testing.assert_allclose(got, PUBLISHED[robot], rtol=2e-9)  # all printed digits
    assert not log.ground_touched


def test_histories_are_read_only_views_that_outlive_the_log(shared_data: Path) -> None:
    urdf = (shared_data / "published" / "optim1.urdf").read_text()
    model = dyn.load_urdf(urdf, joints=ironcub_flight.JOINTS, as_published=True)
    settings = ironcub_flight.settings(1)
    settings.duration = 0.8
    log = dyn.simulate_flight(model, settings)
    joints = log.joint_positions
    assert joints.shape == (101, 23) and joints.flags.c_contiguous and not joints.flags.owndata
    assert np.shares_memory(joints, log.joint_positions)
    assert log.base_rotation.shape == (101, 3, 3) and log.time.shape == (101,)
    np.testing.assert_allclose(log.base_rotation @ np.swapaxes(log.base_rotation, 1, 2), [np.eye(3)] * 101, atol=1e-13)
    with pytest.raises(ValueError, match="read-only"):
        joints[0, 0] = 1.0
    first = joints[0].copy()
    del log
    np.testing.assert_array_equal(joints[0], first)
