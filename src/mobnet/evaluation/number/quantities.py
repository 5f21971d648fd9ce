"""What a claim is about: a number made of the means over runs of some cells."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mobnet.evaluation.number.intervals import Combine, first

Means = NDArray[np.float64]


@dataclass(frozen=True)
class Quantity:
    """A number made of K means, (K, ...) -> (...).

    Attributes:
        made: makes the number of the means [their unit, or - for ratios].
        equality: the number where no cell stands out from the others; None where none are compared.
    """

    made: Combine
    equality: float | None = None


def least_ratio(means: Means) -> Means:
    """Return the smallest of the ratios (...) [-] of the first half of means (K, ...) to the second."""
    half = len(means) // 2
    return (means[:half] / means[half:]).min(axis=0)


def falls(means: Means) -> Means:
    """Return how steadily means (K, ...) fall (...) [-]: share of pairs with the later one lower less higher."""
    earlier, later = np.triu_indices(len(means), 1)
    return np.sign(means[earlier] - means[later]).mean(axis=0)


QUANTITIES: Mapping[str, Quantity] = {
    "value": Quantity(first),
    "ratio": Quantity(lambda means: means[0] / means[1], 1.0),
    "cut": Quantity(lambda means: 1.0 - means[0] / means[1], 0.0),
    "difference": Quantity(lambda means: means[0] - means[1], 0.0),
    "below": Quantity(lambda means: means[1:].min(axis=0) - means[0], 0.0),
    "above": Quantity(lambda means: means[0] - means[1:].max(axis=0), 0.0),
    "falls": Quantity(falls, 0.0),
    "least ratio": Quantity(least_ratio, 1.0),
    "gap ratio": Quantity(lambda means: abs(means[0] - means[1]) / abs(means[2] - means[3]), 1.0),
}
