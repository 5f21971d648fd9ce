"""How much each job of a plan has to do: what a run will cost follows from it and from what jobs took before."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from experiments.plan.files import Files, NetworkName
from mobnet.settings.networks import Network

SECONDS = "s"
INPUTS_PER_JOINT, BASE_INPUTS = 2, 12  # of a network: position and velocity; rotation, turn and acceleration
TOGETHER_S = 960.0  # recordings of so long are held in memory and run side by side [s]: 1.3 GB
Amounts = dict[str, float]


@dataclass(frozen=True)
class Work:
    """What one job has to do.

    Attributes:
        job: name of its account, `RULE` or `RULE/...`.
        kind: jobs of one kind take as long for as much work.
        amounts: what its processor time grows with, by name: seconds of recordings [s]; steps of networks, for a
            training also times their units and their square.
        held: what its memory grows with: seconds [s] of the recordings that it holds, or numbers of training data.
    """

    job: str
    kind: str
    amounts: Mapping[str, float]
    held: float


def total(amounts: Iterable[Mapping[str, float]]) -> Amounts:
    """Return the sum of amounts, name by name."""
    found: Amounts = {}
    for own in amounts:
        for name, amount in own.items():
            found[name] = found.get(name, 0.0) + amount
    return found


def walked(files: Files, scenario: str, seeds: Sequence[int]) -> tuple[Amounts, float]:
    """Return the work of recordings that are made one after another, and the longest of them [s]."""
    seconds = files.duration_s([scenario], seeds[0])
    return {"surrogate s" if files.robot else SECONDS: seconds * len(seeds), "walk": len(seeds)}, seconds


def trained(files: Files, networks: Sequence[NetworkName]) -> tuple[Amounts, float]:
    """Return the work of trainings one after another, and the most numbers of training data that one of them holds."""
    rate_hz = files.settings.rates.data_hz
    found = list[Amounts]()
    held = list[float]()
    for name in networks:
        training = files.catalogue.training(name.method, name.limb)
        network = training.network
        hidden = training.network.hidden or 0
        ways = {"windows": training.learning.sequences == "windows", "spectral": network.spectral}
        cell = " ".join([network.cell, *(way for way, is_so in ways.items() if is_so)])
        steps = steps_of(files, name)
        read = training_s(files, network.data)
        grown = {"step": steps, "step x unit": steps * hidden, "step x unit^2": steps * hidden**2}
        found.append({SECONDS: read, "network": 1.0, **{f"{cell} {name}": amount for name, amount in grown.items()}})
        held.append(read * rate_hz * _width(files, network))
    return total(found), max(held)


def steps_of(files: Files, name: NetworkName) -> float:
    """Return the time steps that a network learns from, over all epochs; 0 of one without inputs."""
    training = files.catalogue.training(name.method, name.limb)
    if not (training.network.Q or training.network.T):
        return 0.0
    read = training_s(files, training.network.data) * files.settings.rates.data_hz / training.learning.data_parts
    return training.epochs * (training.epoch_samples or read)


def estimated(files: Files, scenario: str, level: str) -> tuple[Amounts, float]:
    """Return the work of all methods of a test at a level, and the seconds [s] that run side by side."""
    catalogue = files.catalogue
    seconds = files.settings.test_s(scenario)
    whole = seconds * len(files.test_seeds)
    found: list[Mapping[str, float]] = [{SECONDS: whole}]
    for method in catalogue.tests[scenario][level]:
        kind = catalogue.method(method).kind
        for seed in files.run_seeds(method, scenario, level):
            steps = seconds * files.settings.rates.data_hz * len(files.networks(method, seed, scenario, level))
            found.append({"run": 1.0, f"{kind} s": whole, f"{kind} step": steps})
    return total(found), max(seconds, min(whole, TOGETHER_S))


def fitted(files: Files, method: str) -> tuple[Amounts, float]:
    """Return the work of a fit, which reads the training set of one limb after the other, and the longest set [s]."""
    limbs = files.catalogue.method(method).fitted
    read = [training_s(files, files.catalogue.network(method, limb).data) for limb in limbs]
    return {SECONDS: sum(read)}, max(read)


def detected(files: Files) -> tuple[Amounts, float]:
    """Return the work of detectors, and the duration of all recordings of their longest test [s]."""
    seconds = [files.settings.test_s(name) * len(files.test_seeds) for name in files.settings.detection_walks]
    return {SECONDS: sum(seconds)}, max(seconds)


def training_s(files: Files, name: str) -> float:
    """Return the duration of a training set [s]."""
    size = files.training_size(name)
    return size.shards * size.shard_s


def _width(files: Files, network: Network) -> int:
    """Return the number of inputs and targets of a network."""
    limbs = files.settings.layout.limbs
    seen = INPUTS_PER_JOINT * len(limbs(network.Q)) + len(limbs(network.T)) + BASE_INPUTS
    return seen + len(limbs(network.joints))
