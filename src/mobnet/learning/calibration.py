"""A factor per joint on the predicted standard deviation, learned on validation data alone, after the training.

docs/notes/networks.md derives (N25) to (N27), docs/notes/sigma.md compares them on walks.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr, ndtri

from mobnet.core.arrays import Array
from mobnet.learning.model import LimbNetwork
from mobnet.learning.optimisation import Samples, predictions
from mobnet.learning.streams import EpochPlan


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


@dataclass(frozen=True)
class StdFactors:
    """Factors that correct the standard deviations of n joints, and how well these fit before and after.

    Attributes:
        scale: factor on the standard deviation (n,).
        likelihood_scale: factor that would make the data most likely (n,); for comparison only.
        before: fit of the standard deviations as learned, on the second half of the data.
        after: fit of the scaled ones there, with factors that the first half gives.
    """

    scale: Array
    likelihood_scale: Array
    before: Fit
    after: Fit

    def note(self, joints: Sequence[str], shares: Sequence[float]) -> dict[str, Any]:
        """Return it as JSON for `run.json`, with the names of the joints (n,) and the nominal shares (k,)."""
        before = {name: values.tolist() for name, values in vars(self.before).items()}
        after = {name: values.tolist() for name, values in vars(self.after).items()}
        return {
            "joints": list(joints),
            "shares": list(shares),
            "scale": self.scale.tolist(),
            "likelihood_scale": self.likelihood_scale.tolist(),
            "before": before,
            "after": after,
        }


def calibrate(error: NDArray[Any], std: NDArray[Any], share: float, shares: Sequence[float]) -> StdFactors:
    """Learn the factors; test those of the first half of the data on the second half.

    Errors and predicted standard deviations are (T, n) [N m], in the order of time. `share` is the share of the errors
    that a central interval shall hold; the coverage is measured at the nominal `shares` (k,).
    """
    # A factor fits the data that it was learned from better than any others, so it is tested on the other half.
    cut = len(error) // 2
    halved = scale_for(error[:cut], std[:cut], share)
    # The second factor is (N26), what (22) itself would ask for.
    return StdFactors(
        scale_for(error, std, share),
        np.sqrt(np.square(error / std).mean(axis=0)),
        fit_of(error[cut:], std[cut:], shares),
        fit_of(error[cut:], std[cut:] * halved, shares),
    )


def scale_for(error: NDArray[Any], std: NDArray[Any], share: float) -> Array:
    """Return the factor (n,) on std (T, n) [N m] that puts a share of errors (T, n) [N m] into its interval."""
    # (N27): the size of the few large errors at touch-downs has no say in a quantile.
    return np.quantile(np.abs(error) / std, share, axis=0) / half_width(share)


def predict(network: LimbNetwork, samples: Samples, plan: EpochPlan, horizon: int) -> tuple[Array, Array]:
    """Run a network through a validation, rows (updates, lanes) and `horizon` steps together, its state carried.

    Return error and standard deviation, z-scored, (T, n) each, lane after lane: in the order of time.
    """
    lanes = plan.rows.shape[1]
    shape = (lanes, len(plan) * horizon, samples.targets.shape[1])
    # In one array each: the small tensors of all updates, kept one by one, would scatter the memory between them.
    error, std = np.empty(shape), np.empty(shape)
    for k, (mean, deviation, target) in enumerate(predictions(network, samples, plan, horizon)):
        steps = slice(k * horizon, (k + 1) * horizon)
        error[:, steps] = (mean - target).transpose(0, 1).cpu().numpy()
        std[:, steps] = deviation.transpose(0, 1).cpu().numpy()
    return error.reshape(-1, shape[2]), std.reshape(-1, shape[2])


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
    block = [inside[row : row + rows][free[row : row + rows]] for row in starts]
    return np.array([part.mean() if len(part) else np.nan for part in block])
