"""One training, with every number it depends on."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import torch

from mobnet.core.code import code_hash
from mobnet.core.config import config_hash
from mobnet.core.errors import ConfigError, not_accepted
from mobnet.core.methods import experiment_row, learning_row, network_row
from mobnet.learning.precision import precision_of


@dataclass(frozen=True)
class Job:
    """One training.

    Attributes:
        method: row of the configuration's methods.
        limb: limb group, g of (17).
        seed: number of the repetition.
        root_seed: root of every random number.
        target: what is learned, `uncertainty` or `external`.
        row: the limb's row of Table 1.
        settings: section `learning` of the configuration, the scale's sizes and the method's changes laid over it.
        epochs: number of epochs.
        epoch_samples: training samples of an epoch [samples]; None for all, once.
    """

    method: str
    limb: str
    seed: int
    root_seed: int
    target: str
    row: Mapping[str, Any]
    settings: Mapping[str, Any]
    epochs: int
    epoch_samples: int | None = None

    @property
    def name(self) -> str:
        """Experiment and seed, such as `MOB-Net-LL-s0`."""
        return f"{self.method}-{self.limb}-s{self.seed}"

    @property
    def horizon(self) -> int:
        """Steps of truncated back-propagation [samples], last column of Table 1."""
        return self.row["horizon_steps"]

    def stream(self, rate_hz: float) -> int:
        """Return the length of a stream in whole horizons [samples] at a sampling rate [Hz]."""
        return max(1, round(self.settings["stream_s"] * rate_hz / self.horizon)) * self.horizon

    def generator(self, *purpose: int | str) -> np.random.Generator:
        """Return the random numbers of a purpose, such as an epoch's; independent of all others."""
        return _generator(self.root_seed, self.name, *purpose)

    def shared_generator(self, *purpose: int | str) -> np.random.Generator:
        """Return the random numbers of a purpose that all methods share, such as which data they learn from."""
        return _generator(self.root_seed, self.limb, self.seed, *purpose)

    def rate(self, epoch: int) -> float:
        """Return the learning rate of an epoch: linear to its last value, then constant (section 4.4); unitless."""
        passed = min(1.0, epoch / max(1.0, self.settings["rate_decay_share"] * self.epochs))
        return self.settings["rate_first"] * (1.0 - (1.0 - self.settings["rate_last_ratio"]) * passed)

    def precision(self, device: torch.device) -> torch.dtype:
        """Return the number format of a GRU's products on a device; in other cells torch would round states too."""
        return precision_of(self.settings["precision"], device) if self.row["cell"] == "GRU" else torch.float32

    def fingerprint(self, data_digest: str, device: torch.device) -> str:
        """Return a hash of all that the weights depend on: numbers, data, code, torch's build, device."""
        return config_hash({**asdict(self), "data": data_digest, "code": code_hash("mobnet.learning.train"),
                            "torch": torch.__version__, "device": device.type,
                            "precision": str(self.precision(device))})  # fmt: skip


def _generator(*words: int | str) -> np.random.Generator:
    """Return the random numbers that belong to some words."""
    return np.random.default_rng(list(hashlib.sha256(repr(words).encode()).digest()))


def job_of(config: Mapping[str, Any], method: str, limb: str, seed: int) -> Job:
    """Gather what a training depends on.

    Raises:
        ConfigError: the method or the limb is unknown, or the method learns nothing.
    """
    learned = [name for name, row in config["methods"].items() if "target" in row]
    if method not in learned:
        raise ConfigError(not_accepted("method to train", method, learned))
    row, sizes = network_row(config, method, limb), experiment_row(config, method, limb)
    return Job(
        method, limb, seed, config["seed"], config["methods"][method]["target"], row, learning_row(config, method),
        sizes["epochs"], sizes.get("epoch_samples"),
    )  # fmt: skip
