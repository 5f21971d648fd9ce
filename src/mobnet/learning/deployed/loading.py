"""Trained networks from their folders: each by the class that runs its cell, those of MOB-Net without torch."""

from collections.abc import Callable, Mapping
from pathlib import Path

from mobnet.core.errors import DataError, not_accepted
from mobnet.core.files import WEIGHTS
from mobnet.core.joints import JointLayout
from mobnet.core.place import check_extra
from mobnet.learning.deployed.limbs import LimbNetworks
from mobnet.learning.deployed.networks import Array, ConstantNetwork, Deployed, GruNetwork, Runnable
from mobnet.learning.deployed.weights import WeightsNote, read_weights
from mobnet.learning.features import signal_names

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


def load_limb_networks(folders: Mapping[str, Path], layout: JointLayout) -> LimbNetworks:
    """Read the networks of some limbs, each from its folder.

    Raises:
        DataError: weights are missing or damaged, or belong to another limb or robot.
    """
    networks = [load_network(folder) for folder in folders.values()]
    for network, (limb, folder) in zip(networks, folders.items(), strict=True):
        check_limb(network, limb, folder, layout)
    return LimbNetworks(networks, layout)


def check_limb(network: Runnable, limb: str, folder: Path, layout: JointLayout) -> None:
    """Raise unless a network is of a limb, with the limb's joints, or, over several limbs, with joints of the robot.

    Its inputs must be signals of the robot.
    """
    known = set(network.joints) <= set(layout.names)
    expected = layout.groups.get(limb, network.joints if known else layout.names)
    known_inputs = signal_names(layout)
    for name in network.input_names:
        if name not in known_inputs:
            raise DataError(f"{folder}: {not_accepted('input', name, [*known_inputs[:3], '...'])}")
    if (network.limb, network.joints) != (limb, expected):
        raise DataError(
            f"{folder}: network of limb {network.limb!r} with joints {', '.join(network.joints)}; "
            f"accepted: {limb!r} with {', '.join(expected)}"
        )
