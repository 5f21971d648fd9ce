"""After the warm-up nothing is left to compile for the jobs of another scenario, level and robot."""

import numpy as np
import pytest
from made_weights import weights

from experiments.plan.jobs import walk_settings
from experiments.warm import warm
from mobnet.core import machine_code
from mobnet.core.columns import COMMAND, FEET, recording_width
from mobnet.core.recording import Sensed
from mobnet.detection.detector import LegGate
from mobnet.detection.gate import advance_held, gate_state
from mobnet.estimation.kinds.dahl import bent
from mobnet.estimation.observe import observer_of
from mobnet.formats.network import NetworkCell
from mobnet.formats.plain import as_plain
from mobnet.kernel.detecting import GateNumbers
from mobnet.kernel.first_order import decay, follow
from mobnet.kernel.momentum import sweep
from mobnet.learning.deployed import tick
from mobnet.learning.deployed.limbs import LimbNetworks
from mobnet.learning.deployed.loading import deployed
from mobnet.learning.features import signal_names
from mobnet.robot.description import describe
from mobnet.simulation import engine
from mobnet.simulation.simulator import Simulator


@pytest.mark.slow
@pytest.mark.sim
def test_the_jobs_find_everything_compiled(settings):
    warm(walk_settings(settings, "forward_walk", "ideal"), settings.detection)
    functions = engine.run, machine_code._hold, tick.advance_row, advance_held, sweep, decay, follow
    before = [list(function.signatures) for function in functions]
    assert all(before)
    simulator = Simulator(walk_settings(settings, "robot_walk", "robot_1"), seed=3)
    simulator.start()
    simulator.run(np.zeros((5, recording_width(simulator.robot.layout)), dtype=np.float32))
    robot = describe(settings.robot)
    layout = robot.layout
    widths = (layout.nq, layout.nv, 3, layout.nu, layout.nu, len(FEET), len(COMMAND), len(FEET))
    rows = np.ones((20, sum(widths)), dtype=np.float32)  # a recording is read as views of one array
    sensed = Sensed(*np.split(rows, np.cumsum(widths)[:-1], axis=1))
    observer_of(simulator.robot, settings.levels["robot_1"].nominal_mass_ratio, 9.81, 50.0, 500.0).residual(sensed)
    bent(np.zeros(layout.nu), sensed.v[:, -layout.nu :], np.ones(layout.nu), 500.0)
    gate = LegGate.of(as_plain(settings.detection.gate, GateNumbers), robot, "LL", 500.0)
    gate.step(gate_state(), np.zeros(layout.nq), np.zeros(6), 0.0, 0.0)
    tensors, note = weights(NetworkCell(cell="GRU", hidden=8), 3, 2, seed=0)
    network = deployed(tensors, note.model_copy(update={"inputs": signal_names(layout)[:3]}))
    networks = LimbNetworks([network, network], layout)
    networks.step(networks.init(), sensed[0])
    assert [list(function.signatures) for function in functions] == before
