"""The part language: both evaluators against closed forms and against each other, names, refusals."""

from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from codesign.errors import GeometryError
from codesign.geometry.brep import build_brep
from codesign.geometry.mass import extrapolate, mass_properties, volume_moments
from codesign.geometry.profile import Path, Profile, Resolution, circle, polygon, rectangle
from codesign.geometry.shape import (
    Extrusion,
    Frame,
    Revolution,
    Shape,
    at_points,
    box,
    cone,
    cylinder,
    plate,
    polar,
    stepped_hole,
    union,
)
from codesign.geometry.solid import build_solid
from codesign.parts.part import Part, parameter

PI = np.pi
CLOSED_FORMS: dict[str, tuple[Shape, float]] = {
    "box": (box((0, 0, 0), (1, 2, 3)), 6.0),
    "cylinder": (cylinder(2, 0, 5), 20 * PI),
    "cone": (cone(0, 1, 3, 2), 7 * PI),
    "tube": (Extrusion(circle(0, 0, 3).without(circle(1, 0, 1)), 0, 1), 8 * PI),
    "torus": (Revolution(circle(0, 5, 2)), 40 * PI**2),
    "rounded plate": (plate(rectangle(0, 0, 10, 6, radius=2), 2), 2 * (60 - 16 + 4 * PI)),
    "chamfered bar": (plate(Path(0, 0).line(4, 0, chamfer=1).line(4, 4).line(0, 4).close(), 1), 15.5),
    "hole pattern": (box((0, 0, 0), (9, 9, 9)) - at_points(cylinder(1, -1, 10), [(2, 2), (7, 7)]), 729 - 18 * PI),
    "stepped hole": (box((-9, -9, 0), (9, 9, 5)) - stepped_hole((1, -1, 2), (2, 2, 6)), 1620 - 2 * PI - 12 * PI),
    "intersection": (box((-1, -1, 0), (1, 1, 1)) & cylinder(1, 0, 1), PI),
    "touching": (union(box((0, 0, 0), (1, 1, 1)), box((0, 0, 1), (1, 1, 3))), 3.0),
    "moved and turned": (box((0, 0, 0), (1, 2, 3)).moved(4, 5, 6).rotated("y", 30).mirrored("z"), 6.0),
    "flange": (
        cylinder(20, 0, 4) - at_points(cylinder(2, -1, 5), polar(15, 0, 90, 180, 270)),
        4 * (400 * PI - 16 * PI),
    ),
}


def exact_moments(shape: Shape) -> np.ndarray:
    solids = [build_solid(shape, Resolution(48, 1e-4, refine)) for refine in (1, 2)]
    return extrapolate(*(volume_moments(solid.points, solid.triangles) for solid in solids))


@pytest.mark.parametrize("name", CLOSED_FORMS)
def test_mesh_and_brep_have_the_volume_of_the_closed_form(name: str) -> None:
    shape, volume = CLOSED_FORMS[name]
    assert exact_moments(shape)[0] == pytest.approx(volume, rel=1e-5)  # extrapolated from 48 and 96 segments
    assert build_brep(shape).volume == pytest.approx(volume, rel=1e-10)


def test_inertia_of_a_cylinder() -> None:
    properties = mass_properties(exact_moments(cylinder(20, 0, 50)), density=7850.0)
    mass = 7850.0 * PI * 0.02**2 * 0.05
    assert properties.mass == pytest.approx(mass, rel=1e-5)
    np.testing.assert_allclose(properties.com, [0, 0, 0.025], atol=1e-12)
    across = mass * (3 * 0.02**2 + 0.05**2) / 12
    np.testing.assert_allclose(properties.inertia, np.diag([across, across, mass * 0.02**2 / 2]), rtol=1e-5, atol=1e-12)


def test_mass_properties_turn_with_the_solid() -> None:
    shape = union(box((0, 0, 0), (10, 20, 30)), cylinder(4, -20, 5).moved(3, 7)) - cylinder(2, -30, 40)
    still = mass_properties(exact_moments(shape), density=2700.0)
    turned = mass_properties(exact_moments(shape.rotated("x", 25).rotated("z", -70, about=(1, 2, 3))), density=2700.0)
    a, b = np.radians([25, -70])
    x = np.array([[1, 0, 0], [0, np.cos(a), -np.sin(a)], [0, np.sin(a), np.cos(a)]])
    z = np.array([[np.cos(b), -np.sin(b), 0], [np.sin(b), np.cos(b), 0], [0, 0, 1]])
    about = np.array([1, 2, 3]) * 1e-3
    np.testing.assert_allclose(turned.com, z @ (x @ still.com - about) + about, rtol=1e-9)
    np.testing.assert_allclose(turned.inertia, z @ x @ still.inertia @ (z @ x).T, rtol=1e-9, atol=1e-15)


@settings(max_examples=25, deadline=None)
@given(st.floats(0.5, 30), st.floats(0.5, 30), st.floats(0.5, 30), st.floats(0.1, 0.24))
def test_areas_and_moments_of_rounded_rectangles(width: float, height: float, x: float, share: float) -> None:
    radius = share * min(width, height)
    profile = rectangle(x, 0, x + width, height, radius=radius)
    area = width * height - (4 - PI) * radius**2
    assert profile.area == pytest.approx(area, rel=1e-12)
    np.testing.assert_allclose(profile.first_moments, [area * (x + width / 2), area * height / 2], rtol=1e-10)


def test_first_moments_of_a_region_with_a_hole() -> None:
    profile = circle(2, 3, 5).without(circle(4, 3, 1))
    np.testing.assert_allclose(profile.first_moments, [50 * PI - 4 * PI, 75 * PI - 3 * PI], rtol=1e-12)


def named_block() -> Shape:
    pocket = cylinder(2, 5, 11, end_face="unused", start_face="floor", face="wall")
    slot = box((-20, -1, 8), (20, 1, 11), z0="slot")
    block = box((-10, -10, 0), (10, 10, 10), z0="base", z1="top")
    ring = Revolution(polygon((10, 0), (14, 0), (14, 3), (10, 3), faces=["", "tip", "", ""]), Frame((0, 0, 0)))
    return (union(block, ring) - pocket - slot).rotated("z", 30).mirrored("x")


def test_names_survive_booleans_motions_and_mirrors_in_both_evaluators() -> None:
    shape = named_block()
    fine = build_solid(shape, Resolution(512, 1e-4))
    exact = build_brep(shape)
    for name in ("base", "top", "floor", "wall", "slot", "tip"):
        triangles = fine.triangles[np.array(fine.face_names)[fine.face] == name]
        a, b, c = (fine.points[triangles[:, k]] for k in range(3))
        area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()
        assert area == pytest.approx(exact.area(name), rel=2e-3), name
    assert exact.area("base") == pytest.approx(400.0)
    assert exact.area("tip") == pytest.approx(9 * PI)
    assert exact.area("floor") == pytest.approx(4 * PI)
    assert "unused" not in fine.names


def far_apart() -> Shape:
    return union(box((0, 0, 0), (1, 1, 1)), box((2, 0, 0), (3, 1, 1)))


def nothing_left() -> Shape:
    return box((0, 0, 0), (1, 1, 1)) - box((-1, -1, -1), (2, 2, 2))


@pytest.mark.parametrize(("make", "reason"), [(far_apart, "2 bodies"), (nothing_left, "empty")])
def test_what_is_not_one_solid_is_refused(make: Callable[[], Shape], reason: str) -> None:
    with pytest.raises(GeometryError, match=reason):
        build_solid(make(), Resolution())
    with pytest.raises(GeometryError, match="bodies"):
        build_brep(make())


@pytest.mark.parametrize(
    ("draw", "reason"),
    [
        (lambda: polygon((0, 0), (0, 1), (1, 1)), "must be positive"),
        (lambda: polygon((0, 0), (4, 0), (0, 3), (1, -1), (4, 4), (0, 4)), "crosses itself"),
        (
            lambda: Path(0, 0).line(6, 0).line(6, 3).line(4, 3).arc(2, 1, center=(2, 3)).line(0, 1).close(),
            "doubles back",
        ),
        (lambda: Path(0, 0).arc(2, 0, center=(0.5, 0)), "radii"),
        (lambda: Path(0, 0).line(1, 0).line(1, 1, radius=3).line(0, 1).close(), "does not fit"),
        (lambda: cylinder(1, 2, 2), "end must lie above"),
        (lambda: Revolution(polygon((0, -1), (1, -1), (1, 1))), "cross its axis"),
    ],
)
def test_impossible_shapes_are_refused(draw: Callable[[], Profile | Shape], reason: str) -> None:
    with pytest.raises(GeometryError, match=reason):
        draw()


@pytest.mark.parametrize(
    "call",
    [
        lambda: box((0, 0, 0), (1, 1, 1), top="a"),
        lambda: Frame(x=(1, 0, 0), y=(1, 0, 0)),
        lambda: Path(0, 0).arc(2, 0, center=(1, 0), turn="up"),
        lambda: box((0, 0, 0), (1, 1, 1)).mirrored("w"),
    ],
)
def test_wrong_arguments_are_refused(call: Callable[[], object]) -> None:
    with pytest.raises(ValueError, match=r"."):
        call()


@dataclass(frozen=True)
class Clip(Part):
    """A plate with a hole: what a user's first part looks like."""

    width: float = parameter("mm", 10, 60)
    hole: float = parameter("mm", 1, 60)
    _: KW_ONLY
    name: str = "clip"
    density: float = 2700.0

    def check(self) -> None:
        self.limit("hole", maximum=self.width - 4, because="2 mm wall beside the hole")

    def through_holes(self) -> int:
        return 1

    def shape(self) -> Shape:
        return box((0, 0, 0), (self.width, self.width, 5), z0="mount") - cylinder(self.hole / 2, -1, 6).moved(
            self.width / 2, self.width / 2
        )


def test_a_users_part() -> None:
    clip = Clip(20, 8)
    assert clip.parameters == {"width": 20, "hole": 8}
    assert clip.faces == ("mount",)
    assert clip.title == "clip width=20 hole=8"
    assert clip.mass_properties().mass == pytest.approx(2700e-9 * (2000 - 80 * PI), rel=1e-5)
    with pytest.raises(
        GeometryError, match=r"clip: hole = 17 mm is above its limit 16 mm \(2 mm wall beside the hole\)"
    ):
        Clip(20, 17)
    with pytest.raises(GeometryError, match=r"clip: width = 61 mm is above its limit 60 mm \(valid range\)"):
        Clip(61, 8)
    with pytest.raises(GeometryError, match="density"):
        Clip(20, 8, density=0.0)


@dataclass(frozen=True)
class Careless(Clip):
    """Forgets to keep the hole inside and names a face that the hole removes."""

    def check(self) -> None:
        pass

    def shape(self) -> Shape:
        inner = box((8, 8, 4), (12, 12, 6), z0="label")
        return box((0, 0, 0), (20, 20, 5)) - inner - cylinder(self.hole / 2, -1, 6).moved(10, 10)


def test_what_a_careless_part_hides_is_found_when_it_is_built() -> None:
    with pytest.raises(GeometryError, match="face 'label' has vanished"):
        Careless(20, 8).surface()
    with pytest.raises(GeometryError, match="falls apart into 4 bodies"):
        Clip.__init__(part := object.__new__(Careless), 20, 26)
        part.surface()
