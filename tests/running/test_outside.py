"""Nothing is written outside the folders that a user named and the project's own, and nothing is sent anywhere.

What a process opens is seen below Python, as a library in C++ may write and ask the network too.
"""

import json
import sys

import c_library
import numpy as np
import pandas as pd
import pytest

from mobnet.commands.words import COMMANDS
from mobnet.core.code import ROOT
from mobnet.running.environment import child_environment

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not c_library.HAS_COMPILER, reason=c_library.REASON),
]
ARM, URDF = ROOT / "tests" / "data" / "arm.yaml", ROOT / "tests" / "data" / "arm.urdf"
EXAMPLE = ROOT / "docs" / "examples" / "run_onnx.py"
RATE_HZ = 100.0
LOGS = {"train": (1, 40.0), "free": (2, 210.0)}  # seed, duration [s]
ROBOT = ("--robot", str(ARM))
NETWORK = ("--network", "net", "--thresholds", "thresholds.yaml")
CHAIN = (  # each with its module, as the commands of `./reproduce`
    ("mobnet.robot.import_table", str(URDF), "--out", "made.yaml"),
    ("mobnet.robotlog.motion", *ROBOT, "--minutes", "0.05", "--out", "motion.csv"),
    ("mobnet.robotlog.observe", "train.csv", *ROBOT, "--out", "train"),
    ("mobnet.robotlog.observe", "free.csv", *ROBOT, "--out", "free"),
    ("mobnet.robotlog.learn", "train", *ROBOT, "--epochs", "1", "--out", "net"),
    ("mobnet.detection.calibrate", "free", *ROBOT, "--network", "net", "--out", "thresholds.yaml"),
    ("mobnet.robotlog.detect", "train.csv", *ROBOT, *NETWORK, "--out", "found"),
    ("mobnet.export.export", "net", *ROBOT, "--thresholds", "thresholds.yaml", "--out", "run_time"),
    ("mobnet.check", "arm.yaml", "net/weights.safetensors", "--robot", str(ARM)),
    ("mobnet.demo", "--out", "demo.png"),
)
MADE = {
    "made.yaml", "motion.csv", "train", "free", "net", "thresholds.yaml", "found", "run_time", "demo.png",
}  # fmt: skip
RUN = """import importlib, json, sys
for module, *words in json.loads(sys.argv[1]):
    assert importlib.import_module(module).main(words) == 0, module
"""


@pytest.fixture(scope="module")
def lab(tmp_path_factory):
    """A folder with logs of the arm on sines, whose torques are those of friction, with noise."""
    folder = tmp_path_factory.mktemp("lab")
    (folder / "arm.yaml").write_bytes(ARM.read_bytes())
    for name, (seed, seconds) in LOGS.items():
        rng, t = np.random.default_rng(seed), np.arange(0, seconds, 1 / RATE_HZ)
        columns = {"time": t}
        for joint in ("J1", "J2"):
            rate, angle = 2 * np.pi * rng.uniform(0.2, 0.4), rng.uniform(0, 6)
            columns[f"q.{joint}"] = 0.4 * np.sin(rate * t + angle)
            columns[f"v.{joint}"] = 0.4 * rate * np.cos(rate * t + angle)
            columns[f"tau_motor.{joint}"] = 2.0 * columns[f"v.{joint}"] + rng.normal(0, 0.05, len(t))
        pd.DataFrame(columns).to_csv(folder / f"{name}.csv", index=False)
    return folder


def elsewhere(found):
    """Return what a command that must succeed wrote elsewhere, and whom it called."""
    done, written, called = found
    assert done.returncode == 0, done.stdout + done.stderr
    return written, called


def test_the_commands_and_the_example_write_and_send_nothing_elsewhere(watched, lab):
    """From a robot's file to a program of one's own, whose user has set nothing up."""
    variables = child_environment(ROOT)
    before = {path.name for path in lab.iterdir()}
    assert elsewhere(watched(sys.executable, "-P", "-c", RUN, json.dumps(CHAIN), folder=lab, **variables)) == ([], [])
    assert {path.name for path in lab.iterdir()} == before | MADE
    arrays = "train/recording", "train/estimate"
    assert elsewhere(watched(sys.executable, "-I", EXAMPLE, "run_time", *arrays, folder=lab)) == ([], [])
    assert {path.name for path in lab.iterdir()} == before | MADE


def test_a_program_that_runs_exported_networks_writes_and_sends_nothing(watched):
    assert elsewhere(watched(sys.executable, "-c", "import mobnet.export.session")) == ([], [])


def test_the_environment_of_all_commands_keeps_onnx_runtime_quiet(watched):
    assert elsewhere(watched(sys.executable, "-c", "import onnxruntime", **child_environment(ROOT))) == ([], [])


def test_what_is_looked_for_would_be_seen(watched, tmp_path):
    """As ONNX Runtime is by itself: else the other tests would say nothing."""
    outside, _ = elsewhere(watched(sys.executable, "-c", "import onnxruntime"))
    assert any("DeveloperTools" in path for path in outside)
    asks = "import socket\ntry: socket.create_connection(('127.0.0.1', 9), timeout=1)\nexcept OSError: pass"
    assert elsewhere(watched(sys.executable, "-c", asks))[1] == ["127.0.0.1", "connect"]


def test_help_of_all_commands_writes_and_sends_nothing(watched):
    for command in COMMANDS:
        assert elsewhere(watched(sys.executable, ROOT / "reproduce", command, "--help")) == ([], [])
