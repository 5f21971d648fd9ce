"""Contiguous streams: how recordings are split 9:1 and fed to a network whose state is carried (section 4.3, 4.4).

A batch is a set of lanes that walk through the data side by side, one horizon of steps per update. Streams, contiguous
pieces of a recording, are laid end to end in an order drawn each epoch and dealt to the lanes; where a lane enters a
new stream its state starts from zero. So every batch is full, whatever the number and the lengths of the streams.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from mobnet.core.errors import DataError

Span = tuple[int, int]  # first row and the row after the last


@dataclass(frozen=True)
class EpochPlan:
    """The course of one epoch.

    Attributes:
        rows: first row of each horizon of steps, (updates, lanes).
        fresh: True where a lane enters a stream there and its state starts from zero, (updates, lanes).
        stride: distance between two steps of a horizon [samples].
    """

    rows: NDArray[np.int64]
    fresh: NDArray[np.bool_]
    stride: int = 1

    def __len__(self) -> int:
        return len(self.rows)


def split(
    segments: Sequence[Span], validation_share: float, held_out: int | None = None
) -> tuple[list[Span], list[Span]]:
    """Cut the end of each contiguous segment off for validation: 9:1 in section 4.3, never single samples.

    With the row `held_out`, all segments from there on validate instead. Return training blocks and validation blocks.
    """
    if held_out is not None:
        return [span for span in segments if span[0] < held_out], [span for span in segments if span[0] >= held_out]
    # Samples a millisecond apart are nearly the same, so that single ones held out would validate nothing.
    training = []
    validation = []
    for start, end in segments:
        cut = end - round((end - start) * validation_share)
        training.append((start, cut))
        validation.append((cut, end))
    return training, validation


def cut_streams(
    blocks: Sequence[Span], stream: int, horizon: int, rng: np.random.Generator | None = None
) -> list[Span]:
    """Cut blocks into streams of whole horizons; a piece shorter than `horizon` [samples] is left out.

    The generator draws where the first cut of a block lies, so that epochs differ, and the order of the streams;
    without it cuts start at the block's first row and the order stays.
    """
    streams = []
    for start, end in blocks:
        first = start + (int(rng.integers(stream)) if rng else 0)
        cuts = [start, *range(first, end, stream), end]
        pieces = [(a, a + (b - a) // horizon * horizon) for a, b in pairwise(cuts)]
        streams += [(a, b) for a, b in pieces if b > a]
    return [streams[i] for i in rng.permutation(len(streams))] if rng else streams


def deal(streams: Sequence[Span], lanes: int, horizon: int) -> EpochPlan:
    """Distribute streams over the lanes of a batch for truncated back-propagation through time (section 4.4).

    Streams, each a whole number of horizons long, are laid end to end and cut into lanes of equal length; what is left
    over at the end is not learned from.

    Raises:
        DataError: the streams hold fewer horizons than there are lanes.
    """
    # (N19): lanes of equal length, so that every batch is full until the last update.
    rows = np.concatenate([np.arange(a, b, horizon) for a, b in streams] or [np.empty(0)]).astype(np.int64)
    updates = len(rows) // lanes
    if updates == 0:
        raise DataError(
            f"{len(rows)} horizons of {horizon} samples cannot fill a batch of {lanes} streams; "
            "accepted: longer recordings, a smaller batch_size"
        )
    follows = np.concatenate([[False], np.diff(rows) == horizon])
    # Two streams may lie end to end in a recording too, where a cut was drawn: a start all the same, (N20).
    follows[np.cumsum([0] + [(b - a) // horizon for a, b in streams[:-1]])] = False
    shape = (lanes, updates)
    fresh = ~follows[: lanes * updates].reshape(shape)
    fresh[:, 0] = True
    return EpochPlan(rows[: lanes * updates].reshape(shape).T.copy(), fresh.T.copy())


def some_of(blocks: Sequence[Span], stream: int, parts: int, rng: np.random.Generator) -> list[Span]:
    """Return one of so many parts of some blocks: streams drawn at random, as section 6.3 draws samples."""
    if parts == 1:
        return list(blocks)
    streams = list[Span]()
    for start, end in blocks:
        streams += [(first, min(first + stream, end)) for first in range(start, end, stream)]
    kept = rng.permutation(len(streams))[: max(1, round(len(streams) / parts))]
    return [streams[i] for i in np.sort(kept)]


def epoch_plan(
    blocks: Sequence[Span], stream: int, horizon: int, lanes: int, rng: np.random.Generator, samples: int | None = None
) -> EpochPlan:
    """Return the course of a training epoch: new cuts, new order; arrays (updates, lanes) of rows [samples].

    Blocks are gone through as often as it takes to fill so many `samples`; None means once, all of them.

    Raises:
        DataError: the streams hold fewer horizons than there are lanes.
    """
    streams = cut_streams(blocks, stream, horizon, rng)
    if samples is None:
        return deal(streams, lanes, horizon)
    total = sum(b - a for a, b in streams)
    while 0 < total < samples:
        more = cut_streams(blocks, stream, horizon, rng)
        streams = streams + more
        total = total + sum(b - a for a, b in more)
    enough = int(np.searchsorted(np.cumsum([b - a for a, b in streams]), samples)) + 1
    return deal(streams[:enough], lanes, horizon)


def window_plan(
    blocks: Sequence[Span], stream: int, horizon: int, lanes: int, rng: np.random.Generator, samples: int | None = None
) -> EpochPlan:
    """Return an epoch of independent windows, each from a zero state; arrays (updates, lanes) of rows [samples].

    `stream` has no meaning here, for windows follow each other at random; without `samples` the epoch has as many as
    the blocks.

    Raises:
        DataError: the blocks hold fewer windows than there are lanes.
    """
    starts = np.concatenate([np.arange(a, b - horizon + 1) for a, b in blocks] or [np.empty(0)]).astype(np.int64)
    updates = (samples or sum(b - a for a, b in blocks)) // (horizon * lanes)
    if min(updates, len(starts)) == 0:
        raise DataError(
            f"{len(starts)} windows of {horizon} samples cannot fill a batch of {lanes}; "
            "accepted: longer recordings, a smaller batch_size"
        )
    rows = rng.choice(starts, (updates, lanes))
    return EpochPlan(rows, np.ones(rows.shape, dtype=bool))


def validation_plan(blocks: Sequence[Span], stream: int, horizon: int, lanes: int) -> EpochPlan:
    """Return the fixed course of a validation, at most `lanes` side by side; arrays (updates, lanes) of rows [samples].

    The state is carried through whole blocks. Lanes are about one stream long, so that the zero states at their starts
    weigh as little as in training.
    """
    longest = max((b - a for a, b in blocks), default=0)
    streams = cut_streams(blocks, max(longest, 1), horizon)
    total = sum(b - a for a, b in streams)
    return deal(streams, max(1, min(lanes, total // stream)), horizon)
