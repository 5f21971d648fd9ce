"""One run in a project's folder: a second one would remove what the first is writing.

The process of a run holds a lock of this project. Snakemake's own refuses only runs that make the same files, and stays
behind where a run is killed.
"""

import os
import re
import shlex
import time
from collections.abc import Sequence
from pathlib import Path

import psutil

from mobnet.core.errors import DataError
from mobnet.core.files import opened, taken
from experiments.running.environment import SCRIPTS

LOCK = Path(".cache") / "run.lock"
# Options with which Snakemake reads and runs no job; -n may stand among other letters, as in -np.
LOOKS = {
    "--dry-run", "--dryrun", "--summary", "-S", "--detailed-summary", "-D", "--list-changes", "--lc",
    "--list-input-changes", "--li", "--list-params-changes", "--lp", "--list-untracked", "--lu", "--list-rules",
    "--list", "-l", "--list-target-rules", "--lt", "--lint", "--dag", "--rulegraph", "--filegraph", "--d3dag",
    "--print-compilation", "--version", "-v", "--help", "-h",
}  # fmt: skip
DRY = re.compile(r"-[a-zA-Z]*n[a-zA-Z]*")
LEAVE_S = 5.0  # that the jobs of a killed run have to remove what they were writing


def only_looks(words: Sequence[str]) -> bool:
    """Return whether a call of Snakemake with these words makes and removes nothing."""
    options = [word.partition("=")[0] for word in words]
    return any(option in LOOKS or DRY.fullmatch(option) for option in options)


def hold_folder(root: Path, words: Sequence[str]) -> None:
    """Keep other runs out of a project's folder until this process ends, and end the jobs of one that was killed.

    Args:
        root: the project's folder.
        words: of this call, for the line that others get.

    Raises:
        DataError: a run goes on there.
    """
    handle = opened(root / LOCK)
    if not taken(handle):
        os.close(handle)
        raise DataError(goes_on((root / LOCK).read_text(encoding="utf-8")))
    os.ftruncate(handle, 0)
    os.write(handle, f"{time.time():.0f} {os.getpid()} {shlex.join(words)}".encode())
    end_orphans(root)


def goes_on(holder: str) -> str:
    """Return the one line that says which run holds the folder, from what it wrote into its lock."""
    since_s, process, words = holder.split(" ", 2)
    since = time.strftime("%H:%M", time.localtime(float(since_s)))
    return (
        f"a run goes on in this folder since {since} ({words}, process {process}); wait for it, or use a clone"
    )


def end_orphans(root: Path) -> None:
    """End jobs whose run was killed outright: what they still write may be older than what the next run makes."""
    place = str(root / SCRIPTS)
    left = [process for process in psutil.process_iter(["cmdline"]) if place in shlex.join(process.info["cmdline"] or [])]
    for process in left:
        process.terminate()
    _, alive = psutil.wait_procs(left, LEAVE_S)
    for process in alive:
        process.kill()
