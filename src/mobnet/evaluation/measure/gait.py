"""One gait cycle cut out of a recording, and the leg that begins it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.columns import FEET, SWING
from mobnet.core.config import load_layout, read_yaml
from mobnet.core.errors import ConfigError, DataError, not_accepted
from mobnet.evaluation.measure.curves import Curves, read_curves
from mobnet.evaluation.measure.metrics import Spans

Entries = Sequence[Mapping[str, Any]]


def read_leg(config: Mapping[str, Any], figure: str, entries: Entries) -> tuple[Curves, slice]:
    """Return `read_cycle` of all joints of the limb that a figure names, (n,)."""
    settings = config["evaluation"][figure]
    return read_cycle(config, settings, entries, load_layout(Path(config["robot"])).limb(settings["limb"]))


def read_cycle(
    config: Mapping[str, Any], settings: Mapping[str, Any], entries: Entries, joints: Sequence[str]
) -> tuple[Curves, slice]:
    """Return what methods made of joints of a leg, and the rows of the first whole gait cycle after the start.

    Args:
        config: resolved configuration: `robot`, `sizes.figure_start_s` instead of start_s where it is given.
        settings: start_s [s].
        entries: a mapping a method, all of one recording.
        joints: names.

    Raises:
        DataError: a file is missing or damaged, or no whole cycle follows the start.
        ConfigError: the first joint belongs to no leg.
    """
    robot, start_s = Path(config["robot"]), config["sizes"].get("figure_start_s", settings["start_s"])
    curves = read_curves(robot, entries, joints, {"swing": f"{SWING}.{foot_of(robot, joints[0])}"})
    rows = gait_cycle(curves.flags["swing"], curves.spans, round(start_s * curves.rate_hz))
    if rows is None:
        length_s = len(curves.truth) / curves.rate_hz
        raise DataError(
            f"{entries[0]['recording']}.parquet: no whole gait cycle after {start_s} s; it lasts {length_s} s"
        )
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


def foot_of(robot: Path, joint: str) -> str:
    """Return the foot, as named in a recording, of the leg that has a joint.

    Raises:
        ConfigError: the joint belongs to no leg.
    """
    table = read_yaml(robot)
    sides = sorted({foot.split("_")[0] for foot in FEET})
    legs = {side: table["groups"][table["feet"][side]["limb"]] for side in sides}
    for side, joints in legs.items():
        if joint in joints:
            return next(foot for foot in FEET if foot.startswith(side))
    raise ConfigError(f"{robot}: " + not_accepted("leg joint", joint, [name for leg in legs.values() for name in leg]))
