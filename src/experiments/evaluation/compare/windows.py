"""Which samples of recordings are looked at: all or those around pushes, evenly thinned, in blocks of time."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from experiments.evaluation.compare.rmse import Spans
from experiments.settings.measures import Coverage, CoverageTest
from mobnet.core.columns import CONTACT, EXTERNAL, FEET, PUSHED, SWING
from mobnet.core.errors import DataError
from mobnet.core.store import read_array

FLAG = 0.5  # a stored flag above this is 1


@dataclass(frozen=True)
class Pushed:
    """Where in a recording the swinging left leg or an arm is pushed: it has external torque but touches nothing.

    A push turns the joint with more than this torque [N m]; the robot is still looked at for some time after it [s]. A
    joint of the left leg counts in swing and off the ground alone.
    """

    joint: str
    torque_nm: float
    after_s: float
    leg: bool = True

    def spans(self, stem: Path) -> Spans:
        """Return the spans (start, end) of rows around the pushes of a recording, in order."""
        names = [*(f"{signal}.{FEET[0]}" for signal in (SWING, CONTACT)), f"{EXTERNAL}.{self.joint}"]
        array, meta = read_array(stem, names)
        free = (array[:, 0] > FLAG) & (array[:, 1] < FLAG) if self.leg else np.ones(len(array), dtype=bool)
        return flagged_spans(
            free & (np.abs(array[:, 2]) > self.torque_nm), meta["segments"], round(self.after_s * meta["rate_hz"])
        )


def push_windows(stem: Path, rows: int, before_s: float, after_s: float) -> Spans:
    """Return the spans (start, end) of rows around each push of a recording, in order, each within its segment.

    A span begins and ends some time [s] before and after a push: the truth behind the observer's low-pass outlasts it.

    Raises:
        DataError: a file or a column is missing, or the samples are not as many as `rows`.
    """
    pushed, meta = read_array(stem, [PUSHED])
    if len(pushed) != rows:
        raise DataError(f"{stem}.json: rows is {len(pushed)}, but its estimates have {rows}")
    before, after = (round(time_s * meta["rate_hz"]) for time_s in (before_s, after_s))
    flags = pushed[:, 0] > FLAG
    windows: list[tuple[int, int]] = []
    # Segment by segment, as rows of two segments do not follow each other in time: no window reaches into the next one.
    for first, last in meta["segments"]:
        for start, end in flagged_spans(flags, ((first, last),), 0):
            windows.append((max(start - before, first), min(end + after, last)))
    return tuple(windows)


def pushed_of(test: CoverageTest, settings: Coverage) -> Pushed | None:
    """Return which samples of a test count: those around pushes where it names a joint, else None for all."""
    if test.pushed is None:
        return None
    return Pushed(test.pushed, settings.push_nm, settings.push_after_s, test.pushed.startswith(settings.limb))


def flagged_spans(flags: NDArray[np.bool_], segments: Spans, after: int) -> Spans:
    """Return the spans (start, end) of rows in which a flag (T,) is set or was within the last `after` rows.

    A span stays within one of the contiguous segments (start, end).
    """
    spans: list[tuple[int, int]] = []
    for first, last in segments:
        wide = np.zeros(last - first + 1, dtype=bool)
        for row in np.flatnonzero(flags[first:last]):
            wide[row : min(row + after + 1, last - first)] = True
        edges = np.flatnonzero(np.diff(wide, prepend=False)) + first
        spans += [(int(start), int(end)) for start, end in edges.reshape(-1, 2)]
    return tuple(spans)


def rows_in(spans: Spans, count: int) -> NDArray[np.bool_]:
    """Return whether each of some rows lies in a span (start, end), (count,)."""
    inside = np.zeros(count, dtype=bool)
    for start, end in spans:
        inside[start:end] = True
    return inside


def blocks_of(spans: Spans, length: int) -> Iterator[tuple[int, int]]:
    """Yield spans (start, end) cut into blocks of `length` rows; the last of each span may be shorter."""
    for first, last in spans:
        for start in range(int(first), int(last), length):
            yield start, min(start + length, int(last))


def evenly(total: int, count: int) -> NDArray[np.intp]:
    """Return the indices of `count` samples spread evenly over `total`, or of all where there are fewer."""
    taken = min(total, count)
    return np.arange(taken) * total // max(1, taken)
