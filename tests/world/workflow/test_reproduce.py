"""The entry script on a bare machine, and in folders that were copied, moved, or are named as nobody expects."""

import os
import re
import shutil
import subprocess
import sys
import time
from itertools import pairwise

import pytest

from experiments.commands.setup import fault_of
from experiments.commands.words import COMMANDS

from .conftest import ROOT

ENTRY = str(ROOT / "reproduce")
CHECK_S = 1.0  # 0.1 s on an idle machine


def call(*words, folder=ROOT, **variables):
    """Run a command in a folder and return what it printed, its two streams together."""
    both = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True, "check": False}
    return subprocess.run(list(map(str, words)), cwd=folder, env={**os.environ, **variables}, **both)


@pytest.mark.parametrize("words", [["--help"], ["clean", "-h"]])
def test_help_needs_no_environment(words):
    bare = [sys.executable, "-I", "-S", ENTRY, *words]
    done = subprocess.run(bare, capture_output=True, text=True, check=True, env={"PATH": "/usr/bin:/bin"})
    assert all(command in done.stdout for command in COMMANDS) or words[0] in done.stdout


@pytest.mark.parametrize("words", [[], ["setup", "--cpu", "--cuda"]])
def test_unknown_words_are_refused(words):
    done = call(sys.executable, ENTRY, *words)
    assert done.returncode == 2
    assert "usage: ./reproduce" in done.stdout


def test_foreign_modules_never_reach_it(tmp_path):
    (tmp_path / "argparse.py").write_text("raise ImportError('foreign argparse')")
    done = call(
        sys.executable, ENTRY, "--help", PYTHONPATH=str(tmp_path), PYTHONSTARTUP="/none", PYTHONWARNINGS="error"
    )
    assert done.returncode == 0, done.stdout


def test_an_accepted_python_is_looked_for_on_path(tmp_path):
    older = tmp_path / "older.py"  # runs the script as a Python that is not accepted
    older.write_text(f"import sys, runpy\nsys.version_info = (3, 9, 2)\nsys.argv = [{ENTRY!r}, 'al']\n")
    older.write_text(older.read_text() + f"runpy.run_path({ENTRY!r}, run_name='__main__')\n")
    shim = tmp_path / "bin" / "python3.11"
    shim.parent.mkdir()
    shim.write_text("#!/bin/sh\nexit 127\n")  # as pyenv's for a version that is not chosen
    shim.chmod(0o755)
    script = ENTRY.replace(str(ROOT), str(tmp_path))
    shutil.copy2(ENTRY, script)
    older.write_text(older.read_text().replace(ENTRY, script))
    done = call(sys.executable, older, PATH=str(shim.parent))
    assert "python3.11, python3.12, python3.13: one is needed, found Python 3.9.2" in done.stdout
    (tmp_path / "bin" / "python3.12").symlink_to(sys.executable)
    (tmp_path / "src").symlink_to(ROOT / "src")
    assert "'al' is not accepted" in call(sys.executable, older, PATH=str(shim.parent)).stdout


def test_every_start_checks_the_environment_in_no_time():
    times = [time.process_time()]
    for _ in range(3):
        assert fault_of(ROOT, None) is None
        times.append(time.process_time())
    assert min(end - start for start, end in pairwise(times)) < CHECK_S


@pytest.fixture(scope="module")
def copied(make_project):
    """A copy of the project with its environment, whose packages are linked to save time, under an awkward name."""
    folder = make_project("copied")
    (folder / ".venv").unlink()
    (folder / ".venv").mkdir()
    for name in ("pyvenv.cfg", "installed"):
        shutil.copy2(ROOT / ".venv" / name, folder / ".venv" / name)
    shutil.copytree(ROOT / ".venv" / "bin", folder / ".venv" / "bin", symlinks=True, copy_function=os.link)
    (folder / ".venv" / "lib").symlink_to(ROOT / ".venv" / "lib")
    return folder.rename(folder.with_name("it's a [copy]"))


def test_a_copy_runs_its_own_code(copied):
    assert call(sys.executable, copied / "reproduce", "setup").stdout == ""
    done = call(copied / ".venv/bin/python", "-c", "import mobnet; print(mobnet.__file__)", folder=copied)
    assert done.stdout == f"{copied}/src/mobnet/__init__.py\n"


@pytest.mark.parametrize("shell", ["sh", "bash"])
def test_activation_is_that_of_the_copy(copied, shell):
    script = ". .venv/bin/activate; echo $VIRTUAL_ENV; command -v snakemake; snakemake --version >&2"
    done = call(shell, "-c", script, folder=copied)
    assert done.stdout.startswith(f"{copied}/.venv\n{copied}/.venv/bin/snakemake\n9.")


@pytest.mark.slow
def test_jobs_of_a_copy_run_its_code(copied):
    module = copied / "src/mobnet/simulation/record.py"
    text = module.read_text()
    module.write_text(f"{text}\nraise SystemExit('the code of the copy')\n")
    target = "results/smoke/plant/recordings/forward_walk/ideal"
    done = call(sys.executable, copied / "reproduce", target, "--cores", "1", folder=copied)
    module.write_text(text)
    assert done.returncode == 1
    assert "the code of the copy" in done.stdout
    assert "Syntax error" not in done.stdout


@pytest.mark.slow
def test_foreign_packages_never_reach_a_run(copied, tmp_path):
    (tmp_path / "yaml.py").write_text("safe_load = None")
    target = "tables/smoke/table_05.tex"
    for words in (
        [sys.executable, copied / "reproduce", target, "-n"],
        [copied / ".venv/bin/snakemake", "-n", "--config", "scale=smoke", "--", target],
    ):
        done = call(*words, folder=copied, PYTHONPATH=str(tmp_path))
        assert done.returncode == 0, done.stdout
        assert re.search(r"^table +1$", done.stdout, re.MULTILINE)


def test_another_python_is_refused_with_one_line(make_project, snakemake, monkeypatch):
    original = call(sys.executable, "-m", "snakemake", "-n", folder=make_project("original"))
    assert original.returncode == 1
    assert f"runs {ROOT}/src in place of" in original.stdout.splitlines()[-1]
    monkeypatch.setenv("PYTHONPATH", "/opt/ros/lib")
    foreign = snakemake("-n")
    assert foreign.stderr.splitlines()[-1].startswith("PYTHONPATH: '/opt/ros/lib' holds packages of other software")
    assert "Traceback" not in original.stdout + foreign.stderr


def test_a_path_that_tools_misread_is_refused(make_project, snakemake):
    folder = make_project("named")
    folder = folder.rename(folder.with_name("a:b"))
    for done in (call(sys.executable, folder / "reproduce", "all", "-n"), snakemake("-n", folder=folder)):
        told = done.stdout + (done.stderr or "")
        assert done.returncode == 1
        assert "':' is not accepted in the path of the project" in told.splitlines()[-1]


def test_a_target_of_another_scale_is_told(snakemake):
    done = snakemake("-n", "--config", "scale=default", "--", "tables/smoke/table_05.tex")
    assert done.returncode == 1
    line = "tables/smoke/table_05.tex: is not made at scale=default; accepted: --config scale=smoke"
    assert done.stderr.splitlines()[-1] == line
