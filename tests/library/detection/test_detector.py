"""Step by step a detector says what it says of the whole recording, within the time of a tick."""

import time

import numpy as np
import pytest
from made_swings import AIR, GROUND, RATE_HZ

from mobnet.core.estimator import Estimate
from mobnet.detection.chain import make_chain
from mobnet.detection.detector import ALARM_RATIO, LegDetector
from mobnet.detection.signals import Watched, whitening_of
from mobnet.kernel.detecting import WatchedSignals

STEP_S = 50e-6  # a step may take
ROWS = {
    "mean": WatchedSignals(signals=("mean",)),
    "OR": WatchedSignals(signals=("mean", "std")),
    "ratio": WatchedSignals(signals=("ratio",)),
    "norm": WatchedSignals(signals=("mean",), norm=True),
    "phases": WatchedSignals(signals=("mean", "std"), phases=8),
    "command": WatchedSignals(signals=("mean",), commanded=True),
}


def detector_of(row, gate, estimate):
    """Return a detector with thresholds that noise crosses now and then."""
    whitening, slopes = (whitening_of(estimate.tau_ext) if row.norm else None), np.full((6, 3), 2.0)
    watched = Watched(row, slopes if row.commanded else None, whitening)
    thresholds = np.full((row.phases, len(watched.names([f"LL{k}" for k in range(1, 7)]))), 1.5)
    return LegDetector(watched, gate, make_chain(15.0, 0.005, RATE_HZ, thresholds, norm=row.norm))


@pytest.fixture
def estimate(walk):
    """An estimate of two swings: noise that changes slowly, and its standard deviation."""
    rng, count = np.random.default_rng(4), len(walk(2))
    slow = np.repeat(4.0 * rng.normal(size=(count // 50 + 1, 6)), 50, axis=0)[:count]
    return Estimate(slow.astype(np.float32), rng.uniform(1.0, 2.0, (count, 6)).astype(np.float32))


@pytest.mark.parametrize("name", ROWS)
def test_in_steps_it_says_the_same_at_the_same_sample(name, gate, walk, estimate):
    sensed, detector = walk(2), detector_of(ROWS[name], gate, estimate)
    whole = detector.run(gate.run(sensed, estimate.tau_ext), sensed, estimate)
    state, std = detector.init(), estimate.std
    assert std is not None
    for k in range(len(sensed)):
        one = Estimate(estimate.tau_ext[k], std[k])
        alarm = detector.step(state, sensed[k], one, estimate.tau_ext[k])
        assert alarm.ratio == pytest.approx(whole.ratio[k], rel=1e-9)
        assert (alarm.ratio > ALARM_RATIO) == (whole.ratio[k] > ALARM_RATIO)
        assert alarm.signal == whole.signal[k]
    over = whole.ratio > ALARM_RATIO
    assert over.any()
    assert not over[:GROUND].any()
    assert not over[GROUND + AIR : 2 * GROUND + AIR].any()


def test_a_step_takes_a_twentieth_of_a_tick(gate, walk, estimate):
    sensed, detector = walk(1), detector_of(ROWS["OR"], gate, estimate)
    samples = [sensed[k] for k in range(GROUND, GROUND + AIR)]
    assert estimate.std is not None
    one = Estimate(estimate.tau_ext[0], estimate.std[0])
    state, best = detector.init(), np.inf
    for _ in range(5):
        start = time.process_time()
        for sample in samples:
            detector.step(state, sample, one, one.tau_ext)
        best = min(best, (time.process_time() - start) / len(samples))
    assert best < STEP_S
