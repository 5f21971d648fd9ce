"""Figure 17 shows where trainings end, as the table of kinds does; its CSV file has every epoch with its stride.

Kinds are drawn by one recipe and by their own.
"""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from csv_files import check_golden, read_table
from paper_settings import STATISTICS

from experiments.evaluation.figures.drawing.named_bars import MINUS
from experiments.evaluation.figures.paper.figure_17 import draw_losses, figure_17
from experiments.evaluation.measure.learning.losses import losses_of, runs_of
from experiments.evaluation.measure.learning.trainings import read_trainings
from experiments.evaluation.number.frames import rows_of
from experiments.settings.evaluation import Evaluation
from mobnet.core.errors import DataError

Write = Callable[..., Path]
MEASURES = ("training loss", "validation loss", "validation RMSE")


def test_the_end_is_the_last_epoch_in_training_and_the_kept_one_in_validation(write_training: Write) -> None:
    folders = [write_training("GRU", seed, loss) for seed, loss in enumerate((-4.0, -3.0, -2.6))]
    runs = runs_of(*read_trainings(folders))
    ends = rows_of(runs, at_end=True)
    assert rows_of(ends, measure="training loss")["value"].tolist() == pytest.approx((-3.75, -2.75, -2.35))
    assert rows_of(ends, measure="validation loss")["value"].tolist() == pytest.approx((-4.0, -3.0, -2.6))
    losses = losses_of(runs, STATISTICS)
    (value, low, high), *_ = rows_of(losses, at_end=True, measure="validation loss")[
        ["value", "low", "high"]
    ].to_numpy()
    assert value == pytest.approx(-3.2)
    half = 4.3027 * np.std([-4.0, -3.0, -2.6], ddof=1) / 3**0.5  # Student's law with two degrees of freedom
    assert (low, high) == (pytest.approx(-3.2 - half, abs=1e-3), pytest.approx(-3.2 + half, abs=1e-3))


def test_csv_holds_losses_and_error_of_every_method_and_epoch_and_of_the_end(
    tmp_path: Path, write_training: Write, evaluation: Evaluation
) -> None:
    losses = {"GRU": -4.0, "LSTM": -3.8, "RNN": -3.1, "TCN": -3.5, "MLP": -3.0, "MLP-500": -3.3}
    common = {f"{kind}-adam": loss + 0.4 for kind, loss in losses.items()}
    folders = [write_training(kind, seed, loss + 0.05 * seed) for kind, loss in common.items() for seed in range(2)]
    folders += [write_training(kind, 0, loss) for kind, loss in losses.items()]
    figure_17(evaluation.figure_17, folders, STATISTICS, tmp_path / "out")
    rows = read_table(tmp_path / "out/figure_17.csv")
    for method in (*common, *losses):
        own = [(row.measure, row.epoch) for row in rows if row.method == method]
        assert sorted(own, key=str) == sorted(
            [(name, epoch) for name in MEASURES for epoch in (1, 2, 3, None)], key=str
        )
    assert {(row.method in common, row.runs, row.stride) for row in rows} == {(True, 2, 1), (False, 1, 1)}
    assert {row.unit for row in rows if row.measure == "validation RMSE"} == {"N m"}
    assert {row.unit for row in rows if row.measure != "validation RMSE"} == {"-"}
    check_golden(tmp_path / "out/figure_17.csv")
    assert (tmp_path / "out/figure_17.pdf").read_bytes().startswith(b"%PDF")


def test_a_run_that_diverged_does_not_count(tmp_path: Path, write_training: Write, evaluation: Evaluation) -> None:
    good, bad = write_training("GRU", 0), write_training("GRU", 1, loss=40.0, epochs=2, diverged=True)
    lost = write_training("RNN", 0, epochs=1, diverged=True)
    figure_17(evaluation.figure_17, [good], STATISTICS, tmp_path / "alone")
    figure_17(evaluation.figure_17, [good, bad, lost], STATISTICS, tmp_path / "beside")
    texts = [(tmp_path / name / "figure_17.csv").read_text() for name in ("alone", "beside")]
    assert texts[0] == texts[1]


def test_runs_of_unlike_length_are_refused(write_training: Write) -> None:
    read = read_trainings([write_training("GRU", 0), write_training("GRU", 1, epochs=4)])
    with pytest.raises(DataError, match="GRU: runs of 3, 4 epochs"):
        runs_of(*read)


def test_a_kind_has_one_row_in_all_panels_in_which_its_best_is_hollow_and_below() -> None:
    kinds = {"GRU-adam": "GRU", "LSTM-adam": "LSTM", "GRU": "GRU", "LSTM": "LSTM"}
    numbers = {"GRU-adam": (-3.0, -3.2, -2.8), "LSTM-adam": (-2.0,) * 3, "GRU": (-4.0,) * 3, "LSTM": (-5.0,) * 3}
    made = [(measure, method, *number) for measure in MEASURES for method, number in numbers.items()]
    losses = pd.DataFrame(made, columns=["measure", "method", "value", "low", "high"])
    figure = draw_losses(losses, losses, kinds)
    assert [axis.get_xlabel() for axis in figure.axes] == ["loss [-]", "loss [-]", "RMSE [N m]"]
    for axis in figure.axes:
        assert [text.get_text() for text in axis.texts] == [
            f"{MINUS}{value}" for value in ("3.00", "2.00", "4.00", "5.00")
        ]
        interval = axis.lines[0]
        np.testing.assert_array_equal(np.asarray(interval.get_xdata()), [-3.2, -2.8])
        marks = axis.lines[2::3]
        assert [mark.get_markerfacecolor() == "white" for mark in marks] == [False, False, True, True]
        first, second, own, _ = (float(np.asarray(mark.get_ydata())[0]) for mark in marks)
        assert first < own < second
    assert figure.axes[1].get_xlim() == figure.axes[0].get_xlim()
    assert [label.get_text() for label in figure.axes[0].get_yticklabels()] == ["GRU", "LSTM"]
    assert figure.axes[0].get_ylim()[0] > figure.axes[0].get_ylim()[1]  # the first kind is on top
