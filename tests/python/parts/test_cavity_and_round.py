"""Parts with sealed cavities, and round parts: one body, exact mass, the same in every file and in the analysis."""

import math
from dataclasses import KW_ONLY, dataclass
from pathlib import Path

import numpy as np
import pytest
import trimesh

from codesign import fem
from codesign.errors import GeometryError
from codesign.geometry.profile import Path as Outline
from codesign.geometry.profile import circle, rectangle
from codesign.geometry.shape import Frame, Revolution, Shape, box, cylinder
from codesign.parts import Part, parameter, write_step

CUBE = box((0, 0, 0), (20, 20, 20))
BALL = Revolution(Outline(-1, 0).line(1, 0).arc(-1, 0, center=(0, 0), turn="left").close())


@dataclass(frozen=True)
class Tank(Part):
    size: float = parameter("mm", minimum=10, maximum=60)
    _: KW_ONLY
    name: str = "tank"
    density: float = 2700.0

    def through_holes(self) -> int:
        return 0

    def shape(self) -> Shape:
        s = self.size
        return box((0, 0, 0), (s, s, s), z0="mount", z1="lid") - box((3, 3, 3), (s - 3, s - 3, s - 3))


@dataclass(frozen=True)
class Given(Part):
    """A part of a given shape."""

    given: Shape
    holes: int | None = None
    _: KW_ONLY
    name: str = "given"
    density: float = 1000.0

    def through_holes(self) -> int | None:
        return self.holes

    def shape(self) -> Shape:
        return self.given


TANK_VOLUME = 20.0**3 - 14.0**3  # mm³


def test_a_tank_is_one_body_with_exact_mass() -> None:
    properties = Tank(20).mass_properties()
    assert properties.volume == pytest.approx(TANK_VOLUME * 1e-9, rel=1e-12)
    np.testing.assert_allclose(properties.com, 0.01, rtol=1e-12)
    about_middle = 2700e-15 * (20.0**5 - 14.0**5) / 6.0
    np.testing.assert_allclose(properties.inertia, about_middle * np.eye(3), atol=1e-12 * about_middle)


def test_a_tank_is_whole_in_every_file(tmp_path: Path) -> None:
    tank = Tank(20)
    surface = tank.surface()
    assert surface.face_names == ["", "mount", "lid"]
    assert fem.mass_properties(surface, 1.0).volume == pytest.approx(TANK_VOLUME * 1e-9, rel=1e-12)
    tank.write_stl(tmp_path / "tank.stl")
    stl = trimesh.load(tmp_path / "tank.stl")
    assert stl.is_watertight
    assert stl.volume == pytest.approx(TANK_VOLUME, rel=1e-6)
    write_step(tank, tmp_path / "tank.step")
    text = (tmp_path / "tank.step").read_text()
    assert text.count("BREP_WITH_VOIDS(") == 1


def test_a_tank_is_analyzed_with_its_cavity() -> None:
    """Pressed from above: the integral of the vertical stress over the part is force times height for any shape."""
    mesh = fem.tetrahedralize(Tank(20).fem_surface(), 3e-3)
    assert mesh.quality.volume == pytest.approx(TANK_VOLUME * 1e-9, rel=1e-6)
    material = fem.Material("ergal", 71.7e9, 0.3, 2810.0, 462e6)
    result = fem.solve_static(mesh, material, [fem.Support("mount")], [fem.Force("lid", (0.0, 0.0, -1000.0))])
    a, b, c, d = (mesh.nodes[mesh.tets[:, k]] for k in range(4))
    volumes = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6.0
    vertical = np.asarray(result.stress)[:, 2][mesh.tets[:, :4]].mean(axis=1)
    assert volumes @ vertical == pytest.approx(-1000.0 * 0.02, rel=0.03)


def test_through_holes_are_counted_beside_cavities() -> None:
    ring = Revolution(rectangle(-3, 10, 3, 16))
    block = box((-30, -30, -30), (30, 30, 30))
    hollow = block - ring - cylinder(5, -31, 31, Frame((0, 0, 0), (0, 1, 0), (0, 0, 1)))
    assert Given(hollow, holes=2).solid().triangles.size  # the hole and the one in the ring-shaped cavity
    with pytest.raises(GeometryError, match="2 through holes instead of 1"):
        Given(hollow, holes=1).solid()
    assert Given(block - box((-9, -9, -9), (9, 9, 9)) - box((10, 10, 10), (20, 20, 20)), holes=0).solid().triangles.size


def test_a_body_loose_in_a_cavity_is_a_second_body() -> None:
    with pytest.raises(GeometryError, match="falls apart into 2 bodies"):
        Given(CUBE - box((5, 5, 5), (15, 15, 15)) + box((8, 8, 8), (12, 12, 12))).solid()


@pytest.mark.parametrize("top", [20 - 1e-12, 20 - 1e-6, 20 - 5e-4])
def test_a_pocket_closed_by_a_skin_is_named(top: float) -> None:
    with pytest.raises(GeometryError, match=r"closed cavity from \(5, 5, 5\) to \(15, 15, 20\) mm has a skin of"):
        Given(CUBE - box((5, 5, 5), (15, 15, top))).solid()
    with pytest.raises(GeometryError, match="must reach beyond the face"):
        Given(CUBE - box((5, 5, 1), (15, 15, 10)) - box((5, 5, 10 + (20 - top)), (15, 15, 19))).solid()


def test_a_thin_lid_is_a_cavity_and_an_open_pocket_is_none() -> None:
    assert Given(CUBE - box((5, 5, 5), (15, 15, 20 - 2e-3)), holes=0).mass_properties().volume < 6.51e-6
    assert Given(CUBE - box((5, 5, 5), (15, 15, 20))).mass_properties().volume == pytest.approx(6.5e-6, rel=1e-12)


@pytest.mark.parametrize(
    ("shape", "exact"),
    [
        (CUBE - box((5, 5, 5), (15, 15, 15)), 7000.0),
        (BALL, 4.0 / 3.0 * math.pi),
        (box((0.5, -0.5, -0.5), (1.5, 0.5, 0.5)) + BALL, 4.77782),
        (Revolution(circle(0, 20, 5)), 2.0 * math.pi**2 * 20.0 * 25.0),
        (cylinder(1, 0, 3), 3.0 * math.pi),
        (cylinder(10, -30, 30) + cylinder(10, -30, 30, Frame((0, 0, 0), (0, 1, 0), (0, 0, 1))), 32365.77851),
        (box((0, 0, 0), (20, 20, 5)) - cylinder(0.02, -1, 6).moved(10, 10, 0), 2000.0 - math.pi * 0.0004 * 5.0),
    ],
    ids=["void", "ball", "ball and box", "torus", "cylinder", "crossing cylinders", "tiny hole"],
)
def test_volumes_are_exact(shape: Shape, exact: float) -> None:
    assert Given(shape).mass_properties().volume * 1e9 == pytest.approx(exact, rel=1.5e-6)


def test_inertia_of_round_parts() -> None:
    ball = Given(BALL).mass_properties()
    np.testing.assert_allclose(ball.inertia, 0.4 * ball.mass * 1e-6 * np.eye(3), atol=1e-5 * 0.4 * ball.mass * 1e-6)
    torus = Given(Revolution(circle(0, 20, 5))).mass_properties()
    about_axis = torus.mass * (20.0**2 + 0.75 * 25.0) * 1e-6
    assert torus.principal_moments[2] == pytest.approx(about_axis, rel=1e-5)
