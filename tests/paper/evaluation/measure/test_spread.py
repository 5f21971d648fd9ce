"""Standard deviations of errors whose spread and memory are known in closed form."""

import numpy as np
import pytest

from experiments.evaluation.compare.masks import masked_mean
from experiments.evaluation.measure.estimates.sigma import autocorrelation, first_below, ranks


def test_memory_of_a_first_order_process_is_its_pole(rng: np.random.Generator) -> None:
    """Of x_k = a x_{k-1} + noise the autocorrelation is a^lag: it falls below 1/e after -1 / ln(a) rows."""
    pole, noise = 0.95, rng.normal(size=400_000)
    x = np.empty_like(noise)
    x[0] = noise[0]
    for k in range(1, len(x)):
        x[k] = pole * x[k - 1] + noise[k]
    memory = autocorrelation(x[:, None], ((0, 150_000), (150_000, 400_000)), 60)
    np.testing.assert_allclose(memory[:, 0], pole ** np.arange(61), atol=0.02)
    assert first_below(memory, np.exp(-1.0))[0] == pytest.approx(-1.0 / np.log(pole), abs=2.0)


def test_a_constant_error_never_ends_and_white_noise_ends_at_once(rng: np.random.Generator) -> None:
    signal = np.stack([np.full(3000, -2.0), rng.normal(size=3000)], axis=1)
    memory = autocorrelation(signal, ((0, 3000),), 50)
    np.testing.assert_allclose(memory[:, 0], 1.0, atol=1e-9)
    np.testing.assert_allclose(first_below(memory, 0.5), [51.0, 1.0])


def test_lags_are_within_a_span_and_those_that_no_span_has_are_not_defined() -> None:
    signal = np.concatenate([np.ones(10), -np.ones(10)])[:, None]
    memory = autocorrelation(signal, ((0, 10), (10, 20)), 12)
    np.testing.assert_allclose(memory[:10, 0], 1.0, atol=1e-9)
    assert np.isnan(memory[10:]).all()


def test_parts_are_equally_large_and_rise_with_sigma(rng: np.random.Generator) -> None:
    std, inside = rng.uniform(1.0, 5.0, (1000, 2)), np.ones((1000, 2), dtype=bool)
    inside[:100] = False
    found = ranks(std.astype(np.float32), inside, 9)
    assert [int((found[:, 0] == k).sum()) for k in range(-1, 9)] == pytest.approx([100] * 10, abs=1)
    means = [std[found[:, 1] == k, 1].mean() for k in range(9)]
    assert means == sorted(means)


def test_a_mean_over_a_mask_is_that_of_its_rows_and_none_without_any() -> None:
    values, mask = np.array([[1.0, 2.0], [3.0, 4.0], [9.0, 6.0]]), np.array([[1, 0], [1, 0], [0, 0]], dtype=bool)
    np.testing.assert_allclose(masked_mean(values, mask), [2.0, np.nan])
