"""Training end to end: which files it writes, and that a kill -9 changes nothing."""

import json
import os
import pickle
import signal
import subprocess
import sys

import pytest
import torch
from patience import wait_for

from experiments.check import Against, check
from mobnet.core.errors import TrainingError
from mobnet.core.files import CHECKPOINT, METRICS, RUN, WEIGHTS
from mobnet.learning.deployed.loading import load_network
from mobnet.learning.job import precision_name, precision_of

SCRIPT = "import pickle, sys; from experiments.jobs.trainings import train as a; a(**pickle.load(sys.stdin.buffer))"


def kill_after(small, training, folder, epochs):
    """Train in another process and kill it, without warning, once some epochs are done."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), "OMP_NUM_THREADS": "1"}
    process = subprocess.Popen([sys.executable, "-c", SCRIPT], stdin=subprocess.PIPE, env=environment)
    assert process.stdin is not None
    pickle.dump(small.arguments(training, folder), process.stdin)
    process.stdin.close()
    metrics = folder / "state" / METRICS

    def is_far():
        assert process.poll() is None, "the training ended before it could be killed"
        return metrics.exists() and len(metrics.read_text().splitlines()) > epochs

    wait_for(is_far, 0.005)
    process.send_signal(signal.SIGKILL)
    process.wait()


def test_it_writes_weights_metrics_and_a_note(small, tmp_path):
    out = small.train(small.training(), tmp_path)
    assert {path.name for path in out.iterdir()} == {WEIGHTS, METRICS, RUN}
    assert not (tmp_path / "state" / CHECKPOINT).exists()
    note = json.loads((out / RUN).read_text())
    assert (note["limb"], note["target"], note["samples"]) == ("LL", "uncertainty", 7200)  # nine tenths
    assert (note["settings"]["network"]["cell"], note["settings"]["epochs"]) == ("GRU", 5)
    asked = small.settings.learning.precision
    assert note["precision"] == precision_name(precision_of(asked, torch.device(note["device"])))
    assert load_network(out).joints == ("LL1", "LL2", "LL3", "LL4", "LL5", "LL6")


@pytest.mark.parametrize(("method", "changes"), [
    ("MOB-Net", {"divergence_loss": -100.0, "may_diverge": True}), ("GRU-spectral", {}), ("TCN", {}),
])  # fmt: skip
def test_what_a_training_writes_is_accepted(method, changes, small, tmp_path):
    training = small.training(method, "LL", epochs=1, **changes)
    out = small.train(training, tmp_path)
    for name in (WEIGHTS, METRICS, RUN):
        assert check(out / name, Against())


@pytest.mark.slow
def test_a_killed_training_goes_on_to_the_same_bytes(small, tmp_path):
    training = small.training(epochs=12)
    unbroken = small.train(training, tmp_path / "unbroken")
    kill_after(small, training, tmp_path / "killed", epochs=2)
    assert (tmp_path / "killed" / "state" / CHECKPOINT).exists()
    assert not (tmp_path / "killed" / "out").exists()
    resumed = small.train(training, tmp_path / "killed")
    for name in (WEIGHTS, METRICS):
        assert (resumed / name).read_bytes() == (unbroken / name).read_bytes()


def test_a_training_that_diverges_gives_no_result(small, tmp_path):
    with pytest.raises(TrainingError):
        small.train(small.training(divergence_loss=-100.0), tmp_path)
    assert not (tmp_path / "out").exists()
