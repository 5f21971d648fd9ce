"""Compile what many jobs run, once, before they all begin: `python -m mobnet.warm`.

The first job on a machine compiles the plant's loop for most of a minute and leaves the machine code in `.cache/numba`;
on a cluster, hundreds of jobs would begin with this minute. The code is that of the processor on which this runs: a
node with another one compiles for itself.
"""

import logging
import sys
import tempfile
import time
from pathlib import Path

import torch
from torch import nn

from mobnet.core.recording import read_sensed
from mobnet.estimation.observer import MomentumObserver
from mobnet.learning.gru import run_gru
from mobnet.plan.jobs import walk_settings
from mobnet.robot.description import describe
from mobnet.robot.nominal import NominalModel
from mobnet.settings.load import load_settings
from mobnet.settings.settings import Settings
from mobnet.simulation.record import collect

log = logging.getLogger(__name__)
SAMPLES = 2  # of the walk, and steps of the network
LANES, INPUTS, HIDDEN = 2, 3, 4  # of the network; the compiled code is that of any size


def warm(settings: Settings) -> None:
    """Walk the plant, observe it and train a network for two samples, which compiles all that these do."""
    log.info("compiling for this processor what jobs run; a minute, or some seconds where the cache has it")
    started = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        walk_and_observe(settings, Path(folder) / "walk")
    train()
    log.info("compiled, %.0f s", time.perf_counter() - started)


def walk_and_observe(settings: Settings, out: Path) -> None:
    """Record the first scenario at the first level, and compute the residual of the momentum observer."""
    scenario, level = next(iter(settings.scenarios)), next(iter(settings.levels))
    collect(walk_settings(settings, scenario, level), settings.seed, SAMPLES / settings.rates.data_hz, out)
    nominal = NominalModel(describe(settings.robot))
    observer = MomentumObserver(nominal, settings.observer.gain_hz, settings.rates.data_hz, settings.observer.torque)
    observer.residual(read_sensed(out, settings.layout).sensed)


def train() -> None:
    """Run a network over time and back in each number format of the products."""
    cell = nn.GRU(INPUTS, HIDDEN)
    for is_rounded in (False, True):
        with torch.autocast("cpu", dtype=torch.bfloat16, enabled=is_rounded):
            states, _ = run_gru(cell, torch.zeros(SAMPLES, LANES, INPUTS), torch.zeros(1, LANES, HIDDEN))
        states.sum().backward()


if __name__ == "__main__":
    logging.basicConfig(format="%(message)s", stream=sys.stderr)
    log.setLevel(logging.INFO)
    warm(load_settings())
