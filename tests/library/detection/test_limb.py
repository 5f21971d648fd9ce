"""Thresholds of a limb: when it is watched, what recordings have to share, and how detectors of it compare."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mobnet.core.errors import DataError
from mobnet.core.estimator import Estimate
from mobnet.core.recording import ABSENT, SensedRecording
from mobnet.detection.limb import OwnRecording, calibrate_limb
from mobnet.detection.limb_report import beside, report

SECONDS, RATE_HZ = 240, 100.0
NO_PLAN = {ABSENT: ["swing", "landing"]}


@pytest.fixture(scope="module")
def recorded(walk):
    """Return a function that makes a recording of a leg with an estimate of it, whose torque grows with a size."""

    def make(meta=NO_PLAN, rate_hz=RATE_HZ, size=1.0, std=None):
        sensed, rng = walk(18), np.random.default_rng(0)
        rows = round(SECONDS * rate_hz)
        sensed = sensed[np.arange(rows) % len(sensed)]
        torque = size * rng.normal(size=(rows, 6))
        own = Estimate(torque, None if std is None else std * np.ones_like(torque))
        return OwnRecording(Path("log"), SensedRecording(sensed, ((0, rows),), rate_hz, meta), own)

    return make


@pytest.fixture(scope="module")
def calibrated(settings, robot):
    numbers = settings.detection.thresholds.model_copy(update={"resamples": 20})
    own = settings.model_copy(update={"detection": settings.detection.model_copy(update={"thresholds": numbers})})

    def run(*recordings, signal="mean"):
        return calibrate_limb(recordings, robot, "LL", signal, 20.0, own)

    return run


def test_a_leg_is_watched_all_the_time_where_recordings_do_not_tell_when_it_is_in_the_air(recorded, calibrated):
    found = calibrated(recorded())
    assert found.always is not None
    assert next(report(found, 0.95)) == "LL is watched all the time: the recordings do not tell when it is in the air"
    assert found.count >= 200


def test_some_recordings_that_tell_it_and_some_that_do_not_are_refused(recorded, calibrated):
    with pytest.raises(
        DataError, match=r"log: nothing is missing, and swing, landing in .*log; all need the same signals"
    ):
        calibrated(recorded(), recorded({}))


def test_a_rate_at_which_a_collision_has_no_two_samples_is_refused(recorded, calibrated):
    with pytest.raises(DataError, match=r"log: rate_hz is 5\.0; 26 Hz or more are needed, as collisions"):
        calibrated(recorded(rate_hz=5.0))


def test_detectors_are_compared_by_their_smallest_forces(recorded, calibrated):
    small, alone = (calibrated(recorded(size=size)) for size in (1.0, 4.0))
    assert small.over(alone) == pytest.approx(0.25, rel=1e-6)
    assert alone.over(alone) == 1.0
    lines = list(beside(small, alone))
    assert lines[-1] == "smallest forces with the network over those of the observer alone: 25%, geometric mean"
    assert list(beside(alone, small))[-1].startswith("the network does not help this detector")


def test_a_ratio_is_compared_by_the_torques_at_its_standard_deviations(recorded, calibrated):
    mean, ratio = (calibrated(recorded(std=0.5), signal=signal) for signal in ("mean", "ratio"))
    assert (ratio.thresholds == 2.0 * mean.thresholds).all()
    assert ratio.over(mean) == pytest.approx(1.0)
    half = np.where(np.arange(round(SECONDS * RATE_HZ)) % 2, 1.0, 0.1)[:, None]
    uneven = recorded(std=half)
    uneven = replace(uneven, estimate=replace(uneven.estimate, tau_ext=uneven.estimate.tau_ext * half))
    found = calibrated(uneven, signal="ratio")
    assert found.felt == pytest.approx(found.thresholds)  # most samples, and not the usual one


def test_without_points_torques_are_compared(recorded, calibrated):
    small, alone = (replace(calibrated(recorded(size=size)), forces={}) for size in (1.0, 2.0))
    assert small.over(alone) == pytest.approx(0.5, rel=1e-6)
    assert list(beside(small, alone))[-1].startswith("smallest torques with the network over those of the observer")
