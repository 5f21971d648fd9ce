"""What a training minimises: the likelihood (22), or a loss that weighs its samples otherwise.

docs/notes/networks.md derives (N16) to (N18), docs/notes/training.md says why (22) has two others beside it:
`beta_likelihood` (beta-NLL, Seitzer et al. 2022, arXiv:2203.09168), and `squared` (faithful heteroscedastic regression,
Stirn et al. 2023, arXiv:2212.09184), with which the mean is what it would be without a sigma.
"""

from collections.abc import Callable, Mapping
from functools import partial

from torch import Tensor

Objective = Callable[[Tensor, Tensor, Tensor], tuple[Tensor, Tensor]]
# What the last two minimise rates no network, because a wider sigma changes it at the same errors; (22) would choose by
# the samples that they are there to weigh less.
CHOSEN_BY: Mapping[str, str] = {  # column of `Epoch` that is smallest in the epoch kept
    "likelihood": "validation_loss",
    "beta_likelihood": "validation_rmse",
    "squared": "validation_rmse",
}


def gaussian_loss(mean: Tensor, std: Tensor, target: Tensor) -> Tensor:
    """Return the mean of ln(sigma^2) + (mean - target)^2 / sigma^2 over samples and joints, (), eq. (22).

    Mean, standard deviation and target torque are (..., n), z-scored, unitless.
    """
    # The mean instead of the sum of (21), so that the rate and the clip do not depend on the size of a batch.
    return terms(mean - target, std).mean()


def likelihood(mean: Tensor, std: Tensor, target: Tensor) -> tuple[Tensor, Tensor]:
    """Return what is minimised and (22), () each and here the same, of predictions and targets (..., n), z-scored."""
    loss = gaussian_loss(mean, std, target)
    return loss, loss


def beta_likelihood(mean: Tensor, std: Tensor, target: Tensor, beta: float) -> tuple[Tensor, Tensor]:
    """Return (22) with each sample multiplied with sigma^(2 beta), and (22) itself; else as `likelihood`."""
    # (N17): a weight that passed a gradient would be minimised itself, by a small sigma.
    each = terms(mean - target, std)
    return (std.detach().pow(2.0 * beta) * each).mean(), each.mean()


def squared(mean: Tensor, std: Tensor, target: Tensor) -> tuple[Tensor, Tensor]:
    """Return the mean square plus (22) on errors that pass no gradient, and (22) itself; else as `likelihood`.

    That sigma trains nothing but its own part of the linear layer is up to the network (`LimbNetwork.std_apart`).
    """
    # (N18): sigma learns from errors that it cannot make smaller.
    error = mean - target
    loss = terms(error.detach(), std).mean()
    return error.square().mean() + loss, loss


def objective_of(loss: str, beta: float) -> Objective:
    """Return the loss of a name of `CHOSEN_BY`, a function of mean, std and target as `likelihood`.

    Only `beta_likelihood` takes the power `beta` of sigma's square [-].
    """
    objectives: Mapping[str, Objective] = {
        "likelihood": likelihood,
        "beta_likelihood": partial(beta_likelihood, beta=beta),
        "squared": squared,
    }
    return objectives[loss]


def terms(error: Tensor, std: Tensor) -> Tensor:
    """Return the terms of (22) of errors and standard deviations (..., n), z-scored, unitless."""
    # (N16) of sigma itself, not of the variance, because sigma is what the network has and clips, (N10).
    return 2 * std.log() + (error / std).square()
