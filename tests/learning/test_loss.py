"""Gaussian likelihood, eqs. (20) to (22)."""

import math

import pytest
import torch

from mobnet.learning.loss import gaussian_loss


def test_it_is_minus_twice_the_log_of_20_without_its_constant() -> None:
    generator = torch.Generator().manual_seed(0)
    mean, target = torch.randn(2, 50, 6, generator=generator)
    std = torch.rand(50, 6, generator=generator) + 0.1
    likelihood = torch.distributions.Normal(mean, std).log_prob(target)
    expected = (-2 * likelihood).mean() - math.log(2 * math.pi)
    torch.testing.assert_close(gaussian_loss(mean, std, target), expected)


def test_best_std_is_the_size_of_the_error() -> None:
    std = torch.linspace(0.1, 3.0, 291)
    zero = torch.zeros(291)
    losses = torch.stack([gaussian_loss(zero[:1], s[None], zero[:1] + 0.7) for s in std])
    assert float(std[losses.argmin()]) == pytest.approx(0.7, abs=0.01)
