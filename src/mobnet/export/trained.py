"""Trained networks as they are exported: their folders, and the contract that belongs to them."""

import hashlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from mobnet.core.columns import Column, recording_columns, torque_columns
from mobnet.core.errors import DataError, not_accepted, refuse
from mobnet.core.files import RUN, WEIGHTS
from mobnet.core.joints import JointLayout
from mobnet.core.notes import read_note
from mobnet.core.place import version
from mobnet.estimation.own import LearnedNote
from mobnet.export.contract import (
    FORMAT,
    OPSET,
    Contract,
    InputContract,
    NetworkContract,
    ObserverContract,
    OutputContract,
)
from mobnet.export.graph import state_size
from mobnet.formats.limb_thresholds import LimbThresholds
from mobnet.learning.deployed.loading import check_limb, deployed
from mobnet.learning.deployed.networks import Array
from mobnet.learning.deployed.tensors import std_scale_of
from mobnet.learning.deployed.weights import WeightsNote, read_weights
from mobnet.learning.features import QUATERNION_NAMES, ROTATION_NAMES

# The first two columns of the rotation from base to world axes, of a unit quaternion w x y z.
FORMULAS = (
    "1 - 2*(y*y + z*z)",
    "2*(x*y + w*z)",
    "2*(x*z - w*y)",
    "2*(x*y - w*z)",
    "1 - 2*(x*x + z*z)",
    "2*(y*z + w*x)",
)


@dataclass(frozen=True)
class Trained:
    """A trained network: its folder, weights with their hash, and what their notes say."""

    folder: Path
    tensors: Mapping[str, Array]
    note: WeightsNote
    run: LearnedNote
    sha256: str


def read_trained(folder: Path, layout: JointLayout) -> Trained:
    """Read a network from the folder of its training.

    Raises:
        DataError: a file is missing or damaged, or the network belongs to another robot.
    """
    if missing := [name for name in (WEIGHTS, RUN) if not (folder / name).exists()]:
        raise DataError(f"{folder}: {missing[0]} is missing; accepted: a folder of a trained network")
    weights = folder / WEIGHTS
    tensors, note = read_weights(weights)
    run = read_note(folder / RUN, LearnedNote)
    refuse(folder / RUN, _limb_faults(run.limb, note, layout))
    check_limb(deployed(tensors, note), note.limb, folder, layout)
    return Trained(folder, tensors, note, run, hashlib.sha256(weights.read_bytes()).hexdigest())


def _limb_faults(limb: str, note: WeightsNote, layout: JointLayout) -> Iterator[str]:
    """Yield what is wrong with the limb of a training, which becomes the name of a file."""
    if limb != note.limb:
        yield not_accepted("limb", limb, [f"{note.limb}, as {WEIGHTS} says"])
    limbs = [name for name, joints in layout.groups.items() if set(note.joints) <= set(joints)]
    if limb not in layout.groups and limbs:  # one over several limbs has a name of its own
        yield not_accepted("limb", limb, limbs)


def check_apart(networks: Sequence[Trained]) -> None:
    """Raise a DataError where two networks estimate one joint."""
    seen: dict[str, Path] = {}
    for network in networks:
        for joint in network.note.joints:
            if joint in seen:
                text = f"joint {joint!r} is estimated by {seen[joint]} too; accepted: one network for each joint"
                raise DataError(f"{network.folder}: {text}")
            seen[joint] = network.folder


def contract_of(
    robot: str,
    layout: JointLayout,
    networks: Sequence[Trained],
    rate_hz: float,
    observer: ObserverContract,
    thresholds: Iterable[LimbThresholds],
) -> Contract:
    """Return the contract of some networks of a robot and of detectors of their limbs."""
    return Contract(
        format=FORMAT,
        version=version(),
        opset=OPSET,
        robot=robot,
        rate_hz=rate_hz,
        observer=observer,
        quaternion=dict(zip("wxyz", QUATERNION_NAMES, strict=True)) if layout.virtual else {},
        networks=[_network(network, layout) for network in networks],
        detectors=list(thresholds),
    )


def _network(trained: Trained, layout: JointLayout) -> NetworkContract:
    """Return the contract of a network."""
    tensors = trained.tensors
    note = trained.note
    scores = {name: tensors[name].tolist() for name in ("input.mean", "input.std", "target.mean", "target.std")}
    signals = {name: (unit, frame) for name, unit, frame in _signals(layout)}
    formulas = dict(zip(ROTATION_NAMES, FORMULAS, strict=True))
    kinds = [signals[name] for name in note.inputs]
    inputs = [
        InputContract(name=name, unit=unit, frame=frame, formula=formulas.get(name), mean=mean, std=std)
        for name, (unit, frame), mean, std in zip(
            note.inputs, kinds, scores["input.mean"], scores["input.std"], strict=True
        )
    ]
    columns = torque_columns(layout, ["tau"], note.joints)
    scale = std_scale_of(tensors).tolist()
    outputs = [
        OutputContract(joint=joint, unit=unit, frame=frame, mean=mean, std=std, std_scale=factor)
        for joint, (_, unit, frame), mean, std, factor in zip(
            note.joints, columns, scores["target.mean"], scores["target.std"], scale, strict=True
        )
    ]
    return NetworkContract(
        file=f"{note.limb}.onnx",
        name=note.name,
        limb=note.limb,
        estimates=trained.run.target,
        cell=note.cell.cell,
        state=state_size(note.cell, len(note.inputs)),
        std_min=note.std_min,
        weights_sha256=trained.sha256,
        inputs=inputs,
        outputs=outputs,
    )


def _signals(layout: JointLayout) -> Iterator[Column]:
    """Yield name, unit and frame of what a network may see."""
    for field in ("q", "v", "tau_des", "acc_base_in_base"):
        yield from recording_columns(layout)[field]
    yield from ((name, "-", "world") for name in ROTATION_NAMES)
