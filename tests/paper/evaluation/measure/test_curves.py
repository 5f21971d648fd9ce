"""Curves are those of the files, a panel shows the rows asked for, a gait cycle goes from lift-off to lift-off."""

from collections.abc import Callable

import numpy as np
import pytest

from experiments.evaluation.compare.curves import Curves, gait_cycle, read_curves, read_cycle
from experiments.plan.runs import Run
from mobnet.core.columns import foot_of
from mobnet.core.errors import ConfigError, DataError
from mobnet.core.joints import JointLayout

Walk = Callable[..., Run]
FLAGS = {"swing": "swing.left_foot", "push": "pushed"}
AIR = np.array([1, 1, 0, 0, 0, 1, 1, 0, 0, 1, 1, 0, 1, 0, 0, 1], dtype=bool)  # lift-offs at 5, 9, 12, 15
WHOLE = ((0, len(AIR)),)


@pytest.fixture
def curves(walk: Walk, layout: JointLayout) -> Curves:
    """LL3 and LL5 of two methods on a made-up walk, the one with a standard deviation of .5 N m."""
    return read_curves(layout, [walk(-15.0, method="MOB"), walk(2.0, std=0.5)], ["LL5", "LL3"], FLAGS)


def test_estimates_are_off_the_truth_by_their_errors_in_the_order_asked_for(
    curves: Curves, layout: JointLayout
) -> None:
    places = layout.columns(["LL5", "LL3"])
    assert curves.joints == ("LL5", "LL3")
    for method, error in (("MOB", -15.0), ("MOB-Net", 2.0)):
        np.testing.assert_allclose(curves.estimates[method] - curves.truth, error, rtol=1e-4)
    np.testing.assert_allclose(curves.residual - curves.truth, 5.0, rtol=1e-4)
    np.testing.assert_allclose(curves.truth.min(axis=0), 60.0 * np.linspace(-1, 1, layout.nv)[places], rtol=1e-4)


def test_flags_are_those_of_the_recording(curves: Curves) -> None:
    assert [int(flags.sum()) for flags in curves.flags.values()] == [4 * 70, 4 * 10]
    assert np.all(curves.flags["swing"][curves.flags["push"]])


def test_panel_shows_the_rows_from_its_zero(curves: Curves) -> None:
    panel = curves.panel("a", "LL3", slice(100, 200, 5), zero=120)
    np.testing.assert_allclose(panel.time, np.arange(-20, 80, 5) / 100.0)
    assert [curve.label for curve in panel.curves] == ["truth", "MOB", "MOB-Net"]
    np.testing.assert_array_equal(panel.curves[0].values, curves.truth[100:200:5, 1])
    np.testing.assert_array_equal(panel.flags["push"], curves.flags["push"][100:200:5])


def test_a_band_is_shown_where_it_is_wanted_and_predicted(curves: Curves) -> None:
    shown = curves.panel("a", "LL3", slice(0, 10), band=True).curves
    assert [curve.std is None for curve in shown] == [True, True, False]
    np.testing.assert_allclose(np.asarray(shown[2].std), 0.5)
    assert all(curve.std is None for curve in curves.panel("a", "LL3", slice(0, 10)).curves)


def test_uncertainty_is_what_the_residual_has_beyond_the_truth_and_the_estimate(curves: Curves) -> None:
    """The identity of (15): the residual is external torque and uncertainty."""
    target, mob, net = curves.uncertainty_panel("a", "LL3", slice(0, 300)).curves
    assert target.label == "target"
    np.testing.assert_allclose(target.values, 5.0, rtol=1e-4)
    np.testing.assert_allclose(mob.values, 20.0, rtol=1e-4)
    np.testing.assert_allclose(net.values, 3.0, rtol=1e-4)
    np.testing.assert_allclose(np.asarray(net.std), 0.5)


def test_what_is_not_there_is_named(walk: Walk, layout: JointLayout) -> None:
    with pytest.raises(ConfigError, match="joint: 'W1' is not accepted; accepted: LL1"):
        read_curves(layout, [walk(1.0)], ["W1"])
    with pytest.raises(DataError, match=r"column 'swing\.hand' is missing"):
        read_curves(layout, [walk(1.0)], ["LL3"], {"swing": "swing.hand"})


@pytest.mark.parametrize(("start", "rows"), [(0, (5, 9)), (5, (9, 12)), (4, (5, 9)), (6, (9, 12)), (11, (12, 15))])
def test_cycle_goes_from_the_first_lift_off_after_the_start_to_the_next(start: int, rows: tuple[int, int]) -> None:
    assert gait_cycle(AIR, WHOLE, start) == slice(*rows)


def test_every_cycle_is_one_swing_and_one_stance() -> None:
    for start in range(11):
        rows = gait_cycle(AIR, WHOLE, start)
        assert rows is not None
        swing = AIR[rows]
        assert swing[0]
        assert not swing[-1]
        assert np.count_nonzero(np.diff(swing.astype(int))) == 1


def test_cycle_does_not_cross_a_fall_and_there_may_be_none() -> None:
    assert gait_cycle(AIR, ((0, 8), (8, 16)), 0) == slice(9, 12)
    assert gait_cycle(AIR, WHOLE, 13) is None
    assert gait_cycle(np.ones(10, dtype=bool), ((0, 10),), 0) is None


def test_cycle_of_a_recording_is_that_of_the_joints_own_foot(walk: Walk, layout: JointLayout) -> None:
    curves, rows = read_cycle(layout, [walk(2.0)], ["LL3"], 1.0)
    assert rows.stop - rows.start == 140
    assert curves.flags["swing"][rows].sum() == 70
    with pytest.raises(DataError, match=r"no whole gait cycle after 100\.0 s; it lasts 5\.6 s"):
        read_cycle(layout, [walk(2.0)], ["LL3"], 100.0)


def test_a_foot_belongs_to_its_leg(layout: JointLayout) -> None:
    assert (foot_of(layout, "LL3"), foot_of(layout, "RL6")) == ("left_foot", "right_foot")
    with pytest.raises(ConfigError, match="leg joint: 'LA1' is not accepted"):
        foot_of(layout, "LA1")
