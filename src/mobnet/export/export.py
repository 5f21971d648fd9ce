"""Networks as files for a robot's own program: `./reproduce export [NET...] --robot TABLE --out DIR` (docs/runtime.md).

It writes one ONNX file for each limb, and the contract of all of them; without networks, the observer alone with its
thresholds. It runs each file beside the project's own network on random inputs, and prints by how much they differ.
"""

import logging
import sys
from argparse import Namespace
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import TypeVar

import numpy as np

from mobnet.core.errors import DataError, not_accepted
from mobnet.core.files import atomic_path, sweep, write_json
from mobnet.core.options import export_parser
from mobnet.core.printed import printed
from mobnet.core.word_checks import check_export
from mobnet.detection.chain import make_chain
from mobnet.detection.detector import LegGate
from mobnet.detection.signals import MEAN
from mobnet.detection.threshold_file import read_thresholds
from mobnet.estimation.observer import RobotObserver
from mobnet.estimation.sampling import OBSERVER, check_drives
from mobnet.export.contract import CONTRACT, Contract, ObserverContract, read_contract
from mobnet.export.graph import graph_of
from mobnet.export.model_file import RuntimeDetector, RuntimeNetwork, model_content
from mobnet.export.session import OnnxNetwork
from mobnet.export.trained import Trained, check_apart, contract_of, read_trained
from mobnet.formats.limb_thresholds import LimbThresholds
from mobnet.formats.plain import as_plain
from mobnet.kernel.detecting import GateNumbers
from mobnet.kernel.drive import TorqueKind
from mobnet.learning.deployed.loading import WITHOUT_TORCH, deployed
from mobnet.robot.description import RobotDescription
from mobnet.robot.given import given_robot
from mobnet.robot.nominal import NominalModel
from mobnet.settings.lab import Lab, load_lab

MODEL = "model.bin"
log = logging.getLogger(__name__)
SAMPLES, SEED = 1000, 1  # of the random inputs on which a file is compared with its network
Value = TypeVar("Value", TorqueKind, float)


def model_of(
    robot: RobotDescription, contract: Contract, networks: Sequence[Trained], gate: GateNumbers
) -> bytes | None:
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
    if not all(network.note.cell.cell in WITHOUT_TORCH for network in networks):
        return None
    observing = contract.observer
    nominal = NominalModel(robot, gravity_m_s2=observing.gravity_m_s2)
    observer = RobotObserver(nominal, observing.gain_hz, contract.rate_hz, observing.torque)
    pairs = zip(networks, contract.networks, strict=True)
    parts = [RuntimeNetwork(network.tensors, network.note, entry.estimates) for network, entry in pairs]
    return model_content(observer, parts, [_detector(network, robot, gate) for network in contract.detectors])


def _detector(thresholds: LimbThresholds, robot: RobotDescription, gate: GateNumbers) -> RuntimeDetector:
    """Return the detector of a limb's thresholds."""
    chain = make_chain(thresholds.low_pass_hz, thresholds.hold_s, thresholds.rate_hz, np.array([thresholds.thresholds]))
    swing = LegGate.of(gate, robot, thresholds.limb, thresholds.rate_hz) if thresholds.watched == "swing" else None
    settle = 0 if swing else round(thresholds.settle_s * thresholds.rate_hz)
    return RuntimeDetector(
        thresholds.limb,
        tuple(thresholds.joints),
        (thresholds.signal,),
        chain,
        swing,
        settle,
        thresholds.method == OBSERVER,
    )


@dataclass(frozen=True)
class RunTime:
    """How a robot runs exported networks: samples per second [Hz], and its observer."""

    rate_hz: float
    observer: ObserverContract


def export(
    networks: Sequence[Trained],
    robot: RobotDescription,
    run: RunTime,
    thresholds: Sequence[LimbThresholds],
    gate: GateNumbers,
    out: Path,
) -> Contract:
    """Write networks, the model of the C library and their contract into a folder; return the contract.

    All is made before anything is written. The contract is removed first and written last, so that a folder that has
    one is of one export. Files of an earlier export into the folder, which this one lacks, are removed.

    Raises:
        DataError: two networks estimate one joint, thresholds belong to something else, a number is not accepted, a
            file cannot be written, or the folder has a contract that cannot be read.
        ConfigError: a limb that is watched in swing is no leg.
    """
    check_apart(networks)
    for network in networks:
        check_drives(network.folder, network.run.drives, robot)
    check_thresholds(thresholds, networks, robot, run)
    before = (
        {network_contract.file for network_contract in read_contract(out).networks}
        if (out / CONTRACT).exists()
        else set()
    )
    contract = contract_of(robot.name, robot.layout, networks, run.rate_hz, run.observer, thresholds)
    model = model_of(robot, contract, networks, gate)
    files = {} if model is None else {MODEL: model}
    for network, network_contract in zip(networks, contract.networks, strict=True):
        files[network_contract.file] = _onnx_of(network, contract.of(network_contract))
    for name, content in files.items():
        with atomic_path(out / name, len(content)) as temporary:
            temporary.write_bytes(content)
            (out / CONTRACT).unlink(missing_ok=True)
    write_json(out / CONTRACT, contract.as_json())
    for path in (out / MODEL, *out.glob("*.onnx")):
        if path.name in {MODEL, *before} - files.keys():
            path.unlink(missing_ok=True)
    return contract


def _onnx_of(network: Trained, contract: Contract) -> bytes:
    """Return the ONNX file of a network with its part of the contract."""
    model = graph_of(network.tensors, network.note)
    for key, value in contract.metadata().items():
        model.metadata_props.add(key=key, value=value)
    return model.SerializeToString(deterministic=True)


def check_thresholds(
    thresholds: Sequence[LimbThresholds], networks: Sequence[Trained], robot: RobotDescription, run: RunTime
) -> None:
    """Raise a DataError unless thresholds belong to the robot, its run time and, where they name it, the network."""
    fingerprints = {limb_thresholds.note.limb: limb_thresholds.run.fingerprint for limb_thresholds in networks}
    predicted = set(chain.from_iterable(limb_thresholds.note.joints for limb_thresholds in networks))
    for limb_thresholds in thresholds:
        check_drives(Path(f"thresholds of {limb_thresholds.limb}"), limb_thresholds.drives, robot)
        if limb_thresholds.method == OBSERVER and limb_thresholds.signal != MEAN:
            raise DataError(
                not_accepted(
                    f"thresholds of {limb_thresholds.limb}: signal", limb_thresholds.signal, [f"{MEAN} of {OBSERVER}"]
                )
            )
        if limb_thresholds.method != OBSERVER and not set(limb_thresholds.joints) <= predicted:
            accepted = [f"{OBSERVER}, or a network of {', '.join(limb_thresholds.joints)}"]
            raise DataError(
                not_accepted(f"thresholds of {limb_thresholds.limb}: method", limb_thresholds.method, accepted)
            )
        expected = {
            "robot": robot.name,
            "rate_hz": run.rate_hz,
            "gain_hz": run.observer.gain_hz,
            "torque": run.observer.torque,
            "joints": robot.layout.limb(limb_thresholds.limb),
            **(
                {"network": fingerprints.get(limb_thresholds.limb, "that of an exported network")}
                if limb_thresholds.network
                else {}
            ),
        }
        for key, accepted in expected.items():
            if getattr(limb_thresholds, key) != accepted:
                raise DataError(
                    not_accepted(
                        f"thresholds of {limb_thresholds.limb}: {key}", getattr(limb_thresholds, key), [accepted]
                    )
                )


def agreed(name: str, given: Value | None, trained: Sequence[Value | None], default: Value) -> Value:
    """Return the value of trainings or thresholds, where none says it what is given, else a default.

    Raises:
        DataError: they differ, or another value is given than theirs.
    """
    values = sorted({value for value in trained if value is not None})
    if len(values) > 1:
        raise DataError(not_accepted(f"{name} of the networks or thresholds", values, ["one for all of them"]))
    if values and given not in (None, values[0]):
        raise DataError(not_accepted(f"--{name}", given, [f"{values[0]}, that of the files"]))
    return values[0] if values else default if given is None else given


def difference(network: Trained, path: Path) -> float:
    """Return by how much an exported network differs from the project's own on random inputs.

    It is the largest difference of mean and standard deviation, as a share of the target's standard deviation.
    """
    tensors = network.tensors
    rng = np.random.default_rng(SEED)
    lane = rng.normal(tensors["input.mean"], tensors["input.std"], (SAMPLES, len(network.note.inputs))).astype(
        np.float32
    )
    (ours,) = deployed(tensors, network.note).run_all([lane])
    (exported,) = OnnxNetwork(path).run_all([lane])
    apart = np.array([ours.mean, ours.std], np.float32) - np.array([exported.mean, exported.std], np.float32)
    return float(np.max(np.abs(apart) / tensors["target.std"]))


def report_lines(contract: Contract, networks: Sequence[Trained], out: Path) -> Iterator[str]:
    """Yield what the command prints."""
    observer = contract.observer
    yield f"{contract.robot} at {contract.rate_hz:g} Hz, gain {observer.gain_hz:g} 1/s, torques: {observer.torque}"
    for network, network_contract in zip(networks, contract.networks, strict=True):
        outputs = len(network_contract.outputs)
        size = f"{len(network_contract.inputs)} inputs, {outputs} joints, state {network_contract.state}"
        file = out / network_contract.file
        apart = difference(network, file)
        yield f"{file}: {network_contract.cell}, {size}; differs by {apart:.1e} of the target's standard deviation"
    for detector in contract.detectors:
        yield f"detector of {detector.limb}: {detector.signal} of {', '.join(detector.joints)}, {detector.watched}"
    yield f"{out / CONTRACT}"
    if (out / MODEL).exists():
        yield f"{out / MODEL}: for the C library in src/runtime"
    else:
        yield f"{out / MODEL}: not written, as the C library has no other cells than {' and '.join(WITHOUT_TORCH)}"


@dataclass(frozen=True)
class Given:
    """What a caller says of the run time where no training noted it: rate [Hz], gain [1/s], meaning of torques."""

    rate_hz: float | None = None
    gain_hz: float | None = None
    torque: TorqueKind | None = None


def export_folders(
    folders: Sequence[Path], robot: RobotDescription, thresholds: Sequence[Path], given: Given, settings: Lab, out: Path
) -> tuple[Contract, list[Trained]]:
    """Export the networks of folders with files of thresholds; return the contract, and the networks.

    Raises:
        DataError: a file is missing or damaged, or as `export` says.
        ConfigError: a file of thresholds is not accepted, or as `export` says.
    """
    networks = [read_trained(folder, robot.layout) for folder in folders]
    of_limbs = [read_thresholds(path) for path in thresholds]
    # Without a network, thresholds of the observer alone say at which rate and how it ran.
    notes = [network.run for network in networks] or of_limbs
    observer = settings.observer
    run_time = RunTime(
        agreed("rate", given.rate_hz, [note.rate_hz for note in notes], settings.rates.data_hz),
        ObserverContract(
            gain_hz=agreed("gain", given.gain_hz, [note.gain_hz for note in notes], observer.gain_hz),
            torque=agreed("torque", given.torque, [note.torque for note in notes], observer.torque),
            gravity_m_s2=settings.plant.gravity_m_s2,
        ),
    )
    sweep(out)
    return export(networks, robot, run_time, of_limbs, as_plain(settings.detection.gate, GateNumbers), out), networks


def run(options: Namespace) -> Iterator[str]:
    """Export networks as the command's options say, and yield what is printed."""
    check_export(options)
    settings = load_lab()
    robot = given_robot(options.robot, settings.robot)
    given = Given(options.rate, options.gain, options.torque)
    contract, networks = export_folders(options.network, robot, options.thresholds, given, settings, options.out)
    yield from report_lines(contract, networks, options.out)


def main(words: list[str]) -> int:
    """Run the command; return its exit status."""
    options = export_parser().parse_args(words)
    return printed(log, lambda: run(options))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
