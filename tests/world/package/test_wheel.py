"""The package installs into an empty environment, and runs there outside of this folder: a demo, and an arm's path."""

import re
import subprocess
import sys
from pathlib import Path

import pytest
from push_notebook import FOLDER, program

from experiments.commands.tools import Tools

ROOT = Path(__file__).parents[3]
ARM = ROOT / "tests" / "data" / "arm.yaml"
LOGS = {"free": ("--minutes", "4"), "pushed": ("--minutes", "0.5", "--seed", "2", "--pushes")}
PROGRAM = """
import mobnet
arm = mobnet.Robot.read("arm.yaml")
detector = mobnet.Detector.from_files(arm, None, "thresholds.yaml")
samples = mobnet.read_recording("pushed_observed/recording", arm).sensed
print(sum(detector.step(samples[k]).is_on for k in range(len(samples))) > 0)
"""

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    """The commands of an environment that has the wheel, and what it needs for an arm's path, alone."""
    folder = tmp_path_factory.mktemp("package")
    build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)]
    subprocess.run(build, cwd=ROOT, check=True, capture_output=True)
    (wheel,) = folder.glob("*.whl")
    versions = re.findall(r"^(\S+==\S+) \\$", (ROOT / "environment.lock").read_text(), re.MULTILINE)
    constraints = folder / "versions.txt"
    constraints.write_text("\n".join(versions) + "\n")
    tools, environment = Tools.find(ROOT), folder / "environment"
    tools.run("making an environment", str(tools.uv), "venv", "--quiet", "--python", tools.base, str(environment))
    install = [str(tools.uv), "pip", "install", "--quiet", "--python", str(environment / "bin" / "python")]
    wanted = ["-c", str(constraints), f"{wheel}[logs,simulate]"]
    # The set-up of this folder has left all of it in the cache; without that set-up it comes from the registry.
    if tools.try_to(*install, "--offline", *wanted) is not None:
        tools.run("installing the wheel", *install, *wanted)
    return environment / "bin"


@pytest.fixture(scope="module")
def run(installed, tmp_path_factory):
    """A function that runs a command of the environment in a folder of its own, and returns what it prints."""
    folder = tmp_path_factory.mktemp("lab")
    variables = {"PATH": "/usr/bin:/bin", "HOME": str(folder), "XDG_CACHE_HOME": str(folder / "cache")}
    (folder / "arm.yaml").write_bytes(ARM.read_bytes())

    def run_it(name, *words, status=0):
        command = [str(installed / name), *words]
        done = subprocess.run(command, cwd=folder, env=variables, capture_output=True, text=True, check=False)
        assert done.returncode == status, done.stdout + done.stderr
        return done.stdout + done.stderr

    return run_it


def test_the_demo_runs(run):
    lines = run("mobnet", "demo").splitlines()
    errors = {line.split()[0]: line.split()[-2:] for line in lines if line.startswith("LL")}
    assert len(errors) == 6
    assert all(float(network) < float(observer) for observer, network in errors.values())


def test_the_notebook_runs(run):
    assert "MOB-Net-pushed RMSE" in run("python", "-c", f"import os\nos.chdir({str(FOLDER)!r})\n{program()}")


def test_an_arm_goes_from_a_log_to_flags_and_to_a_program(run):
    for name, words in LOGS.items():
        run("mobnet", "motion", "--robot", "arm.yaml", "--out", f"{name}.csv", *words)
        run("mobnet", "observe", f"{name}.csv", "--robot", "arm.yaml")
    run("mobnet", "calibrate", "free_observed", "--robot", "arm.yaml", "--out", "thresholds.yaml")
    said = run("mobnet", "detect", "pushed.csv", "--robot", "arm.yaml", "--thresholds", "thresholds.yaml")
    found, pushes = re.search(r"(\d+) of (\d+) pushes found", said).groups()
    assert 0 < int(found) <= int(pushes)
    assert run("python", "-c", PROGRAM).splitlines()[-1] == "True"


def test_an_extra_that_is_missing_is_one_line_with_the_remedy(run):
    said = run("mobnet", "learn", "free_observed", "--limb", "LL", status=1)
    assert said == "mobnet learn: torch is not installed; accepted: what `pip install 'mobnet[learn]'` installs\n"


def test_a_command_that_is_not_there_is_one_line_with_the_nearest(run):
    assert run("mobnet", "obseve", status=2) == (
        "mobnet: command: 'obseve' is not accepted; "
        "accepted: observe, calibrate, demo, detect, export, identify, learn, motion, robot\n"
    )
