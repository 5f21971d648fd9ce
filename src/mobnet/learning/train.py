"""Training one limb network: from recordings to weights (section 4.4)."""

from __future__ import annotations

import json
import logging
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import torch
from safetensors.torch import save_file

from mobnet.core.config import load_layout
from mobnet.core.files import atomic_path, write_json
from mobnet.core.provenance import provenance
from mobnet.learning.calibration import Calibration
from mobnet.learning.checkpoint import CHECKPOINT, Progress
from mobnet.learning.dataset import LimbData, load_limb_data
from mobnet.learning.job import job_of
from mobnet.learning.model import parameter_count
from mobnet.learning.networks import NOTE, STD_SCALE, WEIGHTS
from mobnet.learning.precision import precision_name
from mobnet.learning.tracking import METRICS, write_metrics
from mobnet.learning.trainer import Trainer

RUN = "run.json"

log = logging.getLogger(__name__)


def train(
    config: Mapping[str, Any],
    method: str,
    limb: str,
    seed: int,
    recording_stems: Sequence[Path],
    residual_stems: Sequence[Path],
    out_dir: Path,
    state_dir: Path,
) -> None:
    """Train one limb network of Table 1 by (22) and keep the epoch that validates best.

    Args:
        config: resolved configuration.
        method: row of its methods.
        limb: limb group.
        seed: number of the repetition.
        recording_stems: recordings to learn from.
        residual_stems: their residual files, in the same order.
        out_dir: gets `weights.safetensors`, `metrics.csv` and, last, `run.json`; nothing before the training is done.
        state_dir: gets a checkpoint and `metrics.csv` at each epoch; a killed training goes on from there to the same
            weights. The checkpoint goes when the training is done.

    Raises:
        ConfigError: method or limb is unknown.
        DataError: a recording or a residual is damaged or too short.
        TrainingError: the loss diverged, where `learning.may_diverge` does not allow it.
    """
    torch.set_num_threads(1)  # more are slower beside another training, and give other weights
    job = job_of(config, method, limb, seed)
    layout = load_layout(Path(config["robot"]))
    data = load_limb_data(layout, job.row, job.target, recording_stems, residual_stems)
    trainer = Trainer(job, data)
    done = trainer.run(state_dir)
    calibration = trainer.calibrate(done)
    note = run_note(config, trainer, data, done, calibration)
    write_weights(out_dir / WEIGHTS, trainer, data, done, calibration)
    write_metrics(out_dir / METRICS, done.rows)
    write_json(out_dir / RUN, note)
    (state_dir / CHECKPOINT).unlink(missing_ok=True)
    log.info("%s: done after epoch %d", job.name, done.epoch)


def write_weights(path: Path, trainer: Trainer, data: LimbData, done: Progress, calibration: Calibration) -> None:
    """Write the best weights with z-scores, (n_in,) and (n,) [N, N m], and factors on std (n,) [-], atomically."""
    trainer.network.load_state_dict(done.best)
    tensors = trainer.network.deployable()
    for name, scale in zip(("input", "target"), trainer.scales, strict=True):
        tensors |= {f"{name}.mean": torch.from_numpy(scale.mean), f"{name}.std": torch.from_numpy(scale.std)}
    if trainer.job.settings["calibrate"]:
        tensors[STD_SCALE] = torch.from_numpy(calibration.scale.astype(np.float32))
    note = {
        "limb": trainer.job.limb,
        "joints": data.joints,
        "inputs": data.input_names,
        "std_min": trainer.job.settings["std_min"],
        "network": dict(trainer.job.row),
    }
    with atomic_path(path) as temporary:
        save_file(tensors, temporary, {NOTE: json.dumps(note)})


def run_note(
    config: Mapping[str, Any], trainer: Trainer, data: LimbData, done: Progress, calibration: Calibration
) -> dict[str, Any]:
    """Return what `run.json` tells: settings, sizes, the best epoch, calibration, time [s] and provenance."""
    job = trainer.job
    return {
        "name": job.name,
        "method": job.method,
        "limb": job.limb,
        "seed": job.seed,
        "target": job.target,
        "settings": {
            **job.settings,
            "epochs": job.epochs,
            "epoch_samples": job.epoch_samples,
            "network": dict(job.row),
        },
        "parameters": parameter_count(trainer.network),
        "samples": trainer.samples,
        "diverged": done.diverged,
        "best": dict(done.best_row()) if done.rows else None,
        "on_windows": trainer.on_windows(done),
        "calibration": calibration.note(data.joints, job.settings["calibration_levels"]),
        "seconds": round(done.seconds, 1),
        "device": trainer.device.type,
        "precision": precision_name(trainer.network.precision),
        "fingerprint": trainer.fingerprint,
        "provenance": provenance(config),
    }
