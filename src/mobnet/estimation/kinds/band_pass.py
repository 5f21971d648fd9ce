"""MOB-fric-BPF of section 5.3: another method's output through a band-pass, as a signal that detects collisions.

The band-pass removes whatever changes slowly: errors of the model, but also a steady load. Its output is therefore no
estimate of the external torque, only of its changes.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import scipy  # its parts are imported where they are used first: the workflow imports kinds before it starts
from pydantic import Field

from mobnet.core.arrays import Array
from mobnet.core.errors import ConfigError, misfit
from mobnet.estimation.filter import FilteredEstimator
from mobnet.estimation.kinds import build_estimator
from mobnet.estimation.recipe import Recipe
from mobnet.formats.base import Positive, Section, Span, Whole
from mobnet.formats.reading import Place
from mobnet.settings.methods import Method


class Options(Section):
    """Cut-off frequencies, and the order of the low-pass that the band-pass is made from, with twice as many poles."""

    band_hz: Span[Positive]
    order: Whole = Field(ge=1, le=20)


def sections_of(band_hz: tuple[float, float], order: int, rate_hz: float) -> Array:
    """Return a Butterworth band-pass as second-order sections (order, 6).

    Cut-off frequencies are in [Hz], [2, 15] in section 5.3; the order is that of the low-pass behind it.

    Raises:
        ConfigError: the band is empty, or does not lie below half the rate.
    """
    low, high = band_hz
    if not 0 < low < high < rate_hz / 2:
        raise ConfigError(f"band_hz: {[low, high]} is not accepted; accepted: 0 < low < high < {rate_hz / 2}")
    return np.asarray(scipy.signal.butter(order, (low, high), "bandpass", fs=rate_hz, output="sos"))


def check(method: Method, options: Options, rate_hz: float) -> Iterator[tuple[Place, str]]:
    """Yield what is not accepted in the row of a method: it filters another one, below half the rate [Hz]."""
    if method.of is None:
        yield ("of",), misfit("no `of`", "the method whose output is filtered")
    if options.band_hz[1] >= rate_hz / 2:
        yield ("options", "band_hz", 1), misfit(options.band_hz[1], f"below half of data_hz, {rate_hz / 2}")


def build(recipe: Recipe) -> FilteredEstimator:
    """Build the band-pass and the method that `of` names."""
    options = recipe.options(Options)
    if recipe.method.of is None:
        raise ConfigError(f"method {recipe.name!r} of kind 'band_pass' names no method to filter; accepted: `of`")
    inner = build_estimator(replace(recipe, name=recipe.method.of))
    return FilteredEstimator(inner, sections_of(options.band_hz, options.order, recipe.rate_hz))
