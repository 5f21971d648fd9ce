"""Of a killed run only unfinished files are removed."""

import os
import time

from experiments.running.environment import DAY_S, sweep_project
from mobnet.core.files import atomic_path


def test_only_unfinished_files_are_removed(tmp_path):
    kept = ["results/a.parquet", "results/.partial.md", "results/.mine.parquet", "configs/.partial.abcdefgh.x"]
    gone = [
        "results/smoke/.partial.ab_12345.s1.parquet", "tables/.partial.abcdefgh.t.csv",
        "results/.partial.abcdefgh.wandb/run", ".snakemake/scripts/tmpabc.train.py",
        "docs/results/.partial.abcdefgh.t.csv",
    ]  # fmt: skip
    for name in (*kept, *gone):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    sweep_project(tmp_path)
    assert {str(path.relative_to(tmp_path)) for path in tmp_path.rglob("*") if path.is_file()} == set(kept)


def test_what_snakemake_left_is_removed_once_no_run_can_read_it(tmp_path):
    old, new = (tmp_path / ".cache" / "tmp" / f"snakemake{name}" for name in ("abc", "def"))
    for folder in (old, new):
        folder.mkdir(parents=True)
    before_s = time.time() - 2 * DAY_S
    os.utime(old, (before_s, before_s))
    sweep_project(tmp_path)
    assert not old.exists()
    assert new.is_dir()


def test_what_a_job_that_outlived_its_run_is_writing_stays(tmp_path):
    path = tmp_path / "results" / "s1.parquet"
    with atomic_path(path) as temporary:
        temporary.write_text("half")
        sweep_project(tmp_path)
        assert temporary.exists()
    assert path.read_text() == "half"
