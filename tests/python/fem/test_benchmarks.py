"""Published benchmarks and closed forms of linear elasticity, on structured meshes made here."""

import numpy as np
import pytest

from codesign import fem
from fem_meshes import box_mesh, box_tets


def graded(divisions, power):
    """Positions in [0, 1] of the corner and mid-edge grid lines, denser at 0; mid-edge ones stay in the middle."""
    corners = (np.arange(divisions + 1) / divisions) ** power
    lines = np.empty(2 * divisions + 1)
    lines[::2] = corners
    lines[1::2] = 0.5 * (corners[1:] + corners[:-1])
    return lines


def nodes_where(mask):
    return fem.select_nodes(np.flatnonzero(mask))


def thick_plate(nr, nt, nz):
    """Quarter of the plate between two ellipses of NAFEMS LE10, curved elements, finer towards D = (2, 0, 0.6)."""
    unit, tets = box_tets(nr, nt, nz)
    index = np.rint(unit * [2 * nr, 2 * nt, 2 * nz]).astype(int)
    s, angle = graded(nr, 2.0)[index[:, 0]], graded(nt, 1.6)[index[:, 1]] * np.pi / 2
    nodes = np.stack([(2 + 1.25 * s) * np.cos(angle), (1 + 1.75 * s) * np.sin(angle), 0.6 * unit[:, 2]], axis=1)
    return fem.TetMesh(nodes, tets.astype(np.int32))


def test_nafems_le10_thick_plate():
    mesh = thick_plate(8, 12, 4)
    x, y, z = mesh.nodes.T
    outer = np.abs((x / 3.25) ** 2 + (y / 2.75) ** 2 - 1) < 1e-9
    steel = fem.Material("steel", 210e9, 0.3)
    supports = [
        fem.Support(nodes_where(np.abs(y) < 1e-9), axes="y"),
        fem.Support(nodes_where(np.abs(x) < 1e-9), axes="x"),
        fem.Support(nodes_where(outer), axes="xy"),
        fem.Support(nodes_where(outer & (np.abs(z - 0.3) < 1e-9)), axes="z"),
    ]
    load = fem.Pressure(fem.faces_with_normal([0, 0, 1]), 1e6)
    result = fem.solve_static(mesh, steel, supports, [load], exclusion_distance=0.0)
    at_d = np.argmin(np.linalg.norm(mesh.nodes - [2, 0, 0.6], axis=1))
    assert len(mesh.nodes) <= 60_000
    assert result.reactions[:, 2].sum() == pytest.approx(5.4487e6, rel=1e-4)  # total load
    assert result.stress[at_d, 1] == pytest.approx(-5.38e6, rel=0.005)


@pytest.mark.parametrize("poisson_ratio", [0.0, 0.3, 0.45])
def test_lame_thick_cylinder(poisson_ratio):
    a, b, p, young = 1.0, 2.0, 1e6, 210e9
    mesh = box_mesh(
        (6, 10, 2),
        lambda u: np.stack(
            [(1 + u[:, 0]) * np.cos(u[:, 1] * np.pi / 2), (1 + u[:, 0]) * np.sin(u[:, 1] * np.pi / 2), 0.4 * u[:, 2]], 1
        ),
    )
    material = fem.Material("elastic", young, poisson_ratio, yield_strength=100e6)
    radius = np.linalg.norm(mesh.nodes[:, :2], axis=1)
    inner = fem.select_faces(lambda c: np.linalg.norm(c[:, :2], axis=1) < 1.05)
    supports = [
        fem.Support(fem.faces_with_normal([-1, 0, 0]), axes="x", symmetry=True),
        fem.Support(fem.faces_with_normal([0, -1, 0]), axes="y", symmetry=True),
        fem.Support(fem.faces_with_normal([0, 0, 1]), axes="z", symmetry=True),
        fem.Support(fem.faces_with_normal([0, 0, -1]), axes="z", symmetry=True),
    ]
    result = fem.solve_static(mesh, material, supports, [fem.Pressure(inner, p)], exclusion_distance=0.0)

    on_x = (np.abs(mesh.nodes[:, 1]) < 1e-9) & (np.abs(radius - a) < 1e-9)
    hoop, radial = p * (b**2 + a**2) / (b**2 - a**2), -p
    axial = poisson_ratio * (hoop + radial)
    displacement = (1 + poisson_ratio) * p * a / (young * (b**2 - a**2)) * ((1 - 2 * poisson_ratio) * a**2 + b**2)
    assert result.stress[on_x, 1] == pytest.approx(hoop, rel=0.015)
    assert result.stress[on_x, 0] == pytest.approx(radial, rel=0.03)
    assert result.displacement[on_x, 0] == pytest.approx(displacement, rel=0.002)

    mises = np.sqrt(0.5 * ((hoop - radial) ** 2 + (radial - axial) ** 2 + (axial - hoop) ** 2))
    assert result.peak_stress == pytest.approx(mises, rel=0.02)
    assert abs(result.peak_stress - mises) <= result.stress_error
    assert result.stress_error < 0.05 * mises
    assert result.safety_factor == pytest.approx(100e6 / result.peak_stress)


@pytest.mark.parametrize(("force", "published"), [([1, 0, 0], 3.0e-5), ([0, 1, 0], 0.1081), ([0, 0, 1], 0.4321)])
def test_straight_cantilever_of_macneal_and_harder(force, published):
    material = fem.Material("unit", 1e7, 0.3)
    root, tip = fem.faces_with_normal([-1, 0, 0]), fem.faces_with_normal([1, 0, 0])
    tips = []
    for divisions in [(24, 1, 1), (80, 2, 2)]:
        mesh = box_mesh(divisions, lambda u: u * [6.0, 0.2, 0.1])
        result = fem.solve_static(mesh, material, [fem.Support(root)], [fem.Force(tip, force)], exclusion_distance=0.0)
        tips.append(result.work)  # a unit force: the mean displacement of the tip face
    assert tips[1] == pytest.approx(published, rel=0.005)
    assert tips[0] < tips[1]  # stiffer than the limit, and less so on the finer mesh
