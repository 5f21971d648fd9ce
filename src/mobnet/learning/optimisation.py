"""One epoch of training and of validation, eqs. (19) to (22), section 4.4; `losses` has what is minimised.

The robot carries the state from sample to sample, and so does training by default. The authors' code trains on
independent windows instead, whose state starts from zero and whose last step alone is in the loss.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import torch
from torch import Tensor

from mobnet.core.errors import DataError
from mobnet.learning.losses import Objective, gaussian_loss, likelihood
from mobnet.learning.model import LimbNetwork
from mobnet.learning.soap import Optimizer
from mobnet.learning.streams import EpochPlan, epoch_plan, window_plan

EVERY_STEP, LAST_STEP = slice(None), slice(-1, None)  # of a horizon, in the loss
SEQUENCES = {"carried": (epoch_plan, EVERY_STEP), "windows": (window_plan, LAST_STEP)}


@dataclass(frozen=True)
class Samples:
    """Z-scored training samples on the device that trains: inputs (N, n_in) and targets (N, n), unitless.

    Where they are `partial`, rows of the targets are nan; the state runs through them, and nothing is learned there.
    """

    inputs: Tensor
    targets: Tensor
    partial: bool = False

    def told(self, *tensors: Tensor) -> tuple[Tensor, ...]:
        """Return mean, std and target (h, B, n) of a horizon, or their samples (m, n) whose target is known."""
        return tuple(tensor[~tensors[-1][..., 0].isnan()] for tensor in tensors) if self.partial else tensors

    def horizons(self, plan: EpochPlan, horizon: int) -> Iterator[tuple[Tensor, Tensor, Tensor]]:
        """Walk through a plan, `horizon` steps an update.

        Yields:
            Inputs (h, B, n_in), targets (h, B, n), and what the carried state is multiplied with (1, B, 1): 0 where a
                lane enters a stream.
        """
        device = self.inputs.device
        steps = plan.stride * torch.arange(horizon, device=device)[:, None]
        rows = torch.from_numpy(plan.rows).to(device)
        kept = torch.from_numpy(~plan.fresh).to(device, self.inputs.dtype)
        for first, keep in zip(rows, kept, strict=True):
            index = (first + steps).reshape(-1)
            shape = (horizon, len(first), -1)
            yield (
                self.inputs.index_select(0, index).view(shape),
                self.targets.index_select(0, index).view(shape),
                keep[None, :, None],
            )


def train_epoch(
    network: LimbNetwork,
    optimizer: Optimizer,
    samples: Samples,
    plan: EpochPlan,
    horizon: int,
    gradient_norm: float,
    scored: slice = EVERY_STEP,
    objective: Objective = likelihood,
) -> tuple[Tensor, Tensor]:
    """Run one epoch of truncated back-propagation through time: state detached every horizon, carried as planned.

    The network is trained in place on rows (updates, lanes) of the plan; the gradient is clipped to a norm, and
    `scored` are the steps of a horizon that are in the loss, which is an objective of `losses`. Return loss (22) and
    norm before the clip of each update, (updates,) unitless.
    """
    network.train()
    losses = []
    norms = []
    state = network.fresh_state(plan.rows.shape[1], samples.inputs.device)
    for x, target, keep in samples.horizons(plan, horizon):
        # (N20): the state goes on from horizon to horizon as on a robot, the gradient does not.
        mean, std, after = network(x, state * keep)
        state = after.detach()
        known = samples.told(mean[scored], std[scored], target[scored])
        if not known[0].numel():
            continue
        minimised, loss = objective(*known)
        optimizer.zero_grad()
        minimised.backward()
        norm, *_ = [clip(part, gradient_norm) for part in network.gradients()]
        norms.append(norm)
        optimizer.step()
        losses.append(loss.detach())
    if not losses:
        raise DataError("no target of the training data is known; accepted: recordings with a swing of the leg")
    return torch.stack(losses), torch.stack(norms)


@torch.no_grad()
def clip(gradients: Sequence[Tensor], most: float) -> Tensor:
    """Scale gradients in place to a norm of `most` where it is larger; return the norm before, ()."""
    # (N21), on the device: reading the norm to decide would make a GPU wait at each update.
    norm = torch.nn.utils.get_total_norm(gradients)
    torch._foreach_mul_(list(gradients), (most / (norm + 1e-6)).clamp(max=1.0))
    return norm


@torch.no_grad()
def predictions(
    network: LimbNetwork, samples: Samples, plan: EpochPlan, horizon: int
) -> Iterator[tuple[Tensor, Tensor, Tensor]]:
    """Run a network in evaluation mode over the rows of a plan (updates, lanes), its state carried as planned.

    Yields:
        Mean, standard deviation and target of each horizon: (steps, lanes, n) each, z-scored.
    """
    network.eval()
    state = network.fresh_state(plan.rows.shape[1], samples.inputs.device)
    for x, target, keep in samples.horizons(plan, horizon):
        mean, std, state = network(x, state * keep)
        yield mean, std, target


def validate(
    network: LimbNetwork, samples: Samples, plan: EpochPlan, horizon: int, scored: slice = EVERY_STEP
) -> tuple[float, Tensor]:
    """Run a validation, its state carried as planned; only the `scored` steps of a horizon count.

    Return mean loss (22), and the root mean square error of each joint (n,), z-scored.
    """
    losses = []
    squares = []
    for predicted in predictions(network, samples, plan, horizon):
        mean, std, target = samples.told(*(part[scored] for part in predicted))
        if target.numel():
            losses.append(gaussian_loss(mean, std, target))
            squares.append((mean - target).square().flatten(0, -2).mean(dim=0))
    if not losses:
        raise DataError("no target of the samples that validate is known; accepted: recordings with a swing of the leg")
    return torch.stack(losses).mean().item(), torch.stack(squares).mean(dim=0).sqrt().cpu()
