"""Trained networks from their folders: each by the class that runs its cell, those of MOB-Net without torch."""

from collections.abc import Callable, Mapping
from pathlib import Path

from mobnet.core.files import WEIGHTS
from mobnet.core.place import check_extra
from mobnet.learning.deployed.networks import Array, ConstantNetwork, Deployed, GruNetwork
from mobnet.learning.deployed.weights import WeightsNote, read_weights

WITHOUT_TORCH: Mapping[str, Callable[..., Deployed]] = {"GRU": GruNetwork, "constant": ConstantNetwork}


def load_network(folder: Path) -> Deployed:
    """Read a trained network from its folder.

    Raises:
        DataError: the weights are missing, damaged or not accepted, one line for each fault.
        ConfigError: the network needs torch, which is not installed.
    """
    return deployed(*read_weights(folder / WEIGHTS))


def deployed(tensors: Mapping[str, Array], note: WeightsNote) -> Deployed:
    """Return the network that a file's tensors and note describe."""
    common = note.limb, tuple(note.joints), tuple(note.inputs), note.std_min
    cell = note.cell
    if cell.cell in WITHOUT_TORCH:
        return WITHOUT_TORCH[cell.cell](tensors, *common)
    check_extra("learn")
    from mobnet.learning.deployed.module_network import ModuleNetwork  # torch starts slowly, and MOB-Net does without

    return ModuleNetwork(tensors, *common, cell=cell)
