"""Histograms count every step once; followed commands are held against their own bin."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from csv_files import read_table

from mobnet.evaluation.figures.commands import commands
from mobnet.evaluation.measure.steps import Steps, bin_edges, bin_of, in_degrees
from mobnet.evaluation.tables.steps import followed, steps

Sets = dict[str, list[str]]


def made_steps(wanted: list[float], factor: float = 1.0) -> Steps:
    """Return steps of the left foot with some step x [m] and what came of it."""
    commanded = np.tile([0.0, 0.0, 0.0, 0.7, 0.05], (len(wanted), 1))
    commanded[:, 0] = wanted
    measured = commanded[:, :4].copy()
    measured[:, 0] *= factor
    return Steps(np.zeros(len(wanted), dtype=np.intp), commanded, measured)


def test_ranges_are_cut_evenly_and_choices_stand_in_the_middle(config: dict[str, Any]) -> None:
    np.testing.assert_allclose(bin_edges(config, 0, 7), np.linspace(-0.15, 0.20, 8))
    np.testing.assert_allclose(bin_edges(config, 3, 7), [0.55, 0.65, 0.75, 0.85, 0.95])
    np.testing.assert_array_equal(bin_of(np.array([0.6, 0.9]), bin_edges(config, 3, 7)), [0, 3])


def test_the_ends_of_a_range_lie_inside_even_when_rounded(config: dict[str, Any]) -> None:
    edges = bin_edges(config, 0, 7)
    values = np.array([-0.15, 0.2], dtype=np.float32)
    np.testing.assert_array_equal(bin_of(values, edges), [0, 6])
    np.testing.assert_array_equal(bin_of(np.array([-0.150001, 0.200001]), edges), [0, 6])


def test_turns_become_degrees_and_nothing_else_changes() -> None:
    before = made_steps([0.1])
    before.commanded[:, 2], before.measured[:, 2] = np.pi / 9, np.pi / 18
    after = in_degrees(before)
    assert (after.commanded[0, 2], after.measured[0, 2]) == (pytest.approx(20.0), pytest.approx(10.0))
    np.testing.assert_array_equal(np.delete(after.commanded, 2, 1), np.delete(before.commanded, 2, 1))
    assert before.commanded[0, 2] == pytest.approx(np.pi / 9)


def test_every_step_is_counted_once_in_every_command(tmp_path: Path, config: dict[str, Any], data_sets: Sets) -> None:
    commands(config, {"walk": data_sets["walk"], "motion": data_sets["motion"]}, tmp_path)
    rows = read_table(tmp_path / "commands.csv")
    for name in ("walk", "motion"):
        sums = {row.command: 0 for row in rows}
        for row in rows:
            sums[row.command] += row.count * (row.set == name)
        assert len(sums) == 5
        assert len(set(sums.values())) == 1
        assert sum(row.share for row in rows if row.set == name) == pytest.approx(5.0, abs=1e-4)
    assert (tmp_path / "commands.pdf").read_bytes().startswith(b"%PDF")


def test_a_set_that_falls_short_shows_it(config: dict[str, Any]) -> None:
    rows = list(followed(config, made_steps([0.2, 0.19, -0.15], 0.8), 0))
    assert [row.count for row in rows] == [1, 2]
    assert all(row.ratio == pytest.approx(0.8) for row in rows)
    assert all(row.within == 0.0 for row in rows)
    assert next(followed(config, made_steps([0.2], 1.1), 0)).within == 1.0


def test_a_bin_around_zero_has_no_ratio_and_steps_in_place_are_left_out(config: dict[str, Any]) -> None:
    rows = list(followed(config, made_steps([0.0, 0.01, -0.01, 0.2]), 0))
    assert [(row.count, row.ratio is None) for row in rows] == [(2, True), (1, False)]


def test_the_table_names_a_command_once(tmp_path: Path, config: dict[str, Any], data_sets: Sets) -> None:
    steps(config, {"walk": data_sets["walk"]}, tmp_path)
    rows = read_table(tmp_path / "steps.csv")
    assert {row.command for row in rows} == {"step_x", "step_y", "turn", "duration"}
    text = (tmp_path / "steps.md").read_text()
    assert text.count("walk") == 4
    assert text.count("step x [m]") == 1
