"""The picture of a log: a line of a long log goes through its extremes, and is broken where a segment ends."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.figure import Figure

from mobnet.formats.loading import load_section
from mobnet.formats.robot import RobotTable
from mobnet.robot.description import describe
from mobnet.robotlog.plot import FOOT, MOST_POINTS, plot_flags, plot_residual

ROWS = 100_000


@pytest.fixture
def drawn(monkeypatch):
    """The figures that are saved."""
    figures = list[Figure]()
    save = Figure.savefig

    def kept(figure, *args, **kwargs):
        figures.append(figure)
        save(figure, *args, **kwargs)

    monkeypatch.setattr(Figure, "savefig", kept)
    return figures


@pytest.fixture
def line(tmp_path, drawn):
    """Return a function of a residual (T, 2) in two segments that draws it and returns the line of the first joint."""
    layout = describe(load_section(Path("tests/data/arm.yaml"), RobotTable)).layout

    def draw(residual):
        half = len(residual) // 2
        read = SimpleNamespace(segments=((0, half), (half, len(residual))), rate_hz=1000.0)
        plot_residual(read, residual, None, layout, tmp_path / "residual")
        return drawn[0].axes[0].lines[0].get_xydata()

    return draw


def test_a_push_of_one_sample_in_a_long_log_is_seen(line):
    residual = np.zeros((ROWS, 2))
    residual[ROWS // 3, 0] = 50.0
    xy = line(residual)
    assert len(xy) <= MOST_POINTS + 4
    assert np.nanmax(xy[:, 1]) == 50.0
    assert xy[np.nanargmax(xy[:, 1]), 0] == pytest.approx(ROWS / 3000.0, abs=0.1)


def test_a_short_log_is_drawn_sample_by_sample_and_broken_between_its_segments(line):
    residual = np.random.default_rng(0).normal(size=(200, 2))
    xy = line(residual)
    np.testing.assert_array_equal(np.flatnonzero(np.isnan(xy[:, 1])), [100, 201])
    np.testing.assert_array_equal(xy[~np.isnan(xy[:, 1]), 1], residual[:, 0])


def test_pushes_that_the_log_tells_are_seen_below_the_flags(drawn, tmp_path):
    time_s = np.arange(100) / 100.0
    found = SimpleNamespace(joints=("J1", "J2"), thresholds=(1.0, 2.0), signal="mean")
    pushed = np.zeros(100, dtype=bool)
    pushed[20:31] = True

    def bars(pushed):
        plot_flags(time_s, ((0, 100),), np.zeros((100, 2)), (), found, pushed, tmp_path / "flags")
        return [[patch.get_bbox().bounds for patch in axis.patches] for axis in drawn[-1].axes]

    assert bars(None) == [[], []]
    for (bar,) in bars(pushed):
        assert bar == pytest.approx((0.2, 0.0, 0.1, FOOT))
