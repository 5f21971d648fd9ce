"""Pushes that are planted into recordings that nothing pushes, and which detector is kept by what it finds of them."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mobnet.core.estimator import Estimate
from mobnet.core.recording import Sensed, SensedRecording
from mobnet.detection.choice import (
    ALONE,
    BARE,
    NETWORK,
    SEED,
    DetectorCandidate,
    best_of,
    lines_of,
    pushing_of,
    tried_on_pushes,
)
from mobnet.detection.detector import GateSignal
from mobnet.detection.limb import OwnRecording, calibrate_limb
from mobnet.detection.planted import PushPlan, found_pushes, plant
from mobnet.detection.signals import Watched
from mobnet.detection.watch import LegRecording, LimbSetup
from mobnet.kernel.detecting import WatchedSignals
from mobnet.kernel.low_pass import low_pass
from mobnet.robot.nominal import NominalModel

SECONDS, RATE_HZ, GAIN_HZ, RATE_PER_H = 240, 100.0, 100.0, 60.0
ROWS = round(SECONDS * RATE_HZ)


@pytest.fixture(scope="module")
def quick(settings):
    """The settings with fewer recordings drawn anew."""
    numbers = settings.detection.thresholds.model_copy(update={"resamples": 20})
    return settings.model_copy(update={"detection": settings.detection.model_copy(update={"thresholds": numbers})})


@pytest.fixture(scope="module")
def tried(arm, quick):
    """Return a function that calibrates a detector on noise of a size [N m] while the arm sways, in two segments."""
    t, none = np.arange(ROWS)[:, None] / RATE_HZ, np.zeros((ROWS, 0))
    q, zero = 0.5 * np.sin(t * [1.0, 1.7]), np.zeros((ROWS, 2))
    sensed = Sensed(q, zero, none, zero, zero, swing=none, command=none, landing=none)
    read = SensedRecording(sensed, ((0, ROWS // 2), (ROWS // 2, ROWS)), RATE_HZ, {"absent": ["swing", "landing"]})
    noise = np.random.default_rng(0).normal(size=(ROWS, 2))

    def make(size, name=ALONE, **options):
        own = [OwnRecording(Path("log"), read, Estimate(size * noise, np.ones((ROWS, 2))))]
        return DetectorCandidate(name, calibrate_limb(own, arm, "A", "mean", RATE_PER_H, quick), own, **options)

    return make


def test_pushes_have_the_sizes_and_times_of_a_simulated_log_and_stay_in_their_segments(tried, arm, quick):
    one, nominal = tried(1.0), NominalModel(arm)
    poses = [own.read.sensed.q for own in one.own]
    planted = plant(one.found.setup, nominal, GAIN_HZ, one.found.limbs, poses, pushing_of(quick), SEED)
    again = plant(one.found.setup, nominal, GAIN_HZ, one.found.limbs, poses, pushing_of(quick), SEED)
    assert sum(len(own.spans) for own in planted) >= quick.robotlog.planted
    assert all((own.torque == other.torque).all() for own, other in zip(planted, again, strict=True))
    high = quick.free_motion.pushes.torque_share[1]
    late = round(quick.robotlog.flag_gap_s * RATE_HZ)
    for own in planted:
        for start, end in own.spans:
            load = np.abs(own.torque[start:end] / arm.torque_limits).max()
            assert 0.0 < load <= high  # some are limited by the arm's weight
            assert any(first <= start and end <= last for first, last in one.own[0].read.segments)
        short, long = (quick.free_motion.pushes.short_s[0] * RATE_HZ, quick.free_motion.pushes.long_s[1] * RATE_HZ)
        assert all(short - 1 <= end - start <= long + late + 1 for start, end in own.spans)


def test_an_estimate_without_error_finds_every_push_and_a_high_threshold_none(tried, arm, quick):
    one = tried(1.0)
    poses = [own.read.sensed.q for own in one.own]
    planted = plant(one.found.setup, NominalModel(arm), GAIN_HZ, one.found.limbs, poses, pushing_of(quick), SEED)
    watched, perfect = Watched(WatchedSignals(signals=("mean",))), [Estimate(np.zeros((ROWS, 2)))]
    for threshold, share in ((1e-3, 1.0), (1e6, 0.0)):
        thresholds = np.full(2, threshold)
        hits = found_pushes(one.found.setup, watched, thresholds, one.found.limbs, perfect, planted)
        assert hits.mean() == share


def test_the_detector_is_kept_that_finds_most_at_the_same_rate_of_false_alarms(tried, quick):
    rows = [tried(40.0, BARE, may_be_kept=False), tried(16.0), tried(8.0, NETWORK.format("mean"))]
    total, counts = tried_on_pushes(rows, GAIN_HZ, quick)
    assert total >= quick.robotlog.planted
    assert counts == sorted(counts)
    assert counts[0] < counts[1] < counts[2] <= total
    rows = [replace(one, pushes=count) for one, count in zip(rows, counts, strict=True)]
    kept = best_of(rows, rows[1].found)
    assert kept.name == "network, mean"
    told = list(lines_of(rows, kept, total))
    assert told[-1] == "kept, as it finds most: network, mean"
    assert [line.split()[-2] for line in told[2:5]] == [str(count) for count in counts]


def test_of_detectors_that_find_as_many_the_one_is_kept_that_feels_less(tried):
    rows = [replace(tried(4.0), pushes=7), replace(tried(2.0, NETWORK.format("mean")), pushes=7)]
    assert best_of(rows, rows[0].found).name == "network, mean"


def test_a_table_whose_friction_hides_pushes_is_told_and_not_kept(tried):
    rows = [replace(tried(1.0, BARE, may_be_kept=False), pushes=9), replace(tried(2.0), pushes=7)]
    kept = best_of(rows, rows[1].found)
    assert kept.name == ALONE
    *_, last = lines_of(rows, kept, 10)
    assert last == "the observer without the table's friction finds more: take a table without `friction`"


@pytest.fixture
def plant_one(arm, quick):
    """Return a function of segments and numbers of pushes -> torques (T, 2) of planted pushes, and their spans."""

    def make(segments, late_s=0.0, **numbers):
        rows = segments[-1][1]
        gate = GateSignal(np.ones(rows, dtype=bool), np.zeros(rows))
        limb = LegRecording(Path("log"), segments, np.zeros((rows, 0)), gate, (), ())
        setup = LimbSetup(quick.detection, arm, "A", RATE_HZ)
        known = {"pause_s": (0.0, 0.0), "torque_share": (0.1, 0.1), "weight_share": 10.0, **numbers}
        pushes = quick.free_motion.pushes.model_copy(update=known)
        poses = [np.full((rows, 2), 0.3)]
        (found,) = plant(setup, NominalModel(arm), GAIN_HZ, [limb], poses, PushPlan(1, pushes, late_s), SEED)
        return found.torque, found.spans

    return make


def test_an_alarm_counts_late_but_not_behind_the_end_of_the_segment(plant_one):
    """A push may end with its segment, and what follows is another walk."""
    times = {"short_s": (1.0, 1.0), "long_s": (1.0, 1.0)}
    for late_s in (0.0, 0.5):
        assert plant_one(((0, 100), (100, 200)), late_s, **times)[1] == ((0, 100), (100, 200))
    assert plant_one(((0, 130), (130, 260)), 0.2, **times)[1] == ((0, 120), (130, 250))


@pytest.mark.parametrize(
    ("rows", "ramp_s", "shape"),
    [
        (8, 0.02, [0.5, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.5]),
        (8, 0.0, [1.0] * 8),  # a ramp takes a row at least
        (6, 1.0, [1 / 3, 2 / 3, 1.0, 1.0, 2 / 3, 1 / 3]),  # and half of the push at most
        (2, 1.0, [1.0, 1.0]),
    ],
    ids=["ramps", "no ramp", "long ramp", "two rows"],
)
def test_a_push_grows_and_fades_as_a_trapezoid(rows, ramp_s, shape, plant_one):
    times = {"short_s": (rows / RATE_HZ, rows / RATE_HZ), "long_s": (rows / RATE_HZ, rows / RATE_HZ)}
    at_once, _ = plant_one(((0, rows),), ramp_s=0.0, **times)
    torque, spans = plant_one(((0, rows),), ramp_s=ramp_s, **times)
    assert spans == ((0, rows),)
    whole, expected = (low_pass(np.array(each)[:, None], GAIN_HZ, RATE_HZ) for each in ([1.0] * rows, shape))
    np.testing.assert_allclose(torque, expected * (at_once[-1] / whole[-1]))


def test_a_push_of_one_row_has_its_whole_size(plant_one):
    """Half of it is no row, over which nothing can grow."""
    times = {"short_s": (1.0 / RATE_HZ, 1.0 / RATE_HZ), "long_s": (1.0 / RATE_HZ, 1.0 / RATE_HZ), "ramp_s": 1.0}
    torque, spans = plant_one(((0, 3),), **times)
    assert spans == ((0, 1), (1, 2), (2, 3))
    assert np.abs(torque[1:]).max(axis=1).min() > 0.0


def test_a_push_is_as_large_as_asked_or_as_the_robot_s_weight_allows(plant_one, arm):
    times = {"short_s": (1.0, 1.0), "long_s": (1.0, 1.0), "ramp_s": 0.0}
    whole, _ = plant_one(((0, 100),), torque_share=(0.1, 0.1), **times)
    assert np.abs(whole[-1] / arm.torque_limits).max() == pytest.approx(0.1)
    light, _ = plant_one(((0, 100),), torque_share=(0.1, 0.1), weight_share=1e-3, **times)
    lighter, _ = plant_one(((0, 100),), torque_share=(0.1, 0.1), weight_share=5e-4, **times)
    assert np.abs(light[-1] / arm.torque_limits).max() < 0.1
    np.testing.assert_allclose(light, 2.0 * lighter)
