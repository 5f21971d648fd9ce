"""From a recording to the observer's residual and the torque it should have followed."""

import logging
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.columns import EXTERNAL, named, recording_columns, residual_columns
from mobnet.core.recording import SensedRecording, read_sensed
from mobnet.core.store import check_rate, read_array, write_array
from mobnet.estimation.label import foot_label
from mobnet.estimation.low_pass import low_pass
from mobnet.estimation.observer import MomentumObserver
from mobnet.robot.description import RobotDescription, describe
from mobnet.robot.nominal import NominalModel
from mobnet.settings.base import TorqueKind
from mobnet.settings.methods import Observer
from mobnet.settings.robot import RobotTable
from mobnet.settings.surrogate import Level

CARRIED = ("scenario", "level", "seed")  # what a recording says of itself and its residual repeats
log = logging.getLogger(__name__)


def observe(
    robot: RobotTable,
    level: Level,
    gravity_m_s2: float,
    observer: Observer,
    recording: Path,
    out: Path,
    rate_hz: float | None = None,
) -> None:
    """Write r of (9) and the low-passed external torque of (15) for a recording, 2 x (T, nv) [N] and [N m].

    Columns are `r.<joint>` and then `tau_ext_lp.<joint>`; segments are the recording's, and the observer starts anew
    with each. The target of the networks (section 4.2.3) is their difference. At a level whose labels are those of the
    foot sensors, `label_lp.<joint>` follows, and the target is r less this. Of the truth, only the external torque and
    the feet's wrenches are read, and r does not depend on them. The recording, made at the uncertainty
    level, and `out` are paths without a suffix. The observer runs at the recording's rate, which is `rate_hz` [Hz]
    where that is given.

    Raises:
        DataError: the recording is damaged.
    """
    description = describe(robot)
    check_rate(recording, rate_hz)
    read = read_sensed(recording, description.layout)
    external, _ = read_array(recording, named(EXTERNAL, description.layout.names), description.layout)
    momentum = observer_of(description, level, gravity_m_s2, observer.gain_hz, read.rate_hz, observer.torque)
    log.info("%s: %d samples in %d segments", recording, len(read.sensed), len(read.segments))
    # Both parts of the target (O7) are written, not their difference: FTS-e2e learns the second, scores need it too.
    parts = residual_and_truth(momentum, read, external)
    labelled = level.labels == "foot_sensors"
    if labelled:
        wrenches = read_wrenches(recording, description)
        parts = (*parts, foot_label(momentum.nominal, read, wrenches, observer.gain_hz))
    meta = {
        "rate_hz": read.rate_hz,
        **{key: read.meta[key] for key in CARRIED if key in read.meta},
        "gain_hz": observer.gain_hz,
        "nominal_mass_ratio": level.nominal_mass_ratio,
    }
    columns = residual_columns(description.layout, labelled)
    write_array(out, np.concatenate(parts, axis=1), columns, meta, read.segments)


def observer_of(
    robot: RobotDescription,
    level: Level,
    gravity_m_s2: float,
    gain_hz: float,
    rate_hz: float,
    torque: TorqueKind = "mean",
) -> MomentumObserver:
    """Return the observer, gain K_0 of (7) [1/s], that knows the robot as an uncertainty level of section 5.1 says."""
    return MomentumObserver(NominalModel(robot, level.nominal_mass_ratio, gravity_m_s2), gain_hz, rate_hz, torque)


def residual_and_truth(
    observer: MomentumObserver, recording: SensedRecording, external: NDArray[Any]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return r of (9) and the external torque (T, nv) low-passed, (T, nv) each [N] and [N m], segment by segment."""
    residual, truth = np.zeros(recording.sensed.v.shape), np.zeros(recording.sensed.v.shape)
    for span in recording.spans():
        # A segment begins with another state of the robot, so that no momentum is carried into it.
        residual[span] = observer.residual(recording.sensed[span])
        truth[span] = low_pass(external[span], observer.gain_hz, recording.rate_hz)
    return residual, truth


def read_wrenches(recording: Path, robot: RobotDescription) -> dict[str, NDArray[np.float32]]:
    """Read the wrenches of the feet in a recording, side -> (T, 6) [N] and [N m], as their sensors read them."""
    columns = recording_columns(robot.layout)
    names = {side: [name for name, *_ in columns[f"wrench_{side}_foot"]] for side in robot.feet}
    return {side: read_array(recording, own, robot.layout)[0] for side, own in names.items()}
