"""The jetpack bracket: closed forms, published mass properties, named faces, refusals."""

import numpy as np
import pytest

from codesign.errors import GeometryError
from codesign.parts.surface import SurfaceMesh
from codesign.studies.ironcub.bracket import JetpackBracket

POCKET_FLOOR_MM2 = np.pi * 23.0**2 - 6.0 * np.pi * 1.6**2


def face_area(surface: SurfaceMesh, name: str) -> float:
    triangles = surface.triangles[surface.face == surface.face_names.index(name)]
    a, b, c = (surface.points[triangles[:, k]] for k in range(3))
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()


@pytest.mark.parametrize(("angle", "distance"), [(1, 40), (15, 42), (36.9, 60), (52, 70.3), (79, 100)])
def test_volume_is_the_closed_form_whatever_the_angle(angle: float, distance: float) -> None:
    volume_mm3 = JetpackBracket(angle, distance).mass_properties().volume * 1e9
    assert volume_mm3 == pytest.approx(43586.36 + 900.0 * distance, rel=5e-6)  # extrapolated from 24 and 48 segments


def test_mass_properties_of_the_original_design() -> None:
    properties = JetpackBracket(15, 42).mass_properties()
    inertia = [[67.701, 0, -37.170], [0, 218.820, 0], [-37.170, 0, 262.671]]
    assert properties.mass == pytest.approx(0.227882, rel=2e-5)
    np.testing.assert_allclose(properties.com * 1e3, [40.185, 0, 13.639], atol=1e-3)
    np.testing.assert_allclose(properties.inertia * 1e6, inertia, rtol=3e-5, atol=1e-9)


def test_published_slab_thickness_gives_the_published_mass() -> None:
    assert JetpackBracket.as_published(1, 47.9133).mass_properties().mass == pytest.approx(0.242863, rel=2e-5)


def test_seat_is_the_pocket_floor() -> None:
    surface = JetpackBracket(15, 42).surface(segments=192)
    assert face_area(surface, "seat") * 1e6 == pytest.approx(POCKET_FLOOR_MM2, rel=5e-4)  # 192-gons


@pytest.mark.parametrize("support", ["published", "bolted"])
@pytest.mark.parametrize("geometry", ["full", "simplified"])
@pytest.mark.parametrize("angle", [1, 45, 79])
def test_analyzed_shapes_have_their_faces(geometry: str, support: str, angle: float) -> None:
    surface = JetpackBracket(angle, 60).fem_surface(geometry, segments=192, support=support)
    assert {"seat", "symmetry"} <= set(surface.face_names)
    assert ("mount" in surface.face_names) == (support == "published")
    assert surface.points[:, 1].min() == 0.0
    if support == "bolted":
        crease_x = 25 - 15 * np.tan(np.radians(angle) / 2)
        holes = np.pi * 4.2**2 + (np.pi * 2**2 / 2 if geometry == "full" else 0.0)  # one M8 hole, half a dowel hole
        assert face_area(surface, "pad") * 1e6 == pytest.approx(20 * (20 + min(20, crease_x)) - holes, rel=1e-3)


@pytest.mark.parametrize(("angle", "distance", "name"), [(0, 60, "angle"), (90, 60, "angle"), (15, 20, "distance")])
def test_values_out_of_range_are_refused_by_name(angle: float, distance: float, name: str) -> None:
    with pytest.raises(GeometryError, match=rf"jetpack_bracket: {name} = .* its limit"):
        JetpackBracket(angle, distance)
