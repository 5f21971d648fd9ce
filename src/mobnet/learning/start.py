"""The trained network from which a fine-tuning starts (section 8.2)."""

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import torch
from torch import Tensor

from mobnet.core.errors import DataError, not_accepted
from mobnet.learning.dataset import LimbData, ZScore
from mobnet.learning.deployed.weights import GRU_TENSORS, read_weights
from mobnet.learning.job import TrainingJob


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
