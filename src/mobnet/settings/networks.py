"""Networks and how they learn (Table 1, sections 4.2 to 4.4, 6.1)."""

from __future__ import annotations

from typing import Literal

from pydantic import model_validator

from mobnet.settings import base
from mobnet.settings.base import Section

CellKind = Literal["GRU", "LSTM", "RNN", "TCN", "MLP", "constant"]
Precision = Literal["auto", "float32", "bfloat16"]
SIZES: dict[CellKind, tuple[str, ...]] = {  # what a kind of cell needs to be told
    "GRU": ("hidden",),
    "LSTM": ("hidden",),
    "RNN": ("hidden",),
    "MLP": ("hidden", "window_steps"),
    "TCN": ("hidden", "window_steps", "kernel_steps", "dilations", "dropout", "head"),
    "constant": (),
}


class Cell(Section):
    """A network's cell and its sizes, Table 1 and section 6.1.

    `hidden` is the size of the state, the channels of a TCN, or the units of an MLP; a TCN and an MLP see
    `window_steps` samples; `head` units stand between a TCN's flattened window and its output. `spectral`, as in the
    authors' code, divides weights by their spectral norm, and `input_gain` multiplies the z-scored inputs.
    """

    cell: CellKind
    hidden: base.Count | None = None
    window_steps: base.Count | None = None
    kernel_steps: base.Count | None = None
    dilations: base.Some[base.Count] | None = None
    dropout: base.Share | None = None
    head: base.Count | None = None
    spectral: base.Flag = False
    input_gain: base.Positive = 1.0

    @model_validator(mode="after")
    def _has_its_sizes(self) -> Cell:
        """Check that the sizes are there which this kind of cell needs."""
        missing = [name for name in SIZES[self.cell] if getattr(self, name) is None]
        if missing:
            raise ValueError(f"{missing[0]} is missing; a cell {self.cell} needs {', '.join(SIZES[self.cell])}")
        if self.spectral and self.cell != "GRU":
            raise ValueError(f"a cell {self.cell} with `spectral` is not accepted; accepted: GRU")
        return self


class NetworkRow(Cell):
    """A network of Table 1 as the configuration has it, on a training set of section 4.3."""

    data: base.TrainingSetName
    experiment: base.ExperimentName
    horizon_steps: base.Count


class Limb(Section):
    """Limbs whose torques a network predicts, and whose motion (`Q`) and desired torques (`T`) it sees."""

    joints: base.Some[base.LimbName]
    Q: base.LimbNames
    T: base.LimbNames


class Network(NetworkRow, Limb):
    """A network of Table 1 on a robot, with a method's changes laid over it."""


class Learning(Section):
    """Optimisation and calibration of every network, section 4.4; `data_parts` is that of section 6.3."""

    batch_size: base.Count
    optimizer_betas: tuple[base.Share, base.Share]
    rate_first: base.Positive
    rate_last_ratio: base.Share
    rate_decay_share: base.Share
    gradient_norm: base.Positive
    std_min: base.Positive
    validation_share: base.Share
    sequences: Literal["carried", "windows"]
    stream_s: base.Positive
    precision: Precision
    divergence_loss: base.Positive
    may_diverge: base.Flag
    calibrate: base.Flag
    calibration_share: base.InnerShare
    calibration_levels: base.InnerShares
    data_parts: base.Count = 1


class Training(Section):
    """All that one training takes of the configuration: a network of a method, with that method's changes."""

    method: str
    limb: str
    target: Literal["uncertainty", "external"]
    network: Network
    learning: Learning
    epochs: base.Count
    epoch_samples: base.Count | None = None
