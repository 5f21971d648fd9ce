"""Collisions of legs in a recording: when each begins and ends, where it hits, how hard."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

from mobnet.core.arrays import Array
from mobnet.core.columns import PUSH, named
from mobnet.core.errors import ConfigError, not_accepted
from mobnet.core.joints import JointLayout
from mobnet.core.store import read_array
from mobnet.settings.data import Push

FORCE = named(PUSH, ("row", "force_x", "force_y", "force_z"))


@dataclass(frozen=True)
class Hit:
    """A push in some rows of a recording: what it hits from where, and its force over time (n,) [N]."""

    name: str
    leg: str
    link: str
    direction: str
    rows: slice
    force: Array


def hits_of(recording: Path, pushes: Mapping[str, Push], layout: JointLayout) -> list[Hit]:
    """Return the pushes of legs in a recording in order; `pushes` are those of its scenario, in their order.

    Raises:
        ConfigError: a push meets no point of a leg.
        DataError: a file or a column is missing.
    """
    array, meta = read_array(recording, FORCE)
    number = array[:, 0]
    force = np.linalg.norm(array[:, 1:], axis=1).astype(np.float64)
    names = list(pushes)
    hits: list[Hit] = []
    for start, end in runs_of(number, meta["segments"]):
        # A recording holds the number of a push, counted from 1, and not its name.
        name = names[int(number[start]) - 1]
        hits.append(Hit(name, *target_of(pushes[name], layout), slice(start, end), force[start:end]))
    return hits


def runs_of(number: np.ndarray, segments: Sequence[Sequence[int]]) -> Iterator[tuple[int, int]]:
    """Yield the rows (start, end) of each run of one number above zero (T,) in contiguous segments."""
    for first, last in segments:
        part = number[first:last]
        edges = np.flatnonzero(np.diff(part, prepend=0.0, append=0.0)) + first
        for start, end in pairwise(edges):
            if number[start] > 0:
                yield int(start), int(end)


def target_of(push: Push, layout: JointLayout) -> tuple[str, str, str]:
    """Return the leg, the link and the direction that a push meets.

    Raises:
        ConfigError: it meets no point named `<side>_<link>_<direction>`.
    """
    parts = (push.point or "").split("_")
    if len(parts) != 3 or parts[0] not in layout.legs:
        accepted = [f"{side}_<link>_<direction>" for side in layout.legs]
        raise ConfigError(not_accepted("point of a collision", push.point, accepted))
    side, link, direction = parts
    return layout.legs[side], link, direction
