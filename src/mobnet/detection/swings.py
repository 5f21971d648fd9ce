"""Swings of a leg in a recording, and the largest numbers in each."""

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.detection.gate import IN_THE_AIR

Spans = tuple[tuple[int, int], ...]


def swings_of(swing: NDArray[Any], segments: Sequence[tuple[int, int]]) -> Spans:
    """Return the rows (start, end) of each whole swing in contiguous segments of the walking plan's swing (T,)."""
    found: list[tuple[int, int]] = []
    for start, end in segments:
        air = np.asarray(swing[start:end]) > IN_THE_AIR
        edges = np.flatnonzero(np.diff(air)) + 1 + start
        # Half a swing has not had its largest value yet, and would make false alarms look rarer than they are.
        lifted = edges[1:] if len(edges) and air[0] else edges
        found += [(int(a), int(b)) for a, b in lifted[: len(lifted) // 2 * 2].reshape(-1, 2)]
    return tuple(found)


def episodes_of(walks: Iterable[tuple[Spans, Spans]]) -> list[int]:
    """Return the contiguous segment of each swing, counted over recordings: their segments and swings in order."""
    found = list[int]()
    before = 0
    for segments, swings in walks:
        found += [before + segment_of(swing, segments) for swing in swings]
        before += len(segments)
    return found


def segment_of(swing: tuple[int, int], segments: Spans) -> int:
    """Return in which of some segments a swing lies."""
    return next(k for k, (_, end) in enumerate(segments) if swing[1] <= end)


def largest(values: NDArray[Any], swings: Sequence[tuple[int, int]]) -> Array:
    """Return the largest numbers (k, ...) of values (T, ...) in each of k swings."""
    shape = (len(swings), *values.shape[1:])
    return np.array([values[start:end].max(axis=0) for start, end in swings], dtype=np.float64).reshape(shape)
