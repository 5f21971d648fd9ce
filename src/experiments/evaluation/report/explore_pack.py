"""Arrays of a page as text: whole numbers, differences over time, byte planes, gzip, base64.

A page unpacks them with the `DecompressionStream` that browsers have. Differences of neighbouring samples are small, so
that their upper bytes are nearly all alike, and are packed together.
"""

import base64
import gzip
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.errors import DataError

LARGEST = 2**15 - 1  # of a whole number of 16 bits


@dataclass(frozen=True)
class PackedArray:
    """An array (T, n) of a page: its name, and the step of its whole numbers in its own unit."""

    name: str
    step: float
    values: NDArray[Any]

    @property
    def place(self) -> dict[str, Any]:
        """What a page must know to unpack it."""
        return {"name": self.name, "step": self.step, "count": len(self.values), "width": self.values.shape[1]}


def packed(parts: Iterable[PackedArray]) -> str:
    """Return arrays one after the other as text, the same for equal ones.

    Raises:
        DataError: a value is more than 32767 steps.
    """
    return base64.b64encode(gzip.compress(b"".join(map(_planes, parts)), 9, mtime=0)).decode()


def _planes(part: PackedArray) -> bytes:
    """Return an array column by column as differences, first all their lower and then all their upper bytes."""
    whole = np.round(np.asarray(part.values, dtype=np.float64) / part.step).T
    if whole.size and np.abs(whole).max() > LARGEST:
        largest = float(np.abs(part.values).max())
        raise DataError(f"{part.name}: {largest:g} is not accepted; accepted: up to {LARGEST * part.step:g}")
    # A difference may exceed 16 bits; it wraps around, and so does its sum.
    steps = np.diff(whole.astype(np.int64), axis=1, prepend=0).astype("<u2", casting="unsafe")
    return np.ascontiguousarray(steps).view(np.uint8).reshape(-1, 2).T.tobytes()
