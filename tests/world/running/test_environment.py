"""Every process of the project runs one thread and writes inside the project."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from experiments.running.environment import CACHES, child_environment, fault_of_place, quieten
from mobnet.core.code import ROOT


def test_caches_lie_inside_the_project_and_each_process_has_one_thread(tmp_path):
    variables = child_environment(tmp_path)
    for name in CACHES.keys() - {"TMPDIR"}:
        assert Path(variables[name]).is_relative_to(tmp_path)
        assert Path(variables[name]).is_dir()
    assert {value for name, value in variables.items() if name.endswith("_NUM_THREADS")} == {"1"}
    assert "TMPDIR" not in child_environment(tmp_path / ("long" * 20)), "too long for the path of a socket"


@pytest.mark.parametrize("sign", ':{}"\\\n')
def test_a_path_with_a_sign_of_other_tools_is_not_accepted(sign):
    assert fault_of_place(Path("/place/it's a [copy] ü")) is None
    assert "is not accepted in the path" in str(fault_of_place(Path(f"/place/a{sign}b")))


def test_what_a_user_set_stays(tmp_path, monkeypatch):
    monkeypatch.setattr(os, "environ", {"OMP_NUM_THREADS": "4"})
    quieten(tmp_path)
    assert os.environ["OMP_NUM_THREADS"] == "4"
    assert os.environ["WANDB_MODE"] == "offline"


IMPORT_ALL = """import importlib, logging, os, pkgutil, sys
written, before = [], dict(os.environ)
changes = os.O_WRONLY | os.O_RDWR | os.O_CREAT


def note(event, arguments):
    if event == "os.mkdir" or (event == "open" and arguments[2] & changes):
        written.append(str(arguments[0]))


sys.addaudithook(note)
import experiments, mobnet, numba

for package in (mobnet, experiments):
    for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
        importlib.import_module(module.name)
cache = os.path.dirname(os.environ["NUMBA_CACHE_DIR"])
assert numba.config.CACHE_DIR == os.environ["NUMBA_CACHE_DIR"], numba.config.CACHE_DIR
assert dict(os.environ) == before, set(os.environ.items()) ^ set(before.items())
assert not logging.getLogger().handlers
outside = [name for name in written if name.startswith("/") and not name.startswith((cache, os.devnull))]
assert not outside, outside
"""


@pytest.mark.slow
def test_importing_changes_nothing(tmp_path):
    """All modules: no variable, no setting, no log, no file but in the caches of other packages."""
    environment = {**os.environ, **child_environment(tmp_path)}
    subprocess.run([sys.executable, "-B", "-c", IMPORT_ALL], check=True, env=environment)


DRAWN = """
from experiments import look as command
command._look = lambda _: 0
command.main([])
import matplotlib.font_manager
"""
CALLED = {
    "a picture": ["-c", DRAWN],
    "check": ["-m", "experiments.check", "README.md"],
    "calibrate": ["-m", "mobnet.detection.calibrate", "--recording", "x", "--estimate", "x"],
    "demo": ["-m", "experiments.demo", "--out", ".cache/demo.png"],
    "compare": ["-m", "experiments.site.snapshot", "compare"],
    "cost": ["-m", "experiments.evaluation.report.cost", "--config", "scale=smoke"],
    "schema": ["-m", "experiments.settings"],
    "snakemake": ["-m", "snakemake", "-n", "--config", "scale=smoke", "--", "tables/smoke/table_01.csv"],
}


@pytest.fixture
def home(tmp_path):
    """Variables of a user with a fresh home, who says nothing about caches."""
    kept = {name: value for name, value in os.environ.items() if name not in CACHES}
    (tmp_path / "home").mkdir()
    return {**kept, "HOME": str(tmp_path / "home")}


@pytest.mark.slow
@pytest.mark.parametrize("name", CALLED)
def test_a_command_that_is_called_directly_writes_nothing_elsewhere_and_sends_nothing(name, watched):
    kept = {key: value for key, value in os.environ.items() if key not in CACHES}
    _, written, called = watched(sys.executable, *CALLED[name], folder=ROOT, **kept)
    assert (written, called) == ([], [])


def test_a_set_up_writes_nothing_at_home_where_rust_is_installed(home, tmp_path):
    """The proxy of `rustup`, which pip asks for its version, makes its home."""
    proxy = tmp_path / "bin" / "rustc"
    proxy.parent.mkdir()
    proxy.write_text('#!/bin/sh\nmkdir -p "${RUSTUP_HOME:-$HOME/.rustup}/seen"\n')
    proxy.chmod(0o755)
    variables = {**home, **child_environment(tmp_path), "PATH": f"{proxy.parent}{os.pathsep}{home['PATH']}"}
    asked = "from pip._internal.network.session import user_agent; user_agent()"
    python = getattr(sys, "_base_executable", sys.executable)
    done = subprocess.run([python, "-c", asked], env=variables, check=False, capture_output=True, text=True)
    if "No module named 'pip'" in done.stderr:
        subprocess.run(["rustc"], env=variables, check=True)
    assert (tmp_path / ".cache" / "rustup" / "seen").is_dir()
    assert os.listdir(home["HOME"]) == []
