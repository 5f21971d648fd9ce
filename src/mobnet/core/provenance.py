"""Where a result comes from: code and packages."""

import functools
import hashlib
import subprocess

from mobnet.core.code import LOCK, ROOT, SHORT

UNKNOWN = "unknown"
CHANGED = "-changed"


def provenance() -> dict[str, str]:
    """Return `commit` and `lock` of a result; `unknown` where git or environment.lock is not there."""
    return {"commit": commit(), "lock": lock_hash()}


@functools.cache
def commit() -> str:
    """Return the commit of this checkout, `-changed` added where tracked files differ from it.

    A copy that lies in a repository of something else has none.
    """
    name = _git("rev-parse", "HEAD")
    if name is None or not _git("ls-files", LOCK.name):
        return UNKNOWN
    return f"{name}{CHANGED}" if _git("status", "--porcelain", "--untracked-files=no") else name


def _git(*words: str) -> str | None:
    """Return what git says about this checkout, or None without git."""
    try:
        done = subprocess.run(["git", "-C", str(ROOT), *words], capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return None
    return done.stdout.strip()


def lock_hash() -> str:
    """Return a short hash of environment.lock, or `unknown` without it."""
    return hashlib.sha256(LOCK.read_bytes()).hexdigest()[:SHORT] if LOCK.exists() else UNKNOWN
