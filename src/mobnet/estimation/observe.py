"""From a recording to the observer's residual and the torque it should have followed."""

import logging
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.columns import recording_columns
from mobnet.core.recording import SensedRecording
from mobnet.core.store import read_array
from mobnet.estimation.low_pass import low_pass
from mobnet.estimation.observer import MomentumObserver
from mobnet.robot.description import RobotDescription
from mobnet.robot.nominal import NominalModel
from mobnet.settings.base import TorqueKind

CARRIED = ("scenario", "level", "seed")  # what a recording says of itself and its residual repeats
log = logging.getLogger(__name__)


def observer_of(
    robot: RobotDescription,
    mass_ratio: float,
    gravity_m_s2: float,
    gain_hz: float,
    rate_hz: float,
    torque: TorqueKind = "mean",
) -> MomentumObserver:
    """Return the observer, gain K_0 of (7) [1/s]; its model has so many times the robot's masses (section 5.1)."""
    return MomentumObserver(NominalModel(robot, mass_ratio, gravity_m_s2), gain_hz, rate_hz, torque)


def residual_and_truth(
    observer: MomentumObserver, recording: SensedRecording, external: NDArray[Any]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return r of (9) and the external torque (T, nv) low-passed, (T, nv) each [N] and [N m], segment by segment."""
    residual = np.zeros(recording.sensed.v.shape)
    truth = np.zeros(recording.sensed.v.shape)
    for span in recording.spans():
        # A segment begins with another state of the robot, so that no momentum is carried into it.
        residual[span] = observer.residual(recording.sensed[span])
        truth[span] = low_pass(external[span], observer.gain_hz, recording.rate_hz)
    return residual, truth


def read_wrenches(recording: Path, robot: RobotDescription) -> dict[str, NDArray[np.float32]]:
    """Read the wrenches of the feet in a recording, side -> (T, 6) [N] and [N m], as their sensors read them."""
    columns = recording_columns(robot.layout)
    wrenches = dict[str, NDArray[np.float32]]()
    for side in robot.feet:
        names = [name for name, *_ in columns[f"wrench_{side}_foot"]]
        wrenches[side], _ = read_array(recording, names, robot.layout)
    return wrenches
