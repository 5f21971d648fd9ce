"""Figures of the data show the arrays given, each in its place."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from mobnet.evaluation.figures.commands import Bars, draw_bars
from mobnet.evaluation.figures.figure_19 import Cloud, draw_clouds


def test_each_panel_shows_its_joint_and_set_under_the_test() -> None:
    rng = np.random.default_rng(0)
    clouds = [
        Cloud(joint, name, rng.normal(size=(5, 2)), rng.normal(size=(3, 2)))
        for name in ("with RTE", "without RTE")
        for joint in ("LL2", "LL3")
    ]
    figure = draw_clouds(clouds, "test")
    assert len(figure.axes) == 4
    for axis, cloud in zip(figure.axes, clouds, strict=True):
        training, test = (collection.get_offsets() for collection in axis.collections)
        np.testing.assert_array_equal(training, cloud.dots)
        np.testing.assert_array_equal(test, cloud.test)
        assert all(collection.get_rasterized() for collection in axis.collections)
    names = [text.get_text() for text in figure.legends[0].get_texts()]
    assert names == ["training with RTE", "training without RTE", "test"]
    assert figure.axes[0].get_ylabel() == "desired torque [N m]"
    assert figure.axes[2].get_xlabel() == "velocity [rad/s]"


def test_a_column_has_one_scale() -> None:
    clouds = [Cloud("LL2", name, np.full((2, 2), k), np.zeros((1, 2))) for k, name in enumerate(("a", "b"))]
    one, two = draw_clouds(clouds, "test").axes
    assert one.get_xlim() == two.get_xlim()
    assert one.get_ylim() == two.get_ylim()


def test_bars_are_as_high_as_their_share_and_do_not_overlap() -> None:
    shares = {"walk": np.array([0.2, 0.8]), "motion": np.array([0.5, 0.5])}
    (axis,) = draw_bars([Bars("step x [m]", np.array([0.0, 1.0, 2.0]), shares)]).axes
    heights = [bar.get_height() for bar in axis.patches]
    np.testing.assert_allclose(heights, [20, 80, 50, 50])
    spans = sorted((bar.get_x(), bar.get_x() + bar.get_width()) for bar in axis.patches)
    assert all(end <= start + 1e-12 for (_, end), (start, _) in pairwise(spans))
