"""Pushes that a simulated log tells: which flags lie in them, and their bands in the picture of the residual."""

from dataclasses import replace

import matplotlib.image
import numpy as np
import pytest

from mobnet.core.estimator import Estimate
from mobnet.robotlog.detected import LogDetection
from mobnet.robotlog.detecting import report_lines
from mobnet.robotlog.flags import Flag, PushCount, found_pushes, pushed_rows
from mobnet.robotlog.observe import ObservedLog, converted_log, main

ROWS = 3000
SPANS = (500, 600), (1000, 1400), (2000, 2050)


@pytest.fixture
def pushed(clean, stored):
    """Store a log that tells three pushes, the last one on another limb."""
    table = clean[:ROWS].assign(pushed=0.0, **{"tau_ext.J1": 0.0, "tau_ext.J2": 0.0})
    for k, (start, end) in enumerate(SPANS):
        table.loc[start : end - 1, "pushed"] = 1.0
        table.loc[start : end - 1, "tau_ext.J2" if k < 2 else "tau_ext.other"] = 3.0
    return stored(table.fillna(0.0))


def flag(start_s, end_s):
    return Flag(start_s, end_s, "J1", 1.5, None)


def test_flags_are_counted_beside_the_pushes_of_the_limb(pushed, arm, settings):
    found = converted_log(pushed, arm.layout, None, settings.robotlog)
    assert np.flatnonzero(np.diff(pushed_rows(found, ("J1", "J2")))).tolist() == [499, 599, 999, 1399]
    flags = [flag(0.2, 0.3), flag(0.52, 0.55), flag(0.57, 0.58), flag(1.45, 1.5), flag(2.01, 2.02)]
    assert found_pushes(found, ("J1", "J2"), flags, late_s=0.1) == (2, 2, 2)
    assert found_pushes(found, ("J1", "J2"), flags, late_s=0.0) == (2, 1, 3)
    assert found_pushes(found, ("J1", "J2"), [], late_s=0.1) == (2, 0, 0)


@pytest.mark.parametrize(
    ("counted", "line"),
    [
        (PushCount(23, 17, 1), "17 of 23 pushes found, 1 other flag"),
        (PushCount(2, 2, 0), "2 of 2 pushes found, 0 other flags"),
    ],
)
def test_detect_tells_how_many_pushes_it_found(counted, line, pushed, arm, settings):
    observed = ObservedLog(converted_log(pushed, arm.layout, None, settings.robotlog), np.empty((0, 2)), ())
    made = LogDetection(observed, Estimate(np.empty((0, 2))), np.empty((0, 2)), (), counted)
    assert list(report_lines(made))[-1] == line
    assert not any("found" in one for one in report_lines(replace(made, found=None)))


def test_a_log_without_the_truth_counts_nothing(clean, stored, arm, settings):
    found = converted_log(stored(clean[:100]), arm.layout, None, settings.robotlog)
    assert found_pushes(found, ("J1", "J2"), [], late_s=0.1) is None


def test_the_residual_has_a_panel_for_each_joint_with_bands_of_pushes(pushed, saying, tmp_path):
    status, _ = saying(main, pushed, "--robot", "tests/data/arm.yaml", "--out", tmp_path / "seen")
    assert status == 0
    picture = matplotlib.image.imread(tmp_path / "seen" / "residual.png")[..., :3]
    is_band = (picture[..., 0] > 0.95) & (picture[..., 2] < 0.8) & (picture[..., 1] > 0.8)
    rows = is_band.sum(axis=1) > 20
    assert np.flatnonzero(np.diff(rows)).size // 2 >= 2
