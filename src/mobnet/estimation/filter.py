"""Another estimator behind a linear filter: what the band-pass of section 5.3 and the Kalman filter share."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import scipy  # its parts are imported where they are used first: the workflow imports kinds before it starts

from mobnet.core.arrays import Array
from mobnet.core.estimator import Estimate, Stretch, TorqueEstimator, estimate_all
from mobnet.core.recording import Sensed

State = tuple[Any, Array]  # of the filtered method, and of the filter (sections, 2, n) [N, N m]


class FilteredEstimator:
    """tau_e of another estimator, same joints (n,), behind a causal filter at rest at first; no standard deviation."""

    def __init__(self, inner: TorqueEstimator, sections: Array) -> None:
        """Take the filter as second-order sections (sections, 6), as SciPy has them."""
        self.joints = inner.joints
        self._inner = inner
        self._sections = sections

    def init(self) -> State:
        """Return the state before the first sample."""
        return self._inner.init(), self._at_rest()

    def step(self, state: State, sample: Sensed) -> tuple[State, Estimate]:
        """Take one sample (1-D arrays); return the new state and the filtered tau_e, (n,) [N, N m]."""
        inner, estimate = self._inner.step(state[0], sample)
        filtered, after = scipy.signal.sosfilt(self._sections, estimate.tau_ext[None], axis=0, zi=state[1])
        return (inner, after), Estimate(filtered[0])

    def estimate(self, sensed: Sensed) -> Estimate:
        """Return the filtered tau_e of one contiguous recording, (T, n) [N, N m], from a fresh state."""
        (result,) = self.estimate_all([Stretch(sensed)])
        return result

    def estimate_all(self, stretches: Sequence[Stretch]) -> list[Estimate]:
        """Return the filtered tau_e of stretches, (T_i, n) [N, N m], each from a fresh state."""
        inner = estimate_all(self._inner, stretches)
        return [
            Estimate(scipy.signal.sosfilt(self._sections, whole.tau_ext, axis=0, zi=self._at_rest())[0])
            for whole in inner
        ]

    def _at_rest(self) -> Array:
        """Return the zero state of the filter, (sections, 2, n) [N, N m]."""
        return np.zeros((len(self._sections), 2, len(self.joints)))
