"""Fatigue: Basquin's line, Goodman's mean stress, rainflow counts and Miner's sum against hand calculations."""

import math

import numpy as np
import pytest

from codesign.fem.fatigue import FatigueStrength, damage, signed_von_mises

ALUMINUM = FatigueStrength(amplitude=159e6, cycles=5e8, ultimate=572e6)  # 7075-T6


def test_the_line_passes_through_both_points() -> None:
    """At its own amplitude the stated cycles; at 0.9 of the ultimate strength a thousand."""
    assert ALUMINUM.life(159e6, 0.0) == pytest.approx(5e8)
    assert ALUMINUM.life(0.9 * 572e6, 0.0) == pytest.approx(1e3)


def test_a_tensile_mean_counts_as_a_larger_amplitude() -> None:
    """Goodman: 100 MPa about 143 MPa (a quarter of the ultimate strength) is 133.3 MPa; compression changes nothing."""
    assert ALUMINUM.life(100e6, 143e6) == pytest.approx(ALUMINUM.life(100e6 / 0.75, 0.0))
    assert ALUMINUM.life(100e6, -143e6) == pytest.approx(ALUMINUM.life(100e6, 0.0))
    assert ALUMINUM.life(300e6, 300e6) == 0.0
    assert ALUMINUM.life(0.0, 100e6) == math.inf


def test_damage_of_a_known_sequence() -> None:
    """0, 200, 100, 200, 0 MPa: one cycle of range 100 about 150, two half cycles of range 200 about 100."""
    wanted = 1.0 / ALUMINUM.life(50e6, 150e6) + 1.0 / ALUMINUM.life(100e6, 100e6)
    assert damage([200e6, 100e6, 200e6], ALUMINUM) == pytest.approx(wanted)
    assert damage(np.zeros(5), ALUMINUM) == 0.0
    assert damage([600e6], ALUMINUM) == math.inf


def test_twice_the_flight_is_twice_the_damage_of_its_cycles() -> None:
    """A thousand equal cycles between 0 and 300 MPa do a thousand times the damage of one."""
    one = damage([300e6], ALUMINUM)
    assert damage(np.tile([300e6, 0.0], 1000), ALUMINUM) == pytest.approx(1000 * one)


def test_the_sign_is_that_of_the_largest_principal_stress() -> None:
    """Tension, compression, shear (von Mises √3 times), and pressure all around (none)."""
    stress = [[5e6, 0, 0, 0, 0, 0], [-5e6, 0, 0, 0, 0, 0], [0, 0, 0, 2e6, 0, 0], [-3e6, -3e6, -3e6, 0, 0, 0]]
    np.testing.assert_allclose(signed_von_mises(stress), [5e6, -5e6, math.sqrt(3) * 2e6, 0.0], atol=1e-6)


def test_figures_that_make_no_line_are_refused() -> None:
    """A fatigue strength above 0.9 of the ultimate strength."""
    with pytest.raises(ValueError, match="fatigue strength"):
        FatigueStrength(550e6, 1e7, 572e6)
