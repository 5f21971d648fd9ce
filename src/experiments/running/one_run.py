"""One run in a project's folder: a second one would remove what the first is writing.

The process of a run holds a lock of this project. Snakemake's own refuses only runs that make the same files, and stays
behind where a run is killed. Standard library only: commands ask before the environment is there.
"""

import contextlib
import os
import re
import shlex
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

from mobnet.core.errors import CommandError
from mobnet.core.files import opened, taken

LOCK = Path(".cache") / "run.lock"
# Options with which Snakemake reads and runs no job; -n may stand among other letters, as in -np.
LOOKED = (
    "--dry-run --dryrun --summary -S --detailed-summary -D --list-changes --lc --list-input-changes --li "
    "--list-params-changes --lp --list-untracked --lu --list-rules --list -l --list-target-rules --lt --lint --dag "
    "--rulegraph --filegraph --d3dag --print-compilation --version -v --help -h"
)
LOOKS = frozenset(LOOKED.split())
DRY = re.compile(r"-[a-zA-Z]*n[a-zA-Z]*")


def only_looks(words: Sequence[str]) -> bool:
    """Return whether a call of Snakemake with these words makes and removes nothing."""
    options = [word.partition("=")[0] for word in words]
    return any(option in LOOKS or DRY.fullmatch(option) for option in options)


def hold_folder(root: Path, words: Sequence[str]) -> int:
    """Keep other runs out of a project's folder until this process ends or closes the descriptor that is returned.

    Args:
        root: the project's folder.
        words: of this call, for the line that others get.

    Raises:
        CommandError: a run goes on there.
    """
    handle = opened(root / LOCK)
    if not taken(handle):
        os.close(handle)
        raise CommandError(goes_on((root / LOCK).read_text(encoding="utf-8")))
    os.ftruncate(handle, 0)
    os.write(handle, f"{time.time():.0f} {os.getpid()} {shlex.join(words)}".encode())
    return handle


@contextlib.contextmanager
def held_folder(root: Path, words: Sequence[str]) -> Iterator[None]:
    """Keep runs out of a project's folder for a while.

    Raises:
        CommandError: a run goes on there.
    """
    handle = hold_folder(root, words)
    try:
        yield
    finally:
        os.close(handle)


def goes_on(holder: str) -> str:
    """Return the one line that says which run holds the folder, from what it has written into its lock."""
    if not holder:  # it has just begun, and has not written yet
        return "a run has just begun in this folder; wait for it, or use a clone"
    since_s, process, words = holder.split(" ", 2)
    since = time.strftime("%H:%M", time.localtime(float(since_s)))
    return f"a run goes on in this folder since {since} ({words}, process {process}); wait for it, or use a clone"
