from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from codesign import errors, fem
from fem_meshes import box_mesh

STEEL = fem.Material("steel", young_modulus=210e9, poisson_ratio=0.3, density=7850.0, yield_strength=250e6)


def bar(divisions=(6, 2, 2), size=(0.1, 0.02, 0.02)):
    return box_mesh(divisions, lambda x: x * np.array(size))


ROOT = fem.faces_with_normal([-1, 0, 0])
TIP = fem.faces_with_normal([1, 0, 0])


def test_bar_under_tension_has_the_uniform_stress():
    mesh = bar()
    supports = [
        fem.Support(ROOT, axes="x", symmetry=True),
        fem.Support(fem.faces_with_normal([0, -1, 0]), axes="y", symmetry=True),
        fem.Support(fem.faces_with_normal([0, 0, -1]), axes="z", symmetry=True),
    ]
    result = fem.solve_static(mesh, STEEL, supports, [fem.Force(TIP, [1000.0, 0, 0])], exclusion_distance=0.0)
    stress = 1000.0 / 4e-4
    assert np.allclose(result.stress, stress * np.array([1, 0, 0, 0, 0, 0]), atol=1e-9 * stress)
    assert result.peak_stress == pytest.approx(stress, rel=1e-9)
    assert result.stress_50 == pytest.approx(stress, rel=1e-9)
    assert result.safety_factor == pytest.approx(250e6 / stress, rel=1e-9)
    assert result.displacement[:, 0].max() == pytest.approx(stress * 0.1 / 210e9, rel=1e-9)


def test_reactions_balance_the_loads_and_the_energy_is_half_the_work():
    mesh = bar()
    loads = [fem.Force(TIP, [10.0, -20.0, 30.0]), fem.Acceleration([0, 0, -9.81]), fem.Pressure(TIP, 1e5)]
    result = fem.solve_static(mesh, STEEL, [fem.Support(ROOT)], loads)
    net = np.array([10.0 - 1e5 * 4e-4, -20.0, 30.0 - 9.81 * 7850 * 4e-5])
    assert np.allclose(result.reactions.sum(axis=0), -net, rtol=1e-9)
    assert np.allclose(result.support_forces[0], -net, rtol=1e-9)
    assert result.work == pytest.approx(2 * result.strain_energy, rel=1e-9)
    assert result.residual <= 1e-9


@pytest.mark.parametrize(
    ("supports", "words"),
    [
        ([], ["translation along x", "translation along y", "translation along z", "rotation about x"]),
        ([fem.Support(ROOT, axes="x")], ["translation along y", "translation along z", "rotation about x"]),
    ],
)
def test_missing_supports_are_named(supports, words):
    with pytest.raises(errors.SolverError) as error:
        fem.solve_static(bar(), STEEL, supports, [fem.Force(TIP, [1, 0, 0])])
    for word in words:
        assert word in str(error.value)


def test_unknown_face_lists_the_known_ones():
    with pytest.raises(ValueError, match="unknown face 'seat'"):
        fem.solve_static(bar(), STEEL, [fem.Support("seat")], [])


def test_meshes_of_four_and_ten_node_tetrahedra_are_the_same_model():
    mesh = bar((2, 1, 1))
    corners = np.unique(mesh.tets[:, :4])
    index = np.full(len(mesh.nodes), -1)
    index[corners] = np.arange(len(corners))
    linear = fem.TetMesh(np.array(mesh.nodes[corners]), index[mesh.tets[:, :4]].astype(np.int32))
    solve = [fem.Support(ROOT)], [fem.Force(TIP, [0, 0, 100.0])]
    of_ten, of_four = (fem.solve_static(m, STEEL, *solve) for m in (mesh, linear))
    assert len(linear.nodes) == len(mesh.nodes)
    assert of_four.work == pytest.approx(of_ten.work, rel=1e-10)
    assert of_four.peak_stress == pytest.approx(of_ten.peak_stress, rel=1e-8)


def test_one_factorization_serves_several_load_cases():
    mesh = bar()
    system = fem.StaticSystem(mesh, STEEL, [fem.Support(ROOT)])
    down, side = fem.Force(TIP, [0, 0, -100.0]), fem.Force(TIP, [0, 30.0, 0])
    parts = system.solve([down]).displacement + system.solve([side]).displacement
    np.testing.assert_allclose(system.solve([down, side]).displacement, parts, atol=1e-10 * np.abs(parts).max())


def test_one_system_can_be_solved_from_several_threads() -> None:
    mesh = bar((12, 4, 4))
    system = fem.StaticSystem(mesh, STEEL, [fem.Support(ROOT)])
    loads = [fem.Force(TIP, force) for force in ([1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, -3.0])]
    alone = [system.solve([load]).displacement for load in loads]
    with ThreadPoolExecutor(4) as pool:
        together = list(pool.map(lambda load: system.solve([load]).displacement, loads * 4))
    for k, displacement in enumerate(together):
        np.testing.assert_array_equal(displacement, alone[k % len(loads)])


def test_a_peak_at_a_point_force_is_not_resolved():
    """The stress there grows with every refinement; over the face it is told within a few per cent."""
    mesh = box_mesh((4, 4, 4))
    root = fem.Support(fem.faces_with_normal([-1, 0, 0]))
    top = int(np.argmin(np.linalg.norm(mesh.nodes - [1.0, 0.5, 1.0], axis=1)))
    point = fem.solve_static(mesh, STEEL, [root], [fem.Force(fem.select_nodes([top]), [0, 0, -1e3])])
    assert point.stress_error > 0.5 * point.peak_stress
    assert not point.peak_resolved
    spread = fem.solve_static(mesh, STEEL, [root], [fem.Force(fem.faces_with_normal([1, 0, 0]), [1e3, 0, 0])])
    assert spread.peak_resolved
    assert spread.stress_50 <= spread.peak_stress


def test_a_peak_right_beside_what_a_clamp_leaves_out_is_told() -> None:
    """A cantilever's stress is largest at its clamp: read beside the exclusion, unless nothing is left out."""
    mesh, forces = bar((20, 5, 5)), [fem.Force(TIP, [0.0, 0.0, -100.0])]
    beside = fem.solve_static(mesh, STEEL, [fem.Support(ROOT)], forces, exclusion_distance=5e-3)
    assert beside.peak_at_exclusion
    assert 5e-3 < beside.border_distance < 6.5e-3
    whole = fem.solve_static(mesh, STEEL, [fem.Support(ROOT)], forces, exclusion_distance=0.0)
    assert not whole.peak_at_exclusion
    assert whole.border_distance < beside.border_distance
