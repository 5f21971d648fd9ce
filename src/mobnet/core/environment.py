"""What every process of the project inherits: one thread each, caches inside the project, nothing sent anywhere.

Standard library only: `reproduce` reads it before anything is installed.
"""

import os
from pathlib import Path

LONGEST_TEMPORARY = 70  # characters; the path of a Unix socket below it must not pass 108
THREADED = ("OMP", "OPENBLAS", "MKL", "NUMEXPR", "NUMBA")
CACHES = {
    "XDG_CACHE_HOME": "xdg",
    "XDG_DATA_HOME": "data",
    "NUMBA_CACHE_DIR": "numba",
    "MPLCONFIGDIR": "matplotlib",
    "PIP_CACHE_DIR": "pip",
    "UV_CACHE_DIR": "uv",
    "WANDB_CACHE_DIR": "wandb/cache",
    "WANDB_CONFIG_DIR": "wandb/config",
    "WANDB_DATA_DIR": "wandb/data",
    "TEXMFVAR": "texmf",
    "TMPDIR": "tmp",
}
FIXED = {
    "PYTHONNOUSERSITE": "1",
    "PYTHONHASHSEED": "0",
    "PYTHONUTF8": "1",
    "WANDB_MODE": "offline",
    "WANDB_SILENT": "true",
    "WANDB_ERROR_REPORTING": "false",
    "DO_NOT_TRACK": "1",
}


def child_environment(root: Path) -> dict[str, str]:
    """Return the variables for a project folder, and make the cache folders they name."""
    places = {name: root / ".cache" / folder for name, folder in CACHES.items()}
    if len(str(places["TMPDIR"])) > LONGEST_TEMPORARY:
        del places["TMPDIR"]
    for place in places.values():
        place.mkdir(parents=True, exist_ok=True)
    threads = {f"{name}_NUM_THREADS": "1" for name in THREADED}
    return {**threads, **{name: str(place) for name, place in places.items()}, **FIXED}


def quieten(root: Path) -> None:
    """Give this process, and so its children, the variables it does not have."""
    for name, value in child_environment(root).items():
        os.environ.setdefault(name, value)
