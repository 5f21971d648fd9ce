"""Whether networks know their robot: nothing touches a swinging leg, so its estimate should lie within its sigma."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.learning.gaussian import half_width


def hanging(
    swing: NDArray[Any], spans: Sequence[tuple[int, int]], rate_hz: float, lift_off_s: float, landing_s: float
) -> NDArray[np.bool_]:
    """Return where a foot surely hangs in the air (T,), from the walking plan's swing (T,): without its two ends.

    After a foot should have lifted off it may still touch the ground for some time [s], and before it should land it
    may have landed; spans (start, end) hang together, and the end of one ends a swing.
    """
    after, before = round(lift_off_s * rate_hz), round(landing_s * rate_hz)
    found = np.zeros(len(swing), dtype=bool)
    for start, end in spans:
        edges = np.flatnonzero(np.diff(np.asarray(swing[start:end]) > 0, prepend=False, append=False))
        for lifted, landed in start + edges.reshape(-1, 2):
            found[lifted + after : max(landed - before, lifted + after)] = True
    return found


def shares_inside(
    estimate: NDArray[Any], std: NDArray[Any], free: NDArray[np.bool_], spans: Sequence[tuple[int, int]], rows: int,
    share: float,
) -> Array:  # fmt: skip
    """Return for windows of some rows the share of estimates in their central interval of a nominal share (k,).

    Estimates and standard deviations are of a leg's joints, (T, n) each [N m], and count where the leg is free (T,). A
    network that knows its robot has about the nominal share; one that does not is further from zero than it says.
    Windows follow each other within a span (start, end); one in which the leg is never free is nan.
    """
    inside = (np.abs(estimate) <= half_width(share) * std).mean(axis=1)
    starts = [row for start, end in spans for row in range(start, end - rows + 1, rows)]
    held = [inside[row : row + rows][free[row : row + rows]] for row in starts]
    return np.array([part.mean() if len(part) else np.nan for part in held])
