"""A run that was killed and went on is one run: the same bytes, and results of one commit, which a snapshot accepts."""

import os
import shutil
import signal
import subprocess
import sys

import pytest
from patience import wait_for

from .conftest import PARTS

TARGET = "results/smoke/plant/residuals/forward_walk/ideal"
ARRAYS = ("recordings", "residuals")
CHECK = """
import sys
from pathlib import Path
from mobnet.core.errors import DataError
from experiments.evaluation.report.manifest import manifest
from experiments.site.snapshot import check_fingerprints, check_run

results = Path("results/smoke")
listed = Path("listed.sha256")
manifest(results, [], [], listed)
try:
    check_run(results, listed)
    check_fingerprints(*sys.argv[1:])
except DataError as error:
    sys.exit(str(error))
"""

pytestmark = [pytest.mark.slow, pytest.mark.sim]


def command(folder):
    return [sys.executable, str(folder / "reproduce"), TARGET]


def start(folder):
    words = [*command(folder), "--cores", "1"]
    with (folder / "out.log").open("ab") as out:
        return subprocess.Popen(words, cwd=folder, stdout=out, stderr=out, start_new_session=True)


def kill_when(run, began):
    """Kill a run with all its processes as soon as a file is there."""
    wait_for(began.exists, 0.02)
    os.killpg(run.pid, signal.SIGKILL)
    run.wait()


def arrays(folder):
    places = [folder / "results" / "smoke" / "plant" / kind for kind in ARRAYS]
    return {str(path): path.read_bytes() for place in places for path in place.rglob("s*.*") if path.is_file()}


def git(folder, *words):
    author = ("-c", "user.name=Somebody", "-c", "user.email=somebody@example.org", "-c", "commit.gpgsign=false")
    subprocess.run(["git", *author, *words], cwd=folder, check=True, capture_output=True)


def refusal(folder, *changes):
    """Return why the results are not those of the commit and of a configuration; nothing if they are."""
    python, changed = str(folder / ".venv" / "bin" / "python"), ("--config", "scale=smoke", *changes)
    words = [python, "-c", CHECK, TARGET, *changed]
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)
    assert "Traceback" not in done.stderr
    return done.stderr.strip()


def test_a_killed_run_that_went_on_is_one_run(make_project):
    folder = make_project("stopped")
    git(folder, "init", "--quiet")
    git(folder, "add", *PARTS)
    git(folder, "commit", "--quiet", "-m", "all")
    log = folder / "results" / "smoke" / "logs" / "collect" / "plant" / "forward_walk-ideal.log"
    kill_when(start(folder), log)
    assert not (folder / TARGET).exists()
    assert start(folder).wait() == 0, (folder / "out.log").read_text()
    resumed = arrays(folder)
    assert refusal(folder) == ""
    places = [str(folder / "results/smoke/plant" / kind) for kind in ARRAYS]
    check = [sys.executable, str(folder / "reproduce"), "check", *places]
    assert subprocess.run(check, cwd=folder, check=False, capture_output=True).returncode == 0
    for kind in ARRAYS:
        shutil.rmtree(folder / "results/smoke/plant" / kind)
    assert start(folder).wait() == 0
    assert arrays(folder) == resumed
    assert "jobs would run again, which is not accepted" in refusal(folder, "observer={gain_hz: 50}")
    (folder / "docs" / "map.md").write_text("changed\n")
    assert "-changed: is not accepted; accepted: a checkout without changed files" in refusal(folder)
    git(folder, "commit", "--quiet", "--all", "-m", "other words")
    assert refusal(folder) == ""
    plant = folder / "configs" / "plant.yaml"
    plant.write_text(plant.read_text() + "# another comment\n")
    git(folder, "commit", "--quiet", "--all", "-m", "another configuration")
    (line,) = refusal(folder).splitlines()
    assert line.startswith("results/smoke/logs/collect/plant/forward_walk-ideal.json: commit ")
    assert "from which configs/plant.yaml differs" in line
    assert "further files" in line
