"""The Mk3's jet: its table, and the inverse of its throttle."""

import numpy as np
import pytest

import ironcub_predictive as whole


@pytest.mark.parametrize(
    ("throttle", "thrust"), [(0, 16.003), (25, 58.607), (50, 110.555), (75, 168.950), (100, 222.127)]
)
def test_steady_thrust_of_a_throttle(throttle: float, thrust: float) -> None:
    wanted = whole.MK3.variable(throttle)
    for near, sign in ((thrust - 6e-4, -1), (thrust + 6e-4, 1)):
        assert sign * (whole.MK3.steady_variable(near) - wanted) > 0


def test_throttle_and_its_variable_are_inverse() -> None:
    for throttle in np.linspace(0.0, 100.0, 41):
        assert whole.MK3.throttle(whole.MK3.variable(throttle)) == pytest.approx(throttle, abs=1e-10)
    assert whole.MK3.variable(0.0) == pytest.approx(-1.521146, abs=1e-6)
    assert whole.MK3.variable(100.0) == pytest.approx(1.650957, abs=1e-6)
    assert whole.MK3.throttle(-9.0) == 0.0 and whole.MK3.throttle(9.0) == 100.0
