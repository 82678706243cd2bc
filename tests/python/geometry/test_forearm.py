"""The forearm support: closed forms, published mass properties, named faces, refusals."""

import numpy as np
import pytest

from codesign.errors import GeometryError
from codesign.geometry.shape import polar
from codesign.parts.part import EXPORT_RESOLUTION
from codesign.studies.ironcub.forearm import ForearmJetSupport

DISTAL_AREA_MM2 = {80: 3622.94, 88: 4010.20, 100: 4468.28, 108: 4661.2}


@pytest.mark.parametrize("offset", DISTAL_AREA_MM2)
def test_distal_face_has_the_published_area(offset: float) -> None:
    assert ForearmJetSupport(offset, 108).seat_area * 1e6 == pytest.approx(DISTAL_AREA_MM2[offset], abs=0.05)


@pytest.mark.parametrize(("offset", "length"), [(80, 50), (80, 150), (83.4, 71.7), (100, 130), (120, 150)])
def test_volume_is_the_closed_form(offset: float, length: float) -> None:
    part = ForearmJetSupport.as_published(offset, length)
    volume_mm3 = 23.9 * (part.seat_area * 1e6 + 490.87) + 254.469 * length + 36083.8
    assert part.mass_properties().volume * 1e9 == pytest.approx(
        volume_mm3, rel=5e-6
    )  # extrapolated from 24 and 48 segments


def test_mass_properties_of_the_published_optimum() -> None:
    properties = ForearmJetSupport.as_published(88, 50).mass_properties()
    inertia = [[2111.3, -3.95, -245.5], [-3.95, 2063.4, -1.53], [-245.5, -1.53, 957.6]]
    assert properties.mass == pytest.approx(0.68965, abs=1e-5)
    np.testing.assert_allclose(properties.com * 1e3, [-82.86, 15.08, -27.19], atol=6e-3)
    np.testing.assert_allclose(properties.inertia * 1e6, inertia, rtol=2e-3, atol=0.2)


def test_fillets_add_what_their_cross_sections_say() -> None:
    sharp, round_ = ForearmJetSupport.as_published(88, 50), ForearmJetSupport(88, 50, spot_face=0.0)
    assert (round_.mass_properties().volume - sharp.mass_properties().volume) * 1e9 == pytest.approx(101.0, abs=0.5)


def test_heads_of_the_flange_screws_find_a_flat_seat() -> None:
    """No material lies in front of the flange within a head's radius of the screws; without spot faces some does."""
    y, z = np.array(polar(11.7, 135.0, -135.0)).T
    for part, free in ((ForearmJetSupport(88, 50), True), (ForearmJetSupport(88, 50, spot_face=0.0), False)):
        points = part.solid(EXPORT_RESOLUTION).points
        inside = (points[:, 0] < -18.0 - 1e-6) & (points[:, 0] > -23.0 + 1e-6)
        clearance = np.hypot(points[:, None, 1] - 15.0 - y, points[:, None, 2] - z).min(axis=1)
        assert bool(clearance[inside].min() > 2.74) is free  # chords of that resolution stay within 0.01 mm
    with pytest.raises(GeometryError, match=r"spot_face = 3 mm is above its limit 2\.75"):
        ForearmJetSupport(88, 50, spot_face=3.0)


@pytest.mark.parametrize("geometry", ["full", "simplified"])
def test_analyzed_shapes_have_their_faces(geometry: str) -> None:
    surface = ForearmJetSupport(80, 108).fem_surface(geometry)
    assert set(surface.face_names) == {"", "mount", "seat"}
    x = surface.points[:, 0] * 1e3
    assert x.max() == (6.0 if geometry == "full" else -6.0)
    assert x.min() == pytest.approx(-(167.0 if geometry == "full" else 165.9), abs=1e-9)


@pytest.mark.parametrize(
    ("offset", "length", "name"),
    [(75, 60, "offset"), (140, 60, "offset"), (90, 5, "length"), (float("nan"), 60, "offset")],
)
def test_values_out_of_range_are_refused_by_name(offset: float, length: float, name: str) -> None:
    with pytest.raises(GeometryError, match=f"forearm_support: {name} = "):
        ForearmJetSupport(offset, length)


def test_refusal_names_value_limit_and_reason() -> None:
    with pytest.raises(
        GeometryError, match=r"offset = 75 mm is below its limit 75\.4 mm \(2 mm between the ring's bore"
    ):
        ForearmJetSupport(75, 60)
    with pytest.raises(GeometryError, match=r"fillet = 3 mm is above its limit 2\.25 mm \(it must end on the flange"):
        ForearmJetSupport(90, 60, fillet=3.0)


def test_right_side_is_the_mirror_image_in_z() -> None:
    left = ForearmJetSupport(88, 50)
    right = left.mirrored("z", "r_forearm")
    a, b = left.mass_properties(), right.mass_properties()
    flip = np.diag([1.0, 1.0, -1.0])
    assert b.mass == pytest.approx(a.mass, rel=1e-12)
    np.testing.assert_allclose(b.com, flip @ a.com, rtol=1e-9)
    np.testing.assert_allclose(b.inertia, flip @ a.inertia @ flip, rtol=1e-9, atol=1e-15)
    assert right.faces == left.faces
    assert right.mirrored("z", "again").mass_properties().com[2] == pytest.approx(a.com[2], rel=1e-12)
