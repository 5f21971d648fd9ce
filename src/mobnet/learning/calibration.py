"""A factor per joint on the predicted standard deviation, learned on validation data alone, after the training.

docs/notes/0035-networks.md derives (N25) to (N27), note 0017 compares them on walks.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.learning.gaussian import Fit, fit_of, half_width
from mobnet.learning.model import LimbNetwork
from mobnet.learning.optimisation import Samples, predictions
from mobnet.learning.streams import EpochPlan


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
    errors = []
    stds = []
    for mean, std, target in predictions(network, samples, plan, horizon):
        errors.append((mean - target).cpu())
        stds.append(std.cpu())
    error, std = (torch.cat(parts).transpose(0, 1).flatten(0, 1).double().numpy() for parts in (errors, stds))
    return error, std
