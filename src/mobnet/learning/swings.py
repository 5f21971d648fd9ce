"""Where nothing touches a leg, by the walking plan alone: there the external torque of its joints is zero."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.columns import SWING, foot_of
from mobnet.core.errors import DataError
from mobnet.core.joints import JointLayout
from mobnet.core.store import read_array, spans_and_rate

IN_THE_AIR = 0.5  # of a flag
Margins = tuple[float, float]  # left out of a swing: time after the planned lift-off, before the planned landing [s]


def hanging(
    swing: NDArray[Any], spans: Sequence[tuple[int, int]], rate_hz: float, margins: Margins
) -> NDArray[np.bool_]:
    """Return where a foot surely hangs in the air (T,), from the walking plan's swing (T,): without its two ends.

    After a foot should have lifted off it may still touch the ground for some time [s], and before it should land it
    may have landed; spans (start, end) hang together, and the end of one ends a swing.
    """
    # (N2). Margins beyond the middle of a short swing leave nothing of it.
    after, before = (round(margin * rate_hz) for margin in margins)
    hangs = np.zeros(len(swing), dtype=bool)
    for start, end in spans:
        edges = np.flatnonzero(np.diff(np.asarray(swing[start:end]) > 0, prepend=False, append=False))
        for lifted, landed in start + edges.reshape(-1, 2):
            hangs[lifted + after : max(landed - before, lifted + after)] = True
    return hangs


def free_rows(recording: Path, layout: JointLayout, joints: Sequence[str], margins: Margins) -> NDArray[np.bool_]:
    """Return where the leg of some joints surely hangs in the air in a recording (T,).

    Raises:
        DataError: the joints are not those of one leg.
    """
    if not any(set(joints) <= set(layout.limb(limb)) for limb in layout.legs.values()):
        raise DataError(f"joints {', '.join(joints)} are not accepted where swings label; accepted: joints of one leg")
    swing, meta = read_array(recording, [f"{SWING}.{foot_of(layout, joints[0])}"])
    return hanging(swing[:, 0] > IN_THE_AIR, *spans_and_rate(meta), margins)
