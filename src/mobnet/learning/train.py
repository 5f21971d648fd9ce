"""Training limb networks: from recordings to weights (section 4.4)."""

import json
import logging
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
import torch
from safetensors.torch import save as to_bytes

from mobnet.core.code import provenance
from mobnet.core.files import CHECKPOINT, METRICS, RUN, TIME, WEIGHTS, atomic_path, write_json
from mobnet.core.machine import one_thread
from mobnet.formats.base import Section
from mobnet.learning.calibration import StdFactors
from mobnet.learning.checkpoint import Progress, copy_weights, write_metrics
from mobnet.learning.dataset import LimbData
from mobnet.learning.deployed.tensors import STD_SCALE
from mobnet.learning.deployed.weights import NOTE
from mobnet.learning.job import TrainingJob, precision_name
from mobnet.learning.model import parameter_count
from mobnet.learning.stacked.train import read_lesson
from mobnet.learning.trainer import Trainer

log = logging.getLogger(__name__)


def train_on(
    data: LimbData,
    job: TrainingJob,
    out: Path,
    state: Path,
    start: Path | None = None,
    lesson: tuple[Path, str] | None = None,
    *,
    in_place: bool = False,
) -> None:
    """Train one limb network by (22), or by another of `losses`, and keep the epoch that validates best.

    The folder `out` gets `weights.safetensors`, `metrics.csv` and, last, `run.json`; nothing before the training is
    done. The folder `state` gets a checkpoint and `metrics.csv` at each epoch; a killed training goes on from there to
    the same weights. The checkpoint is deleted when the training is done; `time.json` stays. A fine-tuning begins with
    the weights of the file `start`. A network that has learned in a stack is not trained again: the `lesson` says in
    which file what it learned stands, and by which name. `in_place` overwrites the data with their z-scores.

    Raises:
        DataError: the data are too short, or what it learned is that of another training.
        TrainingError: the loss diverged, where `learning.may_diverge` does not allow it.
    """
    one_thread()
    if lesson:
        path, name = lesson
        learned = read_lesson(path, name)
        trainer = Trainer(job, data, start, torch.device(learned.device), in_place=in_place)
        schedule = trainer.schedule
        may_diverge = job.training.learning.may_diverge
        done = learned.checked(path, schedule.fingerprint, schedule.chosen_by, may_diverge=may_diverge)
        done.best = done.best or copy_weights(trainer.network)
    else:
        trainer = Trainer(job, data, start, in_place=in_place)
        done = trainer.run(state)
    calibration = trainer.calibrate(done)
    note = run_note(trainer, data, done, calibration)
    write_weights(out / WEIGHTS, trainer, data, done, calibration)
    write_metrics(out / METRICS, done, data.joints)
    write_json(out / RUN, note)
    write_json(state / TIME, {"seconds": round(done.seconds, 3)})  # not in the note, which two runs have alike
    (state / CHECKPOINT).unlink(missing_ok=True)
    log.info("%s: done after epoch %d, %.1f s", job.name, len(done.epochs), done.seconds)


def write_weights(path: Path, trainer: Trainer, data: LimbData, done: Progress, calibration: StdFactors) -> None:
    """Write the best weights with z-scores, (n_in,) and (n,) [N, N m], and factors on std (n,), atomically."""
    training = trainer.job.training
    trainer.network.load_state_dict(done.best)
    tensors = trainer.network.deployable()
    for name, scale in zip(("input", "target"), trainer.schedule.scales, strict=True):
        tensors |= {f"{name}.mean": torch.from_numpy(scale.mean), f"{name}.std": torch.from_numpy(scale.std)}
    if training.learning.calibrate:
        tensors[STD_SCALE] = torch.from_numpy(calibration.scale.astype(np.float32))
    note = {
        "name": trainer.job.name,
        "limb": training.limb,
        "joints": data.joints,
        "inputs": data.input_names,
        "std_min": training.learning.std_min,
        "network": json_of(training.network),
    }
    with atomic_path(path) as temporary:
        temporary.write_bytes(to_bytes(tensors, {NOTE: json.dumps(note)}))


def run_note(trainer: Trainer, data: LimbData, done: Progress, calibration: StdFactors) -> dict[str, Any]:
    """Return the content of `run.json`: settings, sizes, the best epoch, calibration and provenance."""
    job = trainer.job
    training = trainer.job.training
    return {
        "name": job.name,
        "method": training.method,
        "limb": training.limb,
        "seed": job.seed,
        "target": training.target,
        "settings": {
            **json_of(training.learning),
            "epochs": training.epochs,
            "epoch_samples": training.epoch_samples,
            "network": json_of(training.network),
        },
        "parameters": parameter_count(trainer.network),
        "samples": trainer.schedule.samples,
        "diverged": done.diverged,
        "chosen_by": trainer.schedule.chosen_by,
        "best": asdict(done.best_epoch()) if done.epochs else None,
        "on_windows": trainer.on_windows(done),
        "calibration": calibration.note(data.joints, training.learning.calibration_levels),
        "device": trainer.learned_on.type,
        "precision": precision_name(trainer.network.precision),
        "fingerprint": trainer.schedule.fingerprint,
        "provenance": provenance(),
    }


def json_of(section: Section) -> dict[str, Any]:
    """Return a section as JSON, without the keys that have their defaults."""
    return section.model_dump(mode="json", exclude_defaults=True)
