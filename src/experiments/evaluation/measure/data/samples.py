"""Samples of a network's inputs in training and in tests, and training data that tests are compared with."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from experiments.evaluation.compare.windows import FLAG, Pushed, blocks_of, evenly
from experiments.evaluation.measure.data.conditional import gait_phase
from experiments.settings.measures import Coverage
from mobnet.core.arrays import Array
from mobnet.core.columns import FEET, foot_of
from mobnet.core.joints import JointLayout
from mobnet.core.recording_file import read_sensed
from mobnet.learning.features import LimbInputs

Blocks = Sequence[NDArray[Any]]  # one array (n, ...) for each block of samples


@dataclass(frozen=True)
class Reference:
    """Training data that tests are compared with: a tree of z-scored samples, and the inputs' central range (n_in,)."""

    low: Array
    high: Array
    tree: cKDTree


def read_blocks(
    stems: Sequence[Path], layout: JointLayout, inputs: LimbInputs, settings: Coverage, foot: int | None = None,
    pushed: Pushed | None = None,
) -> list[NDArray[np.float32]]:  # fmt: skip
    """Return every k-th sample of a network's inputs and, last, the gait's phase [-], block by block (n, n_in + 1).

    Units are those of `LimbInputs`; the phase is that of the limb. With a foot, 0 left or 1 right, only samples are
    taken in which it is in the air; with pushes, only samples around them, a block for each push.
    """
    blocks = []
    swing_foot = FEET.index(foot_of(layout, layout.limb(settings.limb)[0]))
    for stem in stems:
        recording = read_sensed(stem, layout)
        phase = gait_phase(recording.sensed.swing[:, swing_foot] > FLAG, recording.segments)
        spans = pushed.spans(stem) if pushed else recording.segments
        for start, end in blocks_of(spans, round(settings.block_s * recording.rate_hz)):
            rows = slice(start, end, settings.every)
            sensed = recording.sensed[rows]
            block = np.column_stack([inputs(sensed), phase[rows].astype(np.float32)])
            blocks.append(block[slice(None) if foot is None else sensed.swing[:, foot] > FLAG])
    return blocks


def equal_sets(sets: Sequence[Blocks], most: int) -> list[NDArray[np.float32]]:
    """Return samples (n, n_in) of every set [their units], equally many but no more than `most`, evenly in time."""
    whole = [np.concatenate(blocks) for blocks in sets]
    size = min(most, *map(len, whole))
    return [array[evenly(len(array), size)] for array in whole]


def scale_of(samples: NDArray[Any]) -> tuple[Array, Array]:
    """Return mean and standard deviation (n_in,) of inputs [their units]; a constant input keeps its scale."""
    std = samples.std(axis=0, dtype=np.float64)
    return samples.mean(axis=0, dtype=np.float64), np.where(std > 0.0, std, 1.0)


def refer(samples: NDArray[Any], shares: Sequence[float], mean: Array, std: Array) -> Reference:
    """Return what tests are compared with, from training inputs (n, n_in) [their units].

    The shares are quantiles at the ends of the central range. Mean and standard deviation (n_in,) are those of both
    training sets together: one scale, so that distances to the two compare.
    """
    low, high = np.quantile(samples, shares, axis=0)
    return Reference(low, high, cKDTree((samples - mean) / std))
