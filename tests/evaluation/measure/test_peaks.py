"""Peak ratio and delay of pushes whose estimate is known."""

import numpy as np
import pytest

from mobnet.estimation.low_pass import low_pass
from mobnet.evaluation.measure.estimates.peaks import first_above, medians, push_rows, rises
from mobnet.settings.evaluation import Peaks, PushedLimbRuns

TEST = PushedLimbRuns(scenario="knee_swing", level="ideal", methods=("MOB",), limbs=("LL",))
SETTINGS = Peaks(turned_share=0.5, after_s=0.05, longest_s=0.2, tests=(TEST,))
COUNTED = np.array([True])


def half_sine(size: float, rows: int = 78, length: int = 200) -> np.ndarray:
    """Return a push of one joint (length, 1) [N m] that begins after the first row."""
    push = np.zeros((length, 1))
    push[1 : rows + 1, 0] = size * np.sin(np.pi * (np.arange(rows) + 0.5) / rows)
    return push


@pytest.mark.parametrize("size", [40.0, -40.0])
def test_a_share_that_comes_later_has_that_ratio_and_delay(size: float) -> None:
    push = half_sine(size)
    shown = np.roll(0.8 * push, 7, axis=0) + 5.0  # a constant error is no part of the rise
    ratio, delay = rises(push, shown, 0.5, COUNTED)
    assert ratio[0] == pytest.approx(0.8, abs=1e-6)
    alone, _ = rises(push, 0.8 * push, 0.5, COUNTED)
    late = (np.arcsin(0.5 / 0.8) - np.arcsin(0.5)) / np.pi * 78  # a lower rise reaches half the true peak later, too
    assert alone[0] == pytest.approx(0.8, abs=1e-6)
    assert delay[0] == pytest.approx(7 + late, abs=0.05)


def test_the_observers_low_pass_lags_by_ten_ms_under_a_ramp_and_lowers_a_short_peak() -> None:
    """Of a half-sine of 78 ms at 100 1/s: the largest value of the lag's closed form."""
    push = half_sine(40.0)
    ratio, delay = rises(push, low_pass(push, 100.0, 1000.0), 0.5, COUNTED)
    omega, k = np.pi / 0.078, 100.0
    t = np.linspace(0.0, 0.1, 10_001)
    closed = k * (k * np.sin(omega * t) - omega * np.cos(omega * t) + omega * np.exp(-k * t)) / (k**2 + omega**2)
    assert ratio[0] == pytest.approx(closed[t < 0.078].max(), abs=0.005)
    assert 8.0 < delay[0] < 11.0


def test_a_joint_that_is_hardly_turned_does_not_count_and_a_rise_that_never_comes_ends_with_the_window() -> None:
    push = np.concatenate([half_sine(40.0), half_sine(19.0), half_sine(90.0)], axis=1)
    ratio, delay = rises(push, 0.3 * push, 0.5, np.array([True, True, False]))
    assert ratio[0] == pytest.approx(0.3)
    assert np.isnan([ratio[1:], delay[1:]]).all()
    assert delay[0] == pytest.approx(199 - first_above(push[:, :1], 20.0)[0], abs=0.05)


def test_windows_begin_before_the_push_and_end_after_it_or_at_the_longest_time() -> None:
    pushed = np.zeros(2000, dtype=bool)
    pushed[100:150] = pushed[400:1400] = pushed[1995:] = True
    pushed[1700:1710] = True
    rows = list(push_rows(pushed, ((0, 1600), (1700, 2000)), SETTINGS, 1000.0))
    assert [(one.start, one.stop) for one in rows] == [(99, 200), (399, 600), (1994, 2000)]


def test_median_is_over_the_pushes_that_turn_a_joint() -> None:
    nan = np.nan
    found = medians([np.array([1.0, nan, nan]), np.array([3.0, 5.0, nan]), np.array([9.0, 7.0, nan])], 3)
    np.testing.assert_allclose(found, [3.0, 6.0, nan])
    assert np.isnan(medians([], 2)).all()
