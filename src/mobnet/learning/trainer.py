"""The course of a training: epochs, checkpoints, progress, and stopping when it diverges (section 4.4)."""

import functools
import hashlib
import logging
import math
import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from mobnet.core.columns import Epoch
from mobnet.core.errors import DataError, TrainingError, not_accepted
from mobnet.core.files import CHECKPOINT, METRICS
from mobnet.core.machine import claimed
from mobnet.core.place import caches
from mobnet.learning import checkpoint
from mobnet.learning.calibration import StdFactors, calibrate, predict
from mobnet.learning.checkpoint import Progress, write_metrics
from mobnet.learning.dataset import LimbData, ZScore, scale_of
from mobnet.learning.deployed.weights import GRU_TENSORS, read_weights
from mobnet.learning.job import TrainingJob
from mobnet.learning.losses import CHOSEN_BY, objective_of
from mobnet.learning.model import build_network, seeded
from mobnet.learning.optimisation import EVERY_STEP, LAST_STEP, SEQUENCES, Samples, train_epoch, validate
from mobnet.learning.soap import optimizer_of
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
    for name, own, wanted in (
        ("joints", list(note.joints), list(data.joints)),
        ("inputs", list(note.inputs), list(data.input_names)),
        ("cell", (note.cell.cell, note.cell.hidden), (network.cell, network.hidden)),
    ):
        if own != wanted:
            raise DataError(not_accepted(f"{path}: {name}", own, [wanted]))
    inputs, targets = (ZScore(tensors[f"{name}.mean"], tensors[f"{name}.std"]) for name in ("input", "target"))
    weights = {name: torch.from_numpy(tensors[name].copy()) for name in GRU_TENSORS}
    return Start(weights, (inputs, targets), hashlib.sha256(path.read_bytes()).hexdigest())


@functools.cache
def own_device() -> torch.device:
    """Return the device of all trainings of this process."""
    if not torch.cuda.is_available():
        return torch.device("cpu")
    names = [str(torch.cuda.get_device_properties(place).uuid) for place in range(torch.cuda.device_count())]
    return torch.device("cuda", claimed(names, caches()))


class Trainer:
    """Trains one network on z-scored samples, on a GPU if there is one.

    The z-scores `scales` of the inputs (n_in,) and targets (n,) come from the training blocks alone, or with the first
    weights from the network that it starts from; `fingerprint` is a hash of all that the weights depend on.
    """

    def __init__(self, job: TrainingJob, data: LimbData, start: Path | None = None, *, in_place: bool = False) -> None:
        """Split, scale and move inputs (N, n_in) and targets (N, n) [N, N m] to the device.

        `in_place` z-scores the data themselves, of which nobody needs the numbers any more: no second copy is made.

        Raises:
            DataError: the network that it starts from is damaged, or another one.
        """
        self.job = job
        self.joints = data.joints
        self.device = own_device()
        first = read_start(start, job, data) if start else None
        self.fingerprint = job.fingerprint(data.digest + (first.digest if first else ""), self.device)
        network = job.training.network
        learning = job.training.learning
        blocks, held_out = split(data.segments, learning.validation_share, data.held_out)
        self._held_out = held_out
        stream = job.stream(data.rate_hz)
        self._blocks = some_of(blocks, stream, learning.data_parts, job.shared_generator("data"))
        arrays = data.inputs, data.targets
        # A network that goes on learning keeps its z-scores: with others its weights would mean something else.
        self.scales = first.scales if first else (scale_of(arrays[0], self._blocks), scale_of(arrays[1], self._blocks))
        inputs, targets = (self._scaled(*pair, in_place) for pair in zip(arrays, self.scales, strict=True))
        self._samples = Samples(inputs, targets, partial=learning.labels == "swing")
        self._shape = (stream, job.horizon, learning.batch_size)
        self._validation = self._validation_at(1)
        lanes = self._validation.rows.shape[1]
        self._windows = window_plan(held_out, stream, job.horizon, lanes, job.generator("windows"))
        sizes = len(data.input_names), len(data.joints)
        self.network = build_network(network, *sizes, learning.std_min, self._seed("weights")).to(self.device)
        self.network.precision = job.precision(self.device)
        self.network.std_apart = learning.loss == "squared"
        if first:
            self.network.load_state_dict(first.weights)
        self._optimizer = optimizer_of(self.network, learning)

    @property
    def samples(self) -> int:
        """Number of samples that the weights are learned from."""
        return sum(end - start for start, end in self._blocks)

    @property
    def chosen_by(self) -> str:
        """Column of `metrics.csv` that is smallest in the epoch kept."""
        return CHOSEN_BY[self.job.training.learning.loss]

    def _seed(self, *purpose: int | str) -> int:
        return int(self.job.generator(*purpose).integers(np.iinfo(np.int64).max))

    def _scaled(self, array: NDArray[np.float32], scale: ZScore, in_place: bool) -> Tensor:
        scaled = np.subtract(array, scale.mean, out=array if in_place else None)
        scaled /= scale.std
        return torch.from_numpy(scaled).to(self.device)

    def run(self, state_dir: Path) -> Progress:
        """Run all epochs, or those that a killed run did not finish, and return metrics and best weights.

        Raises:
            TrainingError: the loss is not finite or above `divergence_loss`, and the training may not diverge.
        """
        path = state_dir / CHECKPOINT
        first = checkpoint.copy_weights(self.network)
        done = checkpoint.resume(path, self.fingerprint, self.network, self._optimizer)
        done.chosen_by = self.chosen_by
        while len(done.epochs) < self.job.training.epochs:
            started = time.process_time()
            try:
                epoch, errors = self._epoch(len(done.epochs))
            except TrainingError as error:
                if not self.job.training.learning.may_diverge:
                    raise
                log.warning("%s", error)
                done.diverged = True
                break
            done.epochs.append(epoch)
            done.errors.append(errors)
            if done.best_epoch() is epoch:
                done.best = checkpoint.copy_weights(self.network)
            done.seconds += time.process_time() - started
            checkpoint.save(path, self.fingerprint, self.network, self._optimizer, done)
            write_metrics(state_dir / METRICS, done, self.joints)
            self._report(done)
        # A training that diverges at once is a result too where it may; it has learned nothing then.
        done.best = done.best or first
        return done

    def calibrate(self, done: Progress) -> StdFactors:
        """Return how far off the best weights' standard deviations (n,) [N, N m] are on the validation blocks."""
        self.network.load_state_dict(done.best)
        error, std = predict(self.network, self._samples, self._validation, self.job.horizon)
        if self._samples.partial:
            known = ~np.isnan(error[:, 0])
            error = error[known]
            std = std[known]
        # In N m, as coverage does not depend on the unit but likelihood and CRPS do.
        unit = self.scales[1].std.astype(np.float64)
        learning = self.job.training.learning
        return calibrate(error * unit, std * unit, learning.calibration_share, learning.calibration_levels)

    def on_windows(self, done: Progress) -> dict[str, float]:
        """Return the best weights' loss (22) and RMSE [N, N m] where every sample re-runs its window from zero."""
        self.network.load_state_dict(done.best)
        loss, errors = self._validate(self._windows, LAST_STEP)
        return {"loss": loss, "rmse": float(errors.mean())}

    def _validate(self, plan: EpochPlan, scored: slice = EVERY_STEP) -> tuple[float, NDArray[np.floating]]:
        """Return mean loss (22), and RMSE of each joint (n,) [N, N m], of a validation."""
        loss, rmse = validate(self.network, self._samples, plan, self.job.horizon, scored)
        return loss, rmse.numpy() * self.scales[1].std

    def _epoch(self, epoch: int) -> tuple[Epoch, list[float]]:
        """Learn from the data once, and return what the epoch shows and the RMSE of each joint (n,) [N, N m]."""
        job = self.job
        rate = self.job.rate(epoch)
        learning = self.job.training.learning
        for group in self._optimizer.param_groups:
            group["lr"] = rate
        stride = job.stride(epoch)
        if epoch and (before := job.stride(epoch - 1)) != stride:
            self.network.keep_longer(before / stride)
        plan, scored = self._plan(epoch, stride)
        with seeded(self._seed("dropout", epoch)):
            losses, norms = train_epoch(
                self.network,
                self._optimizer,
                self._samples,
                plan,
                job.horizon,
                learning.gradient_norm,
                scored,
                objective_of(learning),
            )
        # The median: a few updates of a training that goes well can have losses of thousands.
        self._check("median training", epoch, losses.median().item(), rate, learning.divergence_loss)
        validation, errors = self._validate(self._validation_at(stride))
        self._check("validation", epoch, validation, rate)
        loss = losses.mean().item()
        rmse = float(errors.mean())
        return Epoch(epoch + 1, loss, validation, rmse, rate, norms.mean().item(), stride), errors.tolist()

    def _plan(self, epoch: int, stride: int) -> tuple[EpochPlan, slice]:
        """Return the course of an epoch, and which steps of a horizon are in the loss.

        An epoch at coarse time goes through the data as many times more often as it has fewer of their samples, so that
        it has as many updates as the others.
        """
        job = self.job
        (stream, horizon, lanes) = self._shape
        plan_of, scored = SEQUENCES[job.training.learning.sequences]
        samples = job.training.epoch_samples
        if stride > 1:
            samples = stride * (samples or self.samples)
        plan = plan_of(self._blocks, stream, stride * horizon, lanes, job.generator("epoch", epoch), samples)
        return replace(plan, stride=stride), scored

    def _validation_at(self, stride: int) -> EpochPlan:
        """Return the course of a validation at a stride [samples]."""
        stream, horizon, lanes = self._shape
        return replace(validation_plan(self._held_out, stream, stride * horizon, lanes), stride=stride)

    def _check(self, kind: str, epoch: int, loss: float, rate: float, bound: float = math.inf) -> None:
        """Raise if a loss (22) is not finite or above a bound."""
        if not math.isfinite(loss) or loss > bound:
            accepted = f"at most {bound:g}" if math.isfinite(bound) else "finite numbers"
            raise TrainingError(
                f"{self.job.name}: epoch {epoch + 1}: {kind} loss {loss:g} at rate {rate:g} (accepted: {accepted}); "
                "try a smaller learning.rate_first or learning.gradient_norm, and look for outliers"
            )

    def _report(self, done: Progress) -> None:
        """Log the last epoch with its losses and rate, and the time left."""
        last = done.epochs[-1]
        epochs = self.job.training.epochs
        log.info(
            "%s: epoch %d/%d, loss %.3f, validation %.3f (%.3g N m), rate %.2g, %.0f s left",
            self.job.name,
            last.epoch,
            epochs,
            last.train_loss,
            last.validation_loss,
            last.validation_rmse,
            last.rate,
            done.seconds / last.epoch * (epochs - last.epoch),
        )
