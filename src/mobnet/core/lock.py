"""One run of the workflow at a time in a folder, and what killed runs left there.

A run holds `run.lock` alone until its process ends. Each of its jobs holds `jobs.lock` together with the others, also
one that outlives a killed run. Whoever holds both alone may remove unfinished files. The system frees a lock when its
process ends. No other module takes them. Standard library only.

A cluster's queue may hold jobs of a killed run that start later and have no lock yet. So each run gives its jobs its
name, which stands in the folder too, and a job of another name ends at once.
"""

import errno
import fcntl
import functools
import logging
import os
import shlex
import shutil
import uuid
from collections.abc import Iterator
from pathlib import Path

from mobnet.core.errors import DataError
from mobnet.core.files import PARTIAL, refusal, write_text

log = logging.getLogger(__name__)

LOCKS = {  # file below the project -> what holds it
    ".cache/run.lock": "another run in this folder",
    ".cache/jobs.lock": "jobs of a run that was killed",
}
_, JOBS = LOCKS
NAME, RUN = ".cache/run.name", "MOBNET_RUN"  # file with the name of the latest run, and the variable that its jobs get
LOCKLESS = {errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP}  # what a file system says that has no locks
ANY = "[a-z0-9_]" * 8  # what tempfile puts into the name of a file
SWEPT = {  # folder of the project -> unfinished files in it and below
    **dict.fromkeys(("results", "tables", "figures", "paper", "docs/results"), f"**/{PARTIAL}{ANY}.*"),
    ".snakemake/scripts": f"tmp{ANY}.call.py",
    ".cache/tmp": "run-*",
}


def job_prefix(root: Path) -> str:
    """Return what a job's shell does first.

    It holds the lock of the jobs, where there are locks, leaves Ctrl-C to the run that started it, and ends if that run
    is not the latest one. No brace is in it, as Snakemake takes the text for a pattern.
    """
    jobs, name = (shlex.quote(str(root / file)) for file in (JOBS, NAME))
    lock = f"trap '' INT; exec 9<>{jobs}; flock -s 9 2> /dev/null || :; "
    ended = "the run that asked for this job has ended, and another one has begun"
    return lock + f'if [ "$(printenv {RUN})" != "$(cat {name})" ]; then echo {shlex.quote(ended)} >&2; exit 1; fi; '


def begin_run(root: Path) -> bool:
    """Take the locks of a run, waiting for who holds them, and remove unfinished files; return whether it waited.

    The lock of the run is held until this process ends, that of the jobs is released.
    """
    waited = False
    handles = {name: opened(root / name) for name in LOCKS}
    for name, handle in handles.items():
        if not taken(handle):
            log.warning("%s: held by %s; waiting for the end", name, LOCKS[name])
            fcntl.flock(handle, fcntl.LOCK_EX)
            waited = True
    sweep(root)
    os.close(handles[JOBS])
    os.environ[RUN] = uuid.uuid4().hex
    write_text(root / NAME, os.environ[RUN])
    return waited


def holder(root: Path) -> str | None:
    """Take the locks of a run, without waiting; return who holds one of them, None where both are taken."""
    handles = {name: opened(root / name) for name in LOCKS}
    found = next((LOCKS[name] for name, handle in handles.items() if not taken(handle)), None)
    if found:
        for handle in handles.values():
            os.close(handle)
    return found


def opened(path: Path) -> int:
    """Return the descriptor of a lock's file, which nothing closes before this process ends.

    Raises:
        DataError: it cannot be written.
    """
    try:
        path.parent.mkdir(exist_ok=True)
        return os.open(path, os.O_RDWR | os.O_CREAT, 0o644)
    except OSError as error:
        raise DataError(refusal(error, path)) from None


def taken(handle: int) -> bool:
    """Take a lock if nobody else holds it, and return whether it was free; a file system without locks says yes."""
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError as error:
        if error.errno not in LOCKLESS:
            raise
        warn_of_missing_locks()
    return True


@functools.cache
def warn_of_missing_locks() -> None:
    """Say, once, that two runs may meet."""
    log.warning("this file system has no locks: nothing keeps two runs in this folder apart")


def sweep(root: Path) -> None:
    """Remove what interrupted writes left; the caller knows that nobody writes."""
    for path in list(unfinished(root)):
        shutil.rmtree(path, ignore_errors=True) if path.is_dir() else path.unlink(missing_ok=True)


def unfinished(root: Path) -> Iterator[Path]:
    """Yield the files and folders of interrupted writes, and the folders for temporary files of other runs."""
    for folder, pattern in SWEPT.items():
        yield from (path for path in (root / folder).glob(pattern) if path != scratch(root))


def scratch(root: Path) -> Path:
    """Return the folder for temporary files of this process and its children."""
    return root / ".cache" / "tmp" / f"run-{os.getpid()}"
