"""One gait cycle cut out of a recording, and the leg that begins it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mobnet.core.columns import FEET, SWING
from mobnet.core.errors import ConfigError, DataError, not_accepted
from mobnet.core.joints import JointLayout
from mobnet.evaluation.measure.curves import Curves, read_curves
from mobnet.evaluation.measure.metrics import Spans
from mobnet.plan.runs import Run


def read_cycle(layout: JointLayout, runs: Sequence[Run], joints: Sequence[str], start_s: float) -> tuple[Curves, slice]:
    """Return what methods made of joints (n,) of a leg, and the rows of the first whole gait cycle after the start.

    Args:
        layout: joints and legs.
        runs: one of each method, all of one recording.
        joints: names.
        start_s: earliest start of the cycle [s].

    Raises:
        DataError: a file is missing or damaged, or no whole cycle follows the start.
        ConfigError: the first joint belongs to no leg.
    """
    curves = read_curves(layout, runs, joints, {"swing": f"{SWING}.{foot_of(layout, joints[0])}"})
    rows = gait_cycle(curves.flags["swing"], curves.spans, round(start_s * curves.rate_hz))
    if rows is None:
        length_s = len(curves.truth) / curves.rate_hz
        raise DataError(f"{runs[0].recording}.parquet: no whole gait cycle after {start_s} s; it lasts {length_s} s")
    return curves, rows


def gait_cycle(air: NDArray[np.bool_], segments: Spans, start: int) -> slice | None:
    """Return the rows from the first lift-off at or after `start` to the next one within the same segment.

    Args:
        air: whether the foot is planned to be in the air, (T,).
        segments: contiguous stretches (start, end) of rows.
        start: first row looked at.

    Returns:
        Rows of one cycle, or None if there is none.
    """
    for first, end in segments:
        begin = max(int(first), start)
        if begin >= end:
            continue
        lifts = begin + 1 + np.flatnonzero(air[begin + 1 : end] & ~air[begin : end - 1])
        if len(lifts) > 1:
            return slice(int(lifts[0]), int(lifts[1]))
    return None


def foot_of(layout: JointLayout, joint: str) -> str:
    """Return the foot, as named in a recording, of the leg that has a joint.

    Raises:
        ConfigError: the joint belongs to no leg.
    """
    legs = {side: layout.limb(limb) for side, limb in layout.legs.items()}
    for side, joints in legs.items():
        if joint in joints:
            return next(foot for foot in FEET if foot.startswith(side))
    raise ConfigError(not_accepted("leg joint", joint, [name for joints in legs.values() for name in joints]))
