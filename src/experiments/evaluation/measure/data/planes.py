"""Samples of training and of tests in the plane of a joint's velocity and torque, and its torque by phase."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from experiments.evaluation.compare.windows import FLAG, Pushed, evenly
from experiments.evaluation.measure.data.conditional import TorqueRange, even_cells, gait_phase, torque_range
from experiments.settings.measures import Coverage
from mobnet.core.arrays import Array
from mobnet.core.columns import DESIRED, SWING, VELOCITY
from mobnet.core.store import read_array

TESTS = "tests"  # name of all tests together beside those of training sets
PERCENT = 100.0


@dataclass(frozen=True)
class Plane:
    """The samples of one joint in equal cells of its velocity [rad/s] and desired torque [N m].

    Attributes:
        joint: name of the joint.
        edges: of the cells along velocity (n + 1,) and torque (m + 1,), between two quantiles of all training samples.
        shares: training set or `TESTS` -> share of its samples in each cell (n, m) [%].
        ranges: training set or `TESTS` -> central range of the torque by phase of the gait.
    """

    joint: str
    edges: tuple[Array, Array]
    shares: Mapping[str, Array]
    ranges: Mapping[str, TorqueRange]

    @property
    def common(self) -> float:
        """Share of the samples that two training sets have in the same cells [%]."""
        first, second = (share for name, share in self.shares.items() if name != TESTS)
        return float(np.minimum(first, second).sum())

    def rows(self) -> Iterator[tuple[str | float | None, ...]]:
        """Yield the rows of figure_19.csv: cells that are not empty, then the ranges by phase."""
        x, y = self.edges
        for name, share in self.shares.items():
            for i, k in zip(*np.nonzero(share), strict=True):
                yield "plane", name, self.joint, *map(float, (x[i], x[i + 1], y[k], y[k + 1], share[i, k]))
        for name, torques in self.ranges.items():
            phases = torques.cells.edges[0]
            for k in np.flatnonzero(np.isfinite(torques.low)):
                yield (
                    "phase",
                    name,
                    self.joint,
                    *map(float, (phases[k], phases[k + 1], torques.low[k], torques.high[k])),
                    None,
                )


def plane_of(joint: str, sets: Mapping[str, NDArray[Any]], coverage: Coverage) -> Plane:
    """Return the plane of a joint from samples (n, 3) of two training sets and `TESTS`: velocity, torque, phase."""
    training = np.concatenate([samples[:, :2] for name, samples in sets.items() if name != TESTS])
    ends = np.quantile(training, coverage.cell_range, axis=0).T
    x, y = even_cells([(float(low), float(high)) for low, high in ends], [coverage.cells] * 2).edges
    shares: dict[str, Array] = {}
    for name, samples in sets.items():
        counts = np.histogram2d(samples[:, 0], samples[:, 1], (x, y))[0]
        shares[name] = PERCENT * counts / max(1, len(samples))
    return Plane(joint, (x, y), shares, {name: range_of(samples, coverage) for name, samples in sets.items()})


def range_of(samples: NDArray[Any], coverage: Coverage) -> TorqueRange:
    """Return the central range by phase of the torque of samples (n, 3): velocity, torque [N m], phase [-]."""
    cells = even_cells([(0.0, 1.0)], [coverage.phases])
    return torque_range(cells, samples[:, 2:], samples[:, 1], coverage.range, coverage.cell_samples)


def read_samples(
    stems: Sequence[Path], joints: Sequence[str], count: int, foot: str, pushed: Pushed | None = None
) -> NDArray[np.float32]:
    """Return velocity [rad/s], desired torque [N m] and phase [-] at evenly spread samples (n, joints, 3).

    The phase is that of a foot's gait. At most `count` samples of all recordings together are taken, where the phase is
    known, and around pushes only where those are given.
    """
    names = [f"{SWING}.{foot}"]
    for joint in joints:
        names += [f"{quantity}.{joint}" for quantity in (VELOCITY, DESIRED)]
    arrays = [np.zeros((0, len(joints), 3), dtype=np.float32)]
    for stem in stems:
        array, meta = read_array(stem, names)
        phase = gait_phase(array[:, 0] > FLAG, meta["segments"]).astype(np.float32)
        both = array[:, 1:].reshape(len(array), len(joints), 2)
        both_and_phase = np.concatenate([both, np.broadcast_to(phase[:, None, None], (*both.shape[:2], 1))], axis=2)
        spans = pushed.spans(stem) if pushed else meta["segments"]
        arrays += [both_and_phase[start:end][np.isfinite(phase[start:end])] for start, end in spans]
    together = np.concatenate(arrays)
    return together[evenly(len(together), count)]
