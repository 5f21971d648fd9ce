"""MOB-fric-BPF of section 5.3: another method's output through a band-pass, as a signal that detects collisions.

The band leaves out what changes slowly, an error of the model and just so a steady load: what comes out of it is no
estimate of the external torque, only of how that changes.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.signal import butter, sosfilt

from mobnet.core.errors import ConfigError
from mobnet.core.estimator import Estimate, Estimator
from mobnet.core.recording import Sensed
from mobnet.estimation.methods import build_estimator
from mobnet.estimation.recipe import Recipe

Array = NDArray[np.float64]
State = tuple[Any, Array]  # of the filtered method, and of the filter (sections, 2, n) [N, N m]


class BandPassEstimator:
    """tau_e of another estimator behind a Butterworth band-pass, causal, without a standard deviation.

    Attributes:
        joints: names of the other estimator's joints, (n,).
    """

    def __init__(self, inner: Estimator, band_hz: tuple[float, float], order: int, rate_hz: float) -> None:
        """Design the filter.

        Args:
            inner: estimator to filter.
            band_hz: lower and upper cut-off frequency [Hz], [2, 15] in section 5.3.
            order: of the low-pass that the band-pass is made from; the band-pass has twice as many poles.
            rate_hz: samples per second [Hz].

        Raises:
            ConfigError: the band is empty, or does not lie below half the rate.
        """
        low, high = band_hz
        if not 0 < low < high < rate_hz / 2:
            raise ConfigError(f"band_hz: {[low, high]} is not accepted; accepted: 0 < low < high < {rate_hz / 2}")
        self.joints = inner.joints
        self._inner = inner
        self._sections: Array = np.asarray(butter(order, (low, high), "bandpass", fs=rate_hz, output="sos"))

    def init(self) -> State:
        """Return the state before the first sample: a filter at rest."""
        return self._inner.init(), self._at_rest()

    def step(self, state: State, sample: Sensed) -> tuple[State, Estimate]:
        """Take one sample (1-D arrays); return the new state and the band's part of tau_e, (n,) [N, N m]."""
        inner, estimate = self._inner.step(state[0], sample)
        filtered, after = sosfilt(self._sections, estimate.tau_ext[None], axis=0, zi=state[1])
        return (inner, after), Estimate(filtered[0])

    def estimate(self, sensed: Sensed) -> Estimate:
        """Return the band's part of tau_e of one contiguous recording, (T, n) [N, N m], from a fresh state."""
        whole = self._inner.estimate(sensed).tau_ext
        return Estimate(sosfilt(self._sections, whole, axis=0, zi=self._at_rest())[0])

    def _at_rest(self) -> Array:
        """Return the zero state of the filter, (sections, 2, n) [N, N m]."""
        return np.zeros((len(self._sections), 2, len(self.joints)))


def build(recipe: Recipe) -> BandPassEstimator:
    """Build the band-pass and the method that the row's `of` names.

    Raises:
        ConfigError: the row names no band or no method, or the other method cannot be built.
        DataError: a file of the other method is missing or damaged.
    """
    row = recipe.row
    if "of" not in row or "band_hz" not in row:
        raise ConfigError(f"method {recipe.method!r} of kind 'band_pass': accepted: `of`, `band_hz` and `order`")
    inner = build_estimator(recipe.config, row["of"], recipe.networks, recipe.level, recipe.rate_hz, recipe.fitted)
    return BandPassEstimator(inner, row["band_hz"], row["order"], recipe.rate_hz)
