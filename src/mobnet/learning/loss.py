"""Gaussian likelihood of the uncertainty torque, eqs. (19) to (22)."""

import torch
from torch import Tensor


def gaussian_loss(mean: Tensor, std: Tensor, target: Tensor) -> Tensor:
    """Return the mean of ln(sigma^2) + (mean - target)^2 / sigma^2, eq. (22).

    Args:
        mean: predicted torque (..., n), z-scored, unitless.
        std: its standard deviation (..., n), positive.
        target: torque (..., n) in the same scale.

    Returns:
        One number (), the mean over samples and joints.
    """
    return (2 * torch.log(std) + ((mean - target) / std).square()).mean()
