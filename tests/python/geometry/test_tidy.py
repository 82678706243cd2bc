"""Surfaces handed to the mesher: closed, without tiny edges or flat triangles, faces kept."""

import numpy as np
import pytest

from codesign.geometry.mass import volume_moments
from codesign.geometry.profile import Resolution
from codesign.geometry.solid import build_solid
from codesign.geometry.tidy import tidy
from codesign.parts.part import EXPORT_RESOLUTION, Part
from codesign.studies.ironcub.bracket import JetpackBracket
from codesign.studies.ironcub.forearm import ForearmJetSupport

# Designs whose raw booleans have edges of 12 to 32 micrometers or, divided more finely, triangles 0.1 micrometers high.
AWKWARD = [
    (JetpackBracket(37, 78), Resolution(48)),
    (JetpackBracket(62, 60), Resolution(48)),
    (ForearmJetSupport(116, 92), Resolution(48)),
    (JetpackBracket(19.65441687750465, 78.32381594200193), Resolution(76, chord_mm=0.012)),
    (ForearmJetSupport(80, 108), EXPORT_RESOLUTION),
]


def edge_lengths(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    return np.concatenate(
        [np.linalg.norm(points[triangles[:, k]] - points[triangles[:, k - 1]], axis=1) for k in range(3)]
    )


def triangle_heights(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    sides = points[np.roll(triangles, -1, axis=1)] - points[triangles]
    return np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1) / np.linalg.norm(sides, axis=2).max(axis=1)


@pytest.mark.parametrize(("part", "resolution"), AWKWARD, ids=lambda value: getattr(value, "title", str(value)))
def test_awkward_designs_come_out_clean(part: Part, resolution: Resolution) -> None:
    raw = build_solid(part.shape(), resolution)
    assert (
        edge_lengths(raw.points, raw.triangles).min() < 0.05
        or triangle_heights(raw.points, raw.triangles).min() < 0.001
    )
    points, triangles, face = tidy(raw.points, raw.triangles, raw.face)
    directed = np.concatenate([triangles[:, [k, (k + 1) % 3]] for k in range(3)])
    assert set(map(tuple, directed.tolist())) == set(map(tuple, directed[:, ::-1].tolist()))  # closed
    assert len(np.unique(directed, axis=0)) == len(directed)  # every edge once in each direction
    assert edge_lengths(points, triangles).min() >= 0.05
    assert triangle_heights(points, triangles).min() >= 0.002
    assert volume_moments(points, triangles)[0] == pytest.approx(volume_moments(raw.points, raw.triangles)[0], rel=2e-5)
    assert set(face) == set(raw.face)


def test_clean_surface_is_left_alone() -> None:
    raw = build_solid(JetpackBracket(15, 42).fem_shape("simplified"), Resolution())
    points, triangles, face = tidy(raw.points, raw.triangles, raw.face)
    np.testing.assert_array_equal(points, raw.points)
    np.testing.assert_array_equal(triangles, raw.triangles)
    np.testing.assert_array_equal(face, raw.face)
