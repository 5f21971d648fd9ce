"""The zero predictor: nothing touches the robot. What an estimator gains is gained over this."""

from collections.abc import Iterator, Sequence

import numpy as np

from mobnet.core.errors import misfit
from mobnet.core.estimator import Estimate
from mobnet.core.recording import Sensed
from mobnet.estimation.recipe import Recipe
from mobnet.formats.base import Section
from mobnet.formats.reading import Place
from mobnet.settings.methods import Method


class ZeroEstimator:
    """tau_e = 0 at every sample; `joints` (n,) are names of the estimated joints."""

    def __init__(self, joints: Sequence[str]) -> None:
        self.joints = tuple(joints)

    def init(self) -> None:
        """Return the state before the first sample, none."""

    def step(self, state: None, sample: Sensed) -> tuple[None, Estimate]:
        """Take one sample; return no state and zeros, (n,) [N, N m]."""
        return None, Estimate(np.zeros(len(self.joints)))

    def estimate(self, sensed: Sensed) -> Estimate:
        """Return zeros for one contiguous recording, (T, n) [N, N m]."""
        return Estimate(np.zeros((len(sensed), len(self.joints))))


def check(method: Method, options: Section, rate_hz: float) -> Iterator[tuple[Place, str]]:
    """Yield what is not accepted in the row of a method: it has nothing to learn or to fit."""
    if method.limbs or method.fitted or method.of:
        yield (), misfit("`limbs`, `fitted` or `of`", "`kind` alone")


def build(recipe: Recipe) -> ZeroEstimator:
    """Build the predictor for every joint of the robot."""
    return ZeroEstimator(recipe.layout.names)
