"""How long networks learn and how much they see: what they cost follows from it, and which of them are alike."""

from experiments.plan.files import Files
from mobnet.settings.networks import Network

INPUTS_PER_JOINT, BASE_INPUTS = 2, 12  # of a network: position and velocity; rotation, turn and acceleration


def steps_of(files: Files, method: str, limb: str) -> float:
    """Return the time steps that a network learns from, over all epochs; 0 of one without inputs."""
    training = files.catalogue.training(method, limb)
    if not (training.network.Q or training.network.T):
        return 0.0
    read = training_s(files, training.network.data) * files.settings.rates.data_hz / training.learning.data_parts
    return training.epochs * (training.epoch_samples or read)


def training_s(files: Files, name: str) -> float:
    """Return the duration of a training set [s]."""
    size = files.training_size(name)
    return size.shards * size.shard_s


def width_of(files: Files, network: Network) -> int:
    """Return the number of inputs of a network."""
    limbs = files.settings.layout.limbs
    return INPUTS_PER_JOINT * len(limbs(network.Q)) + len(limbs(network.T)) + BASE_INPUTS
