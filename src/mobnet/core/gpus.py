"""How many GPUs a machine has for torch, without importing it, and one of them for each process.

Standard library only: rules ask before any job starts.
"""

import logging
import os
from collections.abc import Mapping, Sequence
from itertools import takewhile
from pathlib import Path

from mobnet.core.lock import opened, taken

log = logging.getLogger(__name__)
CHOSEN, HIDDEN = "CUDA_VISIBLE_DEVICES", ("", "-1")  # variable that lists GPUs for torch, and what ends the list
CPU_BUILD = "+cpu"  # in the version of torch


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
