"""The limb network as it is trained: cell, linear layer, softplus (section 4.1, Table 1)."""

import math
import warnings
from collections.abc import Iterator
from contextlib import contextmanager

import torch
from torch import Tensor, nn
from torch.nn.utils import parametrize
from torch.nn.utils.parametrizations import spectral_norm

from mobnet.core.machine import one_thread
from mobnet.formats.network import NetworkCell
from mobnet.learning.cells import CellModule, build_cell


class LimbNetwork(nn.Module):
    """A cell and a linear layer, GRU[n_in, hidden]-Linear[hidden, 2 n] in Table 1; all numbers z-scored, unitless.

    The paper gives the variance outputs a softplus and clips the standard deviation (section 4.4); here the softplus is
    the standard deviation itself, so that one clip serves both. `precision` is the number format of the cell's products
    in training; otherwise, as on the robot, it is float32. With `std_apart`, training passes no gradient from the
    standard deviation to anything but its own rows of the linear layer.
    """

    def __init__(self, cell: CellModule, joints: int, std_min: float) -> None:
        """Put a linear layer with torch's default initial weights on a cell; `std_min` is z-scored."""
        super().__init__()
        one_thread()
        self.cell: CellModule = cell
        with warnings.catch_warnings():  # torch warns that a layer without inputs has no weights to start from
            warnings.filterwarnings("ignore", "Initializing zero-element tensors")
            self.head = nn.Linear(cell.width, 2 * joints)
        self.std_min = std_min
        self.input_gain = 1.0
        self.precision = torch.float32
        self.std_apart = False

    def forward(self, x: Tensor, state: Tensor) -> tuple[Tensor, Tensor, Tensor]:
        """Run z-scored inputs (h, B, n_in) over a stretch of time from a state (rows, B, columns), eq. (18).

        Return mean and standard deviation (h, B, n), both z-scored, unitless, and the state after the stretch.
        """
        rounded = self.training and self.precision != torch.float32
        with torch.autocast(x.device.type, self.precision, enabled=rounded):
            features, state = self.cell.run(x if self.input_gain == 1.0 else self.input_gain * x, state)
        # The linear layer is not rounded: it is a fourteenth of the time, and its errors would go straight to the mean.
        mean, raw = self._output(features.float())
        # (N10). A softplus on a part of each row would take ten times as long.
        std = nn.functional.softplus(raw.contiguous())
        return mean, std.clamp_min(self.std_min), state.float()

    def _output(self, features: Tensor) -> tuple[Tensor, Tensor]:
        """Return the linear layer's outputs for mean and std, (h, B, n) each, of features (h, B, width)."""
        if not (self.training and self.std_apart):
            mean, raw = self.head(features).chunk(2, dim=-1)
            return mean, raw
        # (N18) trains the mean alone through the cell; sigma sees the features as they come.
        (mean_weight, std_weight) = self.head.weight.chunk(2)
        (mean_bias, std_bias) = self.head.bias.chunk(2)
        linear = nn.functional.linear
        return linear(features, mean_weight, mean_bias), linear(features.detach(), std_weight, std_bias)

    def gradients(self) -> list[list[Tensor]]:
        """Return the gradients that are clipped together: those of all weights, or first of all but those of std."""
        gradients = {name: p.grad for name, p in self.named_parameters() if p.grad is not None}
        if not self.std_apart:
            return [list(gradients.values())]
        # Clipped together, a large gradient of sigma would shrink that of the mean, which (N18) keeps apart from it.
        halves = [grad.chunk(2) for name, grad in gradients.items() if name.startswith("head.")]
        rest = [grad for name, grad in gradients.items() if not name.startswith("head.")]
        return [rest + [mean for mean, _ in halves], [std for _, std in halves]]

    def fresh_state(self, lanes: int, device: torch.device | None = None) -> Tensor:
        """Return the zero state (rows, B, columns) of some lanes, such as (1, B, hidden) of a GRU."""
        rows, columns = self.cell.state_size
        return torch.zeros(rows, lanes, columns, device=device)

    def keep_longer(self, factor: float) -> None:
        """Let the cell keep its state for so many times as many steps, where a gate says how long: GRU and LSTM.

        Of the torque that the state stands for, as much is left then after the same time at a stride that is smaller by
        the same factor (docs/notes/training.md).
        """
        # The second gate of both keeps the state, and g / (1 - g) is the time that it is kept for, in steps.
        bias = self.get_parameter("cell.bias_ih_l0")
        with torch.no_grad():
            bias[self.cell.width : 2 * self.cell.width] += math.log(factor)

    def normalise(self, input_gain: float) -> None:
        """Multiply inputs with a gain, and keep the largest singular values of all matrices at 1 (authors' code)."""
        for name in ("weight_ih_l0", "weight_hh_l0"):
            spectral_norm(self.get_submodule("cell"), name)
        spectral_norm(self.head)
        self.input_gain = input_gain

    def deployable(self) -> dict[str, Tensor]:
        """Return copies of the plain weights on the CPU, any norm and gain of `normalise` multiplied in."""
        self.eval()  # a norm moves in training
        tensors = {name: tensor for name, tensor in self.state_dict().items() if ".parametrizations." not in name}
        for path, module in self.named_modules():
            if parametrize.is_parametrized(module):
                names = [name for name, _ in module.get_submodule("parametrizations").named_children()]
                tensors |= {f"{path}.{name}": getattr(module, name) for name in names}
        # (N24): a robot multiplies with one matrix, without norm and gain.
        if self.input_gain != 1.0:
            tensors["cell.weight_ih_l0"] = self.input_gain * tensors["cell.weight_ih_l0"]
        return {name: tensor.detach().cpu().clone() for name, tensor in tensors.items()}


@contextmanager
def seeded(seed: int) -> Iterator[None]:
    """Let torch draw from a seed inside, initial weights or dropout; its own stream goes on untouched after."""
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(seed)
        yield


def build_network(cell: NetworkCell, inputs: int, joints: int, std_min: float, seed: int) -> LimbNetwork:
    """Build a network of Table 1 or section 6.1, its initial weights drawn from a seed; `std_min` is z-scored.

    Torch's own stream of random numbers is untouched.
    """
    with seeded(seed):
        network = LimbNetwork(build_cell(cell, inputs), joints, std_min)
        if cell.spectral:
            network.normalise(cell.input_gain)
    return network


def parameter_count(network: nn.Module) -> int:
    """Return the number of trained parameters, column `Network Size` of Table 1."""
    return sum(p.numel() for p in network.parameters())
