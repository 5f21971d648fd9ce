"""Histograms of the commands hold every step once, in bins of the ranges of Table 2."""

from itertools import pairwise
from pathlib import Path

import numpy as np
from csv_files import check_golden, read_table

from experiments.evaluation.figures.further.commands import Bars, commands, draw_bars, named_values
from experiments.settings.evaluation import Evaluation
from experiments.settings.settings import Settings


def test_bars_are_as_high_as_their_share_within_the_range_of_the_table() -> None:
    panel = Bars("step x [m]", np.array([-1.0, 0.0, 3.0]), np.array([20.0, 80.0]), [-1.0, 0.0, 3.0])
    (axis,) = draw_bars([panel]).axes
    span, *bars = axis.patches
    np.testing.assert_allclose([bar.get_height() for bar in bars], [20, 80])
    spans = sorted((bar.get_x(), bar.get_x() + bar.get_width()) for bar in bars)
    assert all(end <= start + 1e-12 for (_, end), (start, _) in pairwise(spans))
    assert (span.get_x(), span.get_width()) == (-1.0, 4.0)
    first, last = axis.get_xlim()
    assert first < -1.0 < 3.0 < last
    assert axis.get_xticks().tolist() == [-1.0, 0.0, 3.0]


def test_the_axis_names_the_ends_of_a_range_and_zero_and_the_ends_of_choices(settings: Settings) -> None:
    commands = settings.commands
    assert named_values(commands, 0) == [commands.step_x_m[0], 0.0, commands.step_x_m[1]]
    assert named_values(commands, 3) == [commands.duration_s[0], commands.duration_s[-1]]


def test_the_first_set_is_drawn_and_the_file_has_all(
    tmp_path: Path, settings: Settings, evaluation: Evaluation, data_sets: dict[str, list[Path]]
) -> None:
    pictures = []
    for names in (["walk", "motion"], ["walk"]):
        folder = tmp_path / str(len(names))
        sets = {name: data_sets[name] for name in names}
        commands(evaluation.commands, settings.commands, settings.layout, sets, folder)
        pictures.append((folder / "commands.png").read_bytes())
        assert list(dict.fromkeys(row.set for row in read_table(folder / "commands.csv"))) == names
    assert pictures[0] == pictures[1]


def test_numbers_are_the_golden_ones(
    tmp_path: Path, settings: Settings, evaluation: Evaluation, data_sets: dict[str, list[Path]]
) -> None:
    sets = {name: data_sets[name] for name in ("walk", "motion")}
    commands(evaluation.commands, settings.commands, settings.layout, sets, tmp_path)
    check_golden(tmp_path / "commands.csv")
    assert (tmp_path / "commands.png").read_bytes().startswith(b"\x89PNG")
