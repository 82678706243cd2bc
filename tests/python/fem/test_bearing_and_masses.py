"""Bearing loads and remote masses against closed forms."""

import math

import numpy as np
import pytest

from codesign import fem
from codesign._core import fem as _core
from codesign.cli.stress_options import parse_load
from codesign.geometry.profile import Resolution
from codesign.geometry.shape import Shape, box, cylinder
from codesign.geometry.solid import build_solid
from codesign.parts.surface import surface_mesh

STEEL = fem.Material("steel", 210e9, 0.3, 7850.0, 250e6)
RADIUS, LENGTH = 5e-3, 8e-3
BORE = fem.select_faces(lambda x: np.hypot(x[:, 0] - 0.02, x[:, 1] - 0.01) < 1.01 * RADIUS)


def meshed(shape: Shape, edge: float, segments: int = 48) -> fem.TetMesh:
    return fem.tetrahedralize(surface_mesh(build_solid(shape, Resolution(segments))), edge)


@pytest.fixture(scope="module")
def lug() -> fem.TetMesh:
    """A lug of 8 mm with a bore of radius 5 mm along z through (20, 10) mm."""
    return meshed(box((0, 0, 0), (40, 20, 8), x1="root") - cylinder(5, -1, 9).moved(20, 10), 0.0016)


def nodal_forces(mesh: fem.TetMesh, load: fem.Load) -> np.ndarray:
    """(n, 3) N."""
    return np.asarray(_core.load_vector(mesh, STEEL, [load.native(mesh)])).reshape(-1, 3)


@pytest.mark.parametrize("direction", [(1.0, 0.0, 0.0), (0.6, 0.8, 0.0)])
def test_a_bearing_load_is_the_cosine_distribution(lug: fem.TetMesh, direction: tuple[float, float, float]) -> None:
    """Resultant F along the force through the axis; over each half of the pressed side F / π across it."""
    along = np.array(direction)
    forces = nodal_forces(lug, fem.BearingLoad(BORE, 1000.0 * along))
    np.testing.assert_allclose(forces.sum(axis=0)[:2], 1000.0 * along[:2], atol=1e-6)
    assert abs(forces.sum(axis=0)[2]) < 0.2  # facets of the mesh lean a little along the bore
    arm = lug.nodes - np.array([0.02, 0.01, 0.004])
    np.testing.assert_allclose(np.cross(arm, forces).sum(axis=0), 0.0, atol=2e-3)
    across = np.array([-along[1], along[0], 0.0])
    one_side = (forces @ across)[arm @ across > 1e-9].sum()
    assert one_side == pytest.approx(1000.0 / math.pi, rel=0.01)
    # no node of the half that the pin leaves is loaded
    assert np.abs(forces[arm @ along < -0.4 * RADIUS]).max() < 1e-9


def test_the_largest_pressure_is_that_of_the_closed_form(lug: fem.TetMesh) -> None:
    """p = 2 F / (π r L): the radial stress at the bore's bottom, read from the solution."""
    force = 1000.0
    result = fem.solve_static(
        lug, STEEL, [fem.Support("root")], [fem.BearingLoad(BORE, [-force, 0, 0])], exclusion_distance=0.0
    )
    bottom = np.argmin(np.linalg.norm(lug.nodes - [0.02 - RADIUS, 0.01, 0.004], axis=1))
    assert result.stress[bottom, 0] == pytest.approx(-2 * force / (math.pi * RADIUS * LENGTH), rel=0.1)


def test_what_no_pressure_can_do_is_refused(lug: fem.TetMesh) -> None:
    """A bearing load along the bore."""
    with pytest.raises(fem.ModelError, match="along the axis"):
        nodal_forces(lug, fem.BearingLoad(BORE, [100.0, 0.0, 100.0]))


def test_bearing_loads_and_moments_in_words() -> None:
    """`codesign stress` takes both."""
    _, bearing = parse_load("hole:r=5: bearing 10 0 0", 1e-3)
    assert isinstance(bearing.on(BORE), fem.BearingLoad)
    _, moment = parse_load("hole:r=5: moment 0 0 2", 1e-3)
    load = moment.on(BORE)
    assert isinstance(load, fem.AffineTraction)
    assert load.moment == (0.0, 0.0, 2.0)
    assert moment.words() == "moment (0, 0, 2) N m"


@pytest.fixture(scope="module")
def beam() -> fem.TetMesh:
    """A slender beam of 100 x 4 x 4 mm."""
    return meshed(box((0, 0, 0), (100, 4, 4), x0="root", x1="tip"), 0.004)


def test_a_mass_at_the_tip_lowers_the_frequency_as_beam_theory_says(beam: fem.TetMesh) -> None:
    """f = √(3 E I / (L³ (m + 33 m_beam / 140))) / 2π."""
    mass = 0.1
    system = fem.StaticSystem(
        beam, STEEL, [fem.Support("root")], masses=[fem.RemoteMass("tip", mass, [0.1, 2e-3, 2e-3])]
    )
    inertia, own = 4e-3**4 / 12, 7850.0 * 0.1 * 4e-3**2
    wanted = math.sqrt(3 * 210e9 * inertia / (0.1**3 * (mass + 33 * own / 140))) / (2 * math.pi)
    first, second, *_ = system.natural_frequencies(3).frequency
    assert first == pytest.approx(wanted, rel=0.01)
    assert second == pytest.approx(wanted, rel=0.01)
    iterated = fem.StaticSystem(
        beam, STEEL, [fem.Support("root")], masses=[fem.RemoteMass("tip", mass, [0.1, 2e-3, 2e-3])], solver="iterative"
    )
    assert iterated.natural_frequencies(1).frequency[0] == pytest.approx(first, rel=1e-6)


def test_the_inertia_of_a_mass_counts(beam: fem.TetMesh) -> None:
    """Torsion of a light beam with a heavy disc: f = √(1 / (C I_x)) / 2π, C the twist of a unit moment on its face."""
    inertia = 1e-3
    disc = fem.RemoteMass("tip", 1e-6, [0.1, 2e-3, 2e-3], np.diag([inertia, 1e-9, 1e-9]))
    system = fem.StaticSystem(beam, STEEL, [fem.Support("root")], masses=[disc])
    twisted = system.solve([fem.AffineTraction("tip", np.zeros(3), [0.1, 2e-3, 2e-3], [1.0, 0.0, 0.0])])
    frequency = system.natural_frequencies(1).frequency[0]
    assert frequency == pytest.approx(math.sqrt(1.0 / (twisted.work * inertia)) / (2 * math.pi), rel=1e-5)
    slender = math.sqrt(210e9 / 2.6 * 0.1406 * 4e-3**4 / (0.1 * inertia)) / (2 * math.pi)  # without the held end
    assert frequency == pytest.approx(slender, rel=0.04)


def test_accelerations_pull_at_masses(beam: fem.TetMesh) -> None:
    """Reactions: weight of beam and mass, and the moment of the mass that sits beside the beam."""
    place = np.array([0.1, 0.05, 2e-3])
    system = fem.StaticSystem(beam, STEEL, [fem.Support("root")], masses=[fem.RemoteMass("tip", 0.5, place)])
    result = system.solve([fem.Acceleration([0.0, 0.0, -9.81])])
    own = 7850.0 * 0.1 * 4e-3**2
    reactions = np.asarray(result.reactions)
    np.testing.assert_allclose(reactions.sum(axis=0), [0.0, 0.0, 9.81 * (0.5 + own)], atol=1e-6)
    moment = np.cross(beam.nodes, reactions).sum(axis=0)
    weight = np.cross([0.05, 2e-3, 2e-3], [0, 0, -9.81 * own]) + np.cross(place, [0, 0, -9.81 * 0.5])
    np.testing.assert_allclose(moment, -weight, atol=1e-6)


def test_a_mass_that_is_none_is_refused(beam: fem.TetMesh) -> None:
    """Zero or negative, or an inertia that no body has."""
    for mass, inertia in ((0.0, np.zeros((3, 3))), (1.0, -np.eye(3))):
        with pytest.raises(ValueError, match="remote mass"):
            fem.StaticSystem(
                beam, STEEL, [fem.Support("root")], masses=[fem.RemoteMass("tip", mass, [0, 0, 0], inertia)]
            )
