"""Loads that vary: sums of unit responses against direct solutions, and the search for the largest stress of all."""

import numpy as np
import pytest

from codesign import fem
from codesign.geometry.profile import Resolution
from codesign.geometry.shape import box, cylinder
from codesign.geometry.solid import build_solid
from codesign.parts.surface import surface_mesh

POINT = (0.05, 0.01, 0.02)
STEEL = fem.Material("steel", 210e9, 0.3, 7850.0, 250e6)


@pytest.fixture(scope="module")
def mesh() -> fem.TetMesh:
    """A block with a hole across, named faces at both ends."""
    shape = box((0, 0, 0), (60, 20, 12), x0="root", x1="tip") - cylinder(4, -1, 13).moved(20, 10)
    return fem.tetrahedralize(surface_mesh(build_solid(shape, Resolution(24))), 0.006)


def unit_loads() -> list[list[fem.Load]]:
    """Wrench at the tip (6), uniform acceleration (3), its gradient (9)."""
    units: list[list[fem.Load]] = []
    for axis in np.eye(3):
        units.append([fem.AffineTraction("tip", axis, POINT)])
    for axis in np.eye(3):
        units.append([fem.AffineTraction("tip", np.zeros(3), POINT, axis)])
    for axis in np.eye(3):
        units.append([fem.Acceleration(axis)])
    for entry in np.eye(9):
        units.append([fem.Acceleration(np.zeros(3), entry.reshape(3, 3), POINT)])
    return units


def history_of(instants: int, seed: int) -> np.ndarray:
    """A smooth history of the 18 factors whose stresses are alike in size."""
    rng = np.random.default_rng(seed)
    time = np.linspace(0.0, 1.0, instants)[:, None, None]
    waves = np.sin(2 * np.pi * (time * rng.integers(1, 3, (18, 3)) + rng.random((18, 3))))
    size = np.array([100.0] * 3 + [2.0] * 3 + [3e3] * 3 + [1e5] * 9)
    return (waves * rng.random((18, 3))).sum(axis=2) * size


@pytest.mark.parametrize("exclusion", ["local", "published"])
def test_a_history_is_what_direct_solutions_give(mesh: fem.TetMesh, exclusion: fem.static.Exclusion) -> None:
    """20 instants: displacement, stress, reactions, peak and its place equal those of a solution with their loads."""
    system = fem.StaticSystem(mesh, STEEL, [fem.Support("root")], exclusion=exclusion)
    responses = system.unit_responses(unit_loads())
    for factors in history_of(20, seed=1):
        loads = [
            fem.AffineTraction("tip", factors[:3], POINT, factors[3:6]),
            fem.Acceleration(factors[6:9], factors[9:].reshape(3, 3), POINT),
        ]
        direct, summed = system.solve(loads), responses.at(factors)
        for name in ("displacement", "stress", "reactions"):
            wanted = getattr(direct, name)
            np.testing.assert_allclose(getattr(summed, name), wanted, rtol=0, atol=1e-9 * np.abs(wanted).max())
        for name in ("peak_stress", "stress_50", "work", "safety_factor"):
            assert getattr(summed, name) == pytest.approx(getattr(direct, name), rel=1e-9)
        found = responses.peak(factors[None, :])
        assert found.stress == pytest.approx(direct.peak_stress, rel=1e-9)
        np.testing.assert_allclose(found.position, direct.peak_position, atol=1e-9)


@pytest.mark.parametrize("seed", range(2))
def test_no_instant_is_missed(mesh: fem.TetMesh, seed: int) -> None:
    """The bounded search finds what the search of every instant finds, and leaves out pairs."""
    system = fem.StaticSystem(mesh, STEEL, [fem.Support("root")])
    responses = system.unit_responses(unit_loads())
    history = history_of(240, seed)
    peaks = [responses.at(factors).peak_stress for factors in history]
    found = responses.peak(history)
    assert found.instant == int(np.argmax(peaks))
    assert found.stress == pytest.approx(max(peaks), rel=1e-12)
    assert found.visited < 0.6 * found.pairs


def test_the_stress_at_a_node_over_time(mesh: fem.TetMesh) -> None:
    """The unit stresses of a node, times the factors, are the recovered stress of every instant."""
    responses = fem.StaticSystem(mesh, STEEL, [fem.Support("root")]).unit_responses(unit_loads())
    history = history_of(3, seed=9)
    wanted = [responses.at(factors).stress[17] for factors in history]
    units = responses.stress[17].reshape(-1, 6)
    np.testing.assert_allclose(history @ units, wanted, rtol=1e-9, atol=1e-3)


def test_a_turning_bar_is_stretched_as_the_closed_form_says() -> None:
    """Spin w about its end: stress rho w² (L² - x²) / 2 in a slender bar without lateral contraction."""
    bar = surface_mesh(build_solid(box((0, 0, 0), (100, 4, 4), x0="root"), Resolution(8)))
    mesh = fem.tetrahedralize(bar, 0.004)
    spin = np.diag([300.0**2, 0.0, 0.0])  # the field along x of a turn about z
    material = fem.Material("no contraction", 210e9, 0.0, 7850.0, 250e6)
    supports = [fem.Support("root")]
    result = fem.solve_static(mesh, material, supports, [fem.Acceleration(np.zeros(3), spin)], exclusion_distance=0.0)
    x = mesh.nodes[:, 0]
    wanted = 0.5 * 7850.0 * 300.0**2 * (0.1**2 - x**2)
    np.testing.assert_allclose(result.stress[:, 0], wanted, atol=2e-3 * wanted.max())


def test_a_history_of_the_wrong_size_is_refused(mesh: fem.TetMesh) -> None:
    """The message says how many columns it takes."""
    responses = fem.StaticSystem(mesh, STEEL, [fem.Support("root")]).unit_responses(unit_loads())
    with pytest.raises(ValueError, match="18 unit loads"):
        responses.peak(np.zeros((5, 3)))
    with pytest.raises(ValueError, match="finite"):
        responses.peak(np.full((5, 18), np.nan))
    with pytest.raises(fem.ModelError, match="not moved"):
        fem.StaticSystem(mesh, STEEL, [fem.Support("root", displacement=[1e-6, 0, 0])]).unit_responses(unit_loads())
