"""MSH files: gmsh reads the same nodes, elements and named groups."""

from dataclasses import dataclass

import gmsh
import numpy as np
import pytest

from codesign import fem
from codesign.fem.gmsh import write_msh
from codesign.geometry.shape import Shape, box
from codesign.parts import Part


@dataclass(frozen=True)
class Bar(Part):
    """A box with two named ends."""

    def shape(self) -> Shape:
        return box((0, 0, 0), (40, 20, 10), x0="mount", x1="tip")


@pytest.fixture
def read(tmp_path):
    """gmsh with a file read."""
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)

    def load(mesh):
        write_msh(mesh, tmp_path / "part.msh", "bracket")
        gmsh.open(str(tmp_path / "part.msh"))
        return gmsh.model

    yield load
    gmsh.finalize()


def test_gmsh_reads_the_same_mesh_and_groups(read):
    mesh = fem.tetrahedralize(Bar(name="bar", density=1.0).surface(), 8e-3)
    model = read(mesh)
    tags, coordinates, _ = model.mesh.getNodes()
    nodes = np.empty_like(mesh.nodes)
    nodes[tags.astype(int) - 1] = coordinates.reshape(-1, 3)
    np.testing.assert_array_equal(nodes, mesh.nodes)
    groups = {model.getPhysicalName(*group): group for group in model.getPhysicalGroups()}
    assert set(groups) == {"mount", "tip", "rest", "bracket"}
    for name in ("mount", "tip"):
        held, _ = model.mesh.getNodesForPhysicalGroup(*groups[name])
        expected = np.unique(mesh.boundary[mesh.boundary_face == mesh.face_names.index(name)])
        np.testing.assert_array_equal(np.sort(held) - 1, expected)
    (kind,), (numbers,), _ = model.mesh.getElements(3)
    assert (kind, len(numbers)) == (11, len(mesh.tets))
    assert min(model.mesh.getElementQualities(numbers, "minSJ")) > 0.0
    volume = sum(model.mesh.getElementQualities(numbers, "volume"))
    assert volume == pytest.approx(40e-3 * 20e-3 * 10e-3, rel=1e-12)
