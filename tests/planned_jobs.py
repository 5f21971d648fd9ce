"""What Snakemake plans, for tests of the paper's workflow with and without a run. A conftest imports the fixtures."""

import os
import subprocess
from functools import cache
from pathlib import Path

import pytest

from experiments.plan.dry_run import dry_run
from experiments.site.machines import stacks_word

ROOT = Path(__file__).parents[1]
COMPILED = Path(".cache") / "numba"


@pytest.fixture(scope="session")
def snakemake():
    """Return a function that runs snakemake in a folder and returns what it printed."""

    def run(*words, folder=ROOT):
        words = (str(folder / ".venv" / "bin" / "python"), "-m", "snakemake", *words)
        environment = {**os.environ, **({} if folder == ROOT else {"NUMBA_CACHE_DIR": str(folder / COMPILED)})}
        return subprocess.run(words, cwd=folder, env=environment, capture_output=True, text=True, check=False)

    return run


@pytest.fixture(scope="session")
def planned():
    """Return a function that returns all jobs of a dry run at a scale: of everything and without a GPU if not told."""

    @cache
    def asked(scale, target, side_by_side):
        return dry_run([target], [f"scale={scale}", stacks_word(side_by_side)], from_nothing=True)

    return lambda scale, target="all", side_by_side=False: asked(scale, target, side_by_side)


@pytest.fixture(scope="session")
def outputs(planned):
    """Return a function of a scale that returns file -> rule of everything the workflow makes."""

    def made(scale):
        found = {}
        for job in planned(scale):
            found |= dict.fromkeys(filter(None, job.outputs), job.rule)
        return found

    return made
