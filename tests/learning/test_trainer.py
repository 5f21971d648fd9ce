"""The course of a training: the best epoch is kept, and a run that diverges stops."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import torch

from mobnet.core.config import load_layout
from mobnet.core.errors import TrainingError
from mobnet.learning.checkpoint import CHECKPOINT
from mobnet.learning.dataset import LimbData, load_limb_data
from mobnet.learning.job import Job, job_of
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


def test_two_runs_are_the_same_to_the_bit(setting: Setting, tmp_path: Path) -> None:
    first, second = (Trainer(*setting).run(tmp_path / name) for name in "ab")
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


def test_every_epoch_is_on_disk(setting: Setting, tmp_path: Path) -> None:
    Trainer(*setting).run(tmp_path)
    assert len((tmp_path / METRICS).read_text().splitlines()) == setting[0].epochs + 1
    assert (tmp_path / CHECKPOINT).exists()
