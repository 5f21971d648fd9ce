"""A training as its files tell it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from mobnet.core.errors import DataError
from mobnet.evaluation.report.training_runs import flattened, read_training_run

NOTE: dict[str, Any] = {
    "name": "LSTM-LL-s3",
    "method": "LSTM",
    "limb": "LL",
    "seed": 3,
    "target": "uncertainty",
    "settings": {"epochs": 3, "network": {"cell": "LSTM", "Q": ["LL", "RL"]}},
    "parameters": 83468,
    "samples": 1000,
    "diverged": False,
    "best": {"epoch": 99, "validation_loss": -99.0},
    "seconds": 12.5,
    "on_windows": {"loss": -1.0},
    "device": "cpu",
    "precision": "bfloat16",
    "fingerprint": "f",
    "provenance": {"commit": "c"},
}
ONE = "1,0,-1,4,.1,9\n"
HEAD = "epoch,train_loss,validation_loss,validation_rmse,rate,gradient_norm\n"


def files(folder: Path, lines: str, **changed: Any) -> Path:
    """Write a training's files."""
    (folder / "run.json").write_text(json.dumps({**NOTE, **changed}))
    (folder / "metrics.csv").write_text(HEAD + lines)
    return folder


def test_numbers_of_the_best_epoch_come_from_the_metrics(tmp_path: Path) -> None:
    """The first of the smallest validation losses counts, whatever run.json says."""
    run = read_training_run(files(tmp_path, "1,0,-1,4,.1,9\n2,-1,-3,2,.1,9\n3,-2,-3,1,.1,9\n"))
    assert (run.best_epoch, run.loss, run.rmse, run.epoch_count) == (2, -3.0, 2.0, 3)
    assert (run.name, run.cell, run.parameters) == ("LSTM-LL-s3", "LSTM", 83468)
    assert (run.seconds, run.precision, run.state) == (12.5, "bfloat16", "done")


def test_a_training_that_diverged_at_once_has_no_numbers(tmp_path: Path) -> None:
    run = read_training_run(files(tmp_path, "", diverged=True, best=None))
    assert (run.best_epoch, run.loss, run.rmse, run.epoch_count, run.state) == (None, None, None, 0, "diverged")


def test_settings_are_flat_and_whole(tmp_path: Path) -> None:
    settings = read_training_run(files(tmp_path, ONE)).settings
    assert settings["settings.network.Q"] == "LL, RL"
    assert settings["target"] == "uncertainty"
    assert settings["provenance.commit"] == "c"


def test_flattening_keeps_every_leaf() -> None:
    value = {"a": {"b": 1, "c": [1, 2]}, "d": None}
    assert dict(flattened("x", value)) == {"x.a.b": "1", "x.a.c": "1, 2", "x.d": "None"}


def test_a_missing_key_is_named(tmp_path: Path) -> None:
    files(tmp_path, ONE)
    for name in ("samples", "device"):
        (tmp_path / "run.json").write_text(json.dumps({key: value for key, value in NOTE.items() if key != name}))
        with pytest.raises(DataError, match=rf"run\.json: key '{name}' is missing"):
            read_training_run(tmp_path)
