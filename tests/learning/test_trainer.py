"""The course of a training: the best epoch is kept, and a run that diverges stops."""

import re

import numpy as np
import pytest
import torch

from mobnet.core.errors import TrainingError
from mobnet.core.files import METRICS
from mobnet.learning.checkpoint import CHECKPOINT
from mobnet.learning.job import PRECISIONS, TrainingJob
from mobnet.learning.trainer import Trainer

EPOCHS = 5


@pytest.fixture
def trainer(small, data):
    """Return a function of changes of how a network learns that sets a training up."""
    return lambda epochs=EPOCHS, **learning: Trainer(TrainingJob(small.training(epochs=epochs, **learning), 0, 1), data)


def test_it_learns_keeps_the_best_epoch_and_writes_every_one(trainer, tmp_path):
    done = trainer().run(tmp_path)
    losses = [epoch.validation_loss for epoch in done.epochs]
    assert [epoch.epoch for epoch in done.epochs] == list(range(1, EPOCHS + 1))
    assert losses[-1] < losses[0]
    assert done.best_epoch().validation_loss == min(losses)
    assert len((tmp_path / METRICS).read_text().splitlines()) == EPOCHS + 1
    assert (tmp_path / CHECKPOINT).exists()


def test_scales_do_not_see_the_validation_blocks(trainer, data):
    before = trainer().scales
    for _, end in data.segments:
        data.inputs[end - 100 : end] += 5.0
    np.testing.assert_array_equal(before[0].mean, trainer().scales[0].mean)


@pytest.mark.parametrize("precision", PRECISIONS)
def test_two_runs_are_the_same_to_the_bit(trainer, precision, tmp_path):
    first, second = (trainer(epochs=2, precision=precision).run(tmp_path / name) for name in "ab")
    assert first.epochs == second.epochs
    assert all(torch.equal(first.best[name], tensor) for name, tensor in second.best.items())


@pytest.mark.parametrize("how", ["bound", "nan"])
def test_a_training_that_diverges_says_what_to_try(trainer, data, how, settings, tmp_path):
    rate = re.escape(f"{settings.learning.rate_first:g}")
    if how == "nan":
        data.targets[20] = np.nan
    with pytest.raises(
        TrainingError, match=rf"MOB-Net-LL-s0: epoch 1: median training loss .* at rate {rate} .*rate_first"
    ):
        trainer(**({"divergence_loss": -100.0} if how == "bound" else {})).run(tmp_path)
    assert not (tmp_path / CHECKPOINT).exists()


def test_a_few_updates_with_a_huge_loss_are_no_divergence(trainer, data, tmp_path):
    data.targets[20] = 1e6
    epoch = trainer(epochs=1).run(tmp_path).epochs[0]
    assert epoch.train_loss > 50.0  # configs/networks.yaml: divergence_loss


def test_a_training_that_may_diverge_says_so_and_keeps_its_first_weights(trainer, tmp_path):
    diverging = trainer(divergence_loss=-100.0, may_diverge=True)
    first = diverging.network.head.weight.detach().clone()
    done = diverging.run(tmp_path)
    assert done.diverged
    assert not done.epochs
    assert torch.equal(done.best["head.weight"], first)


def test_windows_give_other_weights_than_streams(trainer, tmp_path):
    streams, windows = (trainer(sequences=how).run(tmp_path / how) for how in ("carried", "windows"))
    assert windows.epochs[-1].train_loss < windows.epochs[0].train_loss
    assert not torch.equal(streams.best["head.weight"], windows.best["head.weight"])


def test_dropout_is_drawn_from_seed_and_epoch_alone(small, data, tmp_path):
    training, results = small.training("TCN", epochs=1), []
    for seed in (0, 1):
        torch.manual_seed(seed)  # as whatever ran before in this process may have left it
        results.append(Trainer(TrainingJob(training, 0, 1), data).run(tmp_path / str(seed)).epochs)
    assert results[0] == results[1]


def test_re_run_windows_are_scored_in_physical_units(trainer, tmp_path):
    trained = trainer()
    done = trained.run(tmp_path)
    scored = trained.on_windows(done)
    assert scored == trained.on_windows(done)
    assert scored["rmse"] == pytest.approx(done.best_epoch().validation_rmse, rel=0.5)
