"""Figure 17 shows the mean over runs of every epoch, between its lowest and highest run."""

from collections.abc import Callable
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from csv_files import check_golden, read_table

from mobnet.core.errors import DataError
from mobnet.evaluation.figures.paper.figure_17 import curve, figure_17
from mobnet.evaluation.measure.learning.trainings import read_trainings

Write = Callable[..., Path]


def test_curve_is_the_mean_of_the_runs_within_their_spread(write_training: Write) -> None:
    trainings = read_trainings(write_training("GRU", seed, loss) for seed, loss in enumerate((-4.0, -3.0, -2.6)))["GRU"]
    line = curve("GRU", trainings, "validation_loss")
    assert list(line.x) == [1, 2, 3]
    np.testing.assert_allclose(line.columns, [[-2.2, -3.2, -2.7], [-3.0, -4.0, -3.5], [-1.6, -2.6, -2.1]])


def test_csv_holds_both_losses_of_every_kind_and_epoch(tmp_path: Path, write_training: Write) -> None:
    losses = {"GRU": -4.0, "LSTM": -3.8, "RNN": -3.1, "TCN": -3.5, "MLP": -3.0, "MLP-500": -3.3}
    folders = [write_training(kind, seed, loss + 0.05 * seed) for kind, loss in losses.items() for seed in range(2)]
    figure_17(folders, tmp_path / "out")
    rows = read_table(tmp_path / "out/figure_17.csv")
    keys = [(row.measure, row.method, row.epoch) for row in rows]
    assert keys == list(product(("training loss", "validation loss"), losses, (1, 2, 3)))
    assert {row.runs for row in rows} == {2}
    check_golden(tmp_path / "out/figure_17.csv")
    assert (tmp_path / "out/figure_17.pdf").read_bytes().startswith(b"%PDF")


def test_a_run_that_diverged_does_not_bend_the_curve(tmp_path: Path, write_training: Write) -> None:
    good, bad = write_training("GRU", 0), write_training("GRU", 1, loss=40.0, epochs=2, diverged=True)
    lost = write_training("RNN", 0, epochs=1, diverged=True)
    figure_17([good], tmp_path / "alone")
    figure_17([good, bad, lost], tmp_path / "beside")
    texts = [(tmp_path / name / "figure_17.csv").read_text() for name in ("alone", "beside")]
    assert texts[0] == texts[1]


def test_runs_of_unlike_length_are_refused(write_training: Write) -> None:
    trainings = read_trainings([write_training("GRU", 0), write_training("GRU", 1, epochs=4)])["GRU"]
    with pytest.raises(DataError, match="GRU: runs of 3, 4 epochs"):
        curve("GRU", trainings, "train_loss")
