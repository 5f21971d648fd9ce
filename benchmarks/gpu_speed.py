"""Networks that learn side by side on a GPU: their speed against one `nn.GRU` after another, and what they compute.

All are GRU[30,150]-Linear[150,12] of Table 1 and learn from made-up data. Side by side they learn as a job of the
workflow trains them: samples, loss (22), SOAP, validation, checkpoint. The other ones learn with Adam, which takes less
time than SOAP, and are not validated. Times are of the wall, in turns.

A machine with torch, numpy, safetensors, pydantic, pyyaml and pyarrow runs it from the project's folder, without an
environment: `PYTHONPATH=src python -m benchmarks gpu_speed`.
"""

import functools
import operator
import statistics
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch
from torch import Tensor, nn

from mobnet.learning.dataset import LimbData
from mobnet.learning.features import limb_inputs
from mobnet.learning.job import TrainingJob
from mobnet.learning.model import build_network
from mobnet.learning.numbers import optimiser_numbers
from mobnet.learning.optimisation import Samples, train_epoch
from mobnet.learning.soap import optimizer_of
from mobnet.learning.stacked.cells import StackedGru
from mobnet.learning.stacked.gates import TorchGates, gates_of
from mobnet.learning.stacked.trainer import Member, StackedTrainer, Taught
from mobnet.learning.streams import epoch_plan
from mobnet.settings.lab import Lab, load_lab
from mobnet.settings.networks import Network, Training

RATE_HZ = 1000.0
WEIGHTS = ("weight_ih_l0", "weight_hh_l0", "bias_ih_l0", "bias_hh_l0")  # of `nn.GRU`, as `StackedGru` takes them
BARS = {32: 25.0, 1: 2.0}  # networks side by side -> times one `nn.GRU`
STATES, GRADIENTS = 1e-3, 1e-3  # largest difference of states; norm of that of gradients, of theirs: both with TF32
Row = dict[str, float | str]


@dataclass(frozen=True)
class Sizes:
    """How much is measured.

    Attributes:
        updates: in an epoch.
        rounds: epochs that are timed, after a first one that compiles and captures.
        sets: sets of data, from which networks learn in turn.
        hidden: size of the state; None is that of the leg.
    """

    updates: int = 200
    rounds: int = 5
    sets: int = 4
    hidden: int | None = None


class TimedTrainer(StackedTrainer):
    """Notes the speed of each epoch, all networks together [time steps/s]."""

    def __init__(self, members: list[Member], device: torch.device) -> None:
        """Take networks and the device that trains them."""
        super().__init__(members, device)
        training = members[0].job.training
        self._steps = training.learning.batch_size * training.network.horizon_steps
        self.speeds: list[float] = []

    def _epoch(self, done: Taught) -> None:
        before = int(done.updates.sum())
        started = time.perf_counter()
        super()._epoch(done)
        self.speeds.append((int(done.updates.sum()) - before) * self._steps / (time.perf_counter() - started))


def main() -> list[Row]:
    """Return the rows of the GPU; without one say of each why it is missing."""
    if not torch.cuda.is_available():
        for what in ("networks side by side", "their bytes of two runs", "their gates, states and gradients"):
            print(f"no GPU here: {what} are not measured", file=sys.stderr)
        return []
    torch.set_float32_matmul_precision("high")  # as a job of the workflow has it
    print(f"{torch.cuda.get_device_name()}, torch {torch.__version__}", file=sys.stderr)
    return rows(torch.device("cuda"), Sizes(), BARS)


def rows(device: torch.device, sizes: Sizes, bars: dict[int, float]) -> list[Row]:
    """Return a row for each number of networks, then what they compute, on a device."""
    lab = load_lab()
    training = leg(lab, sizes)
    data = [made_up(lab, training, sizes, seed) for seed in range(sizes.sets)]
    alone = alone_speed(training, data[0], sizes, device)
    found: list[Row] = []
    for networks, bar in bars.items():
        speeds = side_by_side_speed(training, data, networks, device)
        row: Row = {
            "name": f"leg networks side by side, {networks}, against one nn.GRU after another",
            "ours": statistics.median(speeds) / 1e3,
            "reference": statistics.median(alone) / 1e3,
            "unit": "1000 time steps/s",
            "ratio": statistics.median(speeds) / statistics.median(alone),
            "ratio_min": min(speeds) / max(alone),
            "bar": bar,
        }
        found.append(row)
    most = max(bars)
    differ = differing(training, data, most, device)
    kernels = float(not isinstance(gates_of(device), TorchGates))
    states, gradients = differences(training, data[0], device)
    found.append({"name": f"of {most}, those that differ in a second run", "ours": differ, "unit": "", "at_most": 0.0})
    found.append({"name": "gates in one kernel", "ours": kernels, "unit": "", "at_least": 1.0})
    found.append({"name": "states, beside nn.GRU", "ours": states, "unit": "", "at_most": STATES})
    found.append({"name": "gradients, beside nn.GRU", "ours": gradients, "unit": "", "at_most": GRADIENTS})
    return found


def leg(lab: Lab, sizes: Sizes) -> Training:
    """Return the training of a leg's network of Table 1, which sees every sample from the first epoch on."""
    network = Network.model_validate({**vars(lab.robot.networks["LL"]), **vars(lab.networks["LL"])})
    return Training(
        method="MOB-Net",
        limb="LL",
        target="uncertainty",
        network=network.model_copy(update={"hidden": sizes.hidden or network.hidden}),
        learning=lab.learning.model_copy(update={"coarse": (), "precision": "float32"}),
        epochs=sizes.rounds + 1,
    )


def made_up(lab: Lab, training: Training, sizes: Sizes, seed: int) -> LimbData:
    """Return data for an epoch of about so many updates: noise, of which a network learns the size."""
    layout = lab.robot.layout
    learning = training.learning
    names = limb_inputs(layout, training.network).names
    joints = layout.limbs(training.network.joints)
    learned = sizes.updates * learning.batch_size * training.network.horizon_steps
    samples = round(learned / (1.0 - learning.validation_share))
    rng = np.random.default_rng(seed)
    inputs = rng.standard_normal((samples, len(names)), np.float32)
    targets = rng.standard_normal((samples, len(joints)), np.float32)
    return LimbData(inputs, targets, ((0, samples),), names, joints, RATE_HZ)


def members(training: Training, data: list[LimbData], networks: int, folder: Path) -> list[Member]:
    """Return networks with seeds of their own, which learn from the sets of data in turn."""
    found: list[Member] = []
    for seed in range(networks):
        job = TrainingJob(training, seed, 1)
        load = functools.partial(operator.getitem, data, seed % len(data))
        found.append(Member(str(seed), job, load, folder / str(seed)))
    return found


def side_by_side_speed(training: Training, data: list[LimbData], networks: int, device: torch.device) -> list[float]:
    """Return the speed of each timed epoch, all networks together [time steps/s]."""
    with tempfile.TemporaryDirectory() as scratch:
        trainer = TimedTrainer(members(training, data, networks, Path(scratch)), device)
        trainer.run(Path(scratch) / "stack")
    return trainer.speeds[1:]


def alone_speed(training: Training, data: LimbData, sizes: Sizes, device: torch.device) -> list[float]:
    """Return the speed of epochs of one network with torch's own GRU and Adam [time steps/s]."""
    job = TrainingJob(training, 0, 1)
    learning = training.learning
    network = build_network(training.network, len(data.input_names), len(data.joints), learning.std_min, seed=0)
    network.to(device)
    optimizer = optimizer_of(network, optimiser_numbers(learning.model_copy(update={"optimizer": "adam"})))
    rows_learned = sizes.updates * learning.batch_size * job.horizon
    inputs = torch.from_numpy(data.inputs[:rows_learned]).to(device)
    targets = torch.from_numpy(data.targets[:rows_learned]).to(device)
    samples = Samples(inputs, targets)
    speeds: list[float] = []
    for epoch in range(sizes.rounds + 1):
        rng = np.random.default_rng(epoch)
        plan = epoch_plan([(0, rows_learned)], job.stream(RATE_HZ), job.horizon, learning.batch_size, rng)
        started = time.perf_counter()
        train_epoch(network, optimizer, samples, plan, job.horizon, learning.gradient_norm)
        if device.type == "cuda":
            torch.cuda.synchronize()
        steps = len(plan) * learning.batch_size * job.horizon
        speeds.append(steps / (time.perf_counter() - started))
    return speeds[1:]


def differing(training: Training, data: list[LimbData], networks: int, device: torch.device) -> float:
    """Return how many of some networks have other weights after a second run of two epochs."""
    short = training.model_copy(update={"epochs": 2})
    runs: list[Taught] = []
    for _ in range(2):
        with tempfile.TemporaryDirectory() as scratch:
            own = members(short, data, networks, Path(scratch))
            runs.append(StackedTrainer(own, device).run(Path(scratch) / "stack"))
    count = 0
    for one, other in zip(runs[0].progress, runs[1].progress, strict=True):
        same = [torch.equal(weight, other.best[name]) for name, weight in one.best.items()]
        count += not (same and all(same))
    return float(count)


def differences(training: Training, data: LimbData, device: torch.device) -> tuple[float, float]:
    """Return the largest difference of states from those of `nn.GRU`, and that of gradients as a share of theirs."""
    torch.manual_seed(1)
    network, lanes = training.network, training.learning.batch_size
    inputs = len(data.input_names)
    hidden = network.hidden or 1
    alone = [nn.GRU(inputs, hidden).to(device) for _ in range(3)]
    weights = [torch.stack([gru.get_parameter(name).detach() for gru in alone]).requires_grad_() for name in WEIGHTS]

    def drawn(*shape: int) -> Tensor:
        return torch.randn(shape).to(device)

    x = drawn(3, network.horizon_steps, lanes, inputs)
    state = drawn(3, lanes, hidden)
    given = drawn(3, network.horizon_steps, lanes, hidden)
    states = StackedGru.apply(x, state, *weights)
    (states * given).sum().backward()
    of_states, of_gradients = [0.0], [0.0]
    for k, gru in enumerate(alone):
        expected, _ = gru(x[k], state[k][None])
        (expected * given[k]).sum().backward()
        of_states.append(float((states[k] - expected).detach().abs().max()))
        for name, weight in zip(WEIGHTS, weights, strict=True):
            own = gru.get_parameter(name).grad
            if own is not None and weight.grad is not None:
                of_gradients.append(float((weight.grad[k] - own).norm() / own.norm()))
    return max(of_states), max(of_gradients)


if __name__ == "__main__":
    for row in main():
        print(row)
