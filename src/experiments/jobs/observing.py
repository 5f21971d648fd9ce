"""The rule `observe`: the observer's residual of recordings, and the torque that it should have followed."""

import logging
from collections import deque
from collections.abc import Sequence
from dataclasses import fields
from pathlib import Path

from mobnet.core.columns import EXTERNAL, residual_columns
from mobnet.core.errors import DataError
from mobnet.core.notes import read_array_note
from mobnet.core.recording import Sensed
from mobnet.core.recording_file import read_blocks
from mobnet.core.store import NOTE, array_writer, check_rate, file_of, spans_and_rate
from mobnet.estimation.label import FootLabel
from mobnet.estimation.observe import CARRIED, BlockObserver, feet_zeros, observer_of, wrench_fields
from mobnet.formats.robot import RobotTable
from mobnet.kernel.recursion import BLOCK_ROWS
from mobnet.robot.description import describe
from mobnet.settings.methods import ObserverSettings
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
    for number, recording in enumerate(recordings, start=1):
        log.info("recording %d of %d, %s", number, len(recordings), recording.name)
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
    layout = description.layout
    check_rate(recording, rate_hz)
    note = read_array_note(file_of(recording, NOTE))
    segments, recorded_hz = spans_and_rate(note)
    momentum = observer_of(
        description, level.nominal_mass_ratio, gravity_m_s2, observer.gain_hz, recorded_hz, observer.torque
    )
    log.info("%s: %d samples in %d segments", recording.name, note["rows"], len(segments))
    labelled = level.labels == "foot_sensors"
    wrenches = wrench_fields(description) if labelled else {}
    label = None
    if labelled:
        zeros = feet_zeros(recording, description)
        label = FootLabel(momentum.nominal, zeros, observer.gain_hz, recorded_hz, plates=True)
    observed = BlockObserver(momentum, segments, recorded_hz, label)
    meta = {
        "rate_hz": recorded_hz,
        **{key: note[key] for key in CARRIED if key in note},
        "gain_hz": observer.gain_hz,
        "nominal_mass_ratio": level.nominal_mass_ratio,
    }
    sensed = [field.name for field in fields(Sensed)]
    # Both parts of the target (O7) are written, not their difference: FTS-e2e learns the second, scores need it too.
    blocks = read_blocks(recording, layout, [*sensed, EXTERNAL, *wrenches.values()], BLOCK_ROWS)
    with array_writer(out, residual_columns(layout, labelled)) as writer:
        for first, block in blocks:
            loads = {side: block[name] for side, name in wrenches.items()}
            sensed_block = Sensed(**{name: block[name] for name in sensed})
            residual = observed.block(first, sensed_block, block[EXTERNAL], loads)
            try:
                writer.append(residual)
            except DataError:
                # What cannot be written follows from a fault of the recording, which is told at its end.
                deque(blocks, maxlen=0)
                raise
        writer.close(meta, segments)
