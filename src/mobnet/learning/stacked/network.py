"""Stacked limb networks: cell, linear layer and softplus of `LimbNetwork`, and what a training minimises of each."""

import math
from collections.abc import Mapping, Sequence

import torch
from torch import Tensor
from torch.nn.functional import softplus

from mobnet.learning.losses import terms
from mobnet.learning.model import LimbNetwork
from mobnet.learning.stacked.cells import stacked_cell
from mobnet.settings.networks import Learning

HEAD = ("head.weight", "head.bias")


class StackedNetwork:
    """K networks of one shape; `weights` are those of `LimbNetwork`, one network behind the other, (K, ...)."""

    def __init__(self, networks: Sequence[LimbNetwork], device: torch.device) -> None:
        """Stack the weights of networks that have one shape, one least standard deviation and one way to learn it."""
        first = networks[0]
        self.weights: dict[str, Tensor] = {}
        for name, _ in first.named_parameters():
            stacked = torch.stack([network.get_parameter(name).detach() for network in networks])
            self.weights[name] = stacked.to(device).requires_grad_()
        self._module = first.to(device)
        self._cell = stacked_cell(first.cell)
        self.state_size = first.cell.state_size
        self.width = first.cell.width
        self._std_min = first.std_min
        self._std_apart = first.std_apart

    def run(self, x: Tensor, state: Tensor, *, learning: bool) -> tuple[Tensor, Tensor, Tensor]:
        """Run z-scored inputs (K, h, B, n_in) over a stretch of time from a state (K, rows, B, columns), eq. (18).

        Units drop out where networks are `learning`. Return mean and standard deviation (K, h, B, n), both z-scored,
        unitless, and the state after.
        """
        self._module.train(learning)
        features, after = self._cell.run(self.weights, x, state)
        weight, bias = (self.weights[name] for name in HEAD)
        shape = (*features.shape[:3], -1)
        features = features.flatten(1, 2)
        # (N18) trains the mean alone through the cell; sigma sees the features as they come.
        for_std = features.detach() if self._std_apart else features
        (mean_weight, std_weight) = weight.chunk(2, 1)
        (mean_bias, std_bias) = bias.chunk(2, 1)
        mean = torch.baddbmm(mean_bias[:, None], features, mean_weight.mT).view(shape)
        raw = torch.baddbmm(std_bias[:, None], for_std, std_weight.mT).view(shape)
        return mean, softplus(raw).clamp_min(self._std_min), after

    def clipped(self, gradients: Mapping[str, Tensor], most: float) -> tuple[dict[str, Tensor], Tensor]:
        """Return gradients whose norm in each network is at most so large, and that before (K,), of the mean's part.

        As in `LimbNetwork.gradients`, those of sigma's own rows are clipped apart from the others where they are apart.
        """
        parts: list[dict[str, Tensor]] = [dict(gradients)]
        if self._std_apart:
            rest = {name: gradient for name, gradient in gradients.items() if name not in HEAD}
            halves = {name: gradients[name].chunk(2, 1) for name in HEAD}
            means = {name: half[0] for name, half in halves.items()}
            parts = [{**rest, **means}, {name: half[1] for name, half in halves.items()}]
        scaled: list[dict[str, Tensor]] = []
        norms: list[Tensor] = []
        for part in parts:
            squares = [gradient.flatten(1).square().sum(1) for gradient in part.values()]
            norm = torch.stack(squares).sum(0).sqrt()
            factor = (most / (norm + 1e-6)).clamp(max=1.0)
            scaled.append({name: gradient * spread(factor, gradient) for name, gradient in part.items()})
            norms.append(norm)
        if len(scaled) == 1:
            return scaled[0], norms[0]
        of_mean, of_std = scaled
        return of_mean | {name: torch.cat([of_mean[name], of_std[name]], 1) for name in HEAD}, norms[0]

    @torch.no_grad()
    def keep_longer(self, factor: float) -> None:
        """Let the cells keep their states for so many times as many steps, as `LimbNetwork.keep_longer`."""
        self.weights["cell.bias_ih_l0"][:, self.width : 2 * self.width] += math.log(factor)


def spread(each: Tensor, like: Tensor) -> Tensor:
    """Return a number of each network (K,) in a shape that multiplies an array (K, ...)."""
    return each.view(-1, *[1] * (like.dim() - 1))


def averages(values: Tensor, known: Tensor | None) -> Tensor:
    """Return the mean of each network (K,) of values (K, h, B, n), where `known` (K, h, B, 1) says which count.

    It is zero of a network of which none counts.
    """
    if known is None:
        return values.flatten(1).mean(1)
    counted = known.flatten(1).sum(1).clamp(min=1) * values.shape[-1]
    return torch.where(known, values, 0.0).flatten(1).sum(1) / counted


def stacked_losses(
    learning: Learning, mean: Tensor, std: Tensor, target: Tensor, known: Tensor | None
) -> tuple[Tensor, Tensor]:
    """Return what is minimised and (22) of each network, (K,) each, as `losses` does of one.

    Mean, standard deviation and target torque are (K, h, B, n), z-scored, unitless; a target that is not known is nan.
    """
    if known is not None:
        target = torch.where(known, target, mean.detach())
    error = mean - target
    if learning.loss == "squared":
        loss = averages(terms(error.detach(), std), known)
        return averages(error.square(), known) + loss, loss
    each = terms(error, std)
    loss = averages(each, known)
    if learning.loss == "beta_likelihood":
        return averages(std.detach().pow(2.0 * learning.loss_beta) * each, known), loss
    return loss, loss
