"""The reliability plot draws the numbers given, each limb in one colour."""

import numpy as np

from mobnet.evaluation.figures.further.reliability import CoverageCurve, ReliabilityPanel, curve_rows, draw_reliability

NOMINAL = np.array([0.25, 0.5, 0.75])


def panel(method: str, title: str, *limbs: str) -> ReliabilityPanel:
    """A panel of made-up curves, each limb with its own."""
    curves = [CoverageCurve(limb, NOMINAL, NOMINAL - 0.1 * len(limb), NOMINAL + 0.01 * len(title)) for limb in limbs]
    return ReliabilityPanel(method, title, curves)


def test_a_row_a_method_a_column_a_test_and_no_panel_where_none_is_given() -> None:
    panels = [panel("A", "walk", "LL", "RL"), panel("B", "walk", "RL"), panel("B", "pushed", "RL")]
    figure = draw_reliability(panels)
    shown = {(axis.get_ylabel(), axis.get_title("left")): axis for axis in figure.axes if axis.get_visible()}
    assert list(shown) == [("A", "walk"), ("B", "walk"), ("B", "pushed")]
    for one in panels:
        lines = {line.get_label(): line for line in shown[one.method, one.title].lines}
        for curve in one.curves:
            np.testing.assert_array_equal(lines[curve.label].get_xdata(), NOMINAL)
            np.testing.assert_array_equal(lines[curve.label].get_ydata(), curve.after)


def test_a_limb_has_one_colour_in_every_panel_and_limbs_differ() -> None:
    figure = draw_reliability([panel("A", "walk", "LL", "RL"), panel("B", "walk", "RL")])
    colours = {
        label: {line.get_color() for axis in figure.axes for line in axis.lines if line.get_label() == label}
        for label in ("LL", "RL")
    }
    assert all(len(found) == 1 for found in colours.values())
    assert colours["LL"] != colours["RL"]


def test_plotted_numbers_are_told_as_learned_and_scaled() -> None:
    rows = list(curve_rows([panel("A", "walk", "LL")]))
    assert rows[1] == ("walk", "A", "LL", 0.5, 0.3, 0.54)
    assert len(rows) == len(NOMINAL)
