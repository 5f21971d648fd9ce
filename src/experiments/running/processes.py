"""The processes of a run of the workflow: its jobs, and one beside it that logs trainings for wandb meanwhile."""

import atexit
import contextlib
import os
import subprocess
import time
from pathlib import Path

import psutil

from experiments.running.environment import SCRIPTS

MODULE = "experiments.evaluation.report.wandb_live"
LONGEST_S = 20.0  # that it, or a job, may take to end
LEAVE_S = 5.0  # that a job of a killed run has to remove what it was writing
STEP_S = 0.2  # between two looks for jobs that have begun meanwhile
# Before the command of each job: a terminal sends Ctrl-C to jobs too, and Python may not have loaded yet what hears it.
# A shell that is told to end before it has begun its job begins it all the same, so that none is overlooked.
PREFIX = "trap '' INT; trap : TERM; "


def end_jobs() -> None:
    """Let the jobs of this process end, also those that just begin, and kill those that do not; never returns.

    What each of them had not finished is removed by itself.
    """
    told_at: dict[psutil.Process, float] = {}
    while True:
        for job in psutil.Process().children():
            with contextlib.suppress(psutil.Error, ProcessLookupError):
                if os.getpgid(job.pid) == os.getpgrp():  # the process beside the run ends later
                    end_job(job, told_at)
        time.sleep(STEP_S)


def end_orphans(root: Path) -> None:
    """End jobs whose run was killed outright: what they still write may be older than what the next run makes."""
    place = str(root / SCRIPTS)
    left = [process for process in psutil.process_iter(["cmdline"]) if place in " ".join(process.info["cmdline"] or ())]
    for process in left:
        with contextlib.suppress(psutil.Error):
            process.terminate()
    _, alive = psutil.wait_procs(left, LEAVE_S)
    for process in alive:
        with contextlib.suppress(psutil.Error):
            process.kill()


def end_job(job: psutil.Process, told_at: dict[psutil.Process, float]) -> None:
    """Tell the processes of a job once to end, and note when; kill them where they do not."""
    working = [process for process in job.children(recursive=True) if process.status() != psutil.STATUS_ZOMBIE]
    if working:
        job.suspend()  # the shell, which stays until its command has ended, and would print that a signal did it
    elif job.status() == psutil.STATUS_STOPPED:
        job.kill()
    for process in working or [job]:
        if process not in told_at:
            told_at[process] = time.monotonic()
            process.terminate()
        elif time.monotonic() - told_at[process] > LONGEST_S:
            process.kill()


def follow_trainings(python: str, results: Path, log: Path) -> subprocess.Popen[bytes]:
    """Start the process, which ends with this one: its standard input is a pipe that nobody writes to.

    It never stops a run: what goes wrong stands in its log.
    """
    log.parent.mkdir(parents=True, exist_ok=True)
    with log.open("wb") as file:
        process = subprocess.Popen(
            [python, "-m", MODULE, str(results)],
            stdin=subprocess.PIPE,
            stdout=file,
            stderr=file,
            start_new_session=True,  # no Ctrl-C of a terminal reaches it
        )
    atexit.register(end, process)
    return process


def end(process: subprocess.Popen[bytes]) -> None:
    """Let the process finish its runs, and wait for it."""
    if process.stdin:
        process.stdin.close()
    with contextlib.suppress(subprocess.TimeoutExpired):
        process.wait(LONGEST_S)
