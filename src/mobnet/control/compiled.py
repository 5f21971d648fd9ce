"""The one decorator for compiled code, and where its machine code is cached.

Numba looks only at the file of a function to tell whether its cached machine code is stale, not at the files of the
functions it calls. The cache therefore lives in a folder named after a hash of every compiled source file.
"""

from __future__ import annotations

import hashlib
import os
from pathlib import Path

import numba

PACKAGES = ("control", "simulation")


def source_hash() -> str:
    """Return a short hash of all source files of the compiled packages."""
    root = Path(__file__).parents[1]
    digest = hashlib.sha256(numba.__version__.encode())
    for path in sorted(path for package in PACKAGES for path in (root / package).glob("*.py")):
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


_root = Path(os.environ.get("NUMBA_CACHE_DIR") or Path(__file__).parents[3] / ".cache" / "numba")
numba.config.CACHE_DIR = str(_root / source_hash())

compiled = numba.njit(cache=True, error_model="numpy")
