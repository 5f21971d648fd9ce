"""The main process of the workflow: Ctrl-C ends it and its jobs at once, with one line, from its first moment on.

`./reproduce` starts `python -m experiments.running.run` in place of `python -m snakemake`, with the same words.
"""

import atexit
import contextlib
import logging
import os
import re
import shutil
import signal
import sys
import tempfile
import time
from collections.abc import Sequence
from functools import partial
from pathlib import Path

import psutil

from experiments.running.environment import LONGEST_TEMPORARY
from experiments.running.patches import python, refuse_code
from mobnet.core.code import ROOT, UNKNOWN, commit
from mobnet.core.errors import ConfigError, MobnetError, misfit
from mobnet.core.files import check_room
from mobnet.core.lock import begin_run, scratch, sweep

WRITTEN = (".snakemake", ".cache")  # below the project, by Snakemake itself and by packages
CONFIGFILE = re.compile("--configf(?:i(?:l(?:es?)?)?)?(?:=(.+))?", re.DOTALL)
STOPPED = "stopped; the same command goes on from here"
LONGEST_S, PAUSE_S = 3.0, 0.02  # that killed processes may take to end, and between two looks at them

log = logging.getLogger(__name__)


def prepare(root: Path) -> None:
    """Make Ctrl-C end this process at once, and give it and its children a folder for temporary files in a project."""
    signal.signal(signal.SIGINT, lambda number, _: stop(root, number, alone=False))
    for name in WRITTEN:
        try:
            check_room(root / name)
        except MobnetError as error:
            sys.exit(str(error))
    folder = scratch(root)
    if len(str(folder)) > LONGEST_TEMPORARY:
        return
    folder.mkdir(parents=True, exist_ok=True)
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    os.environ["TMPDIR"] = tempfile.tempdir = str(folder)


def stop(root: Path, number: int, *, alone: bool) -> None:
    """Kill all children, remove what they had not finished if this run is alone in the folder, say one line and end.

    Files appear whole or not at all, so that nothing is lost by killing, and no job has time to tell a fault.
    """
    signal.signal(number, signal.SIG_IGN)
    terminal = os.dup(sys.stderr.fileno())
    nowhere = os.open(os.devnull, os.O_WRONLY)
    for stream in (sys.stdout, sys.stderr):
        os.dup2(nowhere, stream.fileno())
    kill_children()
    if alone:
        sweep(root)
    shutil.rmtree(scratch(root), ignore_errors=True)
    os.write(terminal, f"{STOPPED}\n".encode())
    os._exit(128 + number)


def kill_children() -> None:
    """Kill all children of this process with theirs; they are held first, until no new one appears."""
    found: set[psutil.Process] = set()
    while new := set(psutil.Process().children(recursive=True)) - found:
        found |= new
        for child in new:
            with contextlib.suppress(psutil.Error):
                child.suspend()
    for child in found:
        with contextlib.suppress(psutil.Error):
            child.kill()
    end = time.monotonic() + LONGEST_S
    while any(map(lives, found)) and time.monotonic() < end:
        time.sleep(PAUSE_S)


def lives(process: psutil.Process) -> bool:
    """Return whether a process can still write."""
    with contextlib.suppress(psutil.Error):
        return process.status() != psutil.STATUS_ZOMBIE
    return False


def start_jobs(root: Path, *, are_here: bool) -> None:
    """Wait until this run is alone in the folder; what another one made meanwhile needs a new plan.

    Where jobs are not run here but by a cluster, Ctrl-C is Snakemake's, which takes them out of the queue.
    """
    if begin_run(root):
        os.execv(python(), [python(), *sys.orig_argv[1:]])
    if commit() == UNKNOWN:
        log.warning("%s: git knows no commit here; results will not say which code made them (commit: unknown)", root)
    stops = partial(stop, root, alone=True) if are_here else cancel_jobs
    signal.signal(signal.SIGINT, lambda number, _: stops(number))


def cancel_jobs(number: int) -> None:
    """Let Snakemake cancel the jobs that a cluster has, and end; a second Ctrl-C does not hurry it."""
    signal.signal(number, signal.SIG_IGN)
    log.warning("%s; the cluster's jobs are cancelled", STOPPED)
    raise KeyboardInterrupt


def is_stopped() -> bool:
    """Return whether Ctrl-C has ended this run, which then ignores it: jobs that it cancelled have not failed."""
    return signal.getsignal(signal.SIGINT) is signal.SIG_IGN


def configfiles(words: Sequence[str]) -> list[str]:
    """Return the files that Snakemake's words give in place of the configuration; short forms are names too."""
    parts = zip(map(CONFIGFILE.fullmatch, words), [*words[1:], "nothing"], strict=True)
    return [found[1] or value for found, value in parts if found]


def refuse_configfiles(paths: Sequence[object]) -> None:
    """Check that Snakemake is given no configuration file: its reader runs code that stands in one.

    Raises:
        ConfigError: there is one.
    """
    if paths:
        accepted = "--config key=value, and the files in configs/"
        raise ConfigError(f"--configfile: {misfit(', '.join(map(str, paths)), accepted)}")


def main() -> None:
    """Run snakemake; `reproduce` blocked Ctrl-C until here, so that it is never a traceback."""
    prepare(ROOT)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    try:
        refuse_configfiles(configfiles(sys.argv[1:]))
    except MobnetError as error:
        sys.exit(str(error))
    from snakemake.cli import main as snakemake

    refuse_code()
    snakemake()


if __name__ == "__main__":
    main()
