"""Bins hold every step once; followed commands are compared with their own bin."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from csv_files import check_golden, read_table

from experiments.evaluation.figures.further.commands import commands
from experiments.evaluation.measure.data.steps import WalkedSteps, bin_edges, bin_of, in_degrees
from experiments.evaluation.tables.further.steps import followed
from experiments.settings.evaluation import Evaluation
from experiments.settings.settings import Settings

Sets = dict[str, list[Path]]


def followed_x(settings: Settings, wanted: list[float], factor: float = 1.0) -> pd.DataFrame:
    """Return what came of steps of the left foot with some step x [m], a factor longer than commanded."""
    commanded = np.tile([0.0, 0.0, 0.0, 0.7, 0.05], (len(wanted), 1))
    commanded[:, 0] = wanted
    measured = commanded[:, :4] * [factor, 1.0, 1.0, 1.0]
    steps = WalkedSteps(np.zeros(len(wanted), dtype=np.intp), commanded, measured[:, 3], np.zeros((len(wanted), 0)))
    return followed(steps, measured, 0, bin_edges(settings.commands, 0, 3), 0.15)


def test_ranges_are_cut_evenly_and_choices_stand_in_the_middle(settings: Settings) -> None:
    edges, choices = (bin_edges(settings.commands, column, 7) for column in (0, 3))
    np.testing.assert_allclose(edges, np.linspace(-0.15, 0.20, 8))
    np.testing.assert_allclose(choices, [0.55, 0.65, 0.75, 0.85, 0.95])
    np.testing.assert_array_equal(bin_of(np.array([0.6, 0.9]), choices), [0, 3])
    for ends in (np.array([-0.15, 0.2], dtype=np.float32), np.array([-0.150001, 0.200001])):  # inside, though rounded
        np.testing.assert_array_equal(bin_of(ends, edges), [0, 6])


def test_turns_become_degrees_and_nothing_else_changes() -> None:
    before = np.array([[0.1, 0.0, np.pi / 9, 0.7]])
    np.testing.assert_allclose(in_degrees(before), [[0.1, 0.0, 20.0, 0.7]])
    assert before[0, 2] == np.pi / 9


def test_every_step_is_counted_once_in_every_command(
    tmp_path: Path, settings: Settings, evaluation: Evaluation, data_sets: Sets
) -> None:
    sets = {name: data_sets[name] for name in ("walk", "motion")}
    commands(evaluation.commands, settings.commands, settings.layout, sets, tmp_path)
    rows = read_table(tmp_path / "commands.csv")
    for name in sets:
        own = [row for row in rows if row.set == name]
        sums = {
            command: sum(row.count for row in own if row.command == command) for command in (r.command for r in own)
        }
        assert len(sums) == 5
        assert len(set(sums.values())) == 1
        assert sum(row.share for row in own) == pytest.approx(5.0, abs=1e-4)


def test_a_set_that_falls_short_shows_it(settings: Settings) -> None:
    rows = followed_x(settings, [0.2, 0.19, -0.15], 0.8)
    assert rows["count"].tolist() == [1, 2]
    assert rows["ratio"].tolist() == pytest.approx([0.8, 0.8])
    assert rows["within"].tolist() == [0.0, 0.0]
    assert followed_x(settings, [0.2], 1.1)["within"].tolist() == [1.0]


def test_a_bin_around_zero_has_no_ratio_and_steps_in_place_are_left_out(settings: Settings) -> None:
    rows = followed_x(settings, [0.0, 0.01, -0.01, 0.2])
    assert rows["count"].tolist() == [2, 1]
    for name in ("ratio", "within"):
        assert rows[name].isna().tolist() == [True, False]


def test_the_table_names_a_command_once(make_table: Callable[..., Path], data_sets: Sets) -> None:
    table = make_table("steps", sets={"walk": data_sets["walk"]})
    assert {row.command for row in read_table(table)} == {"step_x", "step_y", "turn", "duration"}
    text = table.with_suffix(".md").read_text()
    assert (text.count("walk"), text.count("step x [m]")) == (4, 1)
    check_golden(table)
