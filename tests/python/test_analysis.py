"""The error estimate of the peak stress."""

from types import SimpleNamespace

import numpy as np
import pytest

from codesign import fem
from codesign.analysis import stress_error

STEEL = fem.Material("steel", young_modulus=210e9, poisson_ratio=0.3, density=7850.0, yield_strength=250e6)
CORNERS = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.1, 1.2, 0.0], [0.0, 0.2, 0.9]])
EDGES = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))
NODES = np.vstack([CORNERS, [(CORNERS[i] + CORNERS[j]) / 2 for i, j in EDGES]])


def analysis(displacement, von_mises, peak):
    mesh = SimpleNamespace(nodes=NODES, tets=np.arange(10)[None, :])
    result = SimpleNamespace(displacement=displacement, von_mises=von_mises, peak_position=NODES[peak])
    return SimpleNamespace(mesh=mesh, result=result)


@pytest.mark.parametrize("peak", range(10))
def test_no_error_where_the_recovered_stress_is_that_of_the_field(peak):
    # simple shear u_x = g y: tau = G g, von Mises sqrt(3) tau
    g, shear_modulus = 1e-4, 210e9 / 2.6
    displacement = np.column_stack([g * NODES[:, 1], np.zeros(10), np.zeros(10)])
    exact = np.full(10, np.sqrt(3) * shear_modulus * g)
    assert stress_error(analysis(displacement, exact, peak), STEEL) == pytest.approx(0.0, abs=1e-3)
    assert stress_error(analysis(displacement, exact + 5e5, peak), STEEL) == pytest.approx(5e5)


@pytest.mark.parametrize("peak", range(10))
def test_quadratic_fields_are_exact_too(peak):
    # uniaxial strain e_xx = 2 a x: von Mises 2 G |e_xx|
    a, shear_modulus = 1e-4, 210e9 / 2.6
    displacement = np.column_stack([a * NODES[:, 0] ** 2, np.zeros(10), np.zeros(10)])
    exact = 2 * shear_modulus * np.abs(2 * a * NODES[:, 0])
    assert stress_error(analysis(displacement, exact, peak), STEEL) == pytest.approx(0.0, abs=1e-3)
