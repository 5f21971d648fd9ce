"""What networks learn side by side reaches the folder of each, as if it had learned alone."""

import json

import numpy as np
import pytest
import torch
from safetensors.numpy import load_file

from experiments.jobs.stacks import train_stack
from experiments.jobs.trainings import train
from mobnet.core.epochs import read_epochs
from mobnet.core.errors import DataError, TrainingError
from mobnet.core.files import CHECKPOINT, METRICS, RUN, WEIGHTS
from mobnet.learning.stacked.train import read_lesson


@pytest.fixture
def taught(small, tmp_path):
    """Return a function that lets two seeds learn side by side, and gives the file and the arguments of each."""

    def teach(**changes):
        training = small.training(epochs=2, batch_size=16, **changes)
        members = {}
        for seed in (0, 1):
            given = {**small.arguments(training, tmp_path / str(seed)), "seed": seed}
            given.pop("out")
            members[f"plant/LL-{seed}"] = {name: value for name, value in given.items() if value is not None}
        file = tmp_path / "stack.safetensors"
        train_stack(members, tmp_path / "state", file)
        assert not (tmp_path / "state" / CHECKPOINT).exists()
        return file, members

    return teach


def test_the_job_of_a_network_takes_what_it_learned(taught, tmp_path, caplog):
    file, members = taught(optimizer="adam")
    assert "no GPU here: 2 networks learn side by side on a processor" in caplog.text
    for seed, (name, given) in enumerate(members.items()):
        out = tmp_path / "taken" / str(seed)
        train(**given, out=out, lesson=(file, name))
        alone = tmp_path / "alone" / str(seed)
        train(**{**given, "state": alone / "state"}, out=alone)
        notes = [json.loads((folder / RUN).read_text()) for folder in (out, alone)]
        assert [note["best"]["epoch"] for note in notes] == [notes[0]["best"]["epoch"]] * 2
        assert notes[0]["fingerprint"] == notes[1]["fingerprint"]
        assert (notes[0]["device"], notes[0]["precision"]) == ("cpu", "float32")
        assert notes[0]["on_windows"]["rmse"] == pytest.approx(notes[1]["on_windows"]["rmse"], rel=1e-2)
        assert len(read_epochs(out / METRICS)[0]) == 2
        weights, expected = (load_file(folder / WEIGHTS) for folder in (out, alone))
        assert weights.keys() == expected.keys()
        for key, array in expected.items():
            np.testing.assert_allclose(weights[key], array, rtol=0.05, atol=5e-3, err_msg=key)
        best = read_lesson(file, name).progress.best
        np.testing.assert_array_equal(weights["head.weight"], best["head.weight"].numpy())


def test_a_file_of_another_training_is_refused(taught, small, tmp_path):
    file, members = taught()
    (name, given), _ = members.items()
    other = {**given, "training": small.training(epochs=2, batch_size=16, rate_first=0.005)}
    with pytest.raises(
        DataError, match=r"stack.safetensors: hash of configuration, data and code: .*; delete the file"
    ):
        train(**other, out=tmp_path / "out", lesson=(file, name))
    with pytest.raises(DataError, match=r"network: 'plant/RL-0' is not accepted; accepted: plant/LL-0, plant/LL-1"):
        train(**given, out=tmp_path / "out", lesson=(file, "plant/RL-0"))
    file.write_bytes(file.read_bytes()[:1000])
    with pytest.raises(DataError, match=r"stack\.safetensors: cannot be read"):
        train(**given, out=tmp_path / "out", lesson=(file, name))


def test_a_network_that_diverged_fails_its_own_job_alone(taught, tmp_path):
    file, members = taught(divergence_loss=-100.0)
    (name, given), _ = members.items()
    with pytest.raises(TrainingError, match=r"MOB-Net-LL-s0: epoch 1: median training loss .* at rate"):
        train(**given, out=tmp_path / "out", lesson=(file, name))
    assert not (tmp_path / "out").exists()


def test_one_that_may_diverge_keeps_its_first_weights(taught, tmp_path):
    file, members = taught(divergence_loss=-100.0, may_diverge=True)
    (name, given), _ = members.items()
    train(**given, out=tmp_path / "out", lesson=(file, name))
    assert json.loads((tmp_path / "out" / RUN).read_text())["diverged"]
    assert torch.from_numpy(load_file(tmp_path / "out" / WEIGHTS)["head.weight"]).isfinite().all()
