"""The schedule of a training: the best epoch is kept, and a run that diverges stops."""

import math
import re

import numpy as np
import pytest
import torch

from mobnet.core.epochs import read_epochs
from mobnet.core.errors import TrainingError
from mobnet.core.files import CHECKPOINT, METRICS
from mobnet.learning.job import PRECISIONS, TrainingJob
from mobnet.learning.trainer import Trainer
from mobnet.settings.networks import Coarse

EPOCHS = 5


@pytest.fixture
def trainer(small, data):
    """Return a function of changes of how a network learns that sets a training up."""

    return lambda epochs=EPOCHS, **learning: Trainer(TrainingJob(small.training(epochs=epochs, **learning), 0, 1), data)


def test_it_learns_keeps_the_best_epoch_and_writes_every_one(trainer, tmp_path):
    trained = trainer()
    done = trained.run(tmp_path)
    losses = [epoch.validation_loss for epoch in done.epochs]
    assert [epoch.epoch for epoch in done.epochs] == list(range(1, EPOCHS + 1))
    assert done.epochs[-1].train_loss < done.epochs[0].train_loss
    assert done.best_epoch().validation_loss == min(losses)
    epochs, errors = read_epochs(tmp_path / METRICS)
    assert epochs == tuple(done.epochs)
    assert tuple(errors) == trained.schedule.joints
    means = np.mean(list(errors.values()), axis=0)
    assert means == pytest.approx([epoch.validation_rmse for epoch in epochs])
    assert len(set(map(tuple, errors.values()))) == len(errors) > 1
    assert (tmp_path / CHECKPOINT).exists()


def test_scales_do_not_see_the_validation_blocks(trainer, data):
    before = trainer().schedule.scales
    for _, end in data.segments:
        data.inputs[end - 100 : end] += 5.0
    np.testing.assert_array_equal(before[0].mean, trainer().schedule.scales[0].mean)


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
    data.targets[20] = 2e7  # how large the loss is depends on the rounding of the processor, up to a factor of two
    epoch = trainer(epochs=1).run(tmp_path).epochs[0]
    assert epoch.train_loss > 50.0  # configs/networks.yaml: divergence_loss


def test_a_training_that_may_diverge_says_so_and_keeps_its_first_weights(trainer, tmp_path):
    diverging = trainer(divergence_loss=-100.0, may_diverge=True)
    first = diverging.network.head.weight.detach().clone()
    done = diverging.run(tmp_path)
    assert done.diverged
    assert not done.epochs
    assert torch.equal(done.best["head.weight"], first)


def test_z_scores_in_place_are_those_of_a_copy_in_half_the_memory(small, data, tmp_path):
    job = TrainingJob(small.training(), 0, 1)
    scored = [Trainer(job, data, in_place=where)._samples for where in (False, True)]
    for name in ("inputs", "targets"):
        copy, own = (getattr(one, name).cpu().numpy() for one in scored)
        np.testing.assert_array_equal(copy, own)
        np.testing.assert_array_equal(getattr(data, name), own)


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


COARSE = ({"stride": 4, "share": 0.4}, {"stride": 2, "share": 0.2})


def test_strides_fall_to_every_sample_and_only_those_epochs_are_kept(trainer, tmp_path):
    done = trainer(coarse=tuple(Coarse(**phase) for phase in COARSE)).run(tmp_path)
    assert [epoch.stride for epoch in done.epochs] == [4, 4, 2, 1, 1]
    assert done.best_epoch().stride == 1
    assert done.best_epoch().validation_loss == min(epoch.validation_loss for epoch in done.epochs[3:])


def test_an_epoch_at_coarse_time_has_as_many_updates(small, data):
    coarse = tuple(Coarse(**phase) for phase in COARSE)
    trained = Trainer(TrainingJob(small.training(coarse=coarse), 0, 1), data)
    plans = [trained.schedule.plan(0, stride) for stride in (1, 2, 4)]
    assert {plan.stride for plan in plans} == {1, 2, 4}
    updates = [len(plan) for plan in plans]
    assert max(updates) <= min(updates) + 1
    ends = [int(plan.rows.max()) + plan.stride * (trained.job.horizon - 1) for plan in plans]
    assert max(ends) < len(data.inputs)


@pytest.mark.parametrize("method", ["GRU", "LSTM"])
def test_the_gate_that_keeps_the_state_keeps_it_for_the_same_time(small, data, method):
    """Where nothing else moves it, a state that decays to a half in 8 ms at one stride does so at another, too."""
    trained = Trainer(TrainingJob(small.training(method), 0, 1), data)
    cell = trained.network.cell
    width, before = cell.width, {name: weight.detach().clone() for name, weight in cell.named_parameters()}
    trained.network.keep_longer(4.0)
    for name, weight in cell.named_parameters():
        moved = weight.detach() - before[name]
        if name == "bias_ih_l0":
            assert torch.allclose(moved[width : 2 * width], torch.full((width,), math.log(4.0)), atol=1e-6)
            moved[width : 2 * width] = 0.0
        assert not moved.any()


@pytest.mark.parametrize("method", ["RNN", "MLP"])
def test_cells_that_do_not_learn_how_long_to_keep_their_state_see_every_sample(small, method):
    coarse = tuple(Coarse(**phase) for phase in COARSE)
    job = TrainingJob(small.training(method, coarse=coarse), 0, 1)
    assert [job.stride(epoch) for epoch in range(EPOCHS)] == [1] * EPOCHS


@pytest.mark.parametrize("optimizer", ["adam", "soap"])
def test_a_training_that_is_killed_goes_on_across_strides_to_the_same_weights(
    small, data, optimizer, monkeypatch, tmp_path
):
    def stop(_):
        raise KeyboardInterrupt

    def fresh():
        coarse = tuple(Coarse(**phase) for phase in COARSE)
        return Trainer(TrainingJob(small.training(optimizer=optimizer, coarse=coarse), 0, 1), data)

    whole = fresh().run(tmp_path / "whole")
    for _ in range(EPOCHS):
        killed = fresh()
        monkeypatch.setattr(killed.schedule, "report", stop)  # behind each checkpoint
        with pytest.raises(KeyboardInterrupt):
            killed.run(tmp_path / "killed")
    done = fresh().run(tmp_path / "killed")
    assert done.epochs == whole.epochs
    assert (tmp_path / "killed" / METRICS).read_bytes() == (tmp_path / "whole" / METRICS).read_bytes()
    assert all(torch.equal(done.best[name], tensor) for name, tensor in whole.best.items())
