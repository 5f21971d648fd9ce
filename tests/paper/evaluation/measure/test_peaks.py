"""Share and delay of pushes whose estimate is known."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from made_swings import unseen

from experiments.evaluation.compare.pair import Pair
from experiments.evaluation.compare.scene import Scene, ShownPushes
from experiments.evaluation.measure.estimates.peaks import (
    BOUND,
    DELAY,
    OBSERVER,
    delays,
    first_above,
    measure,
    medians,
    never_half,
    push_rows,
    slopes,
    turned_joints,
)
from experiments.plan.runs import Run
from experiments.settings.measures import Peaks, Scoring
from experiments.settings.runs import PushedLimbRuns
from mobnet.core.columns import torque_columns
from mobnet.core.joints import JointLayout
from mobnet.core.recording import Recording, Sensed
from mobnet.core.recording_file import write_recording
from mobnet.core.store import write_array
from mobnet.kernel.low_pass import low_pass

TEST = PushedLimbRuns(scenario="knee_swing", level="ideal", methods=("MOB",), limbs=("LL",))
SETTINGS = Peaks(turned_share=0.5, before_s=0.03, after_s=0.05, longest_s=0.2, tests=(TEST,))
COUNTED = np.array([True])
GAIN_HZ = 100.0


def half_sine(size: float, rows: int = 78, length: int = 200) -> np.ndarray:
    """Return a push of one joint (length, 1) [N m] that begins after the first row."""
    push = np.zeros((length, 1))
    push[1 : rows + 1, 0] = size * np.sin(np.pi * (np.arange(rows) + 0.5) / rows)
    return push


@pytest.mark.parametrize("size", [40.0, -40.0])
def test_what_is_shown_of_a_push_is_the_slope_on_it(size: float) -> None:
    push = half_sine(size)
    behind = low_pass(push, 100.0, 1000.0)
    slow = 5.0 + 0.1 * np.arange(200)[:, None]  # an error that is constant or grows is no part of it
    shown = ShownPushes(push, behind, 0.8 * behind + slow)
    assert slopes(shown, [slice(0, 200)], [COUNTED]) == pytest.approx([0.8])


def test_noise_is_no_answer() -> None:
    """Its largest value in a window is as high as the push, its slope is not."""
    push = np.tile(half_sine(20.0), (50, 1))
    behind, noise = low_pass(push, 100.0, 1000.0), 20.0 * np.random.default_rng(3).normal(size=push.shape)
    windows = [slice(start, start + 200) for start in range(0, len(push), 200)]
    (found,) = slopes(ShownPushes(push, behind, noise), windows, [COUNTED] * 50)
    assert np.mean([noise[rows].max() for rows in windows]) > 2.0 * push.max()
    assert abs(found) < 0.1


def test_a_push_counts_for_the_joints_that_it_turns() -> None:
    first, second = half_sine(40.0), half_sine(10.0)
    push = np.concatenate([np.hstack([first, second]), np.hstack([second, first])])
    shown = ShownPushes(push, push, push * [0.9, 0.3])
    windows = [slice(0, 200), slice(200, 400)]
    turned = [turned_joints(push[rows], 0.5, np.array([True, True])) for rows in windows]
    assert [own.tolist() for own in turned] == [[True, False], [False, True]]
    np.testing.assert_allclose(slopes(shown, windows, turned), [0.9, 0.3])
    np.testing.assert_allclose(slopes(shown, windows[:1], turned[:1]), [0.9, np.nan])
    assert turned_joints(np.hstack([first, 2.0 * first]), 0.6, np.array([True, False])).tolist() == [True, False]


@pytest.mark.parametrize("size", [40.0, -40.0])
def test_a_lower_rise_that_comes_later_is_late_by_both(size: float) -> None:
    push = half_sine(size)
    shown = np.roll(0.8 * push, 7, axis=0) + 5.0
    late = (np.arcsin(0.5 / 0.8) - np.arcsin(0.5)) / np.pi * 78  # it reaches half of the true peak later, too
    assert delays(push, shown, COUNTED)[0] == pytest.approx(7 + late, abs=0.05)


def test_the_observers_low_pass_lags_by_about_ten_ms() -> None:
    push = half_sine(40.0)
    assert 8.0 < delays(push, low_pass(push, 100.0, 1000.0), COUNTED)[0] < 11.0


def test_a_rise_that_never_comes_ends_with_the_window() -> None:
    push = np.concatenate([half_sine(40.0), half_sine(19.0)], axis=1)
    found = delays(push, 0.3 * push, np.array([True, False]))
    assert found[0] == pytest.approx(199 - first_above(push[:, :1], 20.0)[0], abs=0.05)
    assert np.isnan(found[1])
    turned = np.array([True, False])
    np.testing.assert_array_equal(never_half(push, 0.3 * push, turned), [1.0, np.nan])
    np.testing.assert_array_equal(never_half(push, 0.6 * push, turned), [0.0, np.nan])


def test_windows_begin_before_the_push_and_end_after_it_or_at_the_longest_time() -> None:
    pushed = np.zeros(2000, dtype=bool)
    pushed[10:50] = pushed[400:1400] = pushed[1995:] = True
    pushed[1700:1710] = True
    rows = list(push_rows(pushed, ((0, 1600), (1700, 2000)), SETTINGS, 1000.0))
    assert [(one.start, one.stop) for one, _ in rows] == [(0, 100), (370, 600), (1965, 2000)]
    assert [(one.start, one.stop) for _, one in rows] == [(9, 100), (399, 600), (1994, 2000)]


def test_median_is_over_the_pushes_that_turn_a_joint() -> None:
    nan = np.nan
    found = medians([np.array([1.0, nan, nan]), np.array([3.0, 5.0, nan]), np.array([9.0, 7.0, nan])], 3)
    np.testing.assert_allclose(found, [3.0, 6.0, nan])
    assert np.isnan(medians([], 2)).all()


LATE, PUSHED_ROWS, SPAN = 7, (300, 380), 800


@pytest.mark.parametrize("rate_hz", [1000.0, 500.0])
def test_an_estimate_that_is_some_rows_late_is_late_by_their_time(
    rate_hz: float, tmp_path: Path, layout: JointLayout
) -> None:
    """A row lasts for 1 ms at 1 kHz, and for 2 ms at 500 Hz."""
    joint, rows = "LL3", np.arange(SPAN)
    start, end = PUSHED_ROWS
    pushed = (rows >= start) & (rows < end)
    push = np.zeros((SPAN, layout.nv))
    push[pushed, layout.columns([joint])] = 40.0
    truth = replace(unseen(layout, SPAN, np.zeros((SPAN, 4))), tau_push=push)
    truth.pushed[pushed, 0] = 1.0
    none, feet = np.zeros((SPAN, layout.nu)), np.zeros((SPAN, 2))
    q, v = np.zeros((SPAN, layout.nq)), np.zeros((SPAN, layout.nv))
    sensed = Sensed(q, v, np.zeros((SPAN, 3)), none, none, feet, np.zeros((SPAN, 5)), feet)
    stem, residual = tmp_path / "recording", tmp_path / "residual"
    write_recording(stem, Recording(sensed, ((0, SPAN),), rate_hz, {}, truth), layout)
    columns = torque_columns(layout, ["tau_ext_lp"], [joint])
    write_array(residual, np.zeros((SPAN, 1)), columns, {"rate_hz": rate_hz, "gain_hz": GAIN_HZ})
    scene = Scene(stem, layout, Scoring())
    behind = scene.behind(GAIN_HZ, [joint])
    run = Run("walk", "ideal", "MOB", 0, 1, stem, residual, tmp_path / "estimate")
    pair = Pair(run, (joint,), np.roll(behind, LATE, axis=0), behind, ((0, SPAN),), rate_hz)
    found = {one.metric: one.values for one in measure(pair, scene, SETTINGS)}
    assert found[DELAY] - found[DELAY + OBSERVER] == pytest.approx([LATE * 1000.0 / rate_hz], abs=1e-3)
    assert found[BOUND].tolist() == [0.0]
    weak = replace(pair, estimate=0.3 * pair.estimate)
    assert {one.metric: one.values for one in measure(weak, scene, SETTINGS)}[BOUND].tolist() == [1.0]
