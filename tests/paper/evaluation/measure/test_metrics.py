"""Metrics are what their closed forms say."""

import numpy as np
import pytest

from experiments.evaluation.compare.rmse import Spans, relative_rmse, rmse, roughness


def whole(signal: np.ndarray) -> Spans:
    """Return one stretch of all rows."""
    return ((0, len(signal)),)


def test_rmse_of_a_constant_error_is_that_constant(rng: np.random.Generator) -> None:
    """A closed form."""
    truth = rng.normal(size=(500, 3))
    error = np.array([-2.0, 0.0, 0.5])
    np.testing.assert_allclose(rmse(truth + error, truth, whole(truth)), np.abs(error), atol=1e-12)


def test_rmse_scales_with_the_error_is_symmetric_and_tells_the_deviation_of_noise(rng: np.random.Generator) -> None:
    estimate, truth = rng.normal(size=(2, 400, 2))
    error = rmse(estimate, truth, whole(truth))
    np.testing.assert_allclose(rmse(7 * estimate, 7 * truth, whole(truth)), 7 * error, rtol=1e-12)
    np.testing.assert_allclose(rmse(truth, estimate, whole(truth)), error, rtol=1e-12)
    noise = rng.normal(scale=1.5, size=(200_000, 1))
    np.testing.assert_allclose(rmse(noise, np.zeros_like(noise), whole(noise)), 1.5, rtol=0.01)


def test_rmse_loses_no_digits_on_float32_with_a_large_offset() -> None:
    """Invariant under an offset that both share."""
    truth = np.full((100_000, 1), 1000.0, dtype=np.float32)
    np.testing.assert_allclose(rmse(truth + np.float32(0.5), truth, whole(truth)), 0.5, rtol=1e-12)


def test_samples_between_segments_do_not_count() -> None:
    estimate = np.array([[1.0], [1.0], [50.0], [1.0], [1.0]])
    np.testing.assert_allclose(rmse(estimate, np.zeros((5, 1)), ((0, 2), (3, 5))), 1.0)


def test_roughness_of_a_ramp_is_its_slope() -> None:
    ramp = (3.0 * np.arange(100) / 1000.0)[:, None]
    np.testing.assert_allclose(roughness(ramp, whole(ramp), 1000.0), 3.0, rtol=1e-9)


def test_roughness_of_two_still_segments_is_zero_however_far_apart() -> None:
    signal = np.concatenate([np.zeros((50, 1)), np.full((50, 1), 100.0)])
    assert roughness(signal, ((0, 50), (50, 100)), 1000.0) == pytest.approx(0.0)
    assert roughness(signal, whole(signal), 1000.0) > 1.0


def test_every_metric_of_a_perfect_constant_estimate_is_zero() -> None:
    signal = np.full((20, 2), 4.0)
    for error in (rmse, relative_rmse):
        np.testing.assert_allclose(error(signal, signal, whole(signal)), 0.0)
    np.testing.assert_allclose(roughness(signal, whole(signal), 1000.0), 0.0)


def test_relative_rmse_is_a_percentage_of_the_largest_truth_and_has_no_unit_of_its_own(
    rng: np.random.Generator,
) -> None:
    """A closed form, invariant under a change of unit."""
    truth = rng.normal(size=(300, 2))
    truth[7] = [-20.0, 50.0]
    for factor in (1.0, 3.0):
        ours = factor * (truth + 2.0)
        np.testing.assert_allclose(relative_rmse(ours, factor * truth, ((0, 200),)), [10.0, 4.0], rtol=1e-12)


def test_a_joint_that_nothing_touches_has_no_relative_rmse() -> None:
    truth = np.array([[0.0, 1.0], [0.0, -4.0]])
    numbers = relative_rmse(truth + 1.0, truth, whole(truth))
    assert np.isnan(numbers[0])
    assert numbers[1] == pytest.approx(25.0)
