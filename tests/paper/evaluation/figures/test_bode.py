"""Gain and phase are drawn at the lines of each joint, relative to the observer's low-pass."""

from collections.abc import Callable, Sequence
from itertools import product
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from csv_files import check_golden, read_table
from numpy.typing import NDArray

from experiments.evaluation.figures.further.bode import ENDS, REFERENCE, bode, draw_bode
from experiments.settings.evaluation import Evaluation
from experiments.settings.runs import LimbRuns
from experiments.settings.settings import Settings
from mobnet.core.arrays import Array
from mobnet.core.joints import JointLayout

METRICS = {"gain_0.5hz": (0.9, "-"), "phase_0.5hz": (-5.0, "deg"), "gain_2hz": (0.5, "-"), "phase_2hz": (-40.0, "deg")}


def test_numbers_stand_at_the_frequency_that_is_injected_on_their_joint(
    tmp_path: Path, settings: Settings, evaluation: Evaluation, layout: JointLayout,
    write_measured: Callable[..., list[Path]],
) -> None:  # fmt: skip
    section = evaluation.bode.model_copy(update={"methods": ("MOB", "MOB-Net")})
    test = LimbRuns(scenario=section.scenario, level=section.level, methods=section.methods, limbs=(section.limb,))
    bode(section, settings.pushes, layout, settings.observer, settings.rates, evaluation.statistics,
         write_measured([test], METRICS), tmp_path)  # fmt: skip
    rows = read_table(tmp_path / "bode_all.csv")
    lines = {push.joint: push.sines.frequency_hz for push in settings.pushes.values() if push.sines}
    assert {row.joint for row in rows} == set(lines)
    for row in rows:
        slow = (0.9, 0.99) if row.quantity == "gain" else (-5.0, -5.5)  # of MOB and of MOB-Net, a tenth more
        place = section.bands_hz.index(0.5 if row.value in map(pytest.approx, slow) else 2.0)
        assert row.frequency_hz == pytest.approx(lines[row.joint][place])
    assert {row.joint for row in read_table(tmp_path / "bode.csv")} == set(section.shown)
    assert {path.suffix for path in tmp_path.glob("bode*")} == {".csv", ".pdf", ".svg", ".png"}
    check_golden(tmp_path / "bode.csv", tmp_path / "bode_all.csv")


def half(frequency_hz: NDArray[np.float64]) -> Array:
    """A low-pass that halves every frequency (n,) [Hz] and delays it by 10 degrees (n,) [-]."""
    return np.full(len(frequency_hz), 0.5 * np.exp(-1j * np.deg2rad(10.0)))


def answers_of(rows: Sequence[tuple[str, str, float, float, float | None, float | None]]) -> pd.DataFrame:
    """Return what the observer makes of sines."""
    names = ["joint", "quantity", "frequency_hz", "value", "low", "high"]
    return pd.DataFrame(rows, columns=names).assign(method="MOB").astype(dict.fromkeys(names[2:], float))


def test_every_joint_has_a_panel_of_gain_and_one_of_phase_with_the_reference() -> None:
    joints = ["LL1", "LL2", "LL3"]
    places = list(product(joints, ("gain", "phase")))
    slow = [(*place, 0.5, 0.9, 0.8, 1.0) for place in places]
    fast = [(*place, 2.0, 0.5, None, None) for place in places]
    figure = draw_bode(answers_of(slow + fast), joints, half, 1.0)
    shown = [axis for axis in figure.axes if axis.get_visible()]
    assert [axis.get_title("left") for axis in shown] == [
        "(a) LL1, gain", "(b) LL1, phase", "(c) LL2, gain", "(d) LL2, phase", "(e) LL3, gain", "(f) LL3, phase",
    ]  # fmt: skip
    for axis in shown:
        assert REFERENCE in [line.get_label() for line in axis.lines]
        assert axis.get_xscale() == "log"
        is_gain = "gain" in axis.get_title("left")
        assert axis.get_ylim() == ENDS["gain" if is_gain else "phase"]


def test_gain_and_phase_are_those_over_the_low_pass() -> None:
    answers = answers_of([("LL1", "gain", 0.5, 0.5, None, None), ("LL1", "phase", 0.5, -30.0, None, None)])
    gain, phase = draw_bode(answers, ["LL1"], half, 1.0).axes
    shown = [{str(line.get_label()): line.get_ydata() for line in axis.lines} for axis in (gain, phase)]
    np.testing.assert_allclose([own["MOB"] for own in shown], [[1.0], [-20.0]])
    np.testing.assert_allclose([own[REFERENCE] for own in shown], [[1.0, 1.0], [0.0, 0.0]])


def test_without_a_push_the_reference_is_drawn_alone() -> None:
    figure = draw_bode(answers_of([]), ["LL1"], half, 1.0)
    assert [len(axis.lines) for axis in figure.axes if axis.get_visible()] == [1, 1]
