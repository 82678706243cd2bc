"""Surfaces handed to the mesher: closed, without tiny edges or flat triangles, faces kept."""

import numpy as np
import pytest

from codesign.geometry.mass import volume_moments
from codesign.geometry.part import Part
from codesign.geometry.profile import Resolution
from codesign.geometry.solid import build_solid
from codesign.geometry.tidy import SHORTEST_EDGE, tidy
from codesign.studies.ironcub.bracket import JetpackBracket
from codesign.studies.ironcub.forearm import ForearmJetSupport

# Designs whose raw booleans have edges of 5 to 30 micrometres, or flat triangles.
AWKWARD = [
    JetpackBracket(37, 78),
    JetpackBracket(52, 70),
    JetpackBracket(64, 46),
    JetpackBracket(67, 94),
    JetpackBracket(19.65441687750465, 78.32381594200193),
    ForearmJetSupport(116, 92),
    ForearmJetSupport(89.27599513848554, 134.1227992692387),
    ForearmJetSupport(83.4, 71.7),
]


def edge_lengths(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    return np.concatenate(
        [np.linalg.norm(points[triangles[:, k]] - points[triangles[:, k - 1]], axis=1) for k in range(3)]
    )


@pytest.mark.parametrize("part", AWKWARD, ids=repr)
def test_awkward_designs_come_out_clean(part: Part) -> None:
    raw = build_solid(part.shape(), Resolution())
    points, triangles, face = tidy(raw.points, raw.triangles, raw.face)
    directed = np.concatenate([triangles[:, [k, (k + 1) % 3]] for k in range(3)])
    opposite = directed[:, ::-1]
    assert set(map(tuple, directed.tolist())) == set(map(tuple, opposite.tolist()))  # closed, each edge used once a way
    assert len(np.unique(directed, axis=0)) == len(directed)
    length = edge_lengths(points, triangles)
    sides = points[np.roll(triangles, -1, axis=1)] - points[triangles]
    height = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1) / np.linalg.norm(sides, axis=2).max(axis=1)
    assert length.min() >= SHORTEST_EDGE
    assert height.min() >= 0.001
    assert volume_moments(points, triangles)[0] == pytest.approx(volume_moments(raw.points, raw.triangles)[0], rel=2e-5)
    assert set(face) == set(raw.face)


def test_clean_surface_is_left_alone() -> None:
    raw = build_solid(JetpackBracket(15, 42).fem_shape("simplified"), Resolution())
    points, triangles, face = tidy(raw.points, raw.triangles, raw.face)
    np.testing.assert_array_equal(points, raw.points)
    np.testing.assert_array_equal(triangles, raw.triangles)
    np.testing.assert_array_equal(face, raw.face)
