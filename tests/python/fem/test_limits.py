"""Limits of mesher and solver: what they count, what they say, and that they cover everything."""

import re
import time

import numpy as np
import pytest

import fem_surfaces
from codesign import fem
from codesign.cli.stress_mesh import Mesher
from codesign.errors import MemoryLimitError, MeshLimitError
from fem_meshes import box_mesh

STEEL = fem.Material("steel", young_modulus=210e9, poisson_ratio=0.3, density=7850.0, yield_strength=250e6)
ROOT, TIP = fem.faces_with_normal([-1, 0, 0]), fem.faces_with_normal([1, 0, 0])
LENGTH, WIDTH, HEIGHT, STEP = 60e-3, 20e-3, 5e-3, 0.3e-3


def tangential_step(angle_deg):
    """A plate with a raised step whose outline starts at one corner, almost along the edge of the plate."""
    away = LENGTH * np.tan(np.radians(angle_deg))
    low = [(0, 0), (LENGTH, 0), (LENGTH, WIDTH), (0, WIDTH)]
    rim = [(0, 0), (LENGTH, 0), (LENGTH, away), (LENGTH, WIDTH), (0, WIDTH)]
    top = [(0, 0), (LENGTH, away), (LENGTH, WIDTH), (0, WIDTH)]
    points = [(*p, z) for level, z in ((low, 0.0), (rim, HEIGHT), (top, HEIGHT + STEP)) for p in level]
    triangles = [
        (0, 2, 1), (0, 3, 2), (0, 1, 5), (0, 5, 4), (4, 5, 6), (4, 6, 10), (4, 10, 9), (1, 2, 7), (1, 7, 6), (1, 6, 5),
        (6, 7, 11), (6, 11, 10), (2, 3, 8), (2, 8, 7), (7, 8, 12), (7, 12, 11), (3, 0, 4), (3, 4, 8), (8, 4, 9),
        (8, 9, 12), (9, 10, 11), (9, 11, 12),
    ]  # fmt: skip
    return fem.SurfaceMesh(np.array(points), np.array(triangles))


def block():
    points = [(x, y, z) for z in (0.0, HEIGHT) for x, y in ((0, 0), (LENGTH, 0), (LENGTH, WIDTH), (0, WIDTH))]
    triangles = [
        (0, 2, 1), (0, 3, 2), (4, 5, 6), (4, 6, 7), (0, 1, 5), (0, 5, 4), (1, 2, 6), (1, 6, 5), (2, 3, 7), (2, 7, 6),
        (3, 0, 4), (3, 4, 7),
    ]  # fmt: skip
    return fem.SurfaceMesh(np.array(points), np.array(triangles))


def beam(divisions=(12, 2, 2)):
    return box_mesh(divisions, lambda x: x * [1.0, 0.03, 0.05])


def test_the_work_decides_and_is_the_same_every_time():
    mesh = fem.tetrahedralize(block(), 3e-3)
    work = mesh.report.questions
    assert fem.tetrahedralize(block(), 3e-3, max_questions=work).report.questions == work
    with pytest.raises(MeshLimitError, match=rf"{work - 1} questions .*max_questions.* larger edge length"):
        fem.tetrahedralize(block(), 3e-3, max_questions=work - 1)


def test_edges_at_a_tiny_angle_are_named_instead_of_a_larger_edge_length():
    for limit in ({"max_questions": 60_000}, {"max_vertices": 1500}):
        with pytest.raises(MeshLimitError) as error:
            fem.tetrahedralize(tangential_step(0.5), 4e-3, **limit)
        message = str(error.value)
        assert next(iter(limit)) in message
        assert "larger edge length does not help" in message
        x, y, z = (float(n) for n in re.search(r"of \((.*), (.*), (.*)\) mm", message).groups())
        assert 0.0 <= x <= 60.0
        assert abs(y) < 0.5  # between the two edges
        assert z == pytest.approx(5.0, abs=0.5)


def test_a_mesh_that_is_too_large_as_a_whole_is_told_so():
    vertices = int(fem.tetrahedralize(block(), 2e-3).tets[:, :4].max()) + 1
    with pytest.raises(MeshLimitError, match=r"1000 vertices \(max_vertices\).*larger edge length is needed"):
        fem.tetrahedralize(block(), 2e-3, max_vertices=1000)
    with pytest.raises(MeshLimitError, match=r"more than 200 vertices .* edge length of at least 2.466 mm is needed"):
        fem.tetrahedralize(block(), 2e-3, max_vertices=200)
    assert vertices > 1000


def test_what_is_too_large_for_a_thin_gap_names_the_gap():
    mesh = (fem_surfaces.box((20, 10, 10)) - fem_surfaces.box((20, 12, 0.4), (5, -1, 5))).to_mesh64()
    surface = fem.SurfaceMesh(mesh.vert_properties[:, :3] * 1e-3, np.asarray(mesh.tri_verts, dtype=np.int32))
    with pytest.raises(MeshLimitError, match=r"elements of 0\.34\d* mm near .*, of 1\.\d+ mm elsewhere") as error:
        fem.tetrahedralize(surface, max_vertices=2000)
    x, _, z = (float(n) for n in re.search(r"near \((.*), (.*), (.*)\) mm", str(error.value)).groups())
    assert 5.0 - 0.1 <= x <= 20.0
    assert 5.0 - 0.1 <= z <= 5.4 + 0.1


def test_a_part_that_is_too_thin_everywhere_is_refused_at_once():
    sheet = fem_surfaces.box((40, 20, 1e-5))
    mesh = sheet.to_mesh64()
    surface = fem.SurfaceMesh(mesh.vert_properties[:, :3] * 1e-3, np.asarray(mesh.tri_verts, dtype=np.int32))
    with pytest.raises(MeshLimitError, match=r"too thin: elements as large as its mean wall of .* mm cover"):
        fem.tetrahedralize(surface, time_limit=5.0)
    with pytest.raises(MeshLimitError, match=r"edge length of at least .* mm is needed"):
        fem.tetrahedralize(block(), 1e-300)


def test_the_time_limit_is_kept_within_a_tenth_wherever_the_mesher_is():
    fem.tetrahedralize(block(), 3e-3)
    for surface, edge in ((tangential_step(0.13), 4e-3), (block(), 4e-4)):
        begun = time.thread_time()
        with pytest.raises(MeshLimitError, match=r"time_limit"):
            fem.tetrahedralize(surface, edge, time_limit=1.0, max_vertices=10**8)
        assert time.thread_time() - begun < 1.1


def test_all_attempts_at_a_part_share_the_limits():
    work = fem.tetrahedralize(block(), 3e-3).report.questions
    mesher = Mesher(3e-3, max_questions=2 * work)
    mesher(block(), last=False)
    mesher(block(), last=True)
    with pytest.raises(MeshLimitError, match="max_questions"):
        Mesher(3e-3, max_questions=2 * work - 2)(block(), last=False)
    mesher = Mesher(4e-4, time_limit=0.2)
    with pytest.raises(MeshLimitError, match="time_limit"):
        mesher(block(), last=False)
    assert mesher.is_spent


def test_modes_by_iteration_are_those_of_the_factor():
    supports = [fem.Support(ROOT)]
    direct = fem.StaticSystem(beam(), STEEL, supports).natural_frequencies(5)
    iterative = fem.StaticSystem(beam(), STEEL, supports, solver="iterative").natural_frequencies(5)
    np.testing.assert_allclose(iterative.frequency, direct.frequency, rtol=1e-7)
    first, other = direct.shape[0], iterative.shape[0]
    np.testing.assert_allclose(np.sign((first * other).sum()) * other, first, atol=1e-4 * np.abs(first).max())


def test_rigid_motions_of_a_free_part_come_out_of_iteration_too():
    mesh = beam((20, 4, 4))
    direct = fem.natural_frequencies(mesh, STEEL, [], 8).frequency
    iterative = fem.natural_frequencies(mesh, STEEL, [], 8, memory_limit=2.4e7).frequency
    assert iterative[:6] == pytest.approx(np.zeros(6), abs=1e-3)
    np.testing.assert_allclose(iterative[6:], direct[6:], rtol=1e-7)


def test_buckling_by_iteration_is_that_of_the_factor():
    supports, loads = [fem.Support(ROOT)], [fem.Force(TIP, (-1000.0, 0.0, 0.0))]
    direct = fem.StaticSystem(beam(), STEEL, supports).buckling_factors(loads, 2)
    iterative = fem.StaticSystem(beam(), STEEL, supports, solver="iterative").buckling_factors(loads, 2)
    np.testing.assert_allclose(iterative.factor, direct.factor, rtol=1e-4)
    assert iterative.reversed == pytest.approx(direct.reversed)


def test_what_does_not_fit_into_the_memory_limit_is_refused_with_number_and_remedy():
    mesh, supports = beam((20, 4, 4)), [fem.Support(ROOT)]
    for solver in ("direct", "iterative", "automatic"):
        with pytest.raises(MemoryLimitError, match=r"\d+ MiB, its memory limit is 2 MiB: larger elements"):
            fem.StaticSystem(mesh, STEEL, supports, solver=solver, memory_limit=2 << 20)
    with pytest.raises(MemoryLimitError, match="larger elements"):
        fem.natural_frequencies(mesh, STEEL, supports, memory_limit=2 << 20)
