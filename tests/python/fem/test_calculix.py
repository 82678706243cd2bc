"""Decks that CalculiX solves: our displacement, our stress at the integration points."""

import re
import shutil
import subprocess

import numpy as np
import pytest

from codesign import fem
from codesign.fem.calculix import write_inp

STEEL = fem.Material("steel S235", 210e9, 0.3, 7850.0, 235e6)
SUPPORTS = [fem.Support("left end")]
CASES = {
    "pull": [fem.Force("right end", [1000.0, 0.0, 200.0])],
    "pressure and weight": [fem.Pressure("top", 2e5), fem.Acceleration([0.0, 0.0, -9.81])],
}


@pytest.fixture(scope="module")
def mesh() -> fem.TetMesh:
    """Bar of 80 x 20 x 10 mm with a notch; coordinates rounded as the deck holds them."""
    points = np.array([(0, 0), (80, 0), (80, 10), (50, 10), (40, 6), (30, 10), (0, 10)]) * 1e-3
    n = len(points)
    solid = np.array([(x, y, z) for y in (0.0, 0.02) for x, z in points])
    triangles, faces = [], []
    for k, name in enumerate(("bottom", "right end", "top", "", "", "top", "left end")):
        a, b = k, (k + 1) % n
        triangles += [(a, b, b + n), (a, b + n, a + n)]
        faces += [name, name]
    for a, b, c in ((0, 4, 6), (0, 1, 4), (1, 2, 3), (1, 3, 4), (4, 5, 6)):
        triangles += [(a, c, b), (a + n, b + n, c + n)]
        faces += ["", ""]
    names = sorted(set(faces))
    flipped = np.array(triangles, dtype=np.int32)[:, ::-1]
    surface = fem.SurfaceMesh(solid, np.ascontiguousarray(flipped), [names.index(f) for f in faces], names)
    if fem.mass_properties(surface, 1.0).volume < 0:
        surface = fem.SurfaceMesh(solid, np.array(triangles, dtype=np.int32), [names.index(f) for f in faces], names)
    return fem.tetrahedralize(surface, 4e-3, curved=False)


@pytest.fixture(scope="module")
def solved(mesh, tmp_path_factory):
    if shutil.which("ccx") is None:
        pytest.fail(
            "ccx is missing: install the Debian packages of apt-packages-test.txt (Debian 13 has no calculix-ccx)"
        )
    folder = tmp_path_factory.mktemp("ccx")
    write_inp(folder / "bar.inp", mesh, STEEL, SUPPORTS, CASES, "a bar")
    run = subprocess.run(["ccx", "bar"], cwd=folder, capture_output=True, text=True, check=False)
    assert run.returncode == 0 and "ERROR" not in run.stdout, run.stdout[-2000:]
    return (folder / "bar.inp").read_text(), (folder / "bar.dat").read_text()


def blocks(text: str, title: str) -> list[np.ndarray]:
    """Tables of a .dat file below a title, one per step."""
    found = re.split(rf"^.*{title}.*$", text, flags=re.MULTILINE)[1:]
    tables = []
    for part in found:
        rows = [
            line.split()
            for line in re.split(r"^ *[a-z]", part.strip("\n"), maxsplit=1, flags=re.MULTILINE)[0].splitlines()
        ]
        tables.append(np.array([row for row in rows if row], dtype=float))
    return tables


def integration_stress(mesh: fem.TetMesh, displacement: np.ndarray) -> np.ndarray:
    """(elements, 4, 6) xx yy zz xy xz yz of straight elements, from the displacement alone."""
    a, b = 0.5854101966249685, 0.1381966011250105
    nodes, tets = np.asarray(mesh.nodes), np.asarray(mesh.tets)
    corners = nodes[tets[:, :4]]
    gradients = np.linalg.inv(np.concatenate([np.ones((len(tets), 4, 1)), corners], axis=2))[:, 1:, :]
    E, nu = STEEL.young_modulus, STEEL.poisson_ratio
    lam, mu = E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))
    edges = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))
    stress = np.empty((len(tets), 4, 6))
    for q in range(4):
        L = np.full(4, b)
        L[q] = a
        shape = [(4 * L[i] - 1) * gradients[:, :, i] for i in range(4)]
        shape += [4 * (L[i] * gradients[:, :, j] + L[j] * gradients[:, :, i]) for i, j in edges]
        grad = np.einsum("ekd,kec->edc", displacement[tets], np.array(shape))
        strain = 0.5 * (grad + np.swapaxes(grad, 1, 2))
        full = 2 * mu * strain + lam * np.trace(strain, axis1=1, axis2=2)[:, None, None] * np.eye(3)
        stress[:, q] = full[:, (0, 1, 2, 0, 0, 1), (0, 1, 2, 1, 2, 2)]
    return stress


def test_calculix_finds_our_displacement_and_stress(mesh, solved):
    _, output = solved
    displacements, stresses = blocks(output, "displacements"), blocks(output, "stresses")
    assert len(displacements) == len(stresses) == len(CASES)
    for loads, theirs, stress in zip(CASES.values(), displacements, stresses, strict=True):
        ours = np.asarray(fem.solve_static(mesh, STEEL, SUPPORTS, loads).displacement)
        assert np.abs(theirs[:, 1:] - ours).max() < 1e-6 * np.abs(ours).max()
        expected = integration_stress(mesh, ours).reshape(-1, 6)
        assert np.abs(stress[:, 2:] - expected).max() < 1e-5 * np.abs(expected).max()


def test_no_number_is_longer_than_calculix_reads_and_no_line_has_more_entries(solved):
    text, _ = solved
    for line in text.splitlines():
        if not line.startswith("*"):
            entries = [entry.strip() for entry in line.rstrip(",").split(",")]
            assert len(entries) <= 16
            assert all(len(entry) <= 20 for entry in entries if re.match(r"^[-+.\d]", entry))


def test_faces_are_sets_and_surfaces_by_name(mesh, solved):
    text, _ = solved
    for name in ("LEFT_END", "RIGHT_END", "TOP", "BOTTOM"):
        assert f"*NSET, NSET=N_{name}\n" in text and f"*SURFACE, NAME=S_{name}, TYPE=ELEMENT\n" in text
    top = list(mesh.face_names).index("top")
    surface = text.split("*SURFACE, NAME=S_TOP, TYPE=ELEMENT\n")[1].split("*")[0].splitlines()
    assert len(surface) == int(np.count_nonzero(np.asarray(mesh.boundary_face) == top))


def test_a_deck_needs_a_load_case(mesh, tmp_path):
    with pytest.raises(ValueError, match="load case"):
        write_inp(tmp_path / "x.inp", mesh, STEEL, SUPPORTS, {})
    assert not (tmp_path / "x.inp").exists()
