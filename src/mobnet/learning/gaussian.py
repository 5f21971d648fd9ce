"""Goodness of Gaussian predictions: coverage, likelihood and the continuous ranked probability score."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr, ndtri

from mobnet.core.arrays import Array


@dataclass(frozen=True)
class Fit:
    """Measures of n predicted torques over their samples.

    Attributes:
        coverage: share of errors inside the central interval of each nominal share (k, n).
        nll: mean negative logarithm of the predicted density (n,) [nats], of torques in [N m], V1..V3 in [N].
        crps: mean continuous ranked probability score (n,) [N m], V1..V3 [N].
    """

    coverage: Array
    nll: Array
    crps: Array


def fit_of(error: NDArray[Any], std: NDArray[Any], shares: Sequence[float]) -> Fit:
    """Return how well errors (T, n) [N m] fit predicted standard deviations (T, n) [N m]; nominal shares (k,)."""
    return Fit(coverage(error, std, shares), likelihood(error, std), ranked_score(error, std))


def half_width(share: float) -> float:
    """Return half the width of the central interval that holds a share of a Gaussian, in standard deviations."""
    # (N25): the share outside lies in two tails.
    return float(ndtri((1.0 + share) / 2.0))


def coverage(error: NDArray[Any], std: NDArray[Any], shares: Sequence[float]) -> Array:
    """Return the share of errors (T, n) [N m] inside each central interval, (k, n)."""
    ratio = np.abs(error) / std
    return np.array([(ratio <= half_width(share)).mean(axis=0) for share in shares])


def likelihood(error: NDArray[Any], std: NDArray[Any]) -> Array:
    """Return the mean negative log-likelihood of errors (T, n) [N m], (n,) [nats]: (21) with its constants."""
    # Half of (N16) and the constant of (20), which a loss can leave out but numbers of nats cannot.
    square = np.square(error / std).mean(axis=0, dtype=np.float64)
    return 0.5 * (np.log(2.0 * np.pi) + square) + np.log(std).mean(axis=0, dtype=np.float64)


def ranked_score(error: NDArray[Any], std: NDArray[Any]) -> Array:
    """Return the mean CRPS of errors (T, n) [N m], (n,) [N m]: closed form of Gneiting et al. 2005, 10.1175/MWR2904.1.

    It is the mean absolute error that a prediction without spread would have, and in the unit of the torque.
    """
    z = error / std  # zeta of (N28)
    density = np.exp(-0.5 * np.square(z)) / np.sqrt(2.0 * np.pi)
    return (std * (z * (2.0 * ndtr(z) - 1.0) + 2.0 * density - 1.0 / np.sqrt(np.pi))).mean(axis=0, dtype=np.float64)
