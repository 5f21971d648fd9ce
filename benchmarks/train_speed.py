"""Training speed of the leg network in float32 and bfloat16: streams with carried state against nn.GRU on a DataLoader.

All train GRU[30,150]-Linear[150,12] of Table 1 by (22) at the configuration's batch size, in one thread, in turns.
"""

import statistics
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import torch
from torch import Tensor, nn
from torch.utils.data import DataLoader, TensorDataset

from mobnet.learning.features import limb_inputs
from mobnet.learning.job import PRECISIONS, Job
from mobnet.learning.losses import gaussian_loss
from mobnet.learning.model import LimbNetwork, build_network
from mobnet.learning.optimisation import Samples, train_epoch
from mobnet.learning.streams import epoch_plan
from mobnet.plan.precision import with_precision
from mobnet.settings.load import load_settings

UPDATES, ROUNDS = 40, 5  # updates in a turn, turns
BAR = 2.0  # times nn.GRU + DataLoader


def main() -> list[dict[str, float | str]]:
    """Return a row for each number format of the products: thousand time steps per second, and the median ratio.

    The format that this CPU trains in has to keep the bar.
    """
    torch.set_num_threads(1)
    settings = with_precision(load_settings(overrides={"scale": "default"}), Path("results") / "default")
    job = Job(settings.training("MOB-Net", "LL"), 0, settings.seed)
    leg, learning = job.training.network, job.training.learning
    sizes = len(limb_inputs(settings.layout, leg).names), len(settings.layout.limbs(leg.joints))
    generator = torch.Generator().manual_seed(0)
    data = [torch.randn(UPDATES * learning.batch_size * job.horizon, n, generator=generator) for n in sizes]

    def network(precision: torch.dtype) -> LimbNetwork:
        built = build_network(leg, *sizes, learning.std_min, seed=0)
        built.precision = precision
        return built

    ours = [_ours(job, network(precision), *data) for precision in PRECISIONS.values()]
    epochs = [*ours, _theirs(job, network(torch.float32), *data)]
    turns = [[_speed(epoch, len(data[0])) for epoch in epochs] for _ in range(ROUNDS + 1)][1:]  # the first one compiles
    speeds = [statistics.median(column) / 1e3 for column in zip(*turns, strict=True)]
    rows = []
    for k, name in enumerate(PRECISIONS):
        ratios = [turn[k] / turn[-1] for turn in turns]
        rows.append({"name": f"training, leg network in {name}, against nn.GRU + DataLoader", "ours": speeds[k],
                     "reference": speeds[-1], "unit": "1000 time steps/s", "ratio": statistics.median(ratios),
                     "ratio_min": min(ratios)})  # fmt: skip
        if name == learning.precision:
            rows[-1]["bar"] = BAR
    return rows


def _speed(epoch: Callable[[], object], rows: int) -> float:
    """Return time steps per second of one epoch over some rows."""
    started = time.perf_counter()
    epoch()
    return rows / (time.perf_counter() - started)


def _ours(job: Job, network: LimbNetwork, inputs: Tensor, targets: Tensor) -> Callable[[], object]:
    """Return one epoch as this package trains."""
    optimizer = torch.optim.Adam(network.parameters(), lr=job.rate(0))
    samples, horizon, learning = Samples(inputs, targets), job.horizon, job.training.learning
    rng = np.random.default_rng(0)

    def epoch() -> object:
        plan = epoch_plan([(0, len(inputs))], job.stream(1000.0), horizon, learning.batch_size, rng)
        return train_epoch(network, optimizer, samples, plan, horizon, learning.gradient_norm)

    return epoch


def _theirs(job: Job, network: LimbNetwork, inputs: Tensor, targets: Tensor) -> Callable[[], object]:
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
        print("{name}: {ours:.1f} against {reference:.1f} {unit}, ratio {ratio:.2f}".format(**row))
