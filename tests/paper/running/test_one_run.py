"""While a run goes on in a folder, what would make or remove files there is refused in one line; what reads is not."""

import os
import signal
import subprocess
import sys

import pytest

from experiments.running.begun import lost, record_begun, record_end
from experiments.running.one_run import LOCK, held_folder, only_looks
from experiments.running.processes import end_orphans
from mobnet.core.errors import CommandError

REFUSED = (
    r"a run goes on in this folder since \d\d:\d\d \(all --config scale=smoke, process \d+\); "
    r"wait for it, or use a clone"
)
WORDS = ("all", "--config", "scale=smoke")


def test_a_second_run_is_refused_in_one_line_and_the_first_keeps_the_folder(tmp_path):
    with held_folder(tmp_path, WORDS):
        for _ in range(2):
            with pytest.raises(CommandError, match=f"^{REFUSED}$"), held_folder(tmp_path, ["docs"]):
                pass
    with held_folder(tmp_path, ["docs"]):
        assert (tmp_path / LOCK).read_text().endswith(f" {os.getpid()} docs")


def test_a_run_that_has_not_yet_written_who_it_is_keeps_the_folder_too(tmp_path):
    with held_folder(tmp_path, WORDS):
        (tmp_path / LOCK).write_text("")
        with pytest.raises(CommandError, match="a run has just begun in this folder"), held_folder(tmp_path, []):
            pass


def test_a_killed_run_leaves_the_folder_free(tmp_path):
    code = """
import os, pathlib, signal, sys
from experiments.running.one_run import hold_folder
hold_folder(pathlib.Path(sys.argv[1]), ["all"])
os.kill(os.getpid(), signal.SIGKILL)
"""
    done = subprocess.run([sys.executable, "-c", code, str(tmp_path)], check=False)
    assert done.returncode == -signal.SIGKILL
    with held_folder(tmp_path, WORDS):
        pass


@pytest.mark.parametrize(
    "words", ["all -n", "-np all", "all --dry-run", "--summary", "--dag all", "--lint", "--list-rules"]
)
def test_what_only_looks_is_known(words):
    assert only_looks(words.split())


@pytest.mark.parametrize("words", ["all", "tables/table_01.tex --cores 2", "--touch", "--unlock", "-F all", "-R train",
                                   "--config scale=new", "--report report.html --report-after-run"])  # fmt: skip
def test_what_makes_or_removes_is_known(words):
    assert not only_looks(words.split())


def test_jobs_that_outlived_a_killed_run_are_ended(tmp_path):
    script = tmp_path / ".snakemake" / "scripts" / "tmpabc.train.py"
    other = tmp_path / "train.py"
    for path in (script, other):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(
            "import signal, time\nsignal.signal(signal.SIGTERM, signal.SIG_IGN)\nprint(flush=True)\ntime.sleep(60)"
        )
    left, foreign = (subprocess.Popen([sys.executable, str(path)], stdout=subprocess.PIPE) for path in (script, other))
    for process in (left, foreign):
        process.stdout.readline()
    end_orphans(tmp_path)
    assert left.wait(10.0) < 0
    assert foreign.poll() is None
    for process in (left, foreign):
        process.kill()
        process.communicate()


def test_what_was_begun_and_is_not_there_is_lost_until_it_is_made(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    listed = tmp_path / "state" / "begun.txt"
    assert lost(listed) == []
    record_begun(listed, ["results/a", "results/b.csv"])
    (tmp_path / "results" / "a").mkdir(parents=True)
    assert lost(listed) == ["results/b.csv"]
    record_begun(listed, ["results/c.csv"])  # of another target: what was lost before still is
    assert lost(listed) == ["results/b.csv", "results/c.csv"]
    (tmp_path / "results" / "c.csv").touch()
    record_end(listed)
    assert lost(listed) == ["results/b.csv"]
    (tmp_path / "results" / "b.csv").touch()
    record_end(listed)
    assert not listed.exists()
