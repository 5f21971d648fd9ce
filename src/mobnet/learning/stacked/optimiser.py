"""SOAP and Adam for stacked networks: what `learning.soap` does of one, each network at its own rate.

Every operation of an update keeps its tensors in place and asks the host nothing, so that a GPU can replay it as a
graph; the bases alone are renewed apart from it.
"""

from collections.abc import Mapping, Sequence

import torch
from torch import Tensor

from mobnet.learning.soap import EPSILON, SIDES, OptimiserNumbers
from mobnet.learning.stacked.network import spread

GATED = ("cell.weight_ih_l0", "cell.weight_hh_l0")  # matrices whose gates learn in bases of their own
PASSES = 2  # of Cholesky-QR: after the second one, bases are orthogonal to a rounding
ORTHOGONAL = 1e-4  # largest entry of Q' Q - I that counts as orthogonal


class StackedOptimiser:
    """The optimiser of stacked weights (K, ...); its state is a flat table of tensors for each of them.

    A network moves where it is `active`; where it is not, its weights and moments stay as they are.
    """

    def __init__(self, weights: Mapping[str, Tensor], width: int, numbers: OptimiserNumbers) -> None:
        """Take weights by name, as `StackedNetwork` has them, how wide its cells are, and the numbers of the laws."""
        self._weights = dict(weights)
        soap = numbers.name == "soap"
        self._gated = tuple(name for name in GATED if soap and name in weights)
        self._gates = weights[self._gated[0]].shape[1] // width if self._gated else 0
        self._betas = numbers.betas
        self._beta_basis = numbers.basis_beta
        self.basis_every = numbers.basis_every
        self.state: dict[str, dict[str, Tensor]] = {}
        for name, weight in self._weights.items():
            shaped = self._shaped(name, weight.detach())
            moments = {"first": torch.zeros_like(shaped), "second": torch.zeros_like(shaped)}
            moments["steps"] = torch.zeros(len(weight), device=weight.device)
            if name in self._gated:
                for side, average in SIDES.items():
                    size = shaped.shape[2 if side == "left" else 3]
                    moments[average] = shaped.new_zeros(*shaped.shape[:2], size, size)
                    moments[side] = torch.zeros_like(moments[average])
            self.state[name] = moments

    def _shaped(self, name: str, array: Tensor) -> Tensor:
        """Return a weight or its gradient; of gates (K, gates, rows, columns)."""
        return array.view(len(array), self._gates, -1, array.shape[-1]) if name in self._gated else array

    @torch.no_grad()
    def begin(self, gradients: Mapping[str, Tensor]) -> None:
        """Give gated matrices their first bases, those of their first gradients, which move nothing else of them."""
        for name in self._gated:
            moments = self.state[name]
            gradient = self._shaped(name, gradients[name])
            for side, square in _squares(gradient).items():
                average = moments[SIDES[side]]
                average.copy_((1 - self._beta_basis) * square)
                finite = average.isfinite().all(-1).all(-1)[..., None, None]
                safe = torch.where(finite, average, torch.eye(average.shape[-1], device=average.device))
                moments[side].copy_(torch.linalg.eigh(safe).eigenvectors.flip(-1))

    @torch.no_grad()
    def step(self, gradients: Mapping[str, Tensor], rates: Tensor, active: Tensor, *, first: bool = False) -> None:
        """Make one update at rates (K,), of the networks that are active (K,), 1 or 0; the `first` only of others."""
        slow, fast = self._betas
        for name, weight in self._weights.items():
            gated = name in self._gated
            if gated and first:
                continue
            moments = self.state[name]
            gradient = self._shaped(name, gradients[name])
            moving = spread(active, gradient)
            turned = moments["left"].mT @ gradient @ moments["right"] if gated else gradient
            moments["steps"] += active
            moment = moments["first"].lerp_(turned, (1 - slow) * moving)
            square = moments["second"].lerp_(turned.square(), (1 - fast) * moving)
            count = moments["steps"].clamp(min=1.0)
            root = (square / spread(1 - fast**count, square)).sqrt_().add_(EPSILON)
            step = moment / root
            if gated:
                step = moments["left"] @ step @ moments["right"].mT
            size = rates * active / (1 - slow**count)
            self._shaped(name, weight).sub_(spread(size, step) * step)
            if gated:
                for side, product in _squares(gradient).items():
                    moments[SIDES[side]].lerp_(product, (1 - self._beta_basis) * moving)

    @torch.no_grad()
    def renew(self, networks: Sequence[int]) -> None:
        """Renew the bases of some networks with one power iteration, and turn the moments along (`soap`)."""
        for name in self._gated:
            moments = self.state[name]
            for side, average in SIDES.items():
                chosen = torch.tensor(networks, device=moments[side].device)
                old, first, second = (moments[key][chosen] for key in (side, "first", "second"))
                powered = moments[average][chosen] @ old
                order = (old * powered).sum(-2).argsort(dim=-1, descending=True, stable=True)
                new = orthogonal(powered.gather(-1, order[..., None, :].expand_as(old)), old)
                turn = new.mT @ old
                left = side == "left"
                index = (order[..., :, None] if left else order[..., None, :]).expand_as(second)
                moments["first"][chosen] = turn @ first if left else first @ turn.mT
                moments["second"][chosen] = second.gather(-2 if left else -1, index)
                moments[side][chosen] = new


def _squares(gradient: Tensor) -> dict[str, Tensor]:
    """Return G G' and G' G of gradients (K, gates, rows, columns), for the bases of either side."""
    return {"left": gradient @ gradient.mT, "right": gradient.mT @ gradient}


def orthogonal(columns: Tensor, otherwise: Tensor) -> Tensor:
    """Return orthogonal bases of matrices (..., n, n) by Cholesky-QR, by QR where that fails.

    A matrix that is not finite gets the basis that stands for it in `otherwise`.
    """
    # Their lengths differ by many orders of magnitude and have no part in the basis.
    q = columns / columns.norm(dim=-2, keepdim=True)
    for _ in range(PASSES):
        factor, _ = torch.linalg.cholesky_ex(q.mT @ q)
        q = torch.linalg.solve_triangular(factor.mT, q, upper=True, left=False)
    identity = torch.eye(q.shape[-1], device=q.device)
    error = (q.mT @ q - identity).abs().amax((-2, -1))
    failed = ~(error < ORTHOGONAL)  # nan is a failure too
    if failed.any():
        finite = columns.isfinite().all(-1).all(-1)
        again = failed & finite
        q[again] = torch.linalg.qr(columns[again]).Q
        q[~finite] = otherwise[~finite]
    return q
