"""SOAP: Adam in the eigenbasis of a matrix's gradients, for the matrix of each gate by itself (docs/notes/training.md).

Vyas et al. (2024), arXiv:2409.11321, algorithm 3. G is the gradient of one gate's matrix, W_ir, W_iz, W_in, W_hr, W_hz
or W_hn of a GRU; L and R are averages of G G' and G' G. In the eigenvectors of L and R the moments of Adam belong to
directions that learn apart from each other, where Adam's belong to single weights.
"""

from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

import torch
from torch import Tensor, nn

from mobnet.learning.model import LimbNetwork

EPSILON = 1e-8  # of Adam, beside the root of the second moment


class OptimiserNumbers(NamedTuple):
    """What an optimiser is made with.

    Attributes:
        name: `adam` or `soap`.
        betas: forgetting factors of the first and the second moment [-].
        basis_beta: that of the averages whose eigenvectors are the bases of SOAP [-].
        basis_every: updates from one renewal of the bases to the next.
    """

    name: str
    betas: tuple[float, float]
    basis_beta: float
    basis_every: int


class Soap:
    """SOAP for matrices that gates share, Adam for all other weights.

    It is used as an optimiser of torch is, and is none: the first one of a process imports `torch._dynamo`, a second of
    each training. The state of a parameter is a flat table of tensors, so that a checkpoint holds it as it does Adam's.
    Moments are kept in the basis: `first` and `second`, (gates, rows, columns), as the gradient.
    """

    def __init__(
        self,
        gated: Iterable[nn.Parameter],
        others: Iterable[nn.Parameter],
        gates: int,
        betas: tuple[float, float],
        beta_basis: float,
        basis_every: int,
    ) -> None:
        """Take matrices (gates * rows, columns), one gate below the other as in torch's modules, and other weights.

        `betas` are the decay rates of Adam's moments and `beta_basis` that of L and R; their eigenvectors are renewed
        every so many updates. The learning rate is set before each update, in `param_groups`.
        """
        self._betas = betas
        self._beta_basis = beta_basis
        self._basis_every = basis_every
        groups = [{"params": list(gated), "gates": gates, "lr": 0.0}, {"params": list(others), "gates": 0, "lr": 0.0}]
        self.param_groups: list[dict[str, Any]] = [group for group in groups if group["params"]]
        self.state: dict[nn.Parameter, dict[str, Tensor]] = {weight: {} for weight in self._weights()}

    def zero_grad(self) -> None:
        """Drop the gradients of all parameters."""
        for weight in self._weights():
            weight.grad = None

    def state_dict(self) -> dict[str, Any]:
        """Return the state of each parameter that has been updated, by its number, as `state`."""
        return {
            "state": {
                number: parameter_state for number, parameter_state in enumerate(self.state.values()) if parameter_state
            }
        }

    def load_state_dict(self, saved: Mapping[str, Any]) -> None:
        """Take what `state_dict` returned."""
        for number, weight in enumerate(self._weights()):
            parameter_state = saved["state"].get(number, {})
            self.state[weight] = {name: tensor.to(weight.device) for name, tensor in parameter_state.items()}

    def _weights(self) -> list[nn.Parameter]:
        """Return all parameters, those of gates first."""
        weights: list[nn.Parameter] = []
        for group in self.param_groups:
            weights += group["params"]
        return weights

    @torch.no_grad()
    def step(self) -> None:
        """Make one update with the gradients of all parameters."""
        for group in self.param_groups:
            for weight in group["params"]:
                gates = group["gates"]
                rate = group["lr"]
                state = self.state[weight]
                shape = (gates, -1, weight.shape[-1]) if gates else weight.shape
                self._update(weight.view(shape), weight.grad.view(shape), state, rate, gated=gates > 0)

    def _update(self, weight: Tensor, gradient: Tensor, state: dict[str, Tensor], rate: float, *, gated: bool) -> None:
        """Move a weight in place, (gates, rows, columns) of a gated matrix, any shape of the others.

        The first gradient of a gated matrix only gives the basis: a gradient is nearly diagonal in a basis of its own,
        and what is left beside the diagonal would be divided by a second moment as small as itself.
        """
        if not state:
            state |= {"steps": torch.zeros(()), "first": torch.zeros_like(weight), "second": torch.zeros_like(weight)}
            if gated:
                self._gather(gradient, state)
                return
        state["steps"] += 1
        turned = state["left"].mT @ gradient @ state["right"] if gated else gradient
        slow, fast = self._betas
        first = state["first"].lerp_(turned, 1 - slow)
        second = state["second"]
        second.mul_(fast).addcmul_(turned, turned, value=1 - fast)
        count = int(state["steps"])
        root = (second / (1 - fast**count)).sqrt_().add_(EPSILON)
        step = first / root
        if gated:
            step = state["left"] @ step @ state["right"].mT
        weight.add_(step, alpha=-rate / (1 - slow**count))
        if gated:
            self._gather(gradient, state)
            if count % self._basis_every == 0:
                _renew(state)

    def _gather(self, gradient: Tensor, state: dict[str, Tensor]) -> None:
        """Take a gradient (gates, rows, columns) into L and R; the first one gives the first basis."""
        new = 1 - self._beta_basis
        squares = {"L": (gradient, gradient.mT), "R": (gradient.mT, gradient)}
        if "L" not in state:
            state |= {name: new * (a @ b) for name, (a, b) in squares.items()}
            state |= {side: _eigenvectors(state[name]) for side, name in SIDES.items()}
            return
        for name, (a, b) in squares.items():
            torch.baddbmm(state[name], a, b, beta=self._beta_basis, alpha=new, out=state[name])


SIDES = {"left": "L", "right": "R"}  # basis -> the average that it diagonalises


def _eigenvectors(average: Tensor) -> Tensor:
    """Return orthogonal eigenvectors (gates, n, n), columns, the largest eigenvalue first."""
    if not average.isfinite().all():  # the loss is not finite either, which ends the training
        return torch.eye(average.shape[-1]).to(average).expand_as(average).contiguous()
    return torch.linalg.eigh(average).eigenvectors.flip(-1).contiguous()


def _renew(state: dict[str, Tensor]) -> None:
    """Renew both bases with one power iteration and QR, and turn the moments along.

    The first moment is a vector and turns exactly. The second belongs to directions: it moves to where the direction
    that it belonged to stands after sorting by eigenvalue.
    """
    for side, name in SIDES.items():
        old = state[side]
        axis = -2 if side == "left" else -1
        powered = state[name] @ old
        order = (old * powered).sum(-2).argsort(dim=-1, descending=True, stable=True)
        columns = order[:, None, :].expand_as(old)
        new = torch.linalg.qr(powered.gather(-1, columns)).Q.contiguous()
        turn = new.mT @ old
        first = state["first"]
        state["first"] = turn @ first if side == "left" else first @ turn.mT
        index = (order[:, :, None] if side == "left" else order[:, None, :]).expand_as(state["second"])
        state["second"] = state["second"].gather(axis, index)
        state[side] = new


Optimizer = Soap | torch.optim.Adam


def optimizer_of(network: LimbNetwork, numbers: OptimiserNumbers) -> Optimizer:
    """Return the optimiser of a network; its rate is set before each epoch."""
    if numbers.name == "adam":
        return torch.optim.Adam(network.parameters(), lr=0.0, betas=numbers.betas, fused=True)
    # Matrices of a recurrent cell, one gate below the other; those of windows are convolutions.
    gated = [weight for weight in network.cell.parameters() if weight.dim() == 2]
    known = set(map(id, gated))  # tensors compare by element
    others = [weight for weight in network.parameters() if id(weight) not in known]
    gates = len(gated[0]) // network.cell.width if gated else 0
    return Soap(gated, others, gates, numbers.betas, numbers.basis_beta, numbers.basis_every)
