"""The device of a training: a GPU that no other job of the project uses, or the CPU."""

import functools

import torch

from mobnet.core.gpus import claimed
from mobnet.core.place import caches


@functools.cache
def own_device() -> torch.device:
    """Return the device of all trainings of this process."""
    if not torch.cuda.is_available():
        return torch.device("cpu")
    names = [str(torch.cuda.get_device_properties(place).uuid) for place in range(torch.cuda.device_count())]
    return torch.device("cuda", claimed(names, caches()))
