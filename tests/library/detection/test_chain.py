"""A ratio is how far a signal lies above its threshold for five samples in a row, behind a first-order low-pass."""

import numpy as np
import pytest

from mobnet.detection.chain import chain_state, low_passed, make_chain
from mobnet.detection.detector import GateSignal, run_over, run_segments

RATE_HZ = 1000.0


def ratios(signals, thresholds, watch=None, *, norm=False):
    always = GateSignal(np.ones(len(signals), dtype=bool), np.zeros(len(signals)))
    return run_over(make_chain(15.0, 0.005, RATE_HZ, thresholds, norm=norm), signals, watch or always).ratio


def test_the_low_pass_is_that_of_first_order():
    signal, out = np.ones((400, 1)), np.zeros((400, 1))
    low_passed(make_chain(15.0, 0.005, RATE_HZ, np.ones((1, 1))).pole, signal, out)
    time = (np.arange(400) + 1) / RATE_HZ
    np.testing.assert_allclose(out[:, 0], 1 - np.exp(-2 * np.pi * 15.0 * time), atol=1e-12)


def test_a_ratio_is_the_least_of_five_samples():
    signal = 10.0 * np.random.default_rng(0).normal(size=(500, 1))
    low = np.zeros((500, 1))
    low_passed(make_chain(15.0, 0.005, RATE_HZ, np.ones((1, 1))).pole, signal, low)
    size = np.abs(low[:, 0])
    expected = [size[k - 4 : k + 1].min() / 2.0 for k in range(4, 500)]
    np.testing.assert_allclose(ratios(signal, np.full((1, 1), 2.0))[4:], expected, rtol=1e-12)
    assert not ratios(signal, np.full((1, 1), 2.0))[:4].any()  # fewer than five samples are no time


def test_a_signal_is_held_for_a_sample_at_least():
    """At a rate at which the time to hold is shorter than half a sample."""
    assert [make_chain(15.0, 0.005, rate_hz, np.ones((1, 1))).hold for rate_hz in (10.0, 100.0, 1000.0)] == [1, 1, 5]


def test_the_highest_joint_counts_and_is_named():
    signals = np.zeros((300, 3))
    signals[100:, 1], signals[150:, 2] = 3.0, -9.0
    chain = make_chain(15.0, 0.005, RATE_HZ, np.ones((1, 3)))
    alarm = run_over(chain, signals, GateSignal(np.ones(300, dtype=bool), np.zeros(300)))
    assert alarm.ratio[299] == pytest.approx(9.0, rel=1e-3)
    assert (alarm.signal[140], alarm.signal[299]) == (1, 2)


def test_what_is_not_watched_counts_as_zero_for_five_samples():
    watched = np.ones(300, dtype=bool)
    watched[200] = False
    found = ratios(np.full((300, 1), 5.0), np.ones((1, 1)), GateSignal(watched, np.zeros(300)))
    assert found[199] > 4.9
    assert not found[200:205].any()
    assert found[205] > 4.9


def test_thresholds_follow_the_phase_of_the_swing():
    phase = np.linspace(0.0, 1.0, 400)
    found = ratios(np.full((400, 1), 4.0), np.array([[1.0], [2.0]]), GateSignal(np.ones(400, dtype=bool), phase))
    assert (found[190], found[390]) == (pytest.approx(4.0, rel=1e-3), pytest.approx(2.0, rel=1e-3))
    assert found[399] == pytest.approx(2.0, rel=1e-3)  # at the very end of the swing, which is in its last phase


def test_the_end_of_a_swing_has_the_threshold_of_its_last_phase():
    memory = np.array([[1.0], [2.0], [1e9]])  # what lies behind the thresholds is none
    found = ratios(np.full((300, 1), 4.0), memory[:2], GateSignal(np.ones(300, dtype=bool), np.ones(300)))
    assert found[-1] == pytest.approx(2.0, rel=1e-3)


def test_the_norm_is_the_length_of_all_signals():
    found = ratios(np.tile([3.0, -4.0], (300, 1)), np.full((1, 1), 2.0), norm=True)
    assert found[-1] == pytest.approx(2.5, rel=1e-3)


def test_each_segment_begins_at_rest():
    signals, watch = np.full((600, 1), 4.0), GateSignal(np.ones(600, dtype=bool), np.zeros(600))
    chain = make_chain(15.0, 0.005, RATE_HZ, np.ones((1, 1)))
    found = run_segments(chain, signals, watch, ((0, 300), (300, 600))).ratio
    np.testing.assert_array_equal(found[:300], found[300:])
    assert chain_state(chain, 1).low.tolist() == [0.0]
