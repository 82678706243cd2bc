"""Nearest approaches of moving bodies: the same as all distances of all pieces in all postures give."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from codesign.dynamics import hull_distances, nearest_approaches
from codesign.transforms import inverse

PIECES, POSTURES = 3, 12


def moving_bodies(spread):
    """Points of the pieces of six bodies, and their poses (6, POSTURES, 4, 4)."""
    generator = np.random.default_rng(5)
    bodies = [
        [generator.normal(size=(20, 3)) * 0.05 + generator.normal(size=3) * 0.1 for _ in range(PIECES)]
        for _ in range(6)
    ]
    poses = np.tile(np.eye(4), (6, POSTURES, 1, 1))
    poses[..., :3, :3] = Rotation.random(6 * POSTURES, rng=generator).as_matrix().reshape(6, POSTURES, 3, 3)
    poses[..., :3, 3] = generator.normal(size=(6, POSTURES, 3)) * spread
    return bodies, poses


PAIRS = np.array([(a, b) for a in range(6) for b in range(a)])


def all_distances(bodies, poses, a, b):
    """(POSTURES,) smallest distances of two bodies."""
    i, j, k = (index.ravel() for index in np.indices((PIECES, PIECES, POSTURES)))
    found = hull_distances([*bodies[a], *bodies[b]], i, PIECES + j, (inverse(poses[a]) @ poses[b])[k])
    return found.reshape(PIECES**2, POSTURES).min(axis=0)


@pytest.mark.parametrize("spread", [0.3, 0.05])  # apart in most postures; overlapping in most
@pytest.mark.parametrize("limit", [10.0, 0.05, -0.02])
def test_the_nearest_of_all_pieces_in_all_postures_is_found(spread, limit):
    bodies, poses = moving_bodies(spread)
    distances, postures = nearest_approaches(bodies, poses, PAIRS, limit)
    below = 0
    for (a, b), distance, posture in zip(PAIRS, distances, postures, strict=True):
        wanted = all_distances(bodies, poses, a, b)
        assert distance == pytest.approx(min(wanted.min(), limit), abs=1e-12)
        if wanted.min() < limit:
            assert posture == np.argmin(wanted)
            below += 1
    assert below > 0 or (spread, limit) == (0.3, -0.02)


def test_what_does_not_move_is_nearest_in_the_first_posture():
    bodies, poses = moving_bodies(0.3)
    poses[1] = poses[0] @ inverse(poses[0, :1]) @ poses[1, :1]
    distances, postures = nearest_approaches(bodies, poses, np.array([[0, 1]]), 10.0)
    assert postures.tolist() == [0]
    assert distances[0] == pytest.approx(all_distances(bodies, poses, 0, 1)[0], abs=1e-12)


@pytest.mark.parametrize(
    ("bodies", "poses", "pairs", "message"),
    [
        ([[]], np.eye(4)[None, None], [[0, 0]], "must have a piece"),
        ([[np.full((1, 3), np.nan)]], np.eye(4)[None, None], [[0, 0]], "finite"),
        ([[np.zeros((1, 3))]], np.eye(4)[None], [[0, 0]], "shape"),
        ([[np.zeros((1, 3))]], np.full((1, 1, 4, 4), np.nan), [[0, 0]], "poses must be finite"),
        ([[np.zeros((1, 3))]], np.eye(4)[None, None], [[0, 1]], "numbers of bodies"),
        ([[np.zeros((1, 3))]], np.eye(4)[None, None], [[-1, 0]], "numbers of bodies"),
    ],
)
def test_wrong_queries_are_refused(bodies, poses, pairs, message):
    with pytest.raises(ValueError, match=message):
        nearest_approaches(bodies, poses, np.array(pairs), 1.0)
