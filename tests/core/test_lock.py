"""One run in a folder; jobs share a lock of their own; only unfinished files are removed."""

import fcntl
import subprocess
import sys
from pathlib import Path

import pytest

from mobnet.core.lock import JOBS, LOCKS, holder, job_prefix, sweep

HOLD = """
import fcntl, sys, time
lock = open(sys.argv[1], "w")
fcntl.flock(lock, fcntl.LOCK_EX)
print("held", flush=True)
time.sleep(60)
"""


@pytest.mark.parametrize("name", LOCKS)
def test_who_holds_a_lock_is_told(tmp_path: Path, name: str) -> None:
    (tmp_path / ".cache").mkdir()
    words = [sys.executable, "-c", HOLD, str(tmp_path / name)]
    with subprocess.Popen(words, stdout=subprocess.PIPE) as other:
        assert other.stdout is not None
        other.stdout.readline()
        assert holder(tmp_path) == LOCKS[name]
        other.kill()
    assert holder(tmp_path) is None


def test_a_job_holds_its_lock_in_a_folder_of_any_name_and_leaves_ctrl_c_to_its_run(tmp_path: Path) -> None:
    root = tmp_path / "a folder's name"
    (root / ".cache").mkdir(parents=True)
    words = ["bash", "-c", f"{job_prefix(root)} echo held; kill -INT $$; read"]
    with subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as job, (root / JOBS).open("w") as lock:
        assert job.stdout is not None
        job.stdout.readline()
        with pytest.raises(BlockingIOError):
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        job.communicate(b"\n")
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    assert job.returncode == 0


def test_only_unfinished_files_are_removed(tmp_path: Path) -> None:
    kept = ["results/a.parquet", "results/.partial.md", "results/.mine.parquet", "configs/.partial.abcdefgh.x"]
    gone = ["results/smoke/.partial.ab_12345.s1.parquet", "tables/.partial.abcdefgh.t.csv", ".cache/tmp/run-1/x"]
    gone += [".snakemake/scripts/tmpabcdefgh.call.py", "results/.partial.abcdefgh.wandb/a/b"]
    for name in (*kept, *gone):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    sweep(tmp_path)
    assert {str(path.relative_to(tmp_path)) for path in tmp_path.rglob("*") if path.is_file()} == set(kept)
