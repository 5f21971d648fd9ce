"""The training of many networks of one shape side by side: epochs, checkpoints, and networks that diverge."""

import hashlib
import logging
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import Tensor

from mobnet.core.code import SHORT
from mobnet.core.epochs import Epoch
from mobnet.core.errors import ConfigError, DataError, TrainingError, not_accepted
from mobnet.core.files import CHECKPOINT, METRICS
from mobnet.learning.checkpoint import Progress, below, read_checkpoint, write_checkpoint, write_metrics
from mobnet.learning.dataset import LimbData
from mobnet.learning.job import TrainingJob
from mobnet.learning.model import seeded
from mobnet.learning.numbers import optimiser_numbers
from mobnet.learning.schedule import Schedule
from mobnet.learning.stacked.network import StackedLosses, StackedNetwork
from mobnet.learning.stacked.optimiser import StackedOptimiser
from mobnet.learning.stacked.passes import Updates, Validation
from mobnet.learning.stacked.samples import StackedSamples, side_by_side
from mobnet.settings.networks import IN_A_STACK

log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Member:
    """One network of a stack.

    Attributes:
        name: its own among them.
        job: its training.
        load: reads its data, which are dropped when they have gone to the device.
        state: folder of its metrics.
        start: weights from which it is fine-tuned.
    """

    name: str
    job: TrainingJob
    load: Callable[[], LimbData]
    state: Path
    start: Path | None = None


@dataclass
class Taught:
    """How far the networks of a stack have come.

    Attributes:
        progress: that of each network; one that diverged has no more epochs.
        updates: number of updates of each network, (K,).
        epochs: number of epochs of the stack.
        told: why a network has diverged, by its name.
        seconds: time of all starts [s].
    """

    progress: list[Progress]
    updates: Tensor
    epochs: int = 0
    told: dict[str, str] = field(default_factory=dict)
    seconds: float = 0.0


class StackedTrainer:
    """Trains networks of one shape side by side on a device: each with its own data, z-scores, rates and seeds.

    A network that diverges stops; the others go on.
    """

    def __init__(self, members: Sequence[Member], device: torch.device) -> None:
        """Prepare the schedules of all networks, and move their data to the device.

        Raises:
            ConfigError: networks differ in what those of a stack have in common.
            DataError: as `Schedule`.
        """
        self._members = members
        self._device = device
        self._schedules: list[Schedule] = []
        arrays: dict[str, tuple[Tensor, Tensor]] = {}  # by the hash of the data, which several networks may share
        digests: list[str] = []
        for member in members:
            data = member.load()
            self._schedules.append(Schedule(member.job, data, device, member.start))
            if data.digest not in arrays:
                inputs, targets = (torch.from_numpy(array).to(device) for array in (data.inputs, data.targets))
                arrays[data.digest] = inputs, targets
            digests.append(data.digest)
        owned = [arrays[digest] for digest in digests]
        check_alike(members, [(inputs.shape[1], targets.shape[1]) for inputs, targets in owned])
        self._job = members[0].job
        learning = self._job.training.learning
        places = [list(arrays).index(digest) for digest in digests]
        self._samples = StackedSamples(list(arrays.values()), places, self._schedules)
        self._network = StackedNetwork([schedule.network() for schedule in self._schedules], device)
        self._optimiser = StackedOptimiser(self._network.weights, self._network.width, optimiser_numbers(learning))
        learnings = [member.job.training.learning for member in members]
        names = [section.loss for section in learnings]
        self._losses = StackedLosses(names, [section.loss_beta for section in learnings], device)
        horizon = self._job.horizon
        scored = self._schedules[0].scored
        self._epochs = Updates(
            self._network,
            self._samples,
            self._optimiser,
            self._losses,
            lanes=learning.batch_size,
            horizon=horizon,
            most_norm=learning.gradient_norm,
            scored=scored,
        )
        self._validations: dict[int, Validation] = {}  # by number of lanes
        self._frozen = torch.zeros(len(members), dtype=torch.bool, device=device)
        self._units = np.stack([schedule.scales[1].std for schedule in self._schedules])

    @property
    def fingerprint(self) -> str:
        """A hash of all that the weights depend on: each network's, and which others learn beside it."""
        return hashlib.sha256(repr(self.fingerprints).encode()).hexdigest()[:SHORT]

    @property
    def fingerprints(self) -> dict[str, str]:
        """The hash of what the weights of each network depend on, by its name."""
        pairs = zip(self._members, self._schedules, strict=True)
        return {member.name: schedule.fingerprint for member, schedule in pairs}

    def run(self, state: Path) -> Taught:
        """Run all epochs, or those that a killed run did not finish; the folder `state` has the checkpoint."""
        path = state / CHECKPOINT
        done = self._resumed(path)
        epochs = self._job.training.epochs
        while done.epochs < epochs and not self._frozen.all():
            started = time.monotonic()
            self._epoch(done)
            done.epochs += 1
            done.seconds += time.monotonic() - started
            self._save(path, done)
            for member, schedule, progress in zip(self._members, self._schedules, done.progress, strict=True):
                write_metrics(member.state / METRICS, progress, schedule.joints)
            left = done.seconds / done.epochs * (epochs - done.epochs)
            log.info("%d of %d epochs of %d networks, %.0f s left", done.epochs, epochs, len(self._members), left)
        return done

    def _epoch(self, done: Taught) -> None:
        """Let all networks learn from their data once, and validate them."""
        epoch = done.epochs
        stride = self._job.stride(epoch)
        if epoch and (before := self._job.stride(epoch - 1)) != stride:
            self._network.keep_longer(before / stride)
        rates = [member.job.rate(epoch) for member in self._members]
        plan = side_by_side([schedule.plan(epoch, stride) for schedule in self._schedules], self._device)
        moved = torch.tensor(rates, device=self._device)
        with seeded(self._schedules[0].seed("dropout", epoch)):
            totals = self._epochs.run(plan, moved, self._frozen, done.updates)
        losses, norms, notes = (total.cpu() for total in totals)
        validations, errors = self._validate(stride)
        weights = {name: weight.detach().cpu() for name, weight in self._network.weights.items()}
        for k, (member, schedule, progress) in enumerate(
            zip(self._members, self._schedules, done.progress, strict=True)
        ):
            if self._frozen[k]:
                continue
            counted = notes[:, k]
            if not counted.any():
                raise DataError(f"{member.name}: no target of the training data is known; accepted: a swing of the leg")
            validation = float(validations[k])
            try:
                schedule.check_losses(epoch, losses[counted, k].median().item(), rates[k])
                schedule.check_validation(epoch, validation, rates[k])
            except TrainingError as error:
                log.warning("%s; the others go on", error)
                self._frozen[k] = True
                progress.diverged = True
                done.told[member.name] = str(error)
                continue
            loss = losses[counted, k].mean().item()
            norm = norms[counted, k].mean().item()
            rmse = float(errors[k].mean())
            progress.epochs.append(Epoch(epoch + 1, loss, validation, rmse, rates[k], norm, stride))
            progress.errors.append(errors[k].tolist())
            if progress.best_epoch() is progress.epochs[-1]:
                progress.best = {name: weight[k].clone() for name, weight in weights.items()}

    def _validate(self, stride: int) -> tuple[Tensor, np.ndarray]:
        """Return mean losses (22), (K,), and RMSE of each joint (K, n) [N, N m], at a stride [samples]."""
        plan = side_by_side([schedule.validation_at(stride) for schedule in self._schedules], self._device)
        lanes = plan.rows.shape[2]
        if lanes not in self._validations:
            self._validations[lanes] = Validation(self._network, self._samples, self._losses, lanes, self._job.horizon)
        losses, errors = self._validations[lanes].run(plan)
        return losses.cpu(), errors.cpu().numpy() * self._units

    def _save(self, path: Path, done: Taught) -> None:
        """Write a checkpoint of all networks."""
        tensors = {f"last.{name}": weight.detach().cpu() for name, weight in self._network.weights.items()}
        for name, moments in self._optimiser.state.items():
            tensors |= {f"optimizer.{name}.{key}": tensor.cpu() for key, tensor in moments.items()}
        tensors["updates"] = done.updates
        best, rows = told_of(done)
        note = {"rows": rows, "epochs": done.epochs, "told": done.told, "seconds": done.seconds}
        write_checkpoint(path, self.fingerprint, {**tensors, **best}, note)

    def _resumed(self, path: Path) -> Taught:
        """Load a checkpoint of this stack; without one nothing is done yet."""
        checkpoint = read_checkpoint(path, self.fingerprint)
        fresh = [Progress(chosen_by=schedule.chosen_by) for schedule in self._schedules]
        if checkpoint is None:
            return Taught(fresh, torch.zeros(len(fresh), dtype=torch.int64))
        tensors, note = checkpoint
        with torch.no_grad():
            for name, weight in self._network.weights.items():
                weight.copy_(tensors[f"last.{name}"])
            for name, moments in self._optimiser.state.items():
                for key, tensor in moments.items():
                    tensor.copy_(tensors[f"optimizer.{name}.{key}"])
        progress = progress_of(tensors, note["rows"], [schedule.chosen_by for schedule in self._schedules])
        for k, row in enumerate(progress):
            self._frozen[k] = row.diverged
        log.info("%s: resuming after epoch %d", path, note["epochs"])
        return Taught(progress, tensors["updates"].clone(), note["epochs"], note["told"], note["seconds"])


def check_alike(members: Sequence[Member], sizes: Sequence[tuple[int, int]]) -> None:
    """Check that networks have in common what those of a stack do; `sizes` are numbers of inputs and of joints.

    Raises:
        ConfigError: one differs from the first.
    """
    first = {**common_of(members[0]), "inputs and joints": sizes[0]}
    for member, size in zip(members[1:], sizes[1:], strict=True):
        for name, value in {**common_of(member), "inputs and joints": size}.items():
            if value != first[name]:
                raise ConfigError(f"{member.name} beside {members[0].name}: {not_accepted(name, value, [first[name]])}")


def common_of(member: Member) -> dict[str, object]:
    """Return what networks of a stack have in common, by name."""
    training = member.job.training
    common: dict[str, object] = {f"learning.{name}": getattr(training.learning, name) for name in IN_A_STACK}
    cell = training.network
    sizes = {"cell": cell.cell, "hidden": cell.hidden, "horizon_steps": cell.horizon_steps, "spectral": cell.spectral}
    return {**common, **sizes, "epochs": training.epochs}


def told_of(done: Taught) -> tuple[dict[str, Tensor], list[dict[str, Any]]]:
    """Return the best weights, those of network k below `best.k.`, and a row of numbers for each network."""
    best: dict[str, Tensor] = {}
    rows: list[dict[str, Any]] = []
    for k, progress in enumerate(done.progress):
        best |= {f"best.{k}.{name}": weight for name, weight in progress.best.items()}
        epochs = [asdict(epoch) for epoch in progress.epochs]
        rows.append({"epochs": epochs, "errors": progress.errors, "diverged": progress.diverged})
    return best, rows


def progress_of(tensors: dict[str, Tensor], rows: Sequence[dict[str, Any]], chosen_by: Sequence[str]) -> list[Progress]:
    """Return the progress of each network from what `told_of` returned."""
    progress: list[Progress] = []
    for k, (row, column) in enumerate(zip(rows, chosen_by, strict=True)):
        epochs = [Epoch(**epoch) for epoch in row["epochs"]]
        progress.append(Progress(epochs, row["errors"], below(f"best.{k}.", tensors), 0.0, row["diverged"], column))
    return progress
