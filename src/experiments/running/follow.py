"""A process beside a run of the workflow that logs its trainings for wandb while they go on."""

import atexit
import contextlib
import subprocess
from pathlib import Path

MODULE = "experiments.evaluation.report.wandb_live"
LONGEST_S = 20.0  # that it may take to end


def follow_trainings(python: str, results: Path, log: Path) -> subprocess.Popen[bytes]:
    """Start the process, which ends with this one: its standard input is a pipe that nobody writes to.

    It never stops a run: what goes wrong stands in its log.
    """
    log.parent.mkdir(parents=True, exist_ok=True)
    with log.open("wb") as file:
        process = subprocess.Popen(
            [python, "-m", MODULE, str(results)], stdin=subprocess.PIPE, stdout=file, stderr=file
        )
    atexit.register(end, process)
    return process


def end(process: subprocess.Popen[bytes]) -> None:
    """Let the process finish its runs, and wait for it."""
    if process.stdin:
        process.stdin.close()
    with contextlib.suppress(subprocess.TimeoutExpired):
        process.wait(LONGEST_S)
