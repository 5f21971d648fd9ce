"""Weights, notes and epochs of networks against their folders, the configuration, and each other."""

from collections.abc import Iterator, Mapping, Sequence
from math import prod
from pathlib import Path

import numpy as np

from mobnet.agreement.said import NOTHING, differences
from mobnet.core.contract import rule_of
from mobnet.core.errors import not_accepted
from mobnet.core.files import METRICS, RUN, WEIGHTS
from mobnet.core.joints import JointLayout
from mobnet.evaluation.measure.trainings import TrainingNote, read_training_note
from mobnet.evaluation.number.rows import read_epochs
from mobnet.learning.deployed.weights import STD_SCALE, Z_SCORES, Array, read_weights, shapes
from mobnet.learning.features import limb_inputs
from mobnet.plan.runs import Files
from mobnet.settings.base import Section
from mobnet.settings.networks import Training

SAME = 1e-5  # relative difference of a factor in two files


def network_faults(path: Path, place: tuple[str, ...], files: Files) -> Iterator[str]:
    """Yield in what the weights, the note or the epochs of a network are not those of its folder."""
    if place[1] in files.trained:
        method, limb, seed = files.trained[place[1]]
        yield from _faults(path, files.catalogue.training(method, limb), seed, files)


def _faults(path: Path, training: Training, seed: int, files: Files) -> Iterator[str]:
    """Yield in what a file of a network is not that of a training and a seed."""
    name, folder = path.parent.name, path.parent
    inputs = limb_inputs(files.settings.layout, training.network).names
    joints = list(files.settings.layout.limbs(training.network.joints))
    if path.name == WEIGHTS:
        tensors, note = read_weights(path)
        said = {"name": name, "limb": training.limb, "inputs": list(inputs), "std_min": training.learning.std_min}
        yield from differences(vars(note), said)
        yield from _tensor_faults(tensors, inputs, files.settings.layout)
        yield from differences(note.network, _json(training.network), "network.")
    if path.name == RUN:
        noted = read_training_note(folder)
        sizes = shapes(training.network, len(inputs), len(joints))
        learned = sum(prod(size) for key, size in sizes.items() if key not in (*Z_SCORES, STD_SCALE))
        said = {
            "name": name, "method": training.method, "limb": training.limb, "seed": seed, "target": training.target,
            "parameters": learned,
        }  # fmt: skip
        yield from differences(vars(noted), said)
        yield from differences(vars(noted.calibration), {"joints": joints}, "calibration.")
        yield from _setting_faults(noted, training)
        if noted.diverged and not training.learning.may_diverge:
            yield not_accepted("diverged", True, ["False, without `learning.may_diverge`"])
    if path.name == METRICS:
        for epoch in read_epochs(path):
            if not 0.0 < epoch.rate <= training.learning.rate_first * (1.0 + SAME):
                accepted = [f"above 0, at most {training.learning.rate_first}, rate_first"]
                yield not_accepted(f"epoch {epoch.epoch}: rate", epoch.rate, accepted)
    if path.name in (WEIGHTS, RUN) and (folder / WEIGHTS).exists() and (folder / RUN).exists():
        yield from _scale_faults(folder, training)


def _tensor_faults(tensors: Mapping[str, Array], inputs: Sequence[str], layout: JointLayout) -> Iterator[str]:
    """Yield weights of a cell that are all zero, and means of inputs that no recording of the robot can have."""
    for name, tensor in tensors.items():
        if name.startswith("cell.weight") and not tensor.any():
            yield not_accepted(f"tensor {name!r}: every entry", 0.0, ["numbers that a training gives"])
    for name, mean in zip(inputs, tensors["input.mean"].tolist(), strict=False):
        rule = rule_of(name, layout)
        if not rule.low <= mean <= rule.high:
            yield not_accepted(f"tensor 'input.mean': {name}", mean, [f"{rule.low:g} to {rule.high:g}"])


def _setting_faults(noted: TrainingNote, training: Training) -> Iterator[str]:
    """Yield settings of a training that are not those of the configuration."""
    given = noted.settings.model_dump(exclude_unset=True)
    network = given.pop("network")
    yield from differences(network, _json(training.network), "settings.network.")
    wanted = {**_json(training.learning), "epochs": training.epochs, "epoch_samples": training.epoch_samples}
    yield from differences(given, wanted, "settings.")
    for key in given.keys() - wanted.keys():
        yield not_accepted(f"settings.{key}", given[key], [f"{NOTHING}, as the configuration has its default"])


def _scale_faults(folder: Path, training: Training) -> Iterator[str]:
    """Yield factors on standard deviations that differ between the weights and the note beside them."""
    tensors, noted = read_weights(folder / WEIGHTS)[0], read_training_note(folder).calibration.scale
    found = tensors.get(STD_SCALE) if training.learning.calibrate else None
    if found is not None and (len(found) != len(noted) or not np.allclose(found, noted, rtol=SAME)):
        yield not_accepted(f"{STD_SCALE} of {WEIGHTS}", found.tolist(), [f"{noted}, calibration.scale of {RUN}"])


def _json(section: Section) -> dict[str, object]:
    """Return a section as a training writes it: without the keys that have their defaults."""
    return section.model_dump(mode="json", exclude_defaults=True)
