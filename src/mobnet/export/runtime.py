"""From exported networks and their contract to the model file of the C library in `src/runtime` (docs/runtime.md)."""

from collections.abc import Sequence

import numpy as np

from mobnet.detection.chain import make_chain
from mobnet.detection.detector import LegGate
from mobnet.estimation.observer import MomentumObserver
from mobnet.estimation.own import OBSERVER
from mobnet.export.contract import Contract
from mobnet.export.model_file import RuntimeDetector, RuntimeNetwork, model_content
from mobnet.export.trained import Trained
from mobnet.learning.deployed.networks import WITHOUT_TORCH
from mobnet.robot.description import RobotDescription
from mobnet.robot.nominal import NominalModel
from mobnet.settings.detection import SwingGate
from mobnet.settings.limb_thresholds import LimbThresholds

MODEL = "model.bin"


def model_of(robot: RobotDescription, contract: Contract, networks: Sequence[Trained], gate: SwingGate) -> bytes | None:
    """Return the model file of a robot, whose table is what the observer knows, with networks and their contract.

    Where the library lacks the cell of a network there is none.

    Args:
        robot: the robot.
        contract: rate, observer, what networks estimate, and thresholds.
        networks: the networks in the contract's order.
        gate: numbers of the gate, for limbs that are watched in swing.

    Raises:
        DataError: a number is one that the library does not accept.
        ConfigError: a limb that is watched in swing is no leg.
    """
    if not all(one.note.cell.cell in WITHOUT_TORCH for one in networks):
        return None
    observing = contract.observer
    nominal = NominalModel(robot, gravity_m_s2=observing.gravity_m_s2)
    observer = MomentumObserver(nominal, observing.gain_hz, contract.rate_hz, observing.torque)
    pairs = zip(networks, contract.networks, strict=True)
    parts = [RuntimeNetwork(one.tensors, one.note, told.estimates) for one, told in pairs]
    return model_content(observer, parts, [_detector(one, robot, gate) for one in contract.detectors])


def _detector(one: LimbThresholds, robot: RobotDescription, gate: SwingGate) -> RuntimeDetector:
    """Return the detector of a limb's thresholds."""
    chain = make_chain(one.low_pass_hz, one.hold_s, one.rate_hz, np.array([one.thresholds]))
    swing = LegGate.of(gate, robot, one.limb, one.rate_hz) if one.watched == "swing" else None
    settle = 0 if swing else round(one.settle_s * one.rate_hz)
    return RuntimeDetector(one.limb, tuple(one.joints), (one.signal,), chain, swing, settle, one.method == OBSERVER)
