"""Nothing is written outside the folders that a user named and the project's own, and nothing is sent anywhere.

What a process opens is seen below Python, as a library in C++ may write and ask the network too.
"""

import json
import shutil
import sys

import c_library
import numpy as np
import pandas as pd
import pytest

from experiments.commands.words import COMMANDS
from experiments.running.environment import child_environment
from experiments.settings.load import load_settings
from mobnet.core.code import ROOT
from mobnet.core.errors import ConfigError

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
    ("experiments.check", "arm.yaml", "net/weights.safetensors", "thresholds.yaml", "--robot", str(ARM)),
)
MADE = {"made.yaml", "motion.csv", "train", "free", "net", "thresholds.yaml", "found", "run_time"}
# Two functions read the configuration; both get the folder that is given.
RUN = """import importlib, json, sys
from pathlib import Path
from mobnet.settings import lab
from experiments.settings import load
lab.load_lab.__defaults__ = (Path(sys.argv[2]),)
load.load_settings.__defaults__ = (Path(sys.argv[2]), None, None)
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


@pytest.fixture(scope="module")
def broken(tmp_path_factory):
    """A configuration in which a claim, a figure and a scenario are wrong, as the paper's authors may leave it."""
    folder = tmp_path_factory.mktemp("project") / "configs"
    shutil.copytree(ROOT / "configs", folder)
    for name in ("claims", "evaluation", "data", "scales", "walking"):
        path = folder / f"{name}.yaml"
        path.write_text(path.read_text() + "\nno_such_section: 1\n")
    with pytest.raises(ConfigError, match="no_such_section"):
        load_settings(folder)
    return folder


def elsewhere(found):
    """Return what a command that must succeed wrote elsewhere, and whom it called."""
    done, written, called = found
    assert done.returncode == 0, done.stdout + done.stderr
    return written, called


def test_the_commands_and_the_example_write_and_send_nothing_elsewhere(watched, lab, broken):
    """From a robot's file to a program of one's own, whose user has set nothing up.

    Nothing of it needs the configuration of the paper's experiments, which cannot be read here.
    """
    variables = child_environment(ROOT)
    before = {path.name for path in lab.iterdir()}
    words = (sys.executable, "-P", "-c", RUN, json.dumps(CHAIN), broken)
    assert elsewhere(watched(*words, folder=lab, **variables)) == ([], [])
    assert {path.name for path in lab.iterdir()} == before | MADE
    arrays = "train/recording", "train/estimate"
    assert elsewhere(watched(sys.executable, "-I", EXAMPLE, "run_time", *arrays, folder=lab)) == ([], [])
    assert {path.name for path in lab.iterdir()} == before | MADE


def test_the_demo_writes_and_sends_nothing_elsewhere(watched, tmp_path):
    words = (sys.executable, "-P", "-m", "experiments.demo", "--out", "demo.png")
    assert elsewhere(watched(*words, folder=tmp_path, **child_environment(ROOT))) == ([], [])
    assert (tmp_path / "demo.png").exists()


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
