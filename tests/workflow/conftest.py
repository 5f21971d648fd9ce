"""Copies of the project in which the workflow may run without touching the checkout's results."""

import shutil
import subprocess
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PARTS = ("Snakefile", "workflow", "profiles", "configs", "src", "docs", "paper", "reproduce", "environment.lock")
Snakemake = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture(scope="session")
def snakemake() -> Snakemake:
    """Return a function that runs snakemake in a folder and returns what it printed."""

    def run(*words: str, folder: Path = ROOT) -> subprocess.CompletedProcess[str]:
        words = (str(folder / ".venv" / "bin" / "python"), "-m", "snakemake", *words)
        return subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)

    return run


@pytest.fixture(scope="session")
def outputs(snakemake: Snakemake) -> Callable[[str], dict[str, str]]:
    """Return a function of a scale that returns file -> rule of everything the workflow makes."""

    @cache
    def listing(scale: str) -> dict[str, str]:
        done = snakemake("--summary", "--config", f"scale={scale}")
        assert done.returncode == 0, done.stderr
        header, *rows = (line.split("\t") for line in done.stdout.splitlines())
        return {row[header.index("output_file")]: row[header.index("rule")] for row in rows}

    return listing


@pytest.fixture(scope="session")
def make_project(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., Path]:
    """Return a function of a name that copies the project, or a copy, without its environment."""

    def make(name: str, origin: Path = ROOT) -> Path:
        folder = tmp_path_factory.mktemp(name)
        for part in PARTS:
            source = origin / part
            ignored = shutil.ignore_patterns("__pycache__", "*.pdf", "build.json", ".*")
            if source.is_dir():
                shutil.copytree(source, folder / part, symlinks=True, ignore=ignored)
            else:
                shutil.copy2(source, folder / part)
        (folder / ".venv").symlink_to(sys.prefix)  # runs the code of the folder in which it is called
        return folder

    return make
