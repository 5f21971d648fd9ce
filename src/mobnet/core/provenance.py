"""Where a result comes from: code, packages and settings."""

from __future__ import annotations

import functools
import hashlib
import subprocess
from collections.abc import Mapping
from typing import Any

from mobnet.core.code import LOCK, ROOT, SHORT
from mobnet.core.config import config_hash

UNKNOWN = "unknown"


def provenance(config: Mapping[str, Any]) -> dict[str, str]:
    """Return what a result file notes of its origin: `commit`, `lock` and `config`.

    Args:
        config: settings that the result depends on.

    Returns:
        commit: git commit, with `-changed` where the checkout differs from it; `unknown` outside of git.
        lock: short hash of environment.lock.
        config: short hash of the settings.
    """
    return {"commit": commit(), "lock": lock_hash(), "config": config_hash(config)}


@functools.cache
def commit() -> str:
    """Return the commit of this checkout, `-changed` added where tracked files differ from it."""
    name = _git("rev-parse", "HEAD")
    if name is None:
        return UNKNOWN
    return f"{name}-changed" if _git("status", "--porcelain", "--untracked-files=no") else name


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
