"""Networks and how they learn (Table 1, sections 4.2 to 4.4, 6.1)."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from mobnet.formats import base
from mobnet.formats.base import Section
from mobnet.formats.network import Limb, NetworkCell, Steps

Precision = Literal["auto", "float32", "bfloat16"]
Optimizer = Literal["adam", "soap"]
Loss = Literal["likelihood", "beta_likelihood", "squared"]
IN_A_STACK = (  # keys of `learning` that networks which learn side by side have in common
    "batch_size",
    "optimizer",
    "optimizer_betas",
    "basis_beta",
    "basis_every",
    "coarse",
    "gradient_norm",
    "std_min",
    "sequences",
    "labels",
)


class NetworkRow(NetworkCell):
    """A network of Table 1 as the configuration has it, on a training set of section 4.3."""

    data: base.TrainingSetName
    experiment: base.ExperimentName
    horizon_steps: Steps


class Network(NetworkRow, Limb):
    """A network of Table 1 on a robot, with a method's changes laid over it."""


class Coarse(Section):
    """A phase of a training in which a step is one of `stride` samples, for a `share` of the epochs."""

    stride: base.Whole = Field(ge=2, le=1000)
    share: base.InnerShare


class Learning(Section):
    """Optimisation and calibration of every network, section 4.4; `data_parts` is that of section 6.3.

    A recurrent network may learn with SOAP instead of Adam, which renews the bases of its gates' matrices at every
    `basis_every`-th update, and may begin at `coarse` time. A fine-tuning learns from the first `data_s` [s] of its
    training data, by their `labels` or, in `swing`, where the walking plan has the leg in the air and nothing else is
    told.
    """

    loss: Loss
    loss_beta: base.Share
    batch_size: base.Whole = Field(ge=1, le=4096)
    optimizer: Optimizer
    optimizer_betas: base.Range[Annotated[base.Share, Field(lt=1)]]
    basis_beta: base.Share = Field(lt=1)
    basis_every: base.Whole = Field(ge=1, le=10_000)
    coarse: tuple[Coarse, ...]
    rate_first: base.Positive = Field(le=1)
    rate_last_ratio: base.Share
    rate_decay_share: base.Share
    gradient_norm: base.Positive = Field(le=1e12)
    std_min: base.Real = Field(ge=1e-12, le=0.1)
    validation_share: base.Real = Field(ge=0.01, le=0.5)
    sequences: Literal["carried", "windows"]
    stream_s: base.Real = Field(ge=0.05, le=600)
    precision: Precision
    divergence_loss: base.Real = Field(ge=1, le=1e6)
    may_diverge: base.Flag
    calibrate: base.Flag
    calibration_share: base.InnerShare
    calibration_levels: base.Rising[base.InnerShare]
    data_parts: base.Whole = Field(default=1, ge=1, le=1000)
    data_s: Annotated[base.Positive, Field(le=1e6)] | None = None
    labels: Literal["all", "swing"] = "all"

    @model_validator(mode="after")
    def _ends_with_every_sample(self) -> Learning:
        """Check that strides fall and that the last epochs see every sample."""
        strides = [phase.stride for phase in self.coarse]
        if strides != sorted(set(strides), reverse=True):
            raise ValueError(f"coarse: strides {strides} are not accepted; accepted: each smaller than the one before")
        if (share := sum(phase.share for phase in self.coarse)) >= 1.0:
            raise ValueError(f"coarse: shares of {share:g} in sum are not accepted; accepted: less than 1")
        return self


class Training(Section):
    """Everything one training reads from the configuration: a method's network, with the method's overrides applied."""

    method: str
    limb: str
    target: Literal["uncertainty", "external"]
    network: Network
    learning: Learning
    epochs: base.Count
    epoch_samples: base.Count | None = None
    held_out: base.Index = 0  # number of the last recordings, which validate
