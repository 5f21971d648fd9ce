"""What a training minimises: the likelihood (22), or a loss that weighs its samples otherwise.

(22) weighs the square of an error with 1 / sigma^2, so that a network learns most where it is already right: a swing
leg, whose external torque is exactly zero, takes the gradient from a stance leg. Two losses change that:

* `beta_likelihood` multiplies each sample of (22) with sigma^(2 beta), through which no gradient passes (beta-NLL,
  Seitzer et al. 2022, arXiv:2203.09168): beta 0 is (22), beta 1 trains the mean as squared errors do;
* `squared` trains the mean by squared errors alone, and sigma by (22) on errors and a state through which no gradient
  passes (faithful heteroscedastic regression, Stirn et al. 2023, arXiv:2212.09184): the mean is what it would be
  without a sigma.

Which number chooses the epoch that is kept follows from the loss. What these two minimise rates no network: its weights
are sigma's own, so that a wider sigma changes the number at the same errors. (22) would choose again by the samples
that they are there to weigh less. They are therefore judged by the RMSE, which tables show; the scale of sigma is
fitted after the training in any case (`calibration`).
"""

from collections.abc import Callable, Mapping
from functools import partial

from torch import Tensor

from mobnet.settings.networks import Learning, Loss

Objective = Callable[[Tensor, Tensor, Tensor], tuple[Tensor, Tensor]]
CHOSEN_BY: Mapping[Loss, str] = {  # column of `Epoch` that is smallest in the epoch kept
    "likelihood": "validation_loss",
    "beta_likelihood": "validation_rmse",
    "squared": "validation_rmse",
}


def gaussian_loss(mean: Tensor, std: Tensor, target: Tensor) -> Tensor:
    """Return the mean of ln(sigma^2) + (mean - target)^2 / sigma^2 over samples and joints, (), eq. (22).

    Mean, standard deviation and target torque are (..., n), z-scored, unitless.
    """
    return _terms(mean - target, std).mean()


def likelihood(mean: Tensor, std: Tensor, target: Tensor) -> tuple[Tensor, Tensor]:
    """Return what is minimised and (22), () each and here the same, of predictions and targets (..., n), z-scored."""
    loss = gaussian_loss(mean, std, target)
    return loss, loss


def beta_likelihood(mean: Tensor, std: Tensor, target: Tensor, beta: float) -> tuple[Tensor, Tensor]:
    """Return (22) with each sample multiplied with sigma^(2 beta), and (22) itself; else as `likelihood`."""
    terms = _terms(mean - target, std)
    return (std.detach().pow(2.0 * beta) * terms).mean(), terms.mean()


def squared(mean: Tensor, std: Tensor, target: Tensor) -> tuple[Tensor, Tensor]:
    """Return the mean square plus (22) on errors that pass no gradient, and (22) itself; else as `likelihood`.

    That sigma trains nothing but its own part of the linear layer is up to the network (`LimbNetwork.std_apart`).
    """
    error = mean - target
    loss = _terms(error.detach(), std).mean()
    return error.square().mean() + loss, loss


def objective_of(learning: Learning) -> Objective:
    """Return the loss that section `learning` names, a function of mean, std and target as `likelihood`."""
    objectives: Mapping[Loss, Objective] = {
        "likelihood": likelihood,
        "beta_likelihood": partial(beta_likelihood, beta=learning.loss_beta),
        "squared": squared,
    }
    return objectives[learning.loss]


def _terms(error: Tensor, std: Tensor) -> Tensor:
    """Return ln(sigma^2) + error^2 / sigma^2 of each sample and joint, (..., n), unitless."""
    return 2 * std.log() + (error / std).square()
