"""Cells of section 6.1, the part of a network before its linear layer: the GRU of Table 1 and its alternatives.

Every cell runs over a stretch of time and carries a state: a recurrent one its hidden state, one that sees a window its
last inputs. So all kinds train on streams, run on a robot and start afresh in the same way.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Protocol

import torch
from torch import Tensor, nn

from mobnet.formats.network import SIZES, CellKind, NetworkCell


class CellModule(Protocol):
    """What a network needs of its cell; each one is an `nn.Module` too."""

    @property
    def width(self) -> int:
        """Number of features per sample."""
        ...

    @property
    def state_size(self) -> tuple[int, int]:
        """Rows and columns of a lane's state."""
        ...

    def run(self, x: Tensor, state: Tensor) -> tuple[Tensor, Tensor]:
        """Return features (h, B, width) of inputs (h, B, n_in), unitless, and the state (rows, B, columns) after."""
        ...


class Carried:
    """Shared by torch's recurrent modules: the hidden state is both the features and the state that is carried."""

    hidden_size: int
    rows = 1

    @property
    def width(self) -> int:
        """Number of features per sample."""
        return self.hidden_size

    @property
    def state_size(self) -> tuple[int, int]:
        """Rows and columns of a lane's state."""
        return self.rows, self.hidden_size


class Gru(Carried, nn.GRU):
    """GRU of Table 1; state (1, B, hidden)."""

    def run(self, x: Tensor, state: Tensor) -> tuple[Tensor, Tensor]:
        """Return hidden states (h, B, hidden) for inputs (h, B, n_in), unitless, and the last (1, B, hidden)."""
        if x.is_cuda:
            return self(x, state)
        from mobnet.learning.gru import run_gru  # here, as a GPU needs no loops, nor what compiles them

        return run_gru(self, x, state)


class Lstm(Carried, nn.LSTM):
    """LSTM, Hochreiter and Schmidhuber (1997); its state (2, B, hidden) is hidden and cell state, stacked."""

    rows = 2

    def run(self, x: Tensor, state: Tensor) -> tuple[Tensor, Tensor]:
        """Return hidden states (h, B, hidden) for inputs (h, B, n_in), unitless, and the state (2, B, hidden)."""
        states, after = self(x, tuple(state.chunk(2)))
        return states, torch.cat(after)


class Rnn(Carried, nn.RNN):
    """Vanilla recurrent network with tanh; state (1, B, hidden)."""

    def run(self, x: Tensor, state: Tensor) -> tuple[Tensor, Tensor]:
        """Return hidden states (h, B, hidden) for inputs (h, B, n_in), unitless, and the last (1, B, hidden)."""
        return self(x, state)


class Block(nn.Module):
    """Residual block of a TCN, Bai et al. (2018): two causal dilated convolutions, each with ReLU and dropout.

    Its output has `width` channels and, without padding, is shorter than its input by `past` samples.
    """

    def __init__(self, inputs: int, width: int, kernel: int, dilation: int, dropout: float) -> None:
        """Build the block: `kernel` taps at a distance of `dilation`, both in samples.

        Where `inputs` and `width` differ, the shortcut is a 1x1 convolution.
        """
        super().__init__()
        self.first = nn.Conv2d(inputs, width, (kernel, 1), dilation=(dilation, 1))
        self.second = nn.Conv2d(width, width, (kernel, 1), dilation=(dilation, 1))
        self.shortcut = nn.Identity() if inputs == width else nn.Conv2d(inputs, width, 1)
        self.dropout = nn.Dropout(dropout)
        self.width = width
        self.past = 2 * (kernel - 1) * dilation

    def forward(self, x: Tensor) -> Tensor:
        """Return (1, width, T - past, B) of (1, inputs, T, B), unitless."""
        # No padding: the carried state takes its place, and the shortcut must lose the same first samples.
        inner = self.dropout(self.first(x).relu())
        inner = self.dropout(self.second(inner).relu())
        return (inner + self.shortcut(x[:, :, self.past :])).relu()


class WindowCell(nn.Module):
    """One hidden tanh layer over the last samples: of the inputs (MLP), or of the output of blocks (TCN).

    The state is the last inputs (past, B, n_in), zeros at a fresh start.
    """

    def __init__(self, inputs: int, hidden: int, steps: int, blocks: Sequence[Block] = ()) -> None:
        """Build the layer: `hidden` units on windows of `steps` samples, behind the blocks."""
        super().__init__()
        self.blocks = nn.Sequential(*blocks)
        self.layer = nn.Conv2d(blocks[-1].width if blocks else inputs, hidden, (steps, 1))
        self.width = hidden
        self.state_size = steps - 1 + sum(block.past for block in blocks), inputs

    def run(self, x: Tensor, state: Tensor) -> tuple[Tensor, Tensor]:
        """Return features (h, B, width) for inputs (h, B, n_in), unitless, and the last inputs (past, B, n_in).

        To the convolution, time and lanes are the axes of an image and the inputs its channels: it reads the samples as
        they lie in memory, channels last, once for all windows that contain them.
        """
        # The state has the samples (N23) that the first of the windows needs, so no window is filled up with zeros.
        samples = torch.cat([state, x])
        with torch.autocast(x.device.type, enabled=False):  # in bfloat16 a block's gradient is NaN, torch 2.13
            features = self.layer(self.blocks(samples[None].permute(0, 3, 1, 2))).tanh()
        return features[0].permute(1, 2, 0), samples[len(x) :]


class Constant(nn.Module):
    """No features: the network consists of the bias of its linear layer, a learned mean and standard deviation."""

    width = 0
    state_size = (1, 0)

    def run(self, x: Tensor, state: Tensor) -> tuple[Tensor, Tensor]:
        """Return nothing (h, B, 0) for any inputs (h, B, n_in), and the state (1, B, 0)."""
        return x[..., :0], state


def _tcn(
    inputs: int, hidden: int, window_steps: int, kernel_steps: int, dilations: Sequence[int], dropout: float, head: int
) -> CellModule:
    """Return a TCN: blocks of `hidden` channels, one for each dilation, then a layer of `head` units."""
    blocks = [
        Block(inputs if i == 0 else hidden, hidden, kernel_steps, dilation, dropout)
        for i, dilation in enumerate(dilations)
    ]
    return WindowCell(inputs, head, window_steps, blocks)


CELLS: Mapping[CellKind, Callable[..., CellModule]] = {  # each takes the number of inputs and its `SIZES` by name
    "GRU": lambda inputs, hidden: Gru(inputs, hidden),
    "LSTM": lambda inputs, hidden: Lstm(inputs, hidden),
    "RNN": lambda inputs, hidden: Rnn(inputs, hidden),
    "MLP": lambda inputs, hidden, window_steps: WindowCell(inputs, hidden, window_steps),
    "TCN": _tcn,
    "constant": lambda inputs: Constant(),
}


def build_cell(cell: NetworkCell, inputs: int) -> CellModule:
    """Build a cell of Table 1 or section 6.1, n_in inputs wide, with torch's default initial weights."""
    return CELLS[cell.cell](inputs, **{name: getattr(cell, name) for name in SIZES[cell.cell]})
