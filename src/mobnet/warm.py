"""Compile what jobs run, once, so that jobs of a cluster, which start together, find it in the cache.

The first job on a machine compiles the plant's loop for most of a minute and leaves the machine code in `.cache/numba`;
on a cluster, hundreds of jobs would begin with this minute. The code is that of the processor on which this runs: a
node with another one compiles for itself.
"""

import logging
import tempfile
import time
from pathlib import Path

import numpy as np
import torch
from torch import nn

from mobnet.core.recording import read_sensed
from mobnet.detection.chain import make_chain
from mobnet.detection.detector import LegGate, run_over
from mobnet.estimation.observer import MomentumObserver
from mobnet.learning.gru import run_gru
from mobnet.robot.description import describe
from mobnet.robot.nominal import NominalModel
from mobnet.settings.detection import Detection
from mobnet.settings.settings import WalkSettings
from mobnet.simulation.record import collect

log = logging.getLogger(__name__)
SAMPLES = 2  # of the walk, and steps of the network
LANES, INPUTS, HIDDEN = 2, 3, 4  # of the network; the compiled code is that of any size


def warm(walk: WalkSettings, detection: Detection) -> None:
    """Walk the plant, observe it and train a network for two samples, and watch the legs for collisions."""
    started = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        _walk(walk, detection, Path(folder) / "walk")
    for precision in (torch.float32, torch.bfloat16):
        _learn(precision)
    log.info("compiled what jobs run, %.0f s", time.perf_counter() - started)


def _walk(walk: WalkSettings, detection: Detection, out: Path) -> None:
    """Record a walk, compute the residual of the momentum observer, and run a detector of each leg."""
    rate_hz, robot = walk.rates.data_hz, describe(walk.robot)
    collect(walk, 0, SAMPLES / rate_hz, out)
    sensed = read_sensed(out, robot.layout).sensed
    MomentumObserver(NominalModel(robot), 1.0, rate_hz).residual(sensed)
    chain, signals = (
        make_chain(detection.low_pass_hz, detection.hold_s, rate_hz, np.ones((1, 1))),
        np.zeros((SAMPLES, 1)),
    )
    for limb in robot.layout.legs.values():
        run_over(chain, signals, LegGate.of(detection.gate, robot, limb, rate_hz).run(sensed, np.zeros((SAMPLES, 6))))


def _learn(precision: torch.dtype) -> None:
    """Run a network over time and back, its products in a number format."""
    cell = nn.GRU(INPUTS, HIDDEN)
    with torch.autocast("cpu", precision, enabled=precision != torch.float32):
        states, _ = run_gru(cell, torch.zeros(SAMPLES, LANES, INPUTS), torch.zeros(1, LANES, HIDDEN))
    states.sum().backward()
