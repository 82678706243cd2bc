"""Natural frequencies against beam theory, and the iterative solver against the direct one."""

import numpy as np
import pytest

from codesign import fem
from fem_meshes import box_mesh

STEEL = fem.Material("steel", young_modulus=210e9, poisson_ratio=0.3, density=7850.0, yield_strength=250e6)
LENGTH, WIDTH, HEIGHT = 1.0, 0.03, 0.05
WAVE_SPEED = np.sqrt(210e9 / 7850.0)
ROOT = fem.faces_with_normal([-1, 0, 0])
TIP = fem.faces_with_normal([1, 0, 0])


def beam(divisions=(20, 1, 1), half=False):
    size = np.array([LENGTH, WIDTH / 2 if half else WIDTH, HEIGHT])
    return box_mesh(divisions, lambda x: x * size)


def bending(root, thickness):
    """Euler and Bernoulli's beam; root: of the frequency equation."""
    return root**2 / (2 * np.pi * LENGTH**2) * WAVE_SPEED * thickness / np.sqrt(12)


def test_cantilever_bends_and_stretches_at_the_frequencies_of_beam_theory():
    modes = fem.natural_frequencies(beam(), STEEL, [fem.Support(ROOT)], count=12)
    frequency = modes.frequency
    assert frequency[0] == pytest.approx(bending(1.8751, WIDTH), rel=0.01)
    assert frequency[1] == pytest.approx(bending(1.8751, HEIGHT), rel=0.01)
    assert frequency[2] == pytest.approx(bending(4.6941, WIDTH), rel=0.015)  # shear and rotation lower it
    axial = [k for k in range(12) if (modes.shape[k][:, 0] ** 2).sum() > 0.9 * (modes.shape[k] ** 2).sum()]
    assert frequency[axial[0]] == pytest.approx(WAVE_SPEED / (4 * LENGTH), rel=0.005)
    first = modes.shape[0]
    assert np.abs(first[:, 1]).max() == pytest.approx(2.0 / np.sqrt(7850.0 * LENGTH * WIDTH * HEIGHT), rel=0.01)


def test_a_free_bar_has_six_rigid_motions_and_then_bends():
    frequency = fem.natural_frequencies(beam(), STEEL, [], count=8).frequency
    assert frequency[:6] == pytest.approx(np.zeros(6), abs=1e-3)
    assert frequency[6] == pytest.approx(bending(4.7300, WIDTH), rel=0.01)
    assert frequency[7] == pytest.approx(bending(4.7300, HEIGHT), rel=0.015)


def test_modes_are_lower_bounded_and_fall_under_refinement():
    coarse, fine = (fem.natural_frequencies(beam(d), STEEL, [fem.Support(ROOT)], 4) for d in [(8, 1, 1), (24, 2, 2)])
    assert (fine.frequency < coarse.frequency).all()


def test_symmetric_and_antisymmetric_modes_of_a_half_make_those_of_the_whole():
    whole = fem.natural_frequencies(beam((20, 2, 2)), STEEL, [fem.Support(ROOT)], 4).frequency
    cut = fem.faces_with_normal([0, -1, 0])
    halves = [
        fem.natural_frequencies(
            beam((20, 1, 2), half=True), STEEL, [fem.Support(ROOT), fem.Support(cut, axes, symmetry=True)], 3
        ).frequency
        for axes in ("y", "xz")
    ]
    assert np.sort(np.concatenate(halves))[:4] == pytest.approx(whole, rel=0.005)


def test_modes_need_a_density():
    weightless = fem.Material("weightless", 1e9, 0.3)
    with pytest.raises(ValueError, match="density"):
        fem.natural_frequencies(beam((2, 1, 1)), weightless, [fem.Support(ROOT)])


def test_conjugate_gradients_agree_with_the_factor():
    curved = box_mesh(
        (8, 3, 3), lambda x: np.stack([x[:, 0], 0.3 * x[:, 1] + 0.1 * x[:, 0] ** 2, 0.2 * x[:, 2] + 0.05 * x[:, 1]], 1)
    )
    solve = [fem.Support(ROOT), fem.Support(TIP, displacement=[0, 0, 1e-4])], [fem.Acceleration([0, 0, -9.81])]
    direct, iterative = (fem.solve_static(curved, STEEL, *solve, solver=s) for s in ("direct", "iterative"))
    assert direct.iterations == 0
    assert 0 < iterative.iterations < 100
    assert iterative.residual <= 1e-9
    scale = np.abs(direct.displacement).max()
    np.testing.assert_allclose(iterative.displacement, direct.displacement, atol=1e-8 * scale)
    assert iterative.peak_stress == pytest.approx(direct.peak_stress, rel=1e-7)


def test_the_solver_is_chosen_by_the_memory_of_the_factor():
    solve = beam((20, 4, 4)), STEEL, [fem.Support(ROOT)], [fem.Force(TIP, [0, 0, 1.0])]
    assert fem.solve_static(*solve).iterations == 0
    assert fem.solve_static(*solve, memory_limit=2e7).iterations > 0
    with pytest.raises(ValueError, match="solver"):
        fem.solve_static(*solve, solver="magic")
