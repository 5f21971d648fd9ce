"""MOB-fric-BPF of section 5.3: another method's output through a band-pass, as a signal that detects collisions.

The band-pass removes whatever changes slowly: errors of the model, but also a steady load. Its output is therefore no
estimate of the external torque, only of its changes.
"""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import scipy  # its parts are imported where they are used first: the workflow imports kinds before it starts
from pydantic import Field

from mobnet.core.arrays import Array
from mobnet.core.errors import ConfigError, misfit
from mobnet.core.estimator import Estimate, Estimator
from mobnet.core.recording import Sensed
from mobnet.estimation.methods import build_estimator
from mobnet.estimation.recipe import Recipe
from mobnet.settings.base import Positive, Section, Span, Whole
from mobnet.settings.methods import Method
from mobnet.settings.reading import Place

State = tuple[Any, Array]  # of the filtered method, and of the filter (sections, 2, n) [N, N m]


class Options(Section):
    """Cut-off frequencies, and the order of the low-pass that the band-pass is made from, with twice as many poles."""

    band_hz: Span[Positive]
    order: Whole = Field(ge=1, le=20)


class BandPassEstimator:
    """tau_e of another estimator, same joints (n,), behind a causal Butterworth band-pass; no standard deviation."""

    def __init__(self, inner: Estimator, band_hz: tuple[float, float], order: int, rate_hz: float) -> None:
        """Design the filter: cut-off frequencies [Hz], [2, 15] in section 5.3, and the order of the low-pass behind it.

        Raises:
            ConfigError: the band is empty, or does not lie below half the rate.
        """
        low, high = band_hz
        if not 0 < low < high < rate_hz / 2:
            raise ConfigError(f"band_hz: {[low, high]} is not accepted; accepted: 0 < low < high < {rate_hz / 2}")
        self.joints = inner.joints
        self._inner = inner
        self._sections: Array = np.asarray(
            scipy.signal.butter(order, (low, high), "bandpass", fs=rate_hz, output="sos")
        )

    def init(self) -> State:
        """Return the state before the first sample: a filter at rest."""
        return self._inner.init(), self._at_rest()

    def step(self, state: State, sample: Sensed) -> tuple[State, Estimate]:
        """Take one sample (1-D arrays); return the new state and the band's part of tau_e, (n,) [N, N m]."""
        inner, estimate = self._inner.step(state[0], sample)
        filtered, after = scipy.signal.sosfilt(self._sections, estimate.tau_ext[None], axis=0, zi=state[1])
        return (inner, after), Estimate(filtered[0])

    def estimate(self, sensed: Sensed) -> Estimate:
        """Return the band's part of tau_e of one contiguous recording, (T, n) [N, N m], from a fresh state."""
        whole = self._inner.estimate(sensed).tau_ext
        return Estimate(scipy.signal.sosfilt(self._sections, whole, axis=0, zi=self._at_rest())[0])

    def _at_rest(self) -> Array:
        """Return the zero state of the filter, (sections, 2, n) [N, N m]."""
        return np.zeros((len(self._sections), 2, len(self.joints)))


def check(method: Method, options: Options, rate_hz: float) -> Iterator[tuple[Place, str]]:
    """Yield what is not accepted in the row of a method: it filters another one, below half the rate [Hz]."""
    if method.of is None:
        yield ("of",), misfit("no `of`", "the method whose output is filtered")
    if options.band_hz[1] >= rate_hz / 2:
        yield ("options", "band_hz", 1), misfit(options.band_hz[1], f"below half of data_hz, {rate_hz / 2}")


def build(recipe: Recipe) -> BandPassEstimator:
    """Build the band-pass and the method that `of` names."""
    options = recipe.options(Options)
    if recipe.method.of is None:
        raise ConfigError(f"method {recipe.name!r} of kind 'band_pass' names no method to filter; accepted: `of`")
    inner = build_estimator(replace(recipe, name=recipe.method.of))
    return BandPassEstimator(inner, options.band_hz, options.order, recipe.rate_hz)
