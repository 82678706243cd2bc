"""Linear buckling against beam theory."""

import math

import numpy as np
import pytest

from codesign import _core, fem
from codesign.errors import ModelError
from codesign.geometry.profile import Path, Resolution
from codesign.geometry.shape import Extrusion
from codesign.geometry.solid import build_solid
from codesign.parts.load_case import StressSettings, native_case
from codesign.parts.strength import part_document
from codesign.parts.surface import surface_mesh
from codesign.robot.inertial import Inertial
from fem_meshes import box_mesh

YOUNG, POISSON = 210e9, 0.3
STEEL = fem.Material("steel", YOUNG, POISSON, 7850.0, 250e6)
STEEL_SHEAR = YOUNG / (2 * (1 + POISSON))
LENGTH, WIDTH, HEIGHT = 1.0, 0.03, 0.05
ROOT, TIP = fem.faces_with_normal([-1, 0, 0]), fem.faces_with_normal([1, 0, 0])
LOAD = 1000.0  # N


def column(divisions=(20, 1, 1)):
    return box_mesh(divisions, lambda x: x * np.array([LENGTH, WIDTH, HEIGHT]))


def euler(thickness, width, effective, length=LENGTH, young=YOUNG):
    """Critical force [N] of a column that bends across its thickness; effective: length of the half wave / length."""
    return np.pi**2 * young * width * thickness**3 / 12 / (effective * length) ** 2


def press(mesh, force=LOAD, count=1, supports=(), material=STEEL):
    loads = [fem.Force(TIP, [-force, 0, 0])]
    return fem.buckling_factors(mesh, material, [fem.Support(ROOT), *supports], loads, count)


def test_a_clamped_column_buckles_at_eulers_forces_about_both_axes():
    forces = LOAD * press(column(), count=3).factor
    assert forces[0] == pytest.approx(euler(WIDTH, HEIGHT, 2), rel=0.01)
    assert forces[1] == pytest.approx(euler(HEIGHT, WIDTH, 2), rel=0.01)
    assert forces[2] == pytest.approx(euler(WIDTH, HEIGHT, 2 / 3), rel=0.015)  # shear lowers it, the clamp raises it


def test_the_shape_is_the_cosine_of_beam_theory():
    mesh = column()
    shape = press(mesh).shape[0]
    assert np.linalg.norm(shape, axis=1).max() == pytest.approx(1.0)
    expected = 1 - np.cos(np.pi * mesh.nodes[:, 0] / (2 * LENGTH))
    np.testing.assert_allclose(np.abs(shape[:, 1]), expected, atol=0.01)


def test_a_guided_tip_and_a_pinned_one_bear_more():
    pinned = press(column(), supports=[fem.Support(TIP, "yz")]).factor[0]
    assert LOAD * pinned == pytest.approx(euler(WIDTH, HEIGHT, 0.69916), rel=0.015)
    # both ends clamped, and the load a prescribed shortening: the factor is of what it is held with
    shortening = [fem.Support(ROOT), fem.Support(TIP, displacement=[-1e-5, 0, 0])]
    system = fem.StaticSystem(column(), STEEL, shortening)
    held = system.solve([]).support_forces[0, 0]
    assert held * system.buckling_factors([]).lowest == pytest.approx(euler(WIDTH, HEIGHT, 0.5), rel=0.015)


def test_factors_fall_towards_the_limit_under_refinement():
    """Without lateral contraction the clamp does not stiffen the end, and beam theory is the limit."""
    material = fem.Material("cork", YOUNG, 0.0)
    forces = [LOAD * press(column((n, 1, 1)), material=material).factor[0] for n in (4, 8, 16, 32)]
    assert (np.diff(forces) < 0).all()
    assert forces[-1] == pytest.approx(euler(WIDTH, HEIGHT, 2), rel=0.002)
    assert forces[0] > 1.01 * forces[-1]


def test_factors_are_inverse_to_the_load():
    once, thrice = (press(column(), force, count=2).factor for force in (LOAD, 3 * LOAD))
    assert once == pytest.approx(3 * thrice, rel=1e-6)


def test_a_pulled_bar_has_no_factor_but_one_of_the_load_reversed():
    pulled = press(column(), -LOAD, count=3)
    assert pulled.factor.shape == (0,)
    assert pulled.shape.shape == (0, len(column().nodes), 3)
    assert pulled.lowest == math.inf
    assert pulled.limit == pytest.approx(STEEL_SHEAR / 4 / (LOAD / (WIDTH * HEIGHT)), rel=0.1)
    assert pulled.reversed == pytest.approx(press(column()).lowest, rel=1e-6)
    assert press(column()).reversed == math.inf
    with pytest.raises(ModelError, match="no node is loaded"):
        press(column(), 0.0)


def test_a_cantilever_strip_turns_over_sideways():
    """Timoshenko and Gere, Theory of Elastic Stability: P = 4.013 sqrt(E I_y G J) / L², force at the tip's centroid.

    The clamp holds the strip's warping too: that shortens it by sqrt(E C_w / (G J)), C_w = h³ t³ / 144.
    """
    length, height, thickness = 1.0, 0.05, 0.005
    strip = box_mesh((80, 1, 8), lambda x: x * np.array([length, thickness, height]))
    sideways = YOUNG * height * thickness**3 / 12
    sideways /= 1 - (thickness / height) ** 2  # for the curvature that it has before
    twisting = STEEL_SHEAR * height * thickness**3 / 3 * (1 - 0.630 * thickness / height)
    free = length - np.sqrt(YOUNG * (height * thickness) ** 3 / 144 / twisting)
    expected = 4.013 * np.sqrt(sideways * twisting) / free**2
    found = fem.buckling_factors(strip, STEEL, [fem.Support(ROOT)], [fem.Force(TIP, [0, 0, -1.0])])
    assert found.lowest == pytest.approx(expected, rel=0.01)
    assert found.reversed == pytest.approx(found.lowest, rel=1e-3)


def bar_case(half, count, force=LOAD):
    """A bar of 200 x 12 x 20 mm, pressed and bent in its plane of symmetry; or its half y > 0."""
    outline = (
        Path(0.0, 0.0 if half else -6.0).line(200.0, 0.0 if half else -6.0, face="cut")
        .line(200.0, 6.0, face="tip").line(0.0, 6.0).line(0.0, 0.0 if half else -6.0, face="root").close()
    )  # fmt: skip
    surface = surface_mesh(build_solid(Extrusion(outline, -10.0, 10.0), Resolution(48)))
    supports = [fem.Support("root")]
    if half:
        supports.append(fem.Support("cut", axes="y", symmetry=True))
    share = 0.5 if half else 1.0
    cases = [fem.LoadCase("pressed", [fem.Force("tip", [-share * force, 0.0, -0.05 * share * force])])]
    settings = StressSettings(STEEL, [], [])
    case = native_case(settings, surface, fem.SizeField(6e-3), supports, cases, copies=2 if half else 1)
    case.buckling = count
    return case


def test_a_half_part_has_the_factors_of_the_whole():
    whole, half = (_core.analyze_part(bar_case(half, 4)).buckling_factors for half in (False, True))
    assert half == pytest.approx(whole, rel=0.005)
    assert LOAD * half[0] == pytest.approx(euler(0.012, 0.02, 2, length=0.2), rel=0.02)  # antisymmetric
    assert LOAD * half[1] == pytest.approx(euler(0.02, 0.012, 2, length=0.2), rel=0.03)  # symmetric


def test_the_part_document_carries_the_factor_if_asked_and_null_if_there_is_none():
    mass = Inertial(1.0, np.zeros(3), np.eye(3))
    pressed, pulled, unasked = (
        _core.analyze_part(bar_case(half=True, count=count, force=force))
        for count, force in ((2, LOAD), (2, -LOAD), (0, LOAD))
    )
    assert part_document(mass, pressed)["buckling_factor"] == pressed.buckling_factors[0]
    assert (pulled.buckling_factors == math.inf).all()
    assert part_document(mass, pulled)["buckling_factor"] is None
    assert "buckling_factor" not in part_document(mass, unasked)


def test_a_count_below_one_is_refused():
    with pytest.raises(ValueError, match="count"):
        press(column((2, 1, 1)), count=0)
