"""The GPUs of a machine, one of them for each process, and the threads of matrix products: one.

Standard library only: rules ask before any job starts.
"""

import ctypes
import logging
import os
import re
import sys
from collections.abc import Mapping, Sequence
from itertools import takewhile
from pathlib import Path

from mobnet.core.files import opened, taken

log = logging.getLogger(__name__)
CHOSEN, HIDDEN = "CUDA_VISIBLE_DEVICES", ("", "-1")  # variable that lists GPUs for torch, and what ends the list
CPU_BUILD = "+cpu"  # in the version of torch
LOADED = Path("/proc/self/maps")
LIBRARY = re.compile(r"/\S.*openblas.*\.so.*$", re.MULTILINE)  # NumPy's and SciPy's bring one each
SET = ("scipy_openblas_set_num_threads64_", "scipy_openblas_set_num_threads", "openblas_set_num_threads")


def gpus_seen(torch_version: str, environment: Mapping[str, str], devices: Path = Path("/dev")) -> int:
    """Return how many GPUs of NVIDIA torch can use here: none with its CPU build."""
    if CPU_BUILD in torch_version:
        return 0
    there = len(list(devices.glob("nvidia[0-9]*"))) or int((devices / "dxg").exists())
    if CHOSEN not in environment:
        return there
    chosen = takewhile(lambda name: name.strip() not in HIDDEN, environment[CHOSEN].split(","))
    return min(there, len(list(chosen)))


def claimed(names: Sequence[str], folder: Path) -> int:
    """Return the place of the first GPU that no other process of the project has; it has a lock until it ends.

    The names, one or more, are unique among machines that share the folder. Where every GPU is taken, as on a cluster
    whose jobs ask for none, a warning says that the first one is shared.
    """
    for place, name in enumerate(names):
        lock = opened(folder / f"gpu-{name}.lock")
        if taken(lock):
            return place
        os.close(lock)
    log.warning("every GPU here is in use by other jobs of this project; this one shares the GPU %s", names[0])
    return 0


# Networks have small matrices: their products take longer in two threads than in one, 36 times longer where a core is
# shared, and give other numbers. Whoever builds a network therefore calls `one_thread`, so that a script of a user's
# own has the speed of a job. The limit holds for the process from then on.
def one_thread() -> None:
    """Let products of NumPy, SciPy and torch run in one thread, of those that this process has loaded."""
    if torch := sys.modules.get("torch"):
        torch.set_num_threads(1)
    loaded = LOADED.read_text(encoding="utf-8") if LOADED.exists() else ""
    for path in set(LIBRARY.findall(loaded)):
        library = ctypes.CDLL(path)
        if name := next((name for name in SET if hasattr(library, name)), None):
            library[name](ctypes.c_int(1))
