"""VTU files: what was analyzed, where the peak is read, units, tensors; a half model made whole."""

from pathlib import Path
from typing import Literal

import numpy as np
import pytest

from codesign import fem
from codesign.fem.vtu import Field, StressModel, write_vtu
from fem_meshes import box_mesh
from vtu_files import read_vtu

MATERIAL = fem.Material("ergal", 71.7e9, 0.3, 2810.0, 462e6)
SIZE = np.array([0.04, 0.01, 0.02])


def solved(exclusion: Literal["local", "published"] = "local") -> tuple[fem.TetMesh, fem.StaticResult]:
    """The half y >= 0 of a cantilever 40 x 20 x 20 mm, bent by a force at its end."""
    mesh = box_mesh((6, 2, 3), lambda nodes: nodes * SIZE)
    root = fem.Support(fem.select_faces(lambda x: x[:, 0] < 1e-6))
    cut = fem.Support(fem.select_faces(lambda x: x[:, 1] < 1e-6), axes="y", symmetry=True)
    end = fem.Force(fem.select_faces(lambda x: x[:, 0] > SIZE[0] - 1e-6), (0.0, 0.0, -100.0))
    return mesh, fem.solve_static(mesh, MATERIAL, [root, cut], [end], copies=2, exclusion=exclusion)


@pytest.fixture(scope="module")
def half() -> tuple[fem.TetMesh, fem.StaticResult]:
    """With the default exclusion."""
    return solved()


def volumes(nodes: np.ndarray, tets: np.ndarray) -> np.ndarray:
    a, b, c, d = (nodes[tets[:, k]] for k in range(4))
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6.0


def von_mises(stress: np.ndarray) -> np.ndarray:
    xx, yy, zz, xy, yz, zx = stress.T
    normal = 0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2)
    return np.sqrt(normal + 3.0 * (xy**2 + yz**2 + zx**2))


def test_the_file_says_what_it_holds(half: tuple[fem.TetMesh, fem.StaticResult], tmp_path: Path) -> None:
    mesh, result = half
    write_vtu(StressModel.of(mesh, result), tmp_path / "half.vtu", {"model": "half, y ≥ 0"})
    file = read_vtu(tmp_path / "half.vtu")
    np.testing.assert_array_equal(file.points, mesh.nodes)
    np.testing.assert_array_equal(file.cells, mesh.tets)
    np.testing.assert_array_equal(file.point_data["stress"], result.stress)
    np.testing.assert_array_equal(file.point_data["displacement"], result.displacement)
    np.testing.assert_array_equal(file.cell_data["error"], result.element_error)
    assert file.active == {"Scalars": "von_mises", "Vectors": "displacement", "Tensors": "stress"}
    assert file.components["stress"] == ["xx", "yy", "zz", "xy", "yz", "zx"]
    assert file.components["displacement"] == ["x", "y", "z"]
    np.testing.assert_array_equal(file.point_data["counts_for_peak"], result.counts_for_peak)
    assert file.units == {
        "displacement": "m", "stress": "Pa", "von_mises": "Pa", "counts_for_peak": "1", "error": "Pa",
    }  # fmt: skip
    assert file.strings["model"] == "half, y ≥ 0"
    assert "coordinates m" in file.strings["units"]


@pytest.mark.parametrize("rule", ["local", "published"])
def test_the_largest_stress_that_counts_is_the_peak(rule: Literal["local", "published"]) -> None:
    mesh, result = solved(rule)
    counts = np.asarray(result.counts_for_peak)
    assert counts.dtype == bool
    at_clamp = mesh.nodes[:, 0] < 1e-6
    border = at_clamp & ((mesh.nodes[:, 2] < 1e-6) | (mesh.nodes[:, 2] > SIZE[2] - 1e-6))
    assert not counts[border].any()
    assert counts[at_clamp].any() == (rule == "local")  # within a clamp, the published rule reads nowhere
    assert counts[(mesh.nodes[:, 0] > 0.01) & (mesh.nodes[:, 0] < 0.03)].all()
    surface = np.unique(mesh.boundary)
    largest = np.asarray(result.von_mises)[surface[counts[surface]]].max()
    assert 0.8 * result.peak_stress < largest <= result.peak_stress * (1.0 + 1e-9)


def test_a_half_becomes_a_whole(half: tuple[fem.TetMesh, fem.StaticResult]) -> None:
    mesh, result = half
    model = StressModel.of(mesh, result)
    whole = model.with_mirror_image(np.zeros(3), np.array([0.0, -1.0, 0.0]))
    on_cut = int((np.abs(mesh.nodes[:, 1]) < 1e-9).sum())
    assert len(whole.nodes) == 2 * len(mesh.nodes) - on_cut
    assert volumes(whole.nodes, whole.tets).min() > 0.0
    assert volumes(whole.nodes, whole.tets).sum() == pytest.approx(2.0 * SIZE.prod(), rel=1e-12)
    for k, (i, j) in enumerate([(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]):
        middle = whole.nodes[whole.tets[:, [i, j]]].mean(axis=1)
        np.testing.assert_allclose(whole.nodes[whole.tets[:, 4 + k]], middle, atol=1e-15)
    fields = {field.name: field.values for field in whole.at_nodes}
    np.testing.assert_allclose(von_mises(fields["stress"]), fields["von_mises"], rtol=1e-9)
    image = np.flatnonzero(whole.nodes[:, 1] < -1e-9)
    order = {tuple(np.round(x, 9)): i for i, x in enumerate(whole.nodes)}
    twins = [order[tuple(np.round(whole.nodes[i] * [1, -1, 1], 9))] for i in image]
    np.testing.assert_allclose(fields["displacement"][image], fields["displacement"][twins] * [1, -1, 1], atol=1e-18)
    signs = np.array([1, 1, 1, -1, -1, 1])
    np.testing.assert_allclose(fields["stress"][image], fields["stress"][twins] * signs, rtol=1e-9, atol=1e-3)
    assert len(whole.in_elements[0].values) == 2 * len(mesh.tets)


def test_the_other_half_of_an_antisymmetric_load(half: tuple[fem.TetMesh, fem.StaticResult]) -> None:
    model = StressModel.of(*half)
    normal = np.array([0.0, -1.0, 0.0])
    same, opposite = (model.with_mirror_image(np.zeros(3), normal, antisymmetric) for antisymmetric in (False, True))
    for one, other in zip(same.at_nodes, opposite.at_nodes, strict=True):
        sign = 1.0 if one.tensor == "scalar" else -1.0
        np.testing.assert_array_equal(one.values[len(model.nodes) :], sign * other.values[len(model.nodes) :])


def test_tensors_mirror_in_any_plane() -> None:
    rng = np.random.default_rng(0)
    normal = rng.normal(size=3)
    normal /= np.linalg.norm(normal)
    stress = Field("stress", rng.normal(size=(5, 6)), "Pa", "symmetric")
    turned = stress.mirrored(normal)
    np.testing.assert_allclose(von_mises(turned), von_mises(stress.values), rtol=1e-12)
    np.testing.assert_allclose(Field("s", turned, "Pa", "symmetric").mirrored(normal), stress.values, atol=1e-12)
