"""docs/examples/run_onnx.py runs without this project, and has its alarms where the project's chain does."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from demo_push import DATA, NETWORK

from mobnet.core.columns import EXTERNAL, named
from mobnet.core.estimator import Estimate
from mobnet.core.recording_file import read_sensed
from mobnet.core.store import read_array
from mobnet.detection.chain import make_chain
from mobnet.detection.detector import ALARM_RATIO, GateSignal, run_over
from mobnet.detection.signals import Watched
from mobnet.export.export import export
from mobnet.export.trained import read_trained
from mobnet.kernel.detecting import WatchedSignals
from mobnet.learning.deployed.loading import load_limb_networks

EXAMPLE = Path(__file__).parents[3] / "docs" / "examples" / "run_onnx.py"
SEGMENTS = [[0, 1200], [1300, 4000]]  # between them samples are missing
LIMITS = {"mean": [6, 18, 18, 25, 8, 6], "ratio": [4.0] * 6}  # N m, and none of a ratio


@pytest.fixture(scope="module")
def estimates(layout):
    """The stored residual less what the project's own network predicts in each segment, (T_i, 6) [N m]."""
    networks = load_limb_networks({"LL": NETWORK}, layout)
    sensed = read_sensed(DATA / "recording", layout).sensed
    residual, _ = read_array(DATA / "estimates" / "MOB", named(EXTERNAL, networks.joints))
    found = networks.run_all([sensed[start:end] for start, end in SEGMENTS])
    return [
        Estimate(residual[start:end] - one.mean, one.std) for one, (start, end) in zip(found, SEGMENTS, strict=True)
    ]


def edges(estimate, signal, limits, settle):
    """Return when alarms of the project's own chain begin and end [s], which watches after the first samples."""
    signals = Watched(WatchedSignals(signals=(signal,))).of(estimate, np.zeros((len(estimate.tau_ext), 5)))
    gate = GateSignal(np.arange(len(signals)) >= settle, np.zeros(len(signals)))
    chain = make_chain(15.0, 0.005, 1000.0, np.array([limits], dtype=float))
    above = run_over(chain, signals, gate).ratio > ALARM_RATIO
    return np.flatnonzero(np.diff(above, prepend=False)) / 1000.0


@pytest.mark.parametrize("signal", ["mean", "ratio"])
def test_alarms_begin_and_end_at_the_samples_of_the_project(signal, estimates, robot, run, gate, tmp_path, thresholds):
    network = read_trained(NETWORK, robot.layout)
    limits = {"settle_s": 0.2, "signal": signal, "thresholds": LIMITS[signal], "network": network.run.fingerprint}
    export([network], robot, run, [thresholds("LL", **limits)], gate, tmp_path / "out")
    for name in ("recording.json", "recording.parquet"):
        shutil.copy(DATA / name, tmp_path)
    note = json.loads((tmp_path / "recording.json").read_text())
    (tmp_path / "recording.json").write_text(json.dumps({**note, "segments": SEGMENTS}))
    words = tmp_path / "out", tmp_path / "recording", DATA / "estimates" / "MOB"
    bare = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    command = [sys.executable, "-I", str(EXAMPLE), *map(str, words)]
    told = subprocess.run(command, capture_output=True, text=True, env=bare, cwd=tmp_path, check=True)
    found = [float(time) for time in re.findall(r"^(\S+) s: LL, (?:first LL\d|over)$", told.stdout, re.MULTILINE)]
    parts = [edges(one, signal, LIMITS[signal], settle=200) for one in estimates]
    wanted = np.concatenate([start / 1000.0 + own for own, (start, _) in zip(parts, SEGMENTS, strict=True)])
    assert found == pytest.approx(wanted)
    assert len(found) == len(told.stdout.splitlines())
    assert all(0 < len(own) < 40 for own in parts)


def test_it_is_short_and_imports_nothing_of_the_project():
    text = EXAMPLE.read_text()
    assert len(text.splitlines()) < 60
    assert not re.search(r"import mobnet|from mobnet", text)
