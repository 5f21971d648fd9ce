"""Products run in one thread in a process whose environment does not say so."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from experiments.running.environment import THREADED

ROOT = Path(__file__).parents[3]
DEPLOYED = """
import numpy as np
from mobnet.learning.deployed.networks import GruNetwork
n, m, h = 4, 30, 400
rng = np.random.default_rng(0)
shapes = {"cell.weight_ih_l0": (3 * h, m), "cell.weight_hh_l0": (3 * h, h), "cell.bias_ih_l0": (3 * h,),
          "cell.bias_hh_l0": (3 * h,), "head.weight": (2 * n, h), "head.bias": (2 * n,), "input.mean": (m,),
          "input.std": (m,), "target.mean": (n,), "target.std": (n,)}
tensors = {name: rng.uniform(0.1, 0.2, shape).astype(np.float32) for name, shape in shapes.items()}
network = GruNetwork(tensors, "LL", tuple("abcd"), tuple(map(str, range(m))), 0.01)
x = np.zeros(m, np.float32)

def work():
    state = network.init()
    for _ in range(500):
        state, _ = network.step(state, x)
"""
TRAINED = """
import numpy as np
import torch
from mobnet.learning.model import build_network
from mobnet.formats.network import NetworkCell
cell = NetworkCell.model_construct(cell="RNN", hidden=400, spectral=False, input_gain=1.0)
network = build_network(cell, 30, 4, 0.01, seed=0)
x, matrix = torch.zeros(10, 64, 30), np.ones((400, 400), np.float32)

def work():
    mean, _, _ = network(x, network.fresh_state(64))
    mean.sum().backward()
    for _ in range(10):
        matrix @ matrix
"""
SHARE = """
import time
work()
threads, process = time.thread_time(), time.process_time()
work()
print((time.process_time() - process) / (time.thread_time() - threads))
"""


@pytest.mark.skipif(len(os.sched_getaffinity(0)) < 2, reason="one core: no library takes two threads")
@pytest.mark.parametrize("script", [DEPLOYED, TRAINED], ids=["deployed", "trained"])
def test_a_network_multiplies_in_the_thread_that_asks(script):
    inherited = {name: value for name, value in os.environ.items() if name.partition("_")[0] not in THREADED}
    told = subprocess.run(
        [sys.executable, "-c", script + SHARE],
        env={**inherited, "PYTHONPATH": str(ROOT / "src")},
        capture_output=True,
        text=True,
        check=True,
    )
    assert float(told.stdout) < 1.2
