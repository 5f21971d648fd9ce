"""A disturbance Kalman filter of the generalised momentum, Wahrburg et al. 2018 (10.1109/TASE.2017.2717405).

It is computed as a filter on the output of another method, (O15) to (O18) of docs/notes/observer.md.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import scipy  # its parts are imported where they are used first: the workflow imports kinds before it starts

from mobnet.core.arrays import Array
from mobnet.core.errors import ConfigError, misfit
from mobnet.estimation.filter import FilteredEstimator
from mobnet.estimation.kinds import build_estimator
from mobnet.estimation.recipe import Recipe
from mobnet.formats.base import Positive, Section
from mobnet.formats.reading import Place
from mobnet.kernel.low_pass import exact_pole
from mobnet.settings.methods import Method


class Options(Section):
    """Standard deviations of what is measured and of the walk of the torque in a second; their ratio alone matters."""

    momentum_nms: Positive
    walk_nm: Positive


def gains(options: Options, rate_hz: float) -> tuple[float, float]:
    """Return the gains k_1, k_2 [-] of the steady state at a rate [Hz]."""
    step = 1.0 / rate_hz
    # (O15): d adds to the momentum's rate, and the momentum alone is measured.
    transition = np.array([[1.0, step], [0.0, 1.0]])
    seen = np.array([[1.0], [0.0]])
    walk = np.diag([0.0, options.walk_nm**2 * step])
    noise = np.array([[options.momentum_nms**2]])
    # (O16): the noise does not change, so neither do the gains; the first samples alone would have others.
    ahead = scipy.linalg.solve_discrete_are(transition.T, seen, walk, noise)
    first, second = ahead[:, 0] / (ahead[0, 0] + noise[0, 0])
    return float(first), float(second * step)


def sections_of(options: Options, gain_hz: float, rate_hz: float) -> Array:
    """Return the inverse of the observer's low-pass of K_0 [1/s] and the filter as a second-order section (1, 6)."""
    (first, second) = gains(options, rate_hz)
    pole = exact_pole(gain_hz, rate_hz)
    # (O18): the zero undoes the observer's low-pass, the poles are those of (O17).
    scale = second / (1.0 - pole)
    return np.array([[scale, -scale * pole, 0.0, 1.0, first + second - 2.0, 1.0 - first]])


def check(method: Method, options: Options, rate_hz: float) -> Iterator[tuple[Place, str]]:
    """Yield what is not accepted in the row of a method: it filters a method that subtracts from the residual."""
    if method.of is None:
        yield ("of",), misfit("no `of`", "a method whose estimate is the residual less what it explains")


def build(recipe: Recipe) -> FilteredEstimator:
    """Build the filter on the method that `of` names."""
    if recipe.method.of is None:
        raise ConfigError(f"method {recipe.name!r} of kind 'kalman' names no method to filter; accepted: `of`")
    inner = build_estimator(replace(recipe, name=recipe.method.of))
    return FilteredEstimator(inner, sections_of(recipe.options(Options), recipe.observing.gain_hz, recipe.rate_hz))
