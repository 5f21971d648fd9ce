"""Training speed of the leg network in float32 and bfloat16: streams with carried state against nn.GRU on a DataLoader.

All train GRU[30,150]-Linear[150,12] of Table 1 by (22) at the configuration's batch size, in one thread, in turns.
Times are of the processor.
"""

import statistics
import sys
import time
from collections.abc import Callable
from typing import get_args

import numpy as np
import torch
from torch import Tensor, nn
from torch.utils.data import DataLoader, TensorDataset

from experiments.plan.plan import with_precision
from experiments.settings.catalogue import Catalogue
from experiments.settings.load import load_settings
from mobnet.core.machine import one_thread
from mobnet.learning.features import limb_inputs
from mobnet.learning.job import PRECISIONS, TrainingJob
from mobnet.learning.losses import gaussian_loss
from mobnet.learning.model import LimbNetwork, build_network
from mobnet.learning.numbers import optimiser_numbers
from mobnet.learning.optimisation import Samples, train_epoch
from mobnet.learning.precision import of_processor
from mobnet.learning.soap import optimizer_of
from mobnet.learning.streams import epoch_plan
from mobnet.settings.networks import Optimizer

UPDATES, ROUNDS = 40, 5  # updates in a turn, turns
BAR = 2.8  # times nn.GRU + DataLoader
OF_PRODUCTS = 0.7  # of the speed of the products alone
OF_ADAM = 1 / 1.2  # of the speed with Adam


def main() -> list[dict[str, float | str]]:
    """Return a row for each number format of the products: thousand time steps per second, and the median ratio.

    The format that this CPU trains in has to keep the bars: against nn.GRU, and against the products of a training
    alone, as libraries compute them. A GPU, where there is one, has a row of its own.
    """
    one_thread()
    settings = with_precision(load_settings(overrides={"scale": "default"}), of_processor())
    job = TrainingJob(Catalogue(settings).training("MOB-Net", "LL"), 0, settings.seed)
    leg, learning = job.training.network, job.training.learning
    sizes = len(limb_inputs(settings.layout, leg).names), len(settings.layout.limbs(leg.joints))
    generator = torch.Generator().manual_seed(0)
    data = [torch.randn(UPDATES * learning.batch_size * job.horizon, n, generator=generator) for n in sizes]

    def network(precision: torch.dtype) -> LimbNetwork:
        built = build_network(leg, *sizes, learning.std_min, seed=0)
        built.precision = precision
        return built

    formats = PRECISIONS.values()
    epochs = [_ours(job, network(precision), *data) for precision in formats]
    epochs += [_products(job, sizes[0], precision) for precision in formats]
    chosen = network(PRECISIONS[learning.precision])
    epochs += [_ours(job, chosen, *data, optimizer) for optimizer in get_args(Optimizer)]
    epochs.append(_theirs(job, network(torch.float32), *data))
    turns = [[_speed(epoch, len(data[0])) for epoch in epochs] for _ in range(ROUNDS + 1)][1:]  # the first one compiles
    rows = []
    for k, name in enumerate(PRECISIONS):
        what, kept = f"training, leg network in {name}, against ", name == learning.precision
        rows.append(_row(what + "nn.GRU + DataLoader", turns, k, -1, BAR if kept else None))
        rows.append(_row(what + "its products alone", turns, k, len(formats) + k, OF_PRODUCTS if kept else None))
    rows.append(_row("training, SOAP against Adam", turns, -2, -3, OF_ADAM))
    return rows + _on_gpu(job, network(torch.float32), *data)


def _row(name: str, turns: list[list[float]], ours: int, reference: int, bar: float | None) -> dict[str, float | str]:
    """Return the row of two columns of the turns, time steps per second."""
    ratios = [turn[ours] / turn[reference] for turn in turns]
    speeds = {
        who: statistics.median(turn[k] for turn in turns) / 1e3 for who, k in (("ours", ours), ("reference", reference))
    }
    row = {
        "name": name,
        **speeds,
        "unit": "1000 time steps/s",
        "ratio": statistics.median(ratios),
        "ratio_min": min(ratios),
    }
    return row if bar is None else {**row, "bar": bar}


def _speed(epoch: Callable[[], object], rows: int) -> float:
    """Return time steps per second of processor time of one epoch over some rows."""
    started = time.process_time()
    epoch()
    return rows / (time.process_time() - started)


def _products(job: TrainingJob, inputs: int, precision: torch.dtype) -> Callable[[], object]:
    """Return the matrix products of an epoch's GRU alone, by NumPy in float32 and by torch in bfloat16.

    Those of the inputs are in float32 in any case. As in a training, each step has its own left factor.
    """
    hidden, lanes, steps = job.training.network.hidden, job.training.learning.batch_size, job.horizon
    shapes = [
        (steps, lanes, inputs, 3 * hidden, torch.float32),
        (steps, lanes, hidden, 3 * hidden, precision),
        (steps, lanes, 3 * hidden, hidden, precision),
        (1, 3 * hidden, steps * lanes, inputs, precision),  # gradients of weights
        (1, 3 * hidden, steps * lanes, hidden, precision),
    ]
    factors = [
        (torch.randn(calls, m, k).to(kind), torch.randn(k, n).to(kind), torch.empty(m, n, dtype=kind))
        for calls, m, k, n, kind in shapes
    ]

    def epoch() -> None:
        for lefts, right, out in factors * UPDATES:
            for left in lefts:
                if left.dtype == torch.float32:
                    np.matmul(left.numpy(), right.numpy(), out=out.numpy())
                else:
                    torch.mm(left, right, out=out)

    return epoch


def _on_gpu(job: TrainingJob, network: LimbNetwork, inputs: Tensor, targets: Tensor) -> list[dict[str, float | str]]:
    """Return the row of a GPU, by wall time; without one say so."""
    if not torch.cuda.is_available():
        print("no GPU here: the speed of a training on one is not measured", file=sys.stderr)
        return []
    epoch, speeds = _ours(job, network.cuda(), inputs.cuda(), targets.cuda()), []
    for _ in range(ROUNDS + 1):
        started = time.perf_counter()
        epoch()
        torch.cuda.synchronize()
        speeds.append(len(inputs) / (time.perf_counter() - started) / 1e3)
    name = f"training, leg network on {torch.cuda.get_device_name()}"
    return [{"name": name, "ours": statistics.median(speeds[1:]), "unit": "1000 time steps/s"}]


def _ours(
    job: TrainingJob, network: LimbNetwork, inputs: Tensor, targets: Tensor, kind: Optimizer = "adam"
) -> Callable[[], object]:
    """Return one epoch as this package trains, with an optimiser of this kind."""
    samples, horizon, learning = Samples(inputs, targets), job.horizon, job.training.learning
    optimizer = optimizer_of(network, optimiser_numbers(learning.model_copy(update={"optimizer": kind})))
    for group in optimizer.param_groups:
        group["lr"] = job.rate(0)
    rng = np.random.default_rng(0)

    def epoch() -> object:
        plan = epoch_plan([(0, len(inputs))], job.stream(1000.0), horizon, learning.batch_size, rng)
        return train_epoch(network, optimizer, samples, plan, horizon, learning.gradient_norm)

    return epoch


def _theirs(job: TrainingJob, network: LimbNetwork, inputs: Tensor, targets: Tensor) -> Callable[[], object]:
    """Return one epoch of the usual loop: shuffled windows from a DataLoader, zero state, nn.GRU."""
    optimizer = torch.optim.Adam(network.parameters(), lr=job.rate(0))
    learning = job.training.learning
    windows = TensorDataset(*(tensor.unflatten(0, (-1, job.horizon)) for tensor in (inputs, targets)))
    loader = DataLoader(windows, batch_size=learning.batch_size, shuffle=True)

    def epoch() -> None:
        for x, target in loader:
            hidden, _ = network.cell(x.transpose(0, 1))
            mean, raw = network.head(hidden).chunk(2, dim=-1)
            std = nn.functional.softplus(raw).clamp_min(network.std_min)
            loss = gaussian_loss(mean, std, target.transpose(0, 1))
            optimizer.zero_grad()
            loss.backward()
            nn.utils.clip_grad_norm_(network.parameters(), learning.gradient_norm)
            optimizer.step()

    return epoch


if __name__ == "__main__":
    for row in main():
        print(row)
