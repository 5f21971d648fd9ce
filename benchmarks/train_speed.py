"""Training speed of the leg network: streams with carried state against nn.GRU on a DataLoader of windows.

Both train GRU[30,150]-Linear[150,12] of Table 1 by (22) at the configuration's batch size, in one thread, in turns.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import torch
from torch import Tensor, nn
from torch.utils.data import DataLoader, TensorDataset

from mobnet.core.config import load_config, load_layout
from mobnet.learning.features import limb_inputs
from mobnet.learning.job import Job, job_of
from mobnet.learning.loss import gaussian_loss
from mobnet.learning.model import LimbNetwork, build_network
from mobnet.learning.optimisation import Samples, train_epoch
from mobnet.learning.streams import epoch_plan

CONFIG = Path(__file__).parents[1] / "configs" / "config.yaml"
UPDATES, ROUNDS = 40, 5  # updates in a turn, turns


def main() -> list[dict[str, float | str]]:
    """Return one row: thousand time steps per second of both, and their ratio, the median over turns."""
    torch.set_num_threads(1)
    config = load_config(CONFIG, "default")
    job = job_of(config, "MOB-Net", "LL", 0)
    layout = load_layout(CONFIG.parents[1] / config["robot"])
    sizes = len(limb_inputs(layout, job.row).names), len(layout.limb("LL"))
    networks = [build_network(job.row, *sizes, job.settings["std_min"], seed=0) for _ in range(2)]
    rows = UPDATES * job.settings["batch_size"] * job.horizon
    generator = torch.Generator().manual_seed(0)
    inputs, targets = (torch.randn(rows, width, generator=generator) for width in sizes)
    ours = _ours(job, networks[0], inputs, targets)
    theirs = _theirs(job, networks[1], inputs, targets)
    turns = [(_speed(ours, rows), _speed(theirs, rows)) for _ in range(ROUNDS + 1)][1:]  # the first one compiles
    ratio = statistics.median(a / b for a, b in turns)
    speeds = [statistics.median(column) / 1e3 for column in zip(*turns, strict=True)]
    unit = "1000 time steps/s"
    return [{"name": "training, leg network, against nn.GRU + DataLoader", "ours": speeds[0], "reference": speeds[1],
             "unit": unit, "ratio": ratio}]  # fmt: skip


def _speed(epoch: Callable[[], object], rows: int) -> float:
    """Return time steps per second of one epoch over some rows."""
    started = time.perf_counter()
    epoch()
    return rows / (time.perf_counter() - started)


def _ours(job: Job, network: LimbNetwork, inputs: Tensor, targets: Tensor) -> Callable[[], object]:
    """Return one epoch as this package trains."""
    optimizer = torch.optim.Adam(network.parameters(), lr=job.rate(0))
    samples, horizon = Samples(inputs, targets), job.horizon
    rng = np.random.default_rng(0)

    def epoch() -> object:
        plan = epoch_plan([(0, len(inputs))], job.stream(1000.0), horizon, job.settings["batch_size"], rng)
        return train_epoch(network, optimizer, samples, plan, horizon, job.settings["gradient_norm"])

    return epoch


def _theirs(job: Job, network: LimbNetwork, inputs: Tensor, targets: Tensor) -> Callable[[], object]:
    """Return one epoch of the usual loop: shuffled windows from a DataLoader, zero state, nn.GRU."""
    optimizer = torch.optim.Adam(network.parameters(), lr=job.rate(0))
    windows = TensorDataset(*(tensor.unflatten(0, (-1, job.horizon)) for tensor in (inputs, targets)))
    loader = DataLoader(windows, batch_size=job.settings["batch_size"], shuffle=True)

    def epoch() -> None:
        for x, target in loader:
            hidden, _ = network.cell(x.transpose(0, 1))
            mean, raw = network.head(hidden).chunk(2, dim=-1)
            std = nn.functional.softplus(raw).clamp_min(network.std_min)
            loss = gaussian_loss(mean, std, target.transpose(0, 1))
            optimizer.zero_grad()
            loss.backward()
            nn.utils.clip_grad_norm_(network.parameters(), job.settings["gradient_norm"])
            optimizer.step()

    return epoch


if __name__ == "__main__":
    for row in main():
        print("{name}: {ours:.1f} against {reference:.1f} {unit}, ratio {ratio:.2f}".format(**row))
