"""Training end to end: what it leaves, and that a kill -9 changes nothing."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
import torch

from mobnet.core.errors import DataError, TrainingError
from mobnet.learning.checkpoint import CHECKPOINT
from mobnet.learning.networks import WEIGHTS, load_network
from mobnet.learning.precision import precision_name, precision_of
from mobnet.learning.tracking import METRICS
from mobnet.learning.train import RUN, train

SCRIPT = """
import json, sys
from pathlib import Path
from mobnet.learning.train import train
config, recordings, residuals, out, state = json.load(sys.stdin)
train(config, "MOB-Net", "LL", 0, [Path(p) for p in recordings], [Path(p) for p in residuals], Path(out), Path(state))
"""
TIMEOUT_S = 120.0


def run(small: object, folder: Path) -> Path:
    """Train in this process; return the folder of the result."""
    train(small.config, "MOB-Net", "LL", 0, small.recordings, small.residuals, folder / "out", folder / "state")
    return folder / "out"


def kill_after(small: object, folder: Path, epochs: int) -> None:
    """Train in another process and kill it, without warning, once some epochs are done."""
    paths = [list(map(str, stems)) for stems in (small.recordings, small.residuals)]
    handed = json.dumps([small.config, *paths, str(folder / "out"), str(folder / "state")])
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), "OMP_NUM_THREADS": "1"}
    process = subprocess.Popen([sys.executable, "-c", SCRIPT], stdin=subprocess.PIPE, text=True, env=environment)
    assert process.stdin is not None
    process.stdin.write(handed)
    process.stdin.close()
    metrics, end = folder / "state" / METRICS, time.monotonic() + TIMEOUT_S
    while not (metrics.exists() and len(metrics.read_text().splitlines()) > epochs):
        assert process.poll() is None, "the training ended before it could be killed"
        assert time.monotonic() < end, "the training is too slow"
        time.sleep(0.005)
    process.send_signal(signal.SIGKILL)
    process.wait()


def test_it_leaves_weights_metrics_and_a_note(small: object, tmp_path: Path) -> None:
    out = run(small, tmp_path)
    assert {path.name for path in out.iterdir()} == {WEIGHTS, METRICS, RUN}
    assert not (tmp_path / "state" / CHECKPOINT).exists()
    note = json.loads((out / RUN).read_text())
    assert (note["limb"], note["target"], note["samples"]) == ("LL", "uncertainty", 7200)  # nine tenths
    assert note["precision"] == precision_name(precision_of("auto", torch.device(note["device"])))
    assert load_network(out).joints == ("LL1", "LL2", "LL3", "LL4", "LL5", "LL6")


@pytest.mark.slow
def test_a_killed_training_goes_on_to_the_same_bytes(small: object, tmp_path: Path) -> None:
    small.config["sizes"]["experiments"]["left_leg"]["epochs"] = 12
    unbroken = run(small, tmp_path / "unbroken")
    kill_after(small, tmp_path / "killed", epochs=2)
    assert (tmp_path / "killed" / "state" / CHECKPOINT).exists()
    assert not (tmp_path / "killed" / "out").exists()
    resumed = run(small, tmp_path / "killed")
    for name in (WEIGHTS, METRICS):
        assert (resumed / name).read_bytes() == (unbroken / name).read_bytes()


def test_a_training_that_diverges_leaves_no_result(small: object, tmp_path: Path) -> None:
    small.config["learning"]["divergence_loss"] = -100.0
    with pytest.raises(TrainingError):
        run(small, tmp_path)
    assert not (tmp_path / "out").exists()


def test_too_few_samples_are_refused(small: object, tmp_path: Path) -> None:
    small.config["learning"]["batch_size"] = 1000
    with pytest.raises(DataError, match="cannot fill a batch of 1000 streams"):
        run(small, tmp_path)
