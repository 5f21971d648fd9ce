"""Whether networks know their robot: nothing touches a swinging leg, so its estimate should lie within its sigma."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.learning.gaussian import half_width


def shares_inside(
    estimate: NDArray[Any],
    std: NDArray[Any],
    free: NDArray[np.bool_],
    spans: Sequence[tuple[int, int]],
    rows: int,
    share: float,
) -> Array:
    """Return for windows of some rows the share of estimates in their central interval of a nominal share (k,).

    Estimates and standard deviations are of a leg's joints, (T, n) each [N m], and count where the leg is free (T,). A
    network that knows its robot has about the nominal share; one that does not is further from zero than it says.
    Windows follow each other within a span (start, end); one in which the leg is never free is nan.
    """
    inside = (np.abs(estimate) <= half_width(share) * std).mean(axis=1)
    starts = list[int]()
    for start, end in spans:
        starts += range(start, end - rows + 1, rows)
    held = [inside[row : row + rows][free[row : row + rows]] for row in starts]
    return np.array([part.mean() if len(part) else np.nan for part in held])
