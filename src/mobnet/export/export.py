"""Networks as files for a robot's own program: `./reproduce export NET... --robot TABLE --out DIR` (docs/runtime.md).

It writes one ONNX file for each limb, and the contract of all of them. It runs each file beside the project's own
network on random inputs, and prints by how much they differ.
"""

import logging
import math
import sys
from argparse import Namespace
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

import numpy as np

from mobnet.core.errors import DataError, not_accepted
from mobnet.core.files import atomic_path, sweep, write_json
from mobnet.detection.threshold_file import read_thresholds
from mobnet.export.contract import CONTRACT, Contract, ObserverContract, read_contract
from mobnet.export.graph import graph_of
from mobnet.export.runtime import export_model
from mobnet.export.session import OnnxNetwork
from mobnet.export.trained import Trained, check_apart, contract_of, read_trained
from mobnet.export.words import export_parser
from mobnet.learning.deployed.networks import deployed
from mobnet.robot.description import RobotDescription
from mobnet.robot.given import given_robot
from mobnet.running.printed import printed
from mobnet.settings.base import TorqueKind
from mobnet.settings.limb_thresholds import LimbThresholds
from mobnet.settings.load import load_settings

log = logging.getLogger(__name__)
SAMPLES, SEED = 1000, 1  # of the random inputs on which a file is compared with its network
Value = TypeVar("Value", TorqueKind, float)


@dataclass(frozen=True)
class RunTime:
    """How a robot runs exported networks: samples per second [Hz], and its observer."""

    rate_hz: float
    observer: ObserverContract


def export(
    networks: Sequence[Trained], robot: RobotDescription, run: RunTime, thresholds: Sequence[LimbThresholds], out: Path
) -> Contract:
    """Write networks and their contract into a folder; return the contract.

    Networks of an earlier export into the folder, which the contract no longer lists, are removed.

    Raises:
        DataError: two networks estimate one joint, thresholds belong to something else, a file cannot be written, or
            the folder has a contract that cannot be read.
    """
    check_apart(networks)
    check_thresholds(thresholds, networks, robot, run)
    before = {own.file for own in read_contract(out).networks} if (out / CONTRACT).exists() else set()
    contract = contract_of(robot.name, robot.layout, networks, run.rate_hz, run.observer, thresholds)
    for one, own in zip(networks, contract.networks, strict=True):
        model = graph_of(one.tensors, one.note)
        for key, value in contract.of(own).metadata().items():
            model.metadata_props.add(key=key, value=value)
        content = model.SerializeToString(deterministic=True)
        with atomic_path(out / own.file, len(content)) as temporary:
            temporary.write_bytes(content)
    write_json(out / CONTRACT, contract.as_json())
    for path in out.glob("*.onnx"):
        if path.name in before - {own.file for own in contract.networks}:
            path.unlink()
    return contract


def check_thresholds(
    thresholds: Sequence[LimbThresholds], networks: Sequence[Trained], robot: RobotDescription, run: RunTime
) -> None:
    """Raise a DataError unless thresholds belong to the robot, its run time and, where they name it, the network."""
    fingerprints = {one.note.limb: one.run.fingerprint for one in networks}
    for one in thresholds:
        expected = {
            "robot": robot.name, "rate_hz": run.rate_hz, "gain_hz": run.observer.gain_hz, "torque": run.observer.torque,
            "joints": robot.layout.limb(one.limb),
            **({"network": fingerprints.get(one.limb, "that of an exported network")} if one.network else {}),
        }  # fmt: skip
        for key, accepted in expected.items():
            if getattr(one, key) != accepted:
                raise DataError(not_accepted(f"thresholds of {one.limb}: {key}", getattr(one, key), [accepted]))


def agreed(name: str, given: Value | None, trained: Sequence[Value | None], default: Value) -> Value:
    """Return the value of the trainings, where none says it what is given, else a default.

    Raises:
        DataError: the trainings differ, or another value is given than theirs.
    """
    found = sorted({value for value in trained if value is not None})
    if len(found) > 1:
        raise DataError(not_accepted(f"{name} of the networks", found, ["one for all of them"]))
    if found and given not in (None, found[0]):
        raise DataError(not_accepted(f"--{name}", given, [f"{found[0]}, that of the training"]))
    return found[0] if found else default if given is None else given


def difference(one: Trained, path: Path) -> float:
    """Return by how much an exported network differs from the project's own on random inputs.

    It is the largest difference of mean and standard deviation, as a share of the target's standard deviation.
    """
    tensors, rng = one.tensors, np.random.default_rng(SEED)
    lane = rng.normal(tensors["input.mean"], tensors["input.std"], (SAMPLES, len(one.note.inputs))).astype(np.float32)
    (own,), (exported,) = deployed(tensors, one.note).run_all([lane]), OnnxNetwork(path).run_all([lane])
    apart = np.array([own.mean, own.std], np.float32) - np.array([exported.mean, exported.std], np.float32)
    return float(np.max(np.abs(apart) / tensors["target.std"]))


def told(contract: Contract, networks: Sequence[Trained], out: Path) -> Iterator[str]:
    """Yield what the command prints."""
    observer = contract.observer
    yield f"{contract.robot} at {contract.rate_hz:g} Hz, gain {observer.gain_hz:g} 1/s, torques: {observer.torque}"
    for one, own in zip(networks, contract.networks, strict=True):
        size = f"{len(own.inputs)} inputs, {len(own.outputs)} joints, state {own.state}"
        apart = difference(one, out / own.file)
        yield f"{out / own.file}: {own.cell}, {size}; differs by {apart:.1e} of the target's standard deviation"
    for detector in contract.detectors:
        yield f"detector of {detector.limb}: {detector.signal} of {', '.join(detector.joints)}, {detector.watched}"
    yield f"{out / CONTRACT}"


def run(options: Namespace) -> Iterator[str]:
    """Export networks as the command's options say, and yield what is printed."""
    settings = load_settings()
    robot = given_robot(options.robot, settings)
    networks = [read_trained(folder, robot.layout) for folder in options.network]
    notes, own = [one.run for one in networks], settings.observer
    for word in ("rate", "gain"):
        value = getattr(options, word)
        if value is not None and not 0.0 < value < math.inf:
            raise DataError(not_accepted(f"--{word}", value, ["a number above 0"]))
    run_time = RunTime(
        agreed("rate", options.rate, [note.rate_hz for note in notes], settings.rates.data_hz),
        ObserverContract(
            gain_hz=agreed("gain", options.gain, [note.gain_hz for note in notes], own.gain_hz),
            torque=agreed("torque", options.torque, [note.torque for note in notes], own.torque),
            gravity_m_s2=settings.plant.gravity_m_s2,
        ),
    )
    sweep(options.out)
    contract = export(networks, robot, run_time, [read_thresholds(path) for path in options.thresholds], options.out)
    model = export_model(options.out, robot, contract, networks, settings.detection.gate)
    yield from told(contract, networks, options.out)
    yield model


def main(words: list[str]) -> int:
    """Run the command; return its exit status."""
    options = export_parser().parse_args(words)
    return printed(log, lambda: run(options))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
