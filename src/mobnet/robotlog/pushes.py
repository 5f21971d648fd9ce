"""The pushes that a simulated log tells, and which of them flags have found."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.core.columns import EXTERNAL, PUSHED
from mobnet.robotlog.convert import Converted
from mobnet.robotlog.flags import Flag, stretches


class PushCount(NamedTuple):
    """How many pushes a log has, how many of them a flag lies in, and how many flags lie in none."""

    pushes: int
    found: int
    others: int


def pushed_rows(log: Converted, joints: Sequence[str]) -> NDArray[np.bool_] | None:
    """Return when a push acts on some joints (T,), None where the log does not tell it."""
    rows = log.truth[PUSHED] > 0.5 if PUSHED in log.truth else None
    names = [f"{EXTERNAL}.{joint}" for joint in joints]
    torques = [log.truth[name] for name in names if name in log.truth]
    if torques:
        felt = np.any(torques, axis=0)
        rows = felt if rows is None else rows & felt
    return rows


def found_pushes(log: Converted, joints: Sequence[str], flags: Sequence[Flag], late_s: float) -> PushCount | None:
    """Count the pushes on some joints that a flag lies in, or begins up to so long [s] after."""
    rows = pushed_rows(log, joints)
    if rows is None:
        return None
    spans = [(log.time_s[a], log.time_s[b - 1] + late_s) for a, b in stretches(rows, log.recording.segments, 0)]
    hits = list[list[bool]]()
    for start, end in spans:
        hits.append([start <= flag.end_s and flag.start_s <= end for flag in flags])
    others = sum(not any(one) for one in zip(*hits, strict=True)) if hits else len(flags)
    return PushCount(len(spans), sum(map(any, hits)), others)
