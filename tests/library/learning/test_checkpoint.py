"""Checkpoints: what is saved comes back, and what belongs elsewhere does not."""

import csv
import logging

import pytest
import torch

from mobnet.core.epochs import Epoch
from mobnet.core.files import METRICS
from mobnet.learning import checkpoint
from mobnet.learning.cells import Gru
from mobnet.learning.checkpoint import Progress
from mobnet.learning.model import LimbNetwork


def trained(steps):
    """Return a small network and its optimizer after some updates."""
    torch.manual_seed(0)
    network = LimbNetwork(Gru(3, 8), 2, 1e-6)
    optimizer = torch.optim.Adam(network.parameters(), lr=1e-2)
    for _ in range(steps):
        advance((network, optimizer))
    return network, optimizer


def advance(pair):
    pair[1].zero_grad()
    pair[0](torch.ones(5, 2, 3), pair[0].fresh_state(2))[0].square().sum().backward()
    pair[1].step()


def epoch(number, validation_loss, stride=1):
    return Epoch(number, 0.0, validation_loss, 0.0, 0.0, 0.0, stride)


@pytest.fixture
def saved(tmp_path):
    pair = trained(3)
    done = Progress([epoch(1, 0.5)], [[0.25, 0.75]], checkpoint.copy_weights(pair[0]), 2.5)
    checkpoint.save(tmp_path / "c.safetensors", "print", *pair, done)
    return tmp_path / "c.safetensors", pair, done


def test_a_resumed_pair_takes_the_same_next_step(saved):
    path, pair, done = saved
    other = trained(0)
    found = checkpoint.resume(path, "print", *other)
    assert (found.epochs, found.errors, found.seconds) == (done.epochs, done.errors, done.seconds)
    assert all(torch.equal(found.best[name], tensor) for name, tensor in done.best.items())
    for both in (pair, other):
        advance(both)
    weights = zip(pair[0].parameters(), other[0].parameters(), strict=True)
    assert all(torch.equal(a, b) for a, b in weights)


def test_a_checkpoint_of_another_run_is_not_used_and_says_so(saved, caplog):
    network, optimizer = trained(0)
    before = checkpoint.copy_weights(network)
    with caplog.at_level(logging.WARNING):
        assert checkpoint.resume(saved[0], "other", network, optimizer).epochs == []
    assert "starting afresh" in caplog.text
    assert all(torch.equal(before[name], tensor) for name, tensor in network.state_dict().items())


def test_a_damaged_checkpoint_is_not_used_and_says_so_nor_is_one_that_is_not_there(saved, caplog):
    saved[0].write_bytes(saved[0].read_bytes()[:100])
    assert checkpoint.resume(saved[0], "print", *trained(0)).epochs == []
    assert "damaged" in caplog.text
    assert checkpoint.resume(saved[0].with_name("none"), "print", *trained(0)).epochs == []


def test_the_first_of_equal_epochs_is_the_best():
    epochs = [epoch(number, loss) for number, loss in enumerate([3.0, 1.0, 2.0, 1.0], start=1)]
    assert Progress(epochs).best_epoch() is epochs[1]


def test_the_best_epoch_is_one_of_the_finest_time():
    epochs = [epoch(1, 0.5, stride=8), epoch(2, 3.0), epoch(3, 2.0)]
    assert Progress(epochs).best_epoch() is epochs[2]


def test_the_same_training_writes_the_same_bytes(saved, tmp_path):
    checkpoint.save(tmp_path / "again", "print", *saved[1], saved[2])
    assert (tmp_path / "again").read_bytes() == saved[0].read_bytes()


def test_metrics_come_back_as_written(tmp_path):
    epochs = [Epoch(number, *(10.0 * number + k for k in range(5)), 1) for number in (1, 2, 3)]
    errors = [[number + 0.5, number + 0.25] for number in (1, 2, 3)]
    checkpoint.write_metrics(tmp_path / METRICS, Progress(epochs, errors), ("LL1", "LL2"))
    with (tmp_path / METRICS).open() as file:
        read = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
    joints = [{"validation_rmse_LL1": one, "validation_rmse_LL2": other} for one, other in errors]
    assert read == [vars(epoch) | own for epoch, own in zip(epochs, joints, strict=True)]
