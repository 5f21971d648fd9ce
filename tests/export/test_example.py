"""docs/examples/run_onnx.py runs without this project, and raises its alarms where the project's chain does."""

import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from mobnet.core.columns import EXTERNAL, named
from mobnet.core.estimator import Estimate
from mobnet.core.recording import read_sensed
from mobnet.core.store import read_array
from mobnet.demo import DATA
from mobnet.detection.chain import make_chain
from mobnet.detection.detector import ALARM_RATIO, GateSignal, run_over
from mobnet.detection.signals import Watched
from mobnet.export.export import export
from mobnet.export.trained import read_trained
from mobnet.learning.deployed.limbs import load_limb_networks
from mobnet.settings.detection import Detector

EXAMPLE = Path(__file__).parents[2] / "docs" / "examples" / "run_onnx.py"
NETWORK = DATA / "networks" / "MOB-Net-LL"
LIMITS = {"mean": [6, 18, 18, 25, 8, 6], "ratio": [4.0] * 6}  # N m, and none of a ratio


@pytest.fixture(scope="module")
def estimate(layout):
    """The stored residual less what the project's own network predicts, (T, 6) [N m]."""
    networks = load_limb_networks({"LL": NETWORK}, layout)
    (found,) = networks.run_all([read_sensed(DATA / "recording", layout).sensed])
    residual, _ = read_array(DATA / "estimates" / "MOB", named(EXTERNAL, networks.joints))
    return Estimate(residual - found.mean, found.std)


def begins(estimate, signal, limits, settle):
    """Return when alarms of the project's own chain begin [s], which watches after the first samples."""
    signals = Watched(Detector(method="MOB-Net", signals=(signal,))).of(estimate, np.zeros((len(estimate.tau_ext), 5)))
    gate = GateSignal(np.arange(len(signals)) >= settle, np.zeros(len(signals)))
    chain = make_chain(15.0, 0.005, 1000.0, np.array([limits], dtype=float))
    above = run_over(chain, signals, gate).ratio > ALARM_RATIO
    return np.flatnonzero(np.diff(above, prepend=False) & above) / 1000.0


@pytest.mark.parametrize("signal", ["mean", "ratio"])
def test_alarms_begin_at_the_samples_of_the_project(signal, estimate, robot, run, tmp_path, thresholds):
    network = read_trained(NETWORK, robot.layout)
    limits = {"settle_s": 0.2, "signal": signal, "thresholds": LIMITS[signal], "network": network.run.fingerprint}
    export([network], robot, run, [thresholds("LL", **limits)], tmp_path / "out")
    words = tmp_path / "out", DATA / "recording", DATA / "estimates" / "MOB"
    bare = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    command = [sys.executable, "-I", str(EXAMPLE), *map(str, words)]
    told = subprocess.run(command, capture_output=True, text=True, env=bare, cwd=tmp_path, check=True)
    found = [float(time) for time in re.findall(r"^(\S+) s: LL, first LL\d$", told.stdout, re.MULTILINE)]
    wanted = begins(estimate, signal, LIMITS[signal], settle=200)
    assert found == pytest.approx(wanted)
    assert 0 < len(wanted) < 20


def test_it_is_short_and_imports_nothing_of_the_project():
    text = EXAMPLE.read_text()
    assert len(text.splitlines()) < 60
    assert not re.search(r"import mobnet|from mobnet", text)
