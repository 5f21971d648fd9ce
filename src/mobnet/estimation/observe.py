"""From a recording to the observer's residual and the torque it should have followed."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.columns import recording_columns
from mobnet.core.recording import Sensed
from mobnet.core.recording_file import read_blocks
from mobnet.core.store import read_array
from mobnet.estimation.label import FootLabel, LabelState, zero_of
from mobnet.estimation.observer import RobotObserver
from mobnet.kernel.drive import TorqueKind
from mobnet.kernel.low_pass import low_pass
from mobnet.kernel.recursion import BLOCK_ROWS
from mobnet.robot.description import RobotDescription
from mobnet.robot.nominal import NominalModel

CARRIED = ("scenario", "level", "seed")  # what a recording says of itself and its residual repeats


def observer_of(
    robot: RobotDescription,
    mass_ratio: float,
    gravity_m_s2: float,
    gain_hz: float,
    rate_hz: float,
    torque: TorqueKind = "mean",
) -> RobotObserver:
    """Return the observer, gain K_0 of (7) [1/s]; its model has so many times the robot's masses (section 5.1)."""
    return RobotObserver(NominalModel(robot, mass_ratio, gravity_m_s2), gain_hz, rate_hz, torque)


class BlockObserver:
    """Residual and low-passed external torque of a recording, and the label of its feet, block by block.

    A segment begins with another state of the robot, so that no momentum is carried into it.
    """

    def __init__(
        self,
        observer: RobotObserver,
        segments: Sequence[tuple[int, int]],
        rate_hz: float,
        label: FootLabel | None = None,
    ) -> None:
        """Take the segments (start, end) of the recording and its rate [Hz]; without a `label` there is none."""
        self._observer = observer
        self._segments = segments
        self._rate_hz = rate_hz
        self._label = label
        self._begin()

    def _begin(self) -> None:
        """Forget what came before: a segment begins."""
        self._observed = self._observer.init()
        self._truth: Array | None = None
        self._labelled = LabelState()

    def block(
        self, first: int, sensed: Sensed, external: NDArray[Any], wrenches: Mapping[str, NDArray[Any]]
    ) -> NDArray[np.float64]:
        """Return r of (9), the external torque low-passed and, if asked for, the label, (n, 2 nv) or (n, 3 nv).

        The samples are those that follow the last block, `first` the number of the first of them; external torques are
        (n, nv), wrenches side -> (n, 6), all in [N] and [N m]. Outside of segments the first two are zero.
        """
        rows = len(sensed)
        residual = np.zeros(sensed.v.shape)
        truth = np.zeros(sensed.v.shape)
        label = None if self._label is None else self._label.torque(sensed, wrenches)
        for start, end in self._segments:
            span = slice(max(start - first, 0), min(end - first, rows))
            if span.start >= span.stop:
                continue
            if start >= first:
                self._begin()
            self._observed = self._observer.follow(self._observed, sensed[span], residual[span])
            truth[span] = low_pass(external[span], self._observer.gain_hz, self._rate_hz, self._truth)
            self._truth = truth[span][-1]
            if self._label is not None and label is not None:
                self._labelled = self._label.follow(self._labelled, sensed[span], label[span])
        return np.concatenate([residual, truth] if label is None else [residual, truth, label], axis=1)


def feet_zeros(recording: Path, robot: RobotDescription) -> dict[str, NDArray[Any]]:
    """Return the constant error of the sensor of each foot in a recording, side -> (6,) [N] and [N m]."""
    names = wrench_fields(robot)
    hanging = {side: list[NDArray[np.float32]]() for side in names}
    for _, block in read_blocks(recording, robot.layout, ["swing", *names.values()], BLOCK_ROWS):
        for k, (side, name) in enumerate(names.items()):
            hanging[side].append(block[name][block["swing"][:, k] > 0])
    return {side: zero_of(np.concatenate(parts)) for side, parts in hanging.items()}


def wrench_fields(robot: RobotDescription) -> dict[str, str]:
    """Return side -> field of a recording with the wrench of that foot."""
    return {side: f"wrench_{side}_foot" for side in robot.feet}


def read_wrenches(recording: Path, robot: RobotDescription) -> dict[str, NDArray[np.float32]]:
    """Read the wrenches of the feet in a recording, side -> (T, 6) [N] and [N m], as their sensors read them."""
    columns = recording_columns(robot.layout)
    wrenches = dict[str, NDArray[np.float32]]()
    for side, field in wrench_fields(robot).items():
        names = [name for name, *_ in columns[field]]
        wrenches[side], _ = read_array(recording, names, robot.layout)
    return wrenches
