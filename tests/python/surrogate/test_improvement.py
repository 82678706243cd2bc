"""Boxes against hypervolumes, expected gains against samples."""

import numpy as np
import pytest
from pymoo.indicators.hv import Hypervolume

from codesign.surrogate.boxes import Boxes
from codesign.surrogate.improvement import ChebyshevImprovement, HypervolumeImprovement


@pytest.mark.parametrize("objectives", [1, 2, 3])
@pytest.mark.parametrize("count", [0, 1, 5, 200])
@pytest.mark.parametrize("levels", [None, 5], ids=["random", "tied"])
def test_boxes_fill_what_the_front_leaves(objectives, count, levels):
    front = 1.2 * np.random.default_rng(count).random((count, objectives))
    if levels:
        front = np.round(levels * front) / levels
    reference = np.ones(objectives)
    boxes = Boxes.beside(front, reference)
    volume = np.prod(boxes.upper - np.maximum(boxes.lower, 0.0), axis=1).sum()
    inside = front[(front < reference).all(axis=1)]
    dominated = Hypervolume(ref_point=reference)(inside) if len(inside) else 0.0
    assert volume == pytest.approx(1.0 - dominated, abs=1e-13)
    assert len(boxes.lower) <= 2 * count + 1
    points = np.random.default_rng(1).random((200, objectives))
    held = ((points[:, None] >= boxes.lower) & (points[:, None] < boxes.upper)).all(axis=2).sum(axis=1)
    free = ~(front[None] <= points[:, None]).all(axis=2).any(axis=1)
    assert (held == free).all()


def test_more_objectives_have_no_boxes():
    with pytest.raises(ValueError, match="4 objectives"):
        Boxes.beside(np.zeros((1, 4)), np.ones(4))


@pytest.mark.parametrize("objectives", [1, 2, 3])
def test_the_expected_growth_is_the_mean_of_a_sample(objectives):
    rng = np.random.default_rng(3)
    front, reference = rng.random((12, objectives)), np.ones(objectives)
    mean, deviation = 0.3 * rng.random((4, objectives)), 0.1 + 0.2 * rng.random((4, objectives))
    boxes = Boxes.beside(front, reference)
    samples = mean[:, None] + deviation[:, None] * rng.standard_normal((4, 40_000, objectives))
    sampled = [
        np.prod(np.maximum(boxes.upper - np.maximum(boxes.lower, part[:, None]), 0.0), axis=2).sum(axis=1).mean()
        for part in samples
    ]
    assert HypervolumeImprovement(front, reference).of(mean, deviation) == pytest.approx(sampled, rel=0.03)


def test_many_objectives_are_ranked_by_their_weighted_distance():
    rng = np.random.default_rng(3)
    front, weights = rng.random((8, 5)), np.full(5, 0.2)
    improvement = ChebyshevImprovement(front, weights, rng)
    at = np.vstack([front.min(axis=0), front[0] + 10.0])
    gain = improvement.of(at, np.full_like(at, 1e-6))

    def distance(values):
        away = 0.2 * (values - front.min(axis=0))
        return away.max(axis=-1) + 0.05 * away.sum(axis=-1)

    assert gain == pytest.approx([distance(front).min(), 0.0], abs=1e-5)
