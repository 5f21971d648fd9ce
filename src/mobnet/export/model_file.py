"""The model file of the C library in `src/runtime`: robot, observer, networks and detectors in one file.

`docs/runtime.md` describes the format. All numbers are little-endian; a section begins at a multiple of 64 bytes.
"""

import struct
import zlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.control.kinematics import empty_pose, update
from mobnet.core.columns import recording_columns
from mobnet.core.contract import rule_of
from mobnet.core.errors import ConfigError, DataError, beyond, not_accepted, refuse_lines
from mobnet.core.files import atomic_path
from mobnet.core.joints import NQ_BASE, JointLayout
from mobnet.detection.chain import Chain
from mobnet.detection.detector import LegGate
from mobnet.detection.leg import Leg
from mobnet.estimation.observer import RobotObserver
from mobnet.kernel.detecting import Signal, Target
from mobnet.kernel.drive import NUMBERS, DriveParameters
from mobnet.learning.deployed.loading import WITHOUT_TORCH
from mobnet.learning.deployed.tensors import GRU_TENSORS, std_scale_of
from mobnet.learning.deployed.weights import WeightsNote
from mobnet.learning.features import ROTATION_NAMES
from mobnet.learning.gates import ordered
from mobnet.robot.nominal import NominalModel

MAGIC = b"MOBNETRT"
VERSION = 1
HEADER, ENTRY, ALIGNED, NAME = 64, 32, 64, 32  # bytes
CHECKED = 12  # bytes in front of what the checksum covers
ROBOT, JOINTS, COLUMNS, OBSERVER, NETWORK, DETECTOR, DRIVES = range(1, 8)  # kinds of sections
# fields of a sample, in the order of `mobnet_sample` in mobnet.h
SAMPLE = ("q", "v", "tau_motor", "tau_des", "acc_base_in_base", "swing", "landing")
JOINT_SOURCES = ("q", "v", "tau_des")  # inputs of a network from a joint, in the order of `enum source` in internal.h
BASE_SOURCES = (ROTATION_NAMES, tuple(f"v.omega_{a}" for a in "xyz"), tuple(f"acc.{a}" for a in "xyz"))
KINDS: tuple[Signal, ...] = ("mean", "std", "ratio")
LONGEST = NAME - 1  # of a name, one byte of which is zero
BOUNDS = 1e-12, 1e9  # of numbers that are not weights, as in cursor.h; those of files that people pass on are narrower
MOST_SAMPLES, MOST_UNITS = 10_000, 8192  # of a hold, and of hidden units or inputs, as in parts.c
SMALLEST = float(np.finfo(np.float32).tiny)  # a standard deviation must be a normal number: detectors divide by it
LARGEST = float(np.finfo(np.float32).max)


def leg_record(nominal: NominalModel, gate: LegGate) -> bytes:
    """Return the bytes of a leg's gate: `struct gate` and `struct leg` of internal.h."""
    numbers = gate.gate
    leg = gate.leg
    head = struct.pack("<dq5dq", *numbers) + struct.pack("<q", leg.first)
    return head + _sole(nominal, leg, leg.foot) + _sole(nominal, leg, leg.other)


def _sole(nominal: NominalModel, leg: Leg, foot: int) -> bytes:
    """Return the link that carries a foot, and in its axes the foot's origin and the corners of its sole [m]."""
    body = foot
    robot = nominal.robot
    while body > 0 and leg.tree.joint[body] < 0:  # welded to its parent
        body = int(leg.tree.parent[body])
    pose = empty_pose(leg.tree)
    q = np.zeros(robot.layout.nq)
    q[NQ_BASE - 4] = 1.0
    update(leg.tree, q, leg.still, 0.0, pose)
    corners = leg.corners @ pose.rotation[foot].T + pose.position[foot]
    points: Any = np.vstack([pose.position[foot], corners]) - pose.position[body]
    link = int(leg.tree.joint[body]) + 1  # the base stands before the links of the joints
    return struct.pack("<q", link) + (points @ pose.rotation[body]).astype("<f8").tobytes()


@dataclass(frozen=True)
class RuntimeNetwork:
    """A network of the library: tensors and note as `read_weights` returns them, and what it estimates.

    That is the uncertainty, which is subtracted from the residual, (15), or the `external` torque itself.
    """

    tensors: Mapping[str, NDArray[np.float32]]
    note: WeightsNote
    estimates: Target = "uncertainty"


@dataclass(frozen=True)
class RuntimeDetector:
    """A detector of the library.

    Attributes:
        name: of the limb that it watches.
        joints: names of the watched joints (n,).
        signals: kinds of signals, each of all joints.
        chain: low-pass, hold and thresholds (phases, kinds * n) [N, N m], of a ratio [-]; without a norm.
        gate: when a leg is watched; None for a limb that is always watched,
        settle: but for so many samples after the start, or after a gap.
        residual: whether it watches the residual, as without a network, and not the estimate.
    """

    name: str
    joints: tuple[str, ...]
    signals: tuple[Signal, ...]
    chain: Chain
    gate: LegGate | None = None
    settle: int = 0
    residual: bool = False


def write_model_file(
    path: Path, observer: RobotObserver, networks: Sequence[RuntimeNetwork], detectors: Sequence[RuntimeDetector]
) -> None:
    """Write the file of an observer that knows its robot, and of the networks and detectors of the robot's limbs.

    Raises:
        DataError: a network has a cell that the library does not run, or two predict the same joint.
        ConfigError: a detector has a norm, thresholds of another number than its signals, or unknown joints.
    """
    content = model_content(observer, networks, detectors)
    with atomic_path(path, len(content)) as temporary:
        temporary.write_bytes(content)


def model_content(
    observer: RobotObserver, networks: Sequence[RuntimeNetwork], detectors: Sequence[RuntimeDetector]
) -> bytes:
    """Return the bytes of such a file.

    Raises:
        DataError: as `write_model_file`, or a number is one that the library does not accept.
        ConfigError: as `write_model_file`.
    """
    layout = observer.nominal.robot.layout
    _check_networks(networks)
    refuse_lines(_number_faults(observer, networks, detectors))
    sections = [
        (ROBOT, _robot(observer)),
        (JOINTS, b"".join(_name(joint) for joint in layout.names)),
        (COLUMNS, b"".join(_columns(layout))),
        (OBSERVER, struct.pack("<ddII", observer.pole, observer.rate_hz, observer.torque == "sample", 0)),
        *([(DRIVES, _drives(observer.drives))] if observer.drives else []),
        *((NETWORK, _network(network, layout)) for network in networks),
        *((DETECTOR, _detector(detector, observer)) for detector in detectors),
    ]
    return file_of(sections)


def _number_faults(
    observer: RobotObserver, networks: Sequence[RuntimeNetwork], detectors: Sequence[RuntimeDetector]
) -> Iterator[str]:
    """Yield the numbers of files from outside that the library would not accept."""
    yield from beyond("rate_hz", observer.rate_hz, BOUNDS)
    for network in networks:
        tensors = network.tensors
        note = network.note
        place = f"network of {network.note.limb}"
        yield from beyond(f"{place}: inputs", len(note.inputs), (0, MOST_UNITS))
        yield from beyond(f"{place}: hidden units", note.cell.hidden or 0, (0, MOST_UNITS))
        least_std = float(np.float32(note.std_min))
        yield from beyond(f"{place}: std_min", least_std, (SMALLEST, LARGEST))
        scaled = tensors["target.std"] * std_scale_of(tensors)
        smallest = {
            "input.std": SMALLEST,
            "target.std": SMALLEST,
            "target.std x std.scale": SMALLEST / min(least_std, 1.0),
        }
        values = {
            "input.std": tensors["input.std"],
            "target.std": tensors["target.std"],
            "target.std x std.scale": scaled,
        }
        for name, least in smallest.items():
            for value in (values[name].min(initial=1.0), values[name].max(initial=1.0)):
                yield from beyond(f"{place}: {name}", float(value), (least, LARGEST))
    for detector in detectors:
        yield from beyond(f"detector of {detector.name}: samples of its hold", detector.chain.hold, (1, MOST_SAMPLES))
        for value in detector.chain.thresholds.ravel().tolist():
            yield from beyond(f"detector of {detector.name}: threshold", value, BOUNDS)


def file_of(sections: Sequence[tuple[int, bytes]]) -> bytes:
    """Return the bytes of a file of sections, each a kind and its bytes, with the header in front."""
    place = _up(HEADER + ENTRY * len(sections))
    table = b""
    body = b""
    for kind, content in sections:
        table += struct.pack("<IIQQQ", kind, 0, place + len(body), len(content), 0)
        body += content.ljust(_up(len(content)), b"\0")
    table = table.ljust(place - HEADER, b"\0")
    checked = struct.pack("<IQI", VERSION, place + len(body), len(sections)).ljust(HEADER - CHECKED, b"\0")
    checked += table + body
    return MAGIC + struct.pack("<I", zlib.crc32(checked)) + checked


def _up(size: int) -> int:
    return -(-size // ALIGNED) * ALIGNED


def _name(text: str) -> bytes:
    """Return a name with zeros behind it."""
    encoded = text.encode()
    if not 0 < len(encoded) <= LONGEST:
        raise ConfigError(not_accepted("name", text, [f"1 to {LONGEST} bytes"]))
    return encoded.ljust(NAME, b"\0")


def _doubles(values: Any) -> bytes:
    return np.asarray(values, dtype="<f8").tobytes()


def _floats(values: Any) -> bytes:
    return np.asarray(values, dtype="<f4").tobytes()


def _robot(observer: RobotObserver) -> bytes:
    """Return the tree as `LINK` has it, without its rotations."""
    nominal = observer.nominal
    links, gravity = nominal.linkage
    feet = len(recording_columns(nominal.robot.layout)["swing"])
    return struct.pack("<4I", nominal.robot.floating, len(links), feet, 0) + _doubles(gravity) + links.tobytes()


def _drives(drives: DriveParameters) -> bytes:
    """Return the numbers of each drive, one after another."""
    return _doubles(np.column_stack([getattr(drives, name) for name in NUMBERS]))


def _columns(layout: JointLayout) -> Iterable[bytes]:
    """Yield name, smallest and largest number of each column of a sample."""
    columns = recording_columns(layout)
    for field in SAMPLE:
        for name, _, _ in columns[field]:
            rule = rule_of(name, layout)
            yield _name(name) + _doubles([rule.low, rule.high])


def _check_networks(networks: Sequence[RuntimeNetwork]) -> None:
    """Raise unless the library runs the networks' cells and each joint has one network at most."""
    predicted: set[str] = set()
    for note in (network.note for network in networks):
        if note.cell.cell not in WITHOUT_TORCH:
            raise DataError(not_accepted(f"network {note.name}: cell", note.cell.cell, WITHOUT_TORCH))
        if twice := predicted & {*note.joints}:
            raise DataError(not_accepted("joint of two networks", min(twice), ["joints that one network predicts"]))
        predicted |= {*note.joints}


def _network(network: RuntimeNetwork, layout: JointLayout) -> bytes:
    """Return a network: sizes, what its inputs are, joints, z-scores, weights as `mobnet.learning.gates` has them."""
    tensors = network.tensors
    note = network.note
    recurrent = note.cell.cell == "GRU"
    if recurrent:
        *trained, w_out, b_out = (tensors[name] for name in GRU_TENSORS)
        w_in, w_state, bias = ordered(*trained)
    else:
        w_in = w_state = bias = w_out = np.zeros((0, 0))
        b_out = tensors["head.bias"]
    inputs = note.inputs if recurrent else []
    hidden = w_state.shape[1]
    means = [tensors[f"input.{part}"][: len(inputs)] for part in ("mean", "std")]
    target = tensors["target.mean"], tensors["target.std"]
    sizes = struct.pack("<4If", len(inputs), hidden, len(note.joints), network.estimates == "external", note.std_min)
    places = b"".join(struct.pack("<2H", *_source(name, layout)) for name in inputs)
    joints = layout.columns(note.joints).astype("<u4").tobytes()
    numbers = (*means, *target, target[1] * std_scale_of(tensors), w_in, w_state, bias, w_out, b_out)
    return _name(note.limb) + sizes + places + joints + b"".join(map(_floats, numbers))


def _source(name: str, layout: JointLayout) -> tuple[int, int]:
    """Return where an input of a network comes from, a number of `enum source` in internal.h, and its place there."""
    sources = list[Sequence[str]]()
    for signal in JOINT_SOURCES:
        sources.append([f"{signal}.{joint}" for joint in layout.actuated])
    accepted = [f"{signal}.<joint>" for signal in JOINT_SOURCES]
    if layout.virtual:
        sources = [*sources, *BASE_SOURCES]
        accepted = [*accepted, *(f"{names[0]}, ..." for names in BASE_SOURCES)]
    for k, names in enumerate(sources):
        if name in names:
            return k, names.index(name)
    raise DataError(not_accepted("input of a network", name, accepted))


def _detector(detector: RuntimeDetector, observer: RobotObserver) -> bytes:
    """Return a detector: sizes, low-pass, thresholds, gate, joints."""
    chain = detector.chain
    gate = detector.gate
    kinds = [KINDS.index(kind) for kind in detector.signals]
    phases, columns = chain.thresholds.shape
    if chain.norm or columns != len(kinds) * len(detector.joints):
        accepted = [f"{len(kinds) * len(detector.joints)}, one for each signal, and no norm"]
        raise ConfigError(not_accepted(f"detector {detector.name}: number of thresholds", columns, accepted))
    sizes = len(detector.joints), len(kinds), *kinds, *[0] * (len(KINDS) - len(kinds)), phases, chain.hold
    when = gate is not None, gate.foot if gate else 0, detector.residual, detector.settle, 0
    head = struct.pack("<12I", *sizes, *when) + _doubles(chain.pole)
    joints = observer.nominal.robot.layout.columns(detector.joints).astype("<u4").tobytes()
    watched = leg_record(observer.nominal, gate) if gate else b""
    return _name(detector.name) + head + _doubles(chain.thresholds) + watched + joints
