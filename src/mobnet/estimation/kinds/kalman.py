"""A disturbance Kalman filter of the generalised momentum, Wahrburg et al. 2018 (10.1109/TASE.2017.2717405).

Each joint has a state of two: its momentum p, whose rate is all known torque and d, and d, the external torque, which
walks at random. With T the sample time, f_k the known torque, w_k and n_k white:

    p_k = p_{k-1} + T (f_k + d_{k-1}),  d_k = d_{k-1} + sqrt(T) w_k,  measured: p_k + n_k

The noise does not change, so that the gains (k_1, k_2 / T) are those of the steady state. With the innovation T e_k,

    e_k = (1 - k_1) e_{k-1} + s_k - d_{k-1},  d_k = d_{k-1} + k_2 e_k,  s_k = (p_k - p_{k-1}) / T - f_k

so d is s behind k_2 / (1 - (2 - k_1 - k_2) / z + (1 - k_1) / z^2). The residual (9) is the same s behind the observer's
low-pass of first order, and what another method subtracts from it, such as friction, has passed that too. The estimate
is therefore that method's output behind the inverse of the low-pass and behind this filter.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import scipy  # its parts are imported where they are used first: the workflow imports kinds before it starts

from mobnet.core.arrays import Array
from mobnet.core.errors import ConfigError, misfit
from mobnet.estimation.filtered import FilteredEstimator
from mobnet.estimation.low_pass import exact_pole
from mobnet.estimation.methods import build_estimator
from mobnet.estimation.recipe import Recipe
from mobnet.settings.base import Positive, Section
from mobnet.settings.methods import Method
from mobnet.settings.reading import Place


class Options(Section):
    """Standard deviations of what is measured and of the walk of the torque in a second; their ratio alone matters."""

    momentum_nms: Positive
    walk_nm: Positive


def gains(options: Options, rate_hz: float) -> tuple[float, float]:
    """Return the gains k_1, k_2 [-] of the steady state at a rate [Hz]."""
    step = 1.0 / rate_hz
    transition, seen = np.array([[1.0, step], [0.0, 1.0]]), np.array([[1.0], [0.0]])
    walk, noise = np.diag([0.0, options.walk_nm**2 * step]), np.array([[options.momentum_nms**2]])
    ahead = scipy.linalg.solve_discrete_are(transition.T, seen, walk, noise)
    first, second = ahead[:, 0] / (ahead[0, 0] + noise[0, 0])
    return float(first), float(second * step)


def sections_of(options: Options, gain_hz: float, rate_hz: float) -> Array:
    """Return the inverse of the observer's low-pass of K_0 [1/s] and the filter as a second-order section (1, 6)."""
    (first, second), pole = gains(options, rate_hz), exact_pole(gain_hz, rate_hz)
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
