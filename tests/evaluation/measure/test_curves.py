"""Curves are those of the files, joint by joint, and a panel shows the rows asked for."""

from collections.abc import Callable

import numpy as np
import pytest

from mobnet.core.errors import ConfigError, DataError
from mobnet.core.joints import JointLayout
from mobnet.evaluation.measure.curves import Curves, read_curves
from mobnet.plan.runs import Run

Walk = Callable[..., Run]
FLAGS = {"swing": "swing.left_foot", "push": "pushed"}


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
