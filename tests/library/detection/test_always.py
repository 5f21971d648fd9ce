"""Limbs that are watched all the time: windows that are independent, and intervals that hold the rate as they say."""

import numpy as np
import pytest
from scipy.signal import lfilter

from mobnet.core.errors import ConfigError, DataError
from mobnet.core.estimator import Estimate
from mobnet.core.recording import Sensed, SensedRecording
from mobnet.detection.always import alike, always_on, always_watched, setup_of, windows_of
from mobnet.detection.calibration import QuietWalk, rate_scales, swing_heights
from mobnet.detection.signals import Watched
from mobnet.detection.watch import LegSetup
from mobnet.kernel.detecting import WatchedSignals

RATE_HZ, SECONDS = 10.0, 1800
RECORDINGS, RESAMPLES = 40, 60
WATCHED = Watched(WatchedSignals(signals=("mean",)))


def slow(rng, rows, lasts_s, spread=0.25):
    """Return a torque (T, 2) [N m] whose size is lognormal and lasts for some time."""
    pole = np.exp(-1.0 / (lasts_s * RATE_HZ))
    noise = lfilter([np.sqrt(1.0 - pole**2)], [1.0, -pole], rng.normal(size=(rows + 1000, 2)), axis=0)[1000:]
    return np.exp(spread * noise)


@pytest.fixture
def recorded(arm):
    def make(torque, segments=None):
        rows, joints, none = len(torque), np.zeros((len(torque), 2)), np.zeros((len(torque), 0))
        sensed = Sensed(joints, joints, none, joints, joints, none, none, none)
        return SensedRecording(sensed, segments or ((0, rows),), RATE_HZ, {}), Estimate(torque)

    return make


@pytest.fixture
def arm_setup(settings, arm):
    numbers = {"least_swings": 200, "resamples": RESAMPLES, "rates_per_h": {"own": 6.0}}
    numbers["confidence"] = settings.robotlog.percentiles
    thresholds = settings.detection.thresholds.model_copy(update=numbers)
    return setup_of(settings.detection.model_copy(update={"thresholds": thresholds}), arm, "A", RATE_HZ)


def test_legs_swing_and_other_limbs_do_not(settings, robot, arm_setup):
    assert isinstance(setup_of(settings.detection, robot, "RL", RATE_HZ), LegSetup)
    assert not isinstance(setup_of(settings.detection, robot, "RA", RATE_HZ), LegSetup)
    assert arm_setup.joints == ("J1", "J2")
    with pytest.raises(ConfigError, match="limb: 'X' is not accepted"):
        setup_of(settings.detection, robot, "X", RATE_HZ)


def test_windows_fill_what_is_watched_and_lie_in_one_segment():
    gate = always_on(100, ((0, 47), (47, 52), (60, 100)), settle_s=1.0, rate_hz=RATE_HZ)
    assert not gate.watched[:10].any()
    assert gate.watched[10:47].all()
    assert not gate.watched[47:70].any()
    assert windows_of(gate.watched, ((0, 47), (47, 52), (60, 100)), 15) == ((10, 25), (25, 40), (70, 85), (85, 100))


@pytest.mark.parametrize(("lasts_s", "shortest"), [(0.02, 1.0), (1.0, 4.0)])
def test_windows_are_longer_where_errors_last(lasts_s, shortest, recorded, arm_setup):
    read, estimate = recorded(slow(np.random.default_rng(0), round(4 * SECONDS * RATE_HZ), lasts_s))
    found = always_watched(arm_setup, WATCHED, [None], [read], [estimate], 1.0, 0.5)
    window_s, (limb,) = found.window_s, found.limbs
    assert window_s == 1.0 if shortest == 1.0 else window_s >= shortest
    assert not found.is_alike
    assert limb.episodes == limb.swings
    assert {end - start for start, end in limb.swings} == {round(window_s * RATE_HZ)}


def test_a_recording_that_is_too_short_for_longer_windows_says_that_they_are_alike(recorded, arm_setup):
    read, estimate = recorded(slow(np.random.default_rng(0), round(300 * RATE_HZ), 30.0))
    found = always_watched(arm_setup, WATCHED, [None], [read], [estimate], 1.0, 0.5)
    assert (found.window_s, found.is_alike) == (1.0, True)


def test_numbers_that_rise_and_fall_are_alike_and_independent_ones_are_not():
    rng = np.random.default_rng(2)
    assert alike([np.exp(np.sin(np.arange(300) / 10))[:, None]])
    assert not alike([rng.lognormal(size=(300, 3))])
    assert not alike([np.ones((300, 1))])
    assert not alike([rng.lognormal(size=(1, 2)) for _ in range(30)])  # no window follows another


def test_signals_and_windows_that_are_always_zero_do_not_decide_whether_windows_are_alike():
    slowly = np.exp(np.sin(np.arange(300) / 10))[:, None]
    assert not alike([np.zeros((300, 1))])
    assert alike([np.hstack([slowly, np.zeros((300, 1))])])
    begun = np.concatenate([np.zeros((20, 1)), slowly])  # nothing was measured at first
    assert alike([begun])


def test_too_short_a_recording_is_one_line_that_says_how_long_it_must_be(recorded, arm_setup):
    read, estimate = recorded(slow(np.random.default_rng(0), round(100 * RATE_HZ), 0.02))
    message = "99 s of free motion, in windows of 1 s; 200 s or more are needed"
    with pytest.raises(DataError, match=message):
        always_watched(arm_setup, WATCHED, [None], [read], [estimate], 1.0, 0.5)


@pytest.mark.slow
@pytest.mark.parametrize("lasts_s", [0.05, 0.5], ids=["short", "lasting"])
def test_the_interval_holds_the_rate_as_often_as_it_says(lasts_s, recorded, arm_setup):
    """Half an hour each; the true rate is that of a recording of two days."""
    whole = slow(np.random.default_rng(99), round(96 * SECONDS * RATE_HZ), lasts_s)
    low = arm_setup.low_passed(whole, ((0, len(whole)),))
    held, rates = 0, []
    for seed in range(RECORDINGS):
        read, estimate = recorded(slow(np.random.default_rng(seed), round(SECONDS * RATE_HZ), lasts_s))
        always = always_watched(arm_setup, WATCHED, [None], [read], [estimate], 1.0, 0.5)
        walk = QuietWalk.of(arm_setup, "", always.limbs, [estimate], share=1.0)
        scales, promises = rate_scales(arm_setup, WATCHED, walk, swing_heights(arm_setup, WATCHED, walk))
        above = (np.abs(low) / (promises["own"].factor * scales[0])).max(axis=1)
        length = round(always.window_s * RATE_HZ)
        alarms = (above[: len(above) // length * length].reshape(-1, length).max(axis=1) > 1.0).sum()
        rates.append(alarms / (len(above) / RATE_HZ / 3600.0))
        held += promises["own"].low <= rates[-1] <= promises["own"].high
    assert held >= 0.88 * RECORDINGS
    assert 3.0 < np.median(rates) < 12.0
