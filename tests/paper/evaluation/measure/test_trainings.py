"""Trainings are read as they were written, and one that diverged is known as such."""

from collections.abc import Callable
from pathlib import Path

import pytest

from experiments.evaluation.measure.learning.trainings import read_training, read_trainings
from experiments.evaluation.number.frames import NETWORKS, TRAININGS
from mobnet.core.errors import DataError

Write = Callable[..., Path]


def test_the_epoch_kept_is_the_one_that_validated_best_not_the_last(write_training: Write) -> None:
    training = read_training(write_training("GRU", seed=2, loss=-4.0, epochs=5))
    assert (training.kept.epoch, training.kept.validation_loss) == (4, -4.0)
    assert (training.last.epoch, training.last.validation_loss) == (5, -3.5)
    assert (training.method, training.seed, training.diverged) == ("GRU", 2, False)


def test_networks_and_their_epochs_stand_in_the_order_given_as_their_schemas_say(write_training: Write) -> None:
    folders = [write_training(method, seed) for method in ("RNN", "GRU") for seed in (1, 0)]
    networks, epochs = read_trainings(folders)
    for frame, schema in ((networks, NETWORKS), (epochs, TRAININGS)):
        assert {name: str(kind) for name, kind in frame.dtypes.items()} == {
            name: told[0] for name, told in schema.items()
        }
        runs = frame[["method", "seed"]].drop_duplicates().to_numpy().tolist()
        assert runs == [["RNN", 1], ["RNN", 0], ["GRU", 1], ["GRU", 0]]


def test_a_training_that_diverged_is_known_even_if_it_has_no_epoch(write_training: Write) -> None:
    folders = [write_training("GRU", 0), write_training("GRU", 1, epochs=0, diverged=True)]
    networks, epochs = read_trainings(folders)
    assert networks["diverged"].tolist() == [False, True]
    assert networks["validation_loss"].isna().tolist() == [False, True]
    assert epochs["seed"].unique().tolist() == [0]


def test_a_training_without_epochs_that_did_not_diverge_is_an_error(write_training: Write) -> None:
    folder = write_training("GRU", epochs=0)
    with pytest.raises(DataError, match=r"epochs: 0 in metrics\.csv and 1 in run\.json are not accepted"):
        read_training(folder)


def test_a_missing_file_is_named(write_training: Write) -> None:
    folder = write_training("GRU")
    (folder / "metrics.csv").unlink()
    with pytest.raises(DataError, match=r"metrics\.csv: file is missing"):
        read_training(folder)
