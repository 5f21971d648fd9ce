"""The decorator for compiled code, and where its machine code is cached.

Code under `compiled` owns no memory: numba then counts no references to arrays, which took half of the controller's
time, and refuses code that allocates. Arrays come from the caller or from `mobnet.control.stack`.

Numba looks only at the file of a function to tell whether its cached machine code is stale, not at the files of the
functions it calls. The cache therefore lives in a folder named after a hash of every compiled source file.
"""

from __future__ import annotations

import hashlib
import os
from pathlib import Path
from typing import Any

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

_options: dict[str, Any] = {"cache": True, "error_model": "numpy"}
allocating = numba.njit(**_options)  # for the outermost loop, which makes the buffers
_options["_nrt"] = False  # no run time of numba, so no memory and no counts
compiled = numba.njit(**_options)
