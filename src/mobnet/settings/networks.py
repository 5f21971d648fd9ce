"""Networks and how they learn (Table 1, sections 4.2 to 4.4, 6.1)."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from mobnet.settings.base import (
    Count,
    ExperimentName,
    Flag,
    InnerShare,
    InnerShares,
    LimbNames,
    Positive,
    Section,
    Share,
    TrainingSetName,
)  # fmt: skip

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

    Attributes:
        hidden: state size, channels of a TCN, or units of an MLP.
        window_steps: samples that a TCN or an MLP sees.
        head: units between a TCN's flattened window and its output.
        spectral: whether weights are divided by their spectral norm, as in the authors' code.
        input_gain: factor of the z-scored inputs.
    """

    cell: CellKind
    hidden: Count | None = None
    window_steps: Count | None = None
    kernel_steps: Count | None = None
    dilations: Annotated[tuple[Count, ...], Field(min_length=1)] | None = None
    dropout: Share | None = None
    head: Count | None = None
    spectral: Flag = False
    input_gain: Positive = 1.0

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
    """A network of Table 1 as the configuration has it.

    Attributes:
        data: training set, section 4.3.
        experiment: entry of a scale that says how long and how often it is trained.
        horizon_steps: samples of truncated back-propagation through time.
    """

    data: TrainingSetName
    experiment: ExperimentName
    horizon_steps: Count


class Limb(Section):
    """What a network predicts and sees of a robot; names are limbs, groups of joints.

    Attributes:
        joints: limbs whose torques it predicts.
        Q: limbs whose joint positions and velocities it sees.
        T: limbs whose desired torques it sees.
    """

    joints: Annotated[LimbNames, Field(min_length=1)]
    Q: LimbNames
    T: LimbNames


class Network(NetworkRow, Limb):
    """A network of Table 1 on a robot, with a method's changes laid over it."""


class Learning(Section):
    """Optimisation and calibration of every network, section 4.4.

    Attributes:
        data_parts: a network learns from one of so many parts of its training data, section 6.3.
        sequences: `carried`: the state is carried through streams; `windows`: windows from a zero state, loss on the
            last step.
    """

    batch_size: Count
    optimizer_betas: tuple[Share, Share]
    rate_first: Positive
    rate_last_ratio: Share
    rate_decay_share: Share
    gradient_norm: Positive
    std_min: Positive
    validation_share: Share
    sequences: Literal["carried", "windows"]
    stream_s: Positive
    precision: Precision
    divergence_loss: Positive
    may_diverge: Flag
    calibrate: Flag
    calibration_share: InnerShare
    calibration_levels: InnerShares
    data_parts: Count = 1


class Training(Section):
    """All that one training takes of the configuration: a network of a method, with that method's changes."""

    method: str
    limb: str
    target: Literal["uncertainty", "external"]
    network: Network
    learning: Learning
    epochs: Count
    epoch_samples: Count | None = None
