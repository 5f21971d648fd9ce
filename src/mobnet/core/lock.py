"""Locks of files, by which processes of one folder keep apart. Standard library only.

The system frees a lock when its process ends, however it ends.
"""

import errno
import fcntl
import functools
import logging
import os
from pathlib import Path

from mobnet.core.errors import DataError
from mobnet.core.files import refusal

log = logging.getLogger(__name__)
LOCKLESS = {errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP}  # what a file system says that has no locks


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
    log.warning("this file system has no locks: nothing keeps two processes in this folder apart")
