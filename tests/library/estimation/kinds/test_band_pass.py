"""The band-pass of MOB-fric-BPF: what it lets through, and what it cannot tell."""

import numpy as np
import pytest

from mobnet.core.errors import ConfigError
from mobnet.core.estimator import Estimate
from mobnet.estimation.filter import FilteredEstimator
from mobnet.estimation.kinds import build_estimator
from mobnet.estimation.kinds.band_pass import sections_of
from mobnet.settings.methods import Method

RATE_HZ, BAND_HZ, ORDER = 1000.0, (2.0, 15.0), 2
SECTIONS = sections_of(BAND_HZ, ORDER, RATE_HZ)


class Given:
    """Estimates a torque that the test gives, one value a sample; it counts samples as its state."""

    joints = ("LL3", "LL4")

    def __init__(self, torque):
        self.torque = np.stack([torque, -torque], axis=1)

    def init(self):
        return 0

    def step(self, state, sample):
        return state + 1, Estimate(self.torque[state])

    def estimate(self, sensed):
        return Estimate(self.torque, np.ones_like(self.torque))


def passed(torque, sensed):
    return FilteredEstimator(Given(torque), SECTIONS).estimate(sensed).tau_ext[:, 0]


@pytest.mark.parametrize(("frequency_hz", "smallest", "largest"), [
    (0.2, 0.0, 0.03), (2.0, 0.69, 0.72), (5.5, 0.97, 1.001), (15.0, 0.69, 0.72), (100.0, 0.0, 0.05),
])  # fmt: skip
def test_gain_over_frequency(frequency_hz, smallest, largest, made_up):
    """One inside the band, 1 / sqrt 2 at its edges, small outside."""
    sensed = made_up(0, 15.0).sensed
    time = np.arange(len(sensed)) / RATE_HZ
    settled = passed(np.sin(2 * np.pi * frequency_hz * time), sensed)[-5000:]
    assert smallest <= np.sqrt(2 * np.mean(settled**2)) <= largest


def test_a_steady_load_fades(made_up):
    """It cannot estimate the constant part: a step shows, then tends to zero."""
    sensed = made_up(0, 3.0).sensed
    seen = passed(np.full(len(sensed), 30.0), sensed)
    assert seen.max() > 15.0
    assert np.abs(seen[-1000:]).max() < 0.05


def test_it_has_no_std_and_the_joints_of_what_it_filters(made_up):
    sensed = made_up(0, 0.2).sensed
    estimator = FilteredEstimator(Given(np.zeros(len(sensed))), SECTIONS)
    assert estimator.estimate(sensed).std is None
    assert estimator.joints == Given.joints


@pytest.mark.parametrize("band_hz", [(0.0, 15.0), (15.0, 2.0), (2.0, 500.0)])
def test_bands_that_cannot_be_are_refused(band_hz):
    with pytest.raises(ConfigError, match=r"band_hz: .* accepted: 0 < low < high < 500"):
        sections_of(band_hz, ORDER, RATE_HZ)


@pytest.mark.parametrize(("change", "message"), [
    ({"of": None}, "method 'b' of kind 'band_pass' names no method to filter; accepted: `of`"),
    ({"options": {}}, "methods.b.options.band_hz: key is missing; .*\nmethods.b.options.order: key is missing; "),
])  # fmt: skip
def test_a_method_without_another_one_or_a_band_is_refused(change, message, recipe_of):
    whole = {"kind": "band_pass", "of": "MOB", "options": {"band_hz": list(BAND_HZ), "order": ORDER}}
    methods = {"MOB": Method(kind="residual"), "b": Method.model_validate({**whole, **change})}
    with pytest.raises(ConfigError, match=message):
        build_estimator(recipe_of("b", methods=methods))
