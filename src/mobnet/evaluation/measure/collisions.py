"""Collisions of legs in a recording: when each begins and ends, where it hits, how hard."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np

from mobnet.core.columns import PUSH, named
from mobnet.core.errors import ConfigError, not_accepted
from mobnet.core.joints import JointLayout
from mobnet.core.store import read_array
from mobnet.settings.data import Push

FORCE = named(PUSH, ("row", "force_x", "force_y", "force_z"))


class Hit:
    """A push in the rows [start, end) of a recording: its force over time and where it meets the robot."""

    def __init__(self, name: str, point: str, leg: str, rows: slice, force: np.ndarray) -> None:
        """Take a push of a scenario, the point that it meets, named `<side>_<link>_<direction>`, and its force [N]."""
        self.name, self.leg, self.rows, self.force = name, leg, rows, force
        _, self.link, self.direction = point.split("_")


def hits_of(recording: Path, pushes: Mapping[str, Push], layout: JointLayout) -> list[Hit]:
    """Return the pushes of legs in a recording in order; `pushes` are those of its scenario, in their order.

    Raises:
        ConfigError: a push meets no point of a leg.
        DataError: a file or a column is missing.
    """
    array, meta = read_array(recording, FORCE)
    number, force = array[:, 0], np.linalg.norm(array[:, 1:], axis=1).astype(np.float64)
    names = list(pushes)
    return [
        Hit(names[int(number[start]) - 1], *leg_of(pushes[names[int(number[start]) - 1]], layout), slice(start, end),
            force[start:end])
        for start, end in runs_of(number, meta["segments"])
    ]  # fmt: skip


def runs_of(number: np.ndarray, segments: Sequence[Sequence[int]]) -> Iterator[tuple[int, int]]:
    """Yield the rows (start, end) of each run of one number above zero (T,) in contiguous segments."""
    for first, last in segments:
        part = number[first:last]
        edges = np.flatnonzero(np.diff(part, prepend=0.0, append=0.0)) + first
        for start, end in pairwise(edges):
            if number[start] > 0:
                yield int(start), int(end)


def leg_of(push: Push, layout: JointLayout) -> tuple[str, str]:
    """Return the point that a push meets and its leg.

    Raises:
        ConfigError: it meets no point named `<side>_<link>_<direction>`.
    """
    parts = (push.point or "").split("_")
    if len(parts) != 3 or parts[0] not in layout.legs:
        accepted = [f"{side}_<link>_<direction>" for side in layout.legs]
        raise ConfigError(not_accepted("point of a collision", push.point, accepted))
    return str(push.point), layout.legs[parts[0]]
