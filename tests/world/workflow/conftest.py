"""Copies of the project in which the workflow may run without touching the checkout's results."""

import hashlib
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from once import once
from planned_jobs import COMPILED, ROOT, outputs, planned, snakemake

from mobnet.core.machine_code import cache_root

from .smoke import LOST, MADE, reproduce, told

__all__ = ["outputs", "planned", "snakemake"]
PARTS = (
    "Snakefile", "workflow", "profiles", "configs", "src", "docs", "examples", "paper", "reproduce", "environment.lock",
    "README.md", "README.md.j2", "CONTRIBUTING.md", "CHANGELOG.md", "CITATION.cff", "SECURITY.md", "Dockerfile",
    "apptainer.def", "tests/data",
)  # fmt: skip


@pytest.fixture(scope="session")
def compiled(tmp_path_factory):
    """All that jobs compile is compiled for this checkout: else each copy of it would take a minute of its own."""

    def compile_all(folder):
        folder.mkdir()
        subprocess.run([sys.executable, "workflow/scripts/warm.py"], cwd=ROOT, check=True, capture_output=True)

    return once(tmp_path_factory, "compiled", compile_all)


@pytest.fixture(scope="session")
def make_project(tmp_path_factory, compiled):
    """Return a function of a name that copies the project, or a copy, without its environment.

    The copy has the machine code that its origin has compiled, as its code is the same.
    """

    def make(name, origin=ROOT):
        folder = tmp_path_factory.mktemp(name)
        copy_project(origin, folder)
        copy_compiled(origin, folder)
        return folder

    return make


@pytest.fixture(scope="session")
def smoke_run(tmp_path_factory, compiled):
    """Two projects: `run`, in which the smoke scale ran on two cores, and `kept`, a copy of it that no test changes."""

    def make(folder):
        run, kept = folder / "run", folder / "kept"
        shutil.rmtree(folder, ignore_errors=True)  # of a run that failed
        run.mkdir(parents=True)
        kept.mkdir()
        copy_project(ROOT, run)
        copy_compiled(ROOT, run)
        assert reproduce(run).wait() == 0, told(run)
        copy_project(run, kept)
        copy_compiled(run, kept)
        copy_results(run, kept)

    return once(tmp_path_factory, "smoke", make)


def copy_project(origin, folder):
    """Copy the project, or a copy, into a folder, without its environment and without what it has compiled."""
    for part in PARTS:
        source = origin / part
        ignored = shutil.ignore_patterns("__pycache__", "main.pdf", "build.json", ".*")
        if source.is_dir():
            shutil.copytree(source, folder / part, symlinks=True, ignore=ignored)
        else:
            shutil.copy2(source, folder / part)
    (folder / ".venv").symlink_to(sys.prefix)  # runs the code of the folder in which it is called


def copy_compiled(origin, folder):
    """Give a copy of the project the machine code of its origin."""
    for source, place in compiled_in(cache_root() if origin == ROOT else origin / COMPILED, origin, folder):
        shutil.copytree(source, folder / COMPILED / place, ignore=shutil.ignore_patterns("*.tmp.*"))


def copy_results(origin, folder):
    """Copy all that a run has made."""
    for part in MADE:
        shutil.copytree(origin / part, folder / part, symlinks=True, dirs_exist_ok=True)


def with_losses(make_project, unbroken, name):
    """Return a copy of a project with its results, of which some are lost."""
    folder = make_project(name, unbroken)
    copy_results(unbroken, folder)
    for place in (folder / name for name in LOST):
        shutil.rmtree(place) if place.is_dir() else place.unlink()
    return folder


def compiled_in(root, origin, folder):
    """Yield the folders of machine code below a root, and their places in a copy: numba names them by the source's."""
    sources = [path.relative_to(origin) for path in (origin / "src").rglob("*") if path.is_dir()]
    renamed = {named_by(origin / source): named_by(folder / source) for source in sources}
    for path in root.glob("*/*"):
        if path.name in renamed:
            yield path, Path(path.parent.name) / renamed[path.name]


def named_by(source):
    """Return the name that numba gives to the machine code of the files of a folder."""
    return f"{source.name}_{hashlib.sha1(str(source).encode()).hexdigest()}"
