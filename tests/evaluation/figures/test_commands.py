"""Histograms of the commands hold every step once, in bins of the ranges of Table 2."""

from itertools import pairwise
from pathlib import Path

import numpy as np
from csv_files import check_golden

from mobnet.evaluation.figures.further.commands import Bars, commands, draw_bars
from mobnet.settings.evaluation import Evaluation
from mobnet.settings.settings import Settings


def test_bars_are_as_high_as_their_share_and_do_not_overlap() -> None:
    counts = {"walk": np.array([2, 8]), "motion": np.array([5, 5])}
    (axis,) = draw_bars([Bars("step x [m]", np.array([0.0, 1.0, 2.0]), counts)]).axes
    np.testing.assert_allclose([bar.get_height() for bar in axis.patches], [20, 80, 50, 50])
    spans = sorted((bar.get_x(), bar.get_x() + bar.get_width()) for bar in axis.patches)
    assert all(end <= start + 1e-12 for (_, end), (start, _) in pairwise(spans))


def test_as_many_sets_as_the_configuration_has_are_told_apart_and_their_legend_is_not_cut(settings: Settings) -> None:
    counts = {name: np.array([2, 8]) for name in settings.evaluation.commands.sets}
    figure = draw_bars([Bars("step x [m]", np.array([0.0, 1.0, 2.0]), counts)])
    (key,) = figure.legends
    assert key.get_window_extent().width <= figure.bbox.width
    assert len({bar.get_facecolor() for bar in figure.axes[0].patches}) == len(counts)


def test_numbers_are_the_golden_ones(
    tmp_path: Path, settings: Settings, evaluation: Evaluation, data_sets: dict[str, list[Path]]
) -> None:
    sets = {name: data_sets[name] for name in ("walk", "motion")}
    commands(evaluation.commands, settings.commands, settings.layout, sets, tmp_path)
    check_golden(tmp_path / "commands.csv")
    assert (tmp_path / "commands.png").read_bytes().startswith(b"\x89PNG")
