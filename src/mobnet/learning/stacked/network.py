"""Stacked limb networks: cell, linear layer and softplus of `LimbNetwork`, and what a training minimises of each."""

import math
from collections.abc import Mapping, Sequence

import torch
from torch import Tensor
from torch.nn.functional import softplus

from mobnet.learning.losses import terms
from mobnet.learning.model import LimbNetwork
from mobnet.learning.stacked.cells import stacked_cell

HEAD = ("head.weight", "head.bias")


class StackedNetwork:
    """K networks of one shape; `weights` are those of `LimbNetwork`, one network behind the other, (K, ...)."""

    def __init__(self, networks: Sequence[LimbNetwork], device: torch.device) -> None:
        """Stack the weights of networks that have one shape and one least standard deviation."""
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
        self._apart = torch.tensor([network.std_apart for network in networks], device=device)[:, None, None]

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
        for_std = torch.where(self._apart, features.detach(), features)
        (mean_weight, std_weight) = weight.chunk(2, 1)
        (mean_bias, std_bias) = bias.chunk(2, 1)
        mean = torch.baddbmm(mean_bias[:, None], features, mean_weight.mT).view(shape)
        raw = torch.baddbmm(std_bias[:, None], for_std, std_weight.mT).view(shape)
        return mean, softplus(raw).clamp_min(self._std_min), after

    def clipped(self, gradients: Mapping[str, Tensor], most: float) -> tuple[dict[str, Tensor], Tensor]:
        """Return gradients whose norm in each network is at most so large, and that before (K,), of the mean's part.

        As in `LimbNetwork.gradients`, those of sigma's own rows are clipped apart from the others where they are apart.
        """
        halves = {name: gradients[name].chunk(2, 1) for name in HEAD}
        of_std = sum(_squares(half[1]) for half in halves.values())
        others = [gradient for name, gradient in gradients.items() if name not in HEAD]
        of_mean = sum(_squares(part) for part in (*others, *(half[0] for half in halves.values())))
        both = of_mean + of_std
        apart = self._apart.flatten()
        norm = torch.where(apart, of_mean, both).sqrt()
        factor = _factor(norm, most)
        std_factor = _factor(torch.where(apart, of_std, both).sqrt(), most)
        scaled = {name: gradient * spread(factor, gradient) for name, gradient in gradients.items()}
        for name, (mean, std) in halves.items():
            scaled[name] = torch.cat([mean * spread(factor, mean), std * spread(std_factor, std)], 1)
        return scaled, norm

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


class StackedLosses:
    """What a training minimises of each network, and (22)."""

    def __init__(self, losses: Sequence[str], betas: Sequence[float], device: torch.device) -> None:
        """Take the name of each network's loss and the beta of `beta_likelihood`, as `losses.objective_of` does."""
        squared = [loss == "squared" for loss in losses]
        powers = [2.0 * beta if loss == "beta_likelihood" else 0.0 for loss, beta in zip(losses, betas, strict=True)]
        self._squared = torch.tensor(squared, device=device)[:, None, None, None]
        self._powers = torch.tensor(powers, device=device)[:, None, None, None]

    def of(self, mean: Tensor, std: Tensor, target: Tensor, known: Tensor | None) -> tuple[Tensor, Tensor]:
        """Return what is minimised and (22) of each network, (K,) each, as `losses` does of one.

        Mean, standard deviation and target torque are (K, h, B, n), z-scored, unitless. Only what is `known`
        (K, h, B, 1) counts; elsewhere a target may be nan.
        """
        if known is not None:
            target = torch.where(known, target, mean.detach())
        error = mean - target
        each = terms(torch.where(self._squared, error.detach(), error), std)
        # To the power of zero, where (22) itself is minimised, a sigma is one.
        minimised = std.detach().pow(self._powers) * each + torch.where(self._squared, error.square(), 0.0)
        return averages(minimised, known), averages(each, known)


def _squares(gradient: Tensor) -> Tensor:
    """Return the sum of squares of each network (K,)."""
    return gradient.flatten(1).square().sum(1)


def _factor(norm: Tensor, most: float) -> Tensor:
    """Return what a gradient of such a norm (K,) is multiplied with."""
    return (most / (norm + 1e-6)).clamp(max=1.0)
