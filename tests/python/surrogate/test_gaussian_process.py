"""Gaussian processes: gradient of the likelihood, predictions, leave-one-out, constants, repeats."""

import numpy as np
import pytest

from codesign.surrogate.gaussian_process import GaussianProcess
from codesign.surrogate.likelihood import Hyperparameters, Likelihood, matern
from codesign.surrogate.outputs import Output, Scaling

RNG = np.random.default_rng(7)
INPUTS = RNG.random((60, 3))
VARIABLE = np.arange(3)


def smooth(x):
    return np.sin(4 * x[:, 0]) + x[:, 1] ** 2


VALUES = smooth(INPUTS)


@pytest.mark.parametrize("logs", [[-1.0, 0.2, 1.5, -6.0], [0.5, -2.0, 0.0, -3.0]])
def test_the_gradient_of_the_likelihood_is_that_of_finite_differences(logs):
    squares = np.square(INPUTS.T[:, :, None] - INPUTS.T[:, None, :])
    likelihood = Likelihood(squares, (VALUES - VALUES.mean()) / VALUES.std())
    _, gradient = likelihood(np.array(logs))
    for i, step in enumerate(1e-5 * np.eye(4)):
        difference = (likelihood(logs + step)[0] - likelihood(logs - step)[0]) / 2e-5
        assert gradient[i] == pytest.approx(difference, rel=1e-5, abs=1e-5)


def test_a_smooth_function_is_found_again_with_an_honest_error():
    process = GaussianProcess.of(INPUTS, VALUES, VARIABLE)
    new = np.random.default_rng(8).random((500, 3))
    mean, deviation = process.predict(new)
    error = np.abs(mean - smooth(new))
    assert error.max() < 0.05
    assert 0.8 < np.mean(error < 1.645 * np.hypot(deviation, process.noise_deviation)) <= 1.0
    assert process.column_lengths[2] > 5 * process.column_lengths[0]  # the third variable does nothing


def test_leaving_out_needs_no_refit():
    lengths = Hyperparameters(np.array([0.5, 0.7, 3.0]), 1e-4)
    process = GaussianProcess.of(INPUTS, VALUES, VARIABLE, lengths)
    said = process.left_out(VALUES)
    for i in (0, 17, 42):
        rest = np.arange(60) != i
        correlation = matern(np.linalg.norm((INPUTS[rest] - INPUTS[i]) / lengths.lengths, axis=1))
        between = np.linalg.norm((INPUTS[rest][:, None] - INPUTS[rest]) / lengths.lengths, axis=2)
        known = np.linalg.solve(matern(between) + 1e-4 * np.eye(59), correlation)
        assert said.mean[i] == pytest.approx(VALUES.mean() + known @ (VALUES[rest] - VALUES.mean()), abs=1e-9)
        variance = process.variance * (1.0 + 1e-4 - correlation @ known)
        assert said.deviation[i] == pytest.approx(VALUES.std() * np.sqrt(variance), rel=1e-6)


def test_a_point_that_gave_what_was_predicted_changes_no_mean_and_only_lessens_deviations():
    process = GaussianProcess.of(INPUTS[:20], VALUES[:20], VARIABLE)
    more = process.conditioned(INPUTS[20])
    new = np.random.default_rng(9).random((50, 3))
    before, after = process.predict(new), more.predict(new)
    assert after[0] == pytest.approx(before[0], abs=1e-12)
    assert (after[1] <= before[1] + 1e-9).all()
    assert more.predict(INPUTS[20:21])[1] < 0.2 * process.predict(INPUTS[20:21])[1]


@pytest.mark.parametrize("value", [0.0, 1.0, 7.3, 0.1])
def test_a_constant_is_known_exactly(value):
    mean, deviation = Output.of("x", INPUTS, np.full(60, value) * (1 + 1e-15), VARIABLE).predict(INPUTS[:2])
    assert mean == pytest.approx(value)
    assert (deviation == 0.0).all()


def test_repeats_that_differ_become_noise():
    twice = np.vstack([INPUTS, INPUTS])
    process = GaussianProcess.of(twice, np.concatenate([VALUES + 0.05, VALUES - 0.05]), VARIABLE)
    assert np.abs(process.predict(INPUTS)[0] - VALUES).max() < 0.05
    assert process.noise_deviation == pytest.approx(0.05, rel=0.3)
    exact = GaussianProcess.of(twice, np.concatenate([VALUES, VALUES]), VARIABLE)
    assert np.abs(exact.predict(INPUTS)[0] - VALUES).max() < 1e-3


def test_the_scaling_of_an_objective_keeps_its_order_and_is_undone():
    values = np.array([3.0, 1.0, 2.0, 900.0, 2.5])
    scaling = Scaling.of(values)
    scaled = scaling.forward(values)
    assert list(np.argsort(scaled)) == list(np.argsort(values))
    assert (scaled.min(), scaling.forward(np.array([2.5]))[0]) == (-1.0, 0.0)
    assert scaled.max() < 10.0
    assert scaling.back(scaled) == pytest.approx(values)
