"""Runs whose results go elsewhere: into another folder, and into a storage of Snakemake, with the same bytes."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from planned_jobs import ROOT

MADE = ("table_01", "steps")  # of no other file, and of a recording, which a job reads where another one has put it
TARGETS = [f"tables/smoke/{name}.tex" for name in MADE]


def run(folder, *words):
    """Run the workflow of this checkout from another folder, and return what it prints."""
    snakemake = [sys.executable, "-m", "snakemake", "--snakefile", str(ROOT / "Snakefile")]
    call = [*snakemake, "--cores", "2", *words, "--", *TARGETS]
    done = subprocess.run(call, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout + done.stderr


def tables(folder):
    """Return what a folder's tables hold, by their names."""
    files = [folder / "tables" / "smoke" / f"{name}.{ending}" for name in MADE for ending in ("csv", "tex", "md")]
    return {file.name: file.read_bytes() for file in files}


@pytest.fixture(scope="module")
def elsewhere(tmp_path_factory, compiled):
    """Return a folder with the tables of a run that was called in another one."""
    folder = tmp_path_factory.mktemp("elsewhere")
    run(tmp_path_factory.mktemp("called_in"), "--directory", str(folder))
    return folder


@pytest.mark.slow
@pytest.mark.sim
def test_results_go_into_the_folder_that_is_named(elsewhere):
    assert {path.name for path in elsewhere.iterdir()} == {".cache", ".snakemake", "results", "tables"}
    assert "Nothing to be done" in run(elsewhere)
    words = [sys.executable, "-m", "snakemake", "--snakefile", str(ROOT / "Snakefile"), "--cores", "1", "docs"]
    done = subprocess.run(words, cwd=elsewhere, capture_output=True, text=True, check=False)
    assert "docs: the pages are made in the folder of the project alone" in done.stdout + done.stderr
    assert done.returncode != 0
    assert (elsewhere / "results" / "smoke" / "logs" / "table" / "steps.log").is_file()


@pytest.mark.slow
@pytest.mark.sim
@pytest.mark.skipif(shutil.which("rsync") is None, reason="the storage plug-in `fs` needs rsync")
def test_a_storage_gets_the_same_tables(elsewhere, tmp_path):
    """Storages of files, of S3 and of others take the same way: a job reads and writes copies below a local folder."""
    folder, storage, local = (tmp_path / name for name in ("run", "storage", "local"))
    for place in (folder, storage):
        place.mkdir()
    words = ("--default-storage-provider", "fs", "--default-storage-prefix", str(storage))
    run(folder, *words, "--local-storage-prefix", str(local))
    assert tables(storage) == tables(elsewhere)
    assert not list(Path(folder).rglob("*.parquet"))
