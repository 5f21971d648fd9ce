"""What a training draws and decides besides its updates: z-scores, first weights, the plan of each epoch, its end.

It is the same for a network that learns alone and for one of many that learn side by side (`stacked`).
"""

import hashlib
import logging
import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from mobnet.core.errors import DataError, TrainingError, not_accepted
from mobnet.learning.checkpoint import Progress
from mobnet.learning.dataset import LimbData, ZScore, scale_of
from mobnet.learning.deployed.tensors import GRU_TENSORS
from mobnet.learning.deployed.weights import read_weights
from mobnet.learning.job import TrainingJob
from mobnet.learning.losses import CHOSEN_BY
from mobnet.learning.model import LimbNetwork, build_network
from mobnet.learning.optimisation import SEQUENCES
from mobnet.learning.streams import EpochPlan, some_of, split, validation_plan, window_plan

log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Start:
    """Weights of a network, z-scores of its inputs (n_in,) and targets (n,), and a hash of the file."""

    weights: Mapping[str, Tensor]
    scales: tuple[ZScore, ZScore]
    digest: str


def read_start(path: Path, job: TrainingJob, data: LimbData) -> Start:
    """Read the network from which a training starts.

    Raises:
        DataError: the file is missing or damaged, or the network has other joints, inputs or sizes.
    """
    tensors, note = read_weights(path)
    network = job.training.network
    for name, saved, wanted in (
        ("joints", list(note.joints), list(data.joints)),
        ("inputs", list(note.inputs), list(data.input_names)),
        ("cell", (note.cell.cell, note.cell.hidden), (network.cell, network.hidden)),
    ):
        if saved != wanted:
            raise DataError(not_accepted(f"{path}: {name}", saved, [wanted]))
    inputs, targets = (ZScore(tensors[f"{name}.mean"], tensors[f"{name}.std"]) for name in ("input", "target"))
    weights = {name: torch.from_numpy(tensors[name].copy()) for name in GRU_TENSORS}
    return Start(weights, (inputs, targets), hashlib.sha256(path.read_bytes()).hexdigest())


class Schedule:
    """What one training on a device goes by.

    The z-scores `scales` of the inputs (n_in,) and targets (n,) come from the training blocks alone, or with the first
    weights from the network that it starts from; `fingerprint` is a hash of all that the weights depend on.
    """

    def __init__(self, job: TrainingJob, data: LimbData, device: torch.device, start: Path | None = None) -> None:
        """Split the data and draw what a training draws once.

        Raises:
            DataError: the network that it starts from is damaged, or another one; or the data are too short.
        """
        self.job = job
        self.joints = data.joints
        self.partial = job.training.learning.labels == "swing"
        self._first = read_start(start, job, data) if start else None
        self.fingerprint = job.fingerprint(data.digest + (self._first.digest if self._first else ""), device)
        learning = job.training.learning
        blocks, self._held_out = split(data.segments, learning.validation_share, data.held_out)
        self._stream = job.stream(data.rate_hz)
        self._blocks = some_of(blocks, self._stream, learning.data_parts, job.shared_generator("data"))
        # A network that goes on learning keeps its z-scores: with others its weights would mean something else.
        self.scales = (
            self._first.scales
            if self._first
            else (scale_of(data.inputs, self._blocks), scale_of(data.targets, self._blocks))
        )
        self._sizes = len(data.input_names), len(data.joints)
        self._lanes = learning.batch_size
        self.validation = self.validation_at(1)

    @property
    def samples(self) -> int:
        """Number of samples that the weights are learned from."""
        return sum(end - start for start, end in self._blocks)

    @property
    def chosen_by(self) -> str:
        """Column of `metrics.csv` that is smallest in the epoch kept."""
        return CHOSEN_BY[self.job.training.learning.loss]

    @property
    def scored(self) -> slice:
        """Steps of a horizon that are in the loss."""
        return SEQUENCES[self.job.training.learning.sequences][1]

    @cached_property
    def windows(self) -> EpochPlan:
        """The plan of a validation in which every sample re-runs its window from zero."""
        lanes = self.validation.rows.shape[1]
        return window_plan(self._held_out, self._stream, self.job.horizon, lanes, self.job.generator("windows"))

    def network(self) -> LimbNetwork:
        """Return the network with its first weights, on the CPU."""
        training = self.job.training
        network = build_network(training.network, *self._sizes, training.learning.std_min, self.seed("weights"))
        network.std_apart = training.learning.loss == "squared"
        if self._first:
            network.load_state_dict(self._first.weights)
        return network

    def seed(self, *purpose: int | str) -> int:
        """Return a seed for a purpose, such as an epoch's."""
        return int(self.job.generator(*purpose).integers(np.iinfo(np.int64).max))

    def plan(self, epoch: int, stride: int) -> EpochPlan:
        """Return the plan of an epoch.

        An epoch at coarse time goes through the data as many times more often as it has fewer of their samples, so that
        it has as many updates as the others.
        """
        job = self.job
        plan_of, _ = SEQUENCES[job.training.learning.sequences]
        samples = job.training.epoch_samples
        if stride > 1:
            samples = stride * (samples or self.samples)
        horizon = stride * job.horizon
        plan = plan_of(self._blocks, self._stream, horizon, self._lanes, job.generator("epoch", epoch), samples)
        return replace(plan, stride=stride)

    def validation_at(self, stride: int) -> EpochPlan:
        """Return the plan of a validation at a stride [samples]."""
        plan = validation_plan(self._held_out, self._stream, stride * self.job.horizon, self._lanes)
        return replace(plan, stride=stride)

    def check_losses(self, epoch: int, median: float, rate: float) -> None:
        """Raise if the median of the loss (22) over the updates of an epoch is not finite or too large.

        Raises:
            TrainingError: it is; the message says what to try.
        """
        # The median: a few updates of a training that goes well can have losses of thousands.
        self._check("median training", epoch, median, rate, self.job.training.learning.divergence_loss)

    def check_validation(self, epoch: int, loss: float, rate: float) -> None:
        """Raise if the validation's loss (22) after an epoch is not finite.

        Raises:
            TrainingError: it is not; the message says what to try.
        """
        self._check("validation", epoch, loss, rate, math.inf)

    def _check(self, kind: str, epoch: int, loss: float, rate: float, bound: float) -> None:
        """Raise if a loss (22) is not finite or above a bound."""
        if not math.isfinite(loss) or loss > bound:
            accepted = f"at most {bound:g}" if math.isfinite(bound) else "finite numbers"
            raise TrainingError(
                f"{self.job.name}: epoch {epoch + 1}: {kind} loss {loss:g} at rate {rate:g} (accepted: {accepted}); "
                "try a smaller learning.rate_first or learning.gradient_norm, and look for outliers"
            )

    def report(self, done: Progress) -> None:
        """Log the last epoch with its losses and rate, and the time left."""
        last = done.epochs[-1]
        epochs = self.job.training.epochs
        log.info(
            "%d of %d epochs, loss %.3f, validation %.3f (%.3g N m), rate %.2g, %.0f s left",
            last.epoch,
            epochs,
            last.train_loss,
            last.validation_loss,
            last.validation_rmse,
            last.rate,
            done.seconds / last.epoch * (epochs - last.epoch),
        )
