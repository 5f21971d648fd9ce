"""The course of a training: the best epoch is kept, and a run that diverges stops."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import torch

from mobnet.core.config import load_layout
from mobnet.core.errors import TrainingError
from mobnet.learning.checkpoint import CHECKPOINT
from mobnet.learning.dataset import LimbData, load_limb_data
from mobnet.learning.job import Job, job_of
from mobnet.learning.precision import PRECISIONS
from mobnet.learning.tracking import METRICS
from mobnet.learning.trainer import Trainer

Setting = tuple[Job, LimbData]


@pytest.fixture
def setting(small: object) -> Setting:
    job = job_of(small.config, "MOB-Net", "LL", 0)
    layout = load_layout(Path(small.config["robot"]))
    return job, load_limb_data(layout, job.row, job.target, small.recordings, small.residuals)


def test_it_learns_and_keeps_the_best_epoch(setting: Setting, tmp_path: Path) -> None:
    done = Trainer(*setting).run(tmp_path)
    losses = [row["validation_loss"] for row in done.rows]
    assert done.epoch == setting[0].epochs
    assert losses[-1] < losses[0]
    assert done.best_row()["validation_loss"] == min(losses)


def test_scales_do_not_see_the_validation_blocks(setting: Setting) -> None:
    job, data = setting
    before = Trainer(job, data).scales
    for _, end in data.segments:
        data.inputs[end - 100 : end] += 5.0
    after = Trainer(job, data).scales
    np.testing.assert_array_equal(before[0].mean, after[0].mean)


@pytest.mark.parametrize("precision", PRECISIONS)
def test_two_runs_are_the_same_to_the_bit(setting: Setting, precision: str, tmp_path: Path) -> None:
    job, data = setting
    job.settings["precision"] = precision
    first, second = (Trainer(replace(job, epochs=2), data).run(tmp_path / name) for name in "ab")
    assert first.rows == second.rows
    assert all(torch.equal(first.best[name], tensor) for name, tensor in second.best.items())


@pytest.mark.parametrize("how", ["bound", "nan"])
def test_a_training_that_diverges_says_what_to_try(setting: Setting, how: str, tmp_path: Path) -> None:
    job, data = setting
    if how == "bound":
        job.settings["divergence_loss"] = -100.0
    else:
        data.targets[20] = np.nan
    with pytest.raises(TrainingError, match=r"MOB-Net-LL-s0: epoch 1: training loss .* at rate 0.005 .*rate_first"):
        Trainer(job, data).run(tmp_path)
    assert not (tmp_path / CHECKPOINT).exists()


def test_windows_give_other_weights_than_streams(setting: Setting, tmp_path: Path) -> None:
    job, data = setting
    streams = Trainer(job, data).run(tmp_path / "a")
    job.settings["sequences"] = "windows"
    windows = Trainer(job, data).run(tmp_path / "b")
    assert windows.rows[-1]["train_loss"] < windows.rows[0]["train_loss"]
    assert not torch.equal(streams.best["head.weight"], windows.best["head.weight"])


def test_dropout_is_drawn_from_seed_and_epoch_alone(setting: Setting, tmp_path: Path) -> None:
    job, data = setting
    row = {
        "cell": "TCN",
        "hidden": 8,
        "kernel_steps": 3,
        "dilations": [1],
        "dropout": 0.5,
        "window_steps": 5,
        "head": 8,
    }
    job = replace(job, row={**job.row, **row}, epochs=1)
    results = []
    for seed in (0, 1):
        torch.manual_seed(seed)  # as whatever ran before in this process may have left it
        results.append(Trainer(job, data).run(tmp_path / str(seed)).rows)
    assert results[0] == results[1]


def test_re_run_windows_are_scored_in_physical_units(setting: Setting, tmp_path: Path) -> None:
    job, data = setting
    trainer = Trainer(job, data)
    done = trainer.run(tmp_path)
    scored = trainer.on_windows(done)
    assert scored == trainer.on_windows(done)
    assert scored["rmse"] == pytest.approx(done.best_row()["validation_rmse"], rel=0.5)


def test_every_epoch_is_on_disk(setting: Setting, tmp_path: Path) -> None:
    Trainer(*setting).run(tmp_path)
    assert len((tmp_path / METRICS).read_text().splitlines()) == setting[0].epochs + 1
    assert (tmp_path / CHECKPOINT).exists()
