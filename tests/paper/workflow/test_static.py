"""Format, lint, types, imports and the workflow's own lint."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

from experiments.commands.setup import LOCKS

ROOT = Path(__file__).parents[3]
CHECKS = {
    "ruff check": ["-m", "ruff", "check", "."],
    "ruff format": ["-m", "ruff", "format", "--check", "."],
    "snakefmt": ["-m", "snakefmt", "--check", "Snakefile", "workflow"],
    "import-linter": ["-c", "from importlinter.cli import lint_imports_command as check; check(['--no-cache'])"],
    "pyright": ["-m", "pyright", "--pythonpath", sys.executable],
}
ONE_ENVIRONMENT = "Specify a conda environment or container for each rule."  # environment.lock serves all of them


@pytest.mark.parametrize("check", CHECKS)
def test_check_passes(check):
    done = subprocess.run([sys.executable, *CHECKS[check]], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_snakemake_lint_passes(snakemake):
    done = snakemake("--lint")
    faults = re.findall(r"^    \* (.+):$", done.stdout + done.stderr, re.MULTILINE)
    assert [fault for fault in faults if fault != ONE_ENVIRONMENT] == []


def test_no_committed_file_names_a_package_host():
    for name in (*LOCKS, "reproduce", "pyproject.toml"):
        assert "://" not in (ROOT / name).read_text(), name
