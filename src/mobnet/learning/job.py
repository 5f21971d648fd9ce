"""One repetition of a training: random numbers, learning rates, number format, and a hash of what makes its weights.

The number format is that of a GRU's matrix products: float32, or bfloat16 with float32's range and 8 bits. Weights,
gates and states stay float32, and so do sums; only what goes into a product is rounded.
"""

import hashlib
from dataclasses import dataclass
from itertools import accumulate

import numpy as np
import torch

from mobnet.core.code import SHORT, code_hash
from mobnet.core.errors import ConfigError, not_accepted
from mobnet.settings.networks import Precision, Training

KEEPING_CELLS = ("GRU", "LSTM")  # a gate of theirs says how much of the state is kept
SLACK = 1e-9  # of a sum of shares
PRECISIONS = {"float32": torch.float32, "bfloat16": torch.bfloat16}


@dataclass(frozen=True)
class TrainingJob:
    """One repetition, number `seed`, of a training; the root seed is that of every random number."""

    training: Training
    seed: int
    root_seed: int

    @property
    def name(self) -> str:
        """Method, limb and seed, such as `MOB-Net-LL-s0`."""
        return f"{self.training.method}-{self.training.limb}-s{self.seed}"

    @property
    def horizon(self) -> int:
        """Steps of truncated back-propagation [samples], last column of Table 1."""
        return self.training.network.horizon_steps

    def stream(self, rate_hz: float) -> int:
        """Return the length of a stream in whole horizons [samples] at a sampling rate [Hz]."""
        return max(1, round(self.training.learning.stream_s * rate_hz / self.horizon)) * self.horizon

    def generator(self, *purpose: int | str) -> np.random.Generator:
        """Return the random numbers of a purpose, such as an epoch's; independent of all others."""
        return _generator(self.root_seed, self.name, *purpose)

    def shared_generator(self, *purpose: int | str) -> np.random.Generator:
        """Return the random numbers of a purpose that all methods share, such as which data they learn from."""
        return _generator(self.root_seed, self.training.limb, self.seed, *purpose)

    def rate(self, epoch: int) -> float:
        """Return the learning rate of an epoch: linear to its last value, then constant (section 4.4)."""
        learning = self.training.learning
        # (N22) with a share of our own: half of a short training at the last rate would teach nothing
        # (docs/notes/training.md).
        passed = min(1.0, epoch / max(1.0, learning.rate_decay_share * self.training.epochs))
        return learning.rate_first * (1.0 - (1.0 - learning.rate_last_ratio) * passed)

    def stride(self, epoch: int) -> int:
        """Return the distance between two steps [samples] of an epoch, 1 in the last one.

        Coarse time is for cells that learn how long they keep their state, on streams.
        """
        network = self.training.network
        learning = self.training.learning
        if network.cell not in KEEPING_CELLS or learning.sequences != "carried":
            return 1
        ends = accumulate(phase.share for phase in learning.coarse)
        passed = (epoch + 1) / self.training.epochs
        return next(
            (phase.stride for phase, end in zip(learning.coarse, ends, strict=True) if passed <= end + SLACK), 1
        )

    def precision(self, device: torch.device) -> torch.dtype:
        """Return the number format of a GRU's products on a device; in other cells torch would round states too."""
        is_gru = self.training.network.cell == "GRU"
        return precision_of(self.training.learning.precision, device) if is_gru else torch.float32

    def fingerprint(self, data_digest: str, device: torch.device) -> str:
        """Return a hash of all that the weights depend on: numbers, data, code, packages, torch's build, device."""
        parts = (
            self.root_seed,
            self.seed,
            self.training.model_dump_json(),
            data_digest,
            code_hash("mobnet.learning.train"),
            torch.__version__,
            device.type,
            self.precision(device),
        )
        return hashlib.sha256(repr(parts).encode()).hexdigest()[:SHORT]


def precision_of(setting: Precision, device: torch.device) -> torch.dtype:
    """Return the number format that a training's products have.

    On a GPU torch runs the GRU, its weights and states in float32.

    Raises:
        ConfigError: the setting is `auto`: what it stands for is decided for all trainings, by the plan.
    """
    if setting not in PRECISIONS:
        raise ConfigError(not_accepted("learning.precision of a training", setting, PRECISIONS))
    return PRECISIONS[setting] if device.type == "cpu" else torch.float32


def precision_name(precision: torch.dtype) -> str:
    """Return the name of a number format in the configuration."""
    return next(name for name, dtype in PRECISIONS.items() if dtype == precision)


def _generator(*words: int | str) -> np.random.Generator:
    # The words' hash as seed: a purpose that is added later changes no numbers of the others.
    return np.random.default_rng(list(hashlib.sha256(repr(words).encode()).digest()))
