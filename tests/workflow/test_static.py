"""Format, lint, types, imports and the workflow's own lint."""

import inspect
import re
import subprocess
import sys

import pytest
from snakemake.scheduling import job_scheduler

from mobnet.commands.setup import LOCKS

from .conftest import ROOT, Snakemake

CHECKS = {
    "ruff check": ["-m", "ruff", "check", "."],
    "ruff format": ["-m", "ruff", "format", "--check", "."],
    "snakefmt": ["-m", "snakefmt", "--check", "Snakefile", "workflow"],
    "import-linter": ["-c", "from importlinter.cli import lint_imports_command as check; check(['--no-cache'])"],
    "pyright": ["-m", "pyright", "--pythonpath", sys.executable],
}
ONE_ENVIRONMENT = "Specify a conda environment or container for each rule."  # environment.lock serves all of them


@pytest.mark.parametrize("check", CHECKS)
def test_check_passes(check: str) -> None:
    done = subprocess.run([sys.executable, *CHECKS[check]], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_snakemake_lint_passes(snakemake: Snakemake) -> None:
    done = snakemake("--lint")
    faults = re.findall(r"^    \* (.+):$", done.stdout + done.stderr, re.MULTILINE)
    assert [fault for fault in faults if fault != ONE_ENVIRONMENT] == []


def test_no_committed_file_names_a_package_host() -> None:
    for name in (*LOCKS, "reproduce", "pyproject.toml"):
        assert "://" not in (ROOT / name).read_text(), name


def test_snakemake_still_has_the_rate_limit_that_the_workflow_switches_off() -> None:
    """A newer Snakemake that keeps it elsewhere would take half of a core again, without a word."""
    source = inspect.getsource(job_scheduler)
    assert "self.job_rate_limiter = (" in source
    assert "if self.job_rate_limiter is not None:" in source
    assert "workflow.scheduler.job_rate_limiter = None" in (ROOT / "workflow" / "rules" / "common.smk").read_text()
