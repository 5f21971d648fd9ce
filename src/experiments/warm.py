"""Compile all that is compiled, so that jobs of a cluster, which start together, find it in the cache.

Each function is called once as the jobs call it, on a few samples: numba compiles for the types of what it is given.
"""

import logging

import numpy as np
import torch
from torch import nn

from mobnet.core.columns import COMMAND, FEET, recording_width
from mobnet.core.machine_code import hold
from mobnet.core.recording import Sensed
from mobnet.detection.chain import low_passed, make_chain
from mobnet.detection.detector import LegGate, run_over
from mobnet.detection.gate import gate_state
from mobnet.estimation.kinds.dahl import bent
from mobnet.estimation.observer import RobotObserver
from mobnet.formats.plain import as_plain
from mobnet.kernel.detecting import GateNumbers
from mobnet.learning.deployed.lanes import gru_states
from mobnet.learning.deployed.tick import GruWeights, advance, advance_row, row_of
from mobnet.learning.gates import ordered
from mobnet.learning.gru import run_gru
from mobnet.robot.description import WalkingRobot
from mobnet.robot.nominal import NominalModel
from mobnet.robot.wrench import feet_torque
from mobnet.settings.detection import Detection
from mobnet.settings.walking import WalkSettings
from mobnet.simulation.simulator import Simulator

SAMPLES = 9  # more than the observer takes side by side
log = logging.getLogger(__name__)


def warm(walk: WalkSettings, detection: Detection) -> None:
    """Compile the plant's loop, the observer, the networks' loops and the detectors, or load them.

    What is compiled is the same for all scenarios, levels and robots that walk.

    Raises:
        ConfigError: the robot cannot walk.
    """
    simulator = Simulator(walk, seed=0)
    simulator.start()
    simulator.run(np.zeros((SAMPLES, recording_width(simulator.robot.layout)), dtype=np.float32))
    sensed = _upright(simulator.robot)
    _observe(simulator.robot, sensed, walk.rates.data_hz)
    for precision in (torch.float32, torch.bfloat16):
        _learn(precision)
    _detect(simulator.robot, sensed, detection, walk.rates.data_hz)
    log.info("compiled code is in the cache")


def _upright(robot: WalkingRobot) -> Sensed:
    """Return samples of a robot at rest, (SAMPLES, ...), float32 as those of recordings are."""
    layout = robot.layout
    widths = (layout.nq, layout.nv, 3, layout.nu, layout.nu, len(FEET), len(COMMAND), len(FEET))
    sensed = Sensed(*(np.zeros((SAMPLES, width), dtype=np.float32) for width in widths))
    sensed.q[:, 3] = 1.0
    return sensed


def _observe(robot: WalkingRobot, sensed: Sensed, rate_hz: float) -> None:
    """Run the observer, the memory of a friction model, and the torque of forces on the feet."""
    nominal = NominalModel(robot)
    RobotObserver(nominal, 1.0, rate_hz).residual(sensed)
    bent(np.zeros(1), sensed.v[:, :1], np.ones(1), rate_hz)
    feet_torque(nominal, sensed.q, {side: np.zeros((SAMPLES, 6)) for side in robot.feet})


def _learn(precision: torch.dtype) -> None:
    """Run a GRU forward and back as a training does, and forward as estimates and robots do."""
    cell = nn.GRU(1, 2)
    state = torch.zeros(1, 1, 2)
    with torch.autocast("cpu", precision, enabled=precision != torch.float32):
        states, _ = run_gru(cell, torch.zeros(SAMPLES, 1, 1), state)
    states.sum().backward()
    weights = [weight.detach().numpy() for weight in cell.parameters()]
    gru_states(weights, state.numpy(), np.zeros((SAMPLES, 1, 1), dtype=np.float32))
    unit, two, gates = (np.zeros(n, dtype=np.float32) for n in (1, 2, 8))
    head = np.zeros((2, 2), dtype=np.float32), two
    net = GruWeights(*ordered(*weights), *head, unit, unit + 1, unit, unit, unit, np.float32(0.0), unit.copy(), gates)
    advance(net, two.copy(), unit, two.copy(), unit.copy(), unit.copy())
    row = hold(row_of([net], [np.zeros(1, dtype=np.intp)]))
    advance_row(row, unit, two.copy(), two.copy(), unit.copy(), unit.copy())


def _detect(robot: WalkingRobot, sensed: Sensed, detection: Detection, rate_hz: float) -> None:
    """Run the gate and the chain of a detector of each leg."""
    signals = np.zeros((SAMPLES, 1))
    for norm in (False, True):
        chain = make_chain(detection.low_pass_hz, detection.hold_s, rate_hz, np.ones((1, 1)), norm=norm)
        for limb in robot.layout.legs.values():
            gate = LegGate.of(as_plain(detection.gate, GateNumbers), robot, limb, rate_hz)
            run_over(chain, signals, gate.run(sensed, np.zeros((SAMPLES, 6))))
            gate.step(gate_state(), np.zeros(robot.layout.nq), np.zeros(6), 0.0, 0.0)
        low_passed(chain.pole, signals, np.zeros_like(signals))
