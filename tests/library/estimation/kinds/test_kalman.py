"""The disturbance Kalman filter against a filter by the book, with covariances, and against closed forms."""

import numpy as np
import pytest
import scipy.signal

from mobnet.core.errors import ConfigError
from mobnet.estimation.kinds import build_estimator
from mobnet.estimation.kinds.kalman import Options, build, check, gains, sections_of
from mobnet.estimation.observe import observer_of
from mobnet.kernel.low_pass import exact_pole, filter_in_place
from mobnet.robot.description import describe
from mobnet.settings.methods import Method

RATE_HZ, GAIN_HZ = 1000.0, 100.0
OPTIONS = Options(momentum_nms=0.3, walk_nm=2000.0)


def by_the_book(options, measured, known):
    """Return d (T,) [N m] from momentum (T,) and the known torque (T,) of the interval before, long after the start."""
    step = 1 / RATE_HZ
    transition, seen = np.array([[1.0, step], [0.0, 1.0]]), np.array([[1.0, 0.0]])
    walk, noise = np.diag([0.0, options.walk_nm**2 * step]), options.momentum_nms**2
    state, covariance, found = np.array([measured[0], 0.0]), np.diag([noise, 1.0]), []
    for _ in range(3000):  # to the steady state, before any measurement
        ahead = transition @ covariance @ transition.T + walk
        gain = ahead @ seen.T / (seen @ ahead @ seen.T + noise)
        covariance = (np.eye(2) - gain @ seen) @ ahead
    for p, f in zip(measured[1:], known[1:], strict=True):
        state = transition @ state + [step * f, 0.0]
        state = state + gain[:, 0] * (p - state[0])
        found.append(state[1])
    return np.array([0.0, *found])


def test_it_is_the_filter_by_the_book_on_what_the_observer_filters_at_first_order():
    rng = np.random.default_rng(0)
    disturbance, known = rng.standard_normal((2, 400)).cumsum(axis=1)
    momentum = np.cumsum(disturbance + known) / RATE_HZ + 0.05 * rng.standard_normal(400)
    raw = np.concatenate([[0.0], np.diff(momentum) * RATE_HZ - known[1:]])
    residual = filter_in_place(raw[:, None].copy(), exact_pole(GAIN_HZ, RATE_HZ))
    ours = scipy.signal.sosfilt(sections_of(OPTIONS, GAIN_HZ, RATE_HZ), residual, axis=0)[:, 0]
    np.testing.assert_allclose(ours, by_the_book(OPTIONS, momentum, known), atol=1e-8 * np.abs(ours).max())


def test_its_filter_alone_passes_a_steady_torque_whole_and_is_of_second_order():
    """In continuous time the poles lie at sqrt(walk / noise) rad/s in size, damped by 1 / sqrt(2)."""
    first, second = gains(OPTIONS, RATE_HZ)
    poles = np.roots([1.0, first + second - 2.0, 1.0 - first])
    size = np.sqrt(OPTIONS.walk_nm / OPTIONS.momentum_nms * np.sqrt(RATE_HZ))
    rates = np.log(poles) * RATE_HZ
    np.testing.assert_allclose(np.abs(rates), size, rtol=0.1)
    np.testing.assert_allclose(-rates.real / np.abs(rates), np.sqrt(0.5), rtol=0.1)
    _, response = scipy.signal.sosfreqz(sections_of(OPTIONS, GAIN_HZ, RATE_HZ), [0.0])
    np.testing.assert_allclose(response, 1.0)


@pytest.mark.parametrize("factor", [0.1, 10.0])
def test_the_ratio_alone_matters(factor):
    scaled = Options(momentum_nms=factor * OPTIONS.momentum_nms, walk_nm=factor * OPTIONS.walk_nm)
    np.testing.assert_allclose(gains(scaled, RATE_HZ), gains(OPTIONS, RATE_HZ), rtol=1e-6)


def test_on_the_observer_it_estimates_the_torque_before_the_low_pass(settings, recipe_of, made_up):
    """With hardly any noise d is the torque of the last interval, which the residual follows late."""
    row = Method(kind="kalman", of="MOB", options={"momentum_nms": 1e-6, "walk_nm": 1e3})
    recipe = recipe_of("quick", "ideal", methods={"MOB": settings.methods["MOB"], "quick": row})
    recording = made_up(0, 0.3)
    given = settings.levels["ideal"].nominal_mass_ratio, settings.plant.gravity_m_s2, GAIN_HZ, RATE_HZ
    residual = observer_of(describe(settings.robot), *given).residual(recording.sensed)
    pole = exact_pole(GAIN_HZ, RATE_HZ)
    raw = np.diff(residual, axis=0, prepend=0.0) * pole / (1 - pole) + residual
    found = build_estimator(recipe).estimate(recording.sensed).tau_ext
    np.testing.assert_allclose(found, raw, atol=0.02 * np.abs(raw).max())


def test_it_needs_a_method_to_filter(settings, recipe_of):
    row = Method(kind="kalman", options=dict(OPTIONS))
    ((place, text),) = check(row, OPTIONS, RATE_HZ)
    assert place == ("of",)
    assert text.startswith("no `of` is not accepted")
    with pytest.raises(ConfigError, match="names no method to filter"):
        build(recipe_of("alone", methods={**settings.methods, "alone": row}))
