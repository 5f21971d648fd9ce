"""The training of one network: epochs, checkpoints, and stopping when it diverges (section 4.4)."""

import functools
import logging
import time
from pathlib import Path

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from mobnet.core.epochs import Epoch
from mobnet.core.errors import TrainingError
from mobnet.core.files import CHECKPOINT, METRICS
from mobnet.core.machine import claimed
from mobnet.core.root import caches
from mobnet.learning import checkpoint
from mobnet.learning.calibration import StdFactors, calibrate, predict
from mobnet.learning.checkpoint import Progress, write_metrics
from mobnet.learning.dataset import LimbData, ZScore
from mobnet.learning.job import TrainingJob
from mobnet.learning.losses import objective_of
from mobnet.learning.model import seeded
from mobnet.learning.numbers import optimiser_numbers
from mobnet.learning.optimisation import EVERY_STEP, LAST_STEP, Samples, train_epoch, validate
from mobnet.learning.schedule import Schedule
from mobnet.learning.soap import optimizer_of
from mobnet.learning.streams import EpochPlan

log = logging.getLogger(__name__)


@functools.cache
def own_device() -> torch.device:
    """Return the device of all trainings of this process."""
    if not torch.cuda.is_available():
        return torch.device("cpu")
    names = [str(torch.cuda.get_device_properties(place).uuid) for place in range(torch.cuda.device_count())]
    return torch.device("cuda", claimed(names, caches()))


class Trainer:
    """Trains one network on z-scored samples, on a GPU if there is one."""

    def __init__(
        self,
        job: TrainingJob,
        data: LimbData,
        start: Path | None = None,
        learned_on: torch.device | None = None,
        *,
        in_place: bool = False,
    ) -> None:
        """Split, scale and move inputs (N, n_in) and targets (N, n) [N, N m] to the device.

        A network that has already learned, in a stack on a device, is only looked at, on the CPU. `in_place` z-scores
        the data themselves, of which nobody needs the numbers any more: no second copy is made.

        Raises:
            DataError: the network that it starts from is damaged, or another one.
        """
        self.job = job
        self.device = torch.device("cpu") if learned_on else own_device()
        self.learned_on = learned_on or self.device
        self.schedule = Schedule(job, data, self.learned_on, start)
        arrays = data.inputs, data.targets
        scales = self.schedule.scales
        inputs, targets = (self._scaled(*pair, in_place) for pair in zip(arrays, scales, strict=True))
        self._samples = Samples(inputs, targets, partial=self.schedule.partial)
        self.network = self.schedule.network().to(self.device)
        self.network.precision = torch.float32 if learned_on else job.precision(self.device)
        self._optimizer = optimizer_of(self.network, optimiser_numbers(job.training.learning))

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
        schedule = self.schedule
        first = checkpoint.copy_weights(self.network)
        done = checkpoint.resume(path, schedule.fingerprint, self.network, self._optimizer)
        done.chosen_by = schedule.chosen_by
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
            checkpoint.save(path, schedule.fingerprint, self.network, self._optimizer, done)
            write_metrics(state_dir / METRICS, done, schedule.joints)
            schedule.report(done)
        # A training that diverges at once is a result too where it may; it has learned nothing then.
        done.best = done.best or first
        return done

    def calibrate(self, done: Progress) -> StdFactors:
        """Return how far off the best weights' standard deviations (n,) [N, N m] are on the validation blocks."""
        self.network.load_state_dict(done.best)
        error, std = predict(self.network, self._samples, self.schedule.validation, self.job.horizon)
        if self._samples.partial:
            known = ~np.isnan(error[:, 0])
            error = error[known]
            std = std[known]
        # In N m, as coverage does not depend on the unit but likelihood and CRPS do.
        unit = self.schedule.scales[1].std.astype(np.float64)
        learning = self.job.training.learning
        return calibrate(error * unit, std * unit, learning.calibration_share, learning.calibration_levels)

    def on_windows(self, done: Progress) -> dict[str, float]:
        """Return the best weights' loss (22) and RMSE [N, N m] where every sample re-runs its window from zero."""
        self.network.load_state_dict(done.best)
        loss, errors = self._validate(self.schedule.windows, LAST_STEP)
        return {"loss": loss, "rmse": float(errors.mean())}

    def _validate(self, plan: EpochPlan, scored: slice = EVERY_STEP) -> tuple[float, NDArray[np.floating]]:
        """Return mean loss (22), and RMSE of each joint (n,) [N, N m], of a validation."""
        loss, rmse = validate(self.network, self._samples, plan, self.job.horizon, scored)
        return loss, rmse.numpy() * self.schedule.scales[1].std

    def _epoch(self, epoch: int) -> tuple[Epoch, list[float]]:
        """Learn from the data once, and return what the epoch shows and the RMSE of each joint (n,) [N, N m]."""
        job = self.job
        schedule = self.schedule
        rate = self.job.rate(epoch)
        learning = self.job.training.learning
        for group in self._optimizer.param_groups:
            group["lr"] = rate
        stride = job.stride(epoch)
        if epoch and (before := job.stride(epoch - 1)) != stride:
            self.network.keep_longer(before / stride)
        plan = schedule.plan(epoch, stride)
        with seeded(schedule.seed("dropout", epoch)):
            losses, norms = train_epoch(
                self.network,
                self._optimizer,
                self._samples,
                plan,
                job.horizon,
                learning.gradient_norm,
                schedule.scored,
                objective_of(learning.loss, learning.loss_beta),
            )
        schedule.check_losses(epoch, losses.median().item(), rate)
        validation, errors = self._validate(schedule.validation_at(stride))
        schedule.check_validation(epoch, validation, rate)
        loss = losses.mean().item()
        rmse = float(errors.mean())
        return Epoch(epoch + 1, loss, validation, rmse, rate, norms.mean().item(), stride), errors.tolist()
