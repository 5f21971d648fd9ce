"""One run in a folder; jobs share a lock of their own; only unfinished files are removed."""

import errno
import fcntl
import os
import subprocess
import sys

import pytest

from mobnet.core.lock import JOBS, LOCKS, RUN, begin_run, holder, job_prefix, sweep, warn_of_missing_locks

HOLD = """
import fcntl, sys, time
lock = open(sys.argv[1], "w")
fcntl.flock(lock, fcntl.LOCK_EX)
print("held", flush=True)
time.sleep(60)
"""


@pytest.mark.parametrize("name", LOCKS)
def test_who_holds_a_lock_is_told(tmp_path, name):
    (tmp_path / ".cache").mkdir()
    words = [sys.executable, "-c", HOLD, str(tmp_path / name)]
    with subprocess.Popen(words, stdout=subprocess.PIPE) as other:
        assert other.stdout is not None
        other.stdout.readline()
        assert holder(tmp_path) == LOCKS[name]
        other.kill()
    assert holder(tmp_path) is None


def test_a_job_holds_its_lock_in_a_folder_of_any_name_and_leaves_ctrl_c_to_its_run(tmp_path):
    root = tmp_path / "a folder's name"
    root.mkdir()
    begin_run(root)
    words = ["bash", "-c", f"{job_prefix(root)} echo held; kill -INT $$; read"]
    with subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as job, (root / JOBS).open("w") as lock:
        assert job.stdout is not None
        job.stdout.readline()
        with pytest.raises(BlockingIOError):
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        job.communicate(b"\n")
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    assert job.returncode == 0


def test_a_job_of_an_earlier_run_ends_at_once_with_one_line(tmp_path, monkeypatch):
    begin_run(tmp_path)
    words = ["bash", "-c", f"{job_prefix(tmp_path)} echo works"]
    assert subprocess.run(words, capture_output=True, text=True, check=True).stdout == "works\n"
    before = os.environ[RUN]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mobnet.core.lock.LOCKS", {JOBS: ""})  # this process holds the other one
        begin_run(tmp_path)
    monkeypatch.setenv(RUN, before)
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr == "the run that asked for this job has ended, and another one has begun\n"


def test_a_file_system_without_locks_is_told_once(tmp_path, monkeypatch, caplog):
    def refuse(*_):
        raise OSError(errno.ENOLCK, "No locks available")

    monkeypatch.setattr("fcntl.flock", refuse)
    warn_of_missing_locks.cache_clear()
    assert not begin_run(tmp_path)
    assert caplog.messages == ["this file system has no locks: nothing keeps two runs in this folder apart"]
    assert holder(tmp_path) is None


def test_only_unfinished_files_are_removed(tmp_path):
    kept = ["results/a.parquet", "results/.partial.md", "results/.mine.parquet", "configs/.partial.abcdefgh.x"]
    gone = ["results/smoke/.partial.ab_12345.s1.parquet", "tables/.partial.abcdefgh.t.csv", ".cache/tmp/run-1/x"]
    gone += [".snakemake/scripts/tmpabcdefgh.call.py", "results/.partial.abcdefgh.wandb/a/b"]
    for name in (*kept, *gone):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    sweep(tmp_path)
    assert {str(path.relative_to(tmp_path)) for path in tmp_path.rglob("*") if path.is_file()} == set(kept)
