"""A training is read as its files describe it."""

from collections.abc import Callable
from pathlib import Path

import pytest

from experiments.evaluation.report.runs_page import flattened, read_training_run
from mobnet.core.errors import DataError
from mobnet.core.files import read_json, write_json

Write = Callable[..., Path]
NAME, ONE = "LSTM-LL-s3", "1,0,-1,4,.1,9"


def test_numbers_of_the_best_epoch_come_from_the_metrics(tmp_path: Path, write_run: Write) -> None:
    """The first of the smallest validation losses counts."""
    lines = [ONE, "2,-1,-3,2,.1,9", "3,-2,-3,1,.1,9"]
    run = read_training_run(write_run(tmp_path, NAME, lines, precision="bfloat16"))
    assert (run.best_epoch, run.loss, run.rmse, run.epoch_count) == (2, -3.0, 2.0, 3)
    assert (run.name, run.cell, run.parameters) == (NAME, "GRU", 83712)
    assert (run.seconds, run.settings["precision"], run.state) == (None, "bfloat16", "done")


def test_another_best_epoch_in_the_note_is_refused(tmp_path: Path, write_run: Write) -> None:
    folder = write_run(tmp_path, NAME, [ONE], best={"epoch": 99, "validation_loss": -99.0})
    with pytest.raises(DataError, match=r"epoch of the smallest .*: 1 in metrics\.csv and 99 in run\.json are not"):
        read_training_run(folder)


def test_a_training_that_diverged_at_once_has_no_numbers(tmp_path: Path, write_run: Write) -> None:
    run = read_training_run(write_run(tmp_path, NAME, [], diverged=True, best=None))
    assert (run.best_epoch, run.loss, run.rmse, run.epoch_count, run.state) == (None, None, None, 0, "diverged")


def test_settings_are_flat_and_whole(tmp_path: Path, write_run: Write) -> None:
    settings = read_training_run(write_run(tmp_path, NAME, [ONE])).settings
    assert settings["settings.network.Q"] == "LL, RL"
    assert settings["target"] == "uncertainty"
    assert settings["provenance.commit"] == "c"
    value = {"a": {"b": 1, "c": [1, 2]}, "d": None}
    assert dict(flattened("x", value)) == {"x.a.b": "1", "x.a.c": "1, 2", "x.d": "None"}


@pytest.mark.parametrize("name", ["samples", "device"])
def test_a_missing_key_is_named(tmp_path: Path, write_run: Write, name: str) -> None:
    note = write_run(tmp_path, NAME, [ONE]) / "run.json"
    write_json(note, {key: value for key, value in read_json(note).items() if key != name})
    with pytest.raises(DataError, match=rf"run\.json: {name}: key is missing"):
        read_training_run(note.parent)
