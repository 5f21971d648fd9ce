"""The rule `observe`: the observer's residual of recordings, and the torque that it should have followed."""

import logging
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from mobnet.core.columns import EXTERNAL, named, residual_columns
from mobnet.core.recording import read_sensed
from mobnet.core.store import check_rate, read_array, write_array
from mobnet.estimation.label import foot_label
from mobnet.estimation.observe import CARRIED, observer_of, read_wrenches, residual_and_truth
from mobnet.robot.description import describe
from mobnet.settings.methods import ObserverSettings
from mobnet.settings.robot import RobotTable
from mobnet.settings.surrogate import Level

log = logging.getLogger(__name__)


def observe_walks(
    robot: RobotTable,
    level: Level,
    gravity_m_s2: float,
    observer: ObserverSettings,
    rate_hz: float,
    recordings: Sequence[Path],
    out: Path,
) -> None:
    """Observe recordings one after another; the folder `out` gets a residual by the name of each of them.

    Raises:
        DataError: a recording is damaged.
    """
    for recording in recordings:
        observe(robot, level, gravity_m_s2, observer, recording, out / recording.name, rate_hz)


def observe(
    robot: RobotTable,
    level: Level,
    gravity_m_s2: float,
    observer: ObserverSettings,
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
    momentum = observer_of(
        description, level.nominal_mass_ratio, gravity_m_s2, observer.gain_hz, read.rate_hz, observer.torque
    )
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
