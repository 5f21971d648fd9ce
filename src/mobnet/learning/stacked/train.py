"""What a stack of networks has learned, as a file: the jobs of its networks take their weights from there."""

import logging
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import torch
from safetensors import SafetensorError

from mobnet.core.epochs import Epoch
from mobnet.core.errors import DataError, TrainingError, not_accepted
from mobnet.core.files import CHECKPOINT
from mobnet.core.machine import one_thread
from mobnet.learning.checkpoint import Progress, below, read_noted, write_checkpoint
from mobnet.learning.stacked.trainer import Member, StackedTrainer, told_of
from mobnet.learning.trainer import own_device

log = logging.getLogger(__name__)


def train_stack(members: Sequence[Member], state: Path, out: Path) -> None:
    """Train networks side by side, and write what they have learned to the file `out`.

    The folder `state` has the checkpoint, from which a killed training goes on; it is deleted at the end.

    Raises:
        ConfigError: networks differ in what those of a stack have in common.
        DataError: the data of one are too short.
    """
    one_thread()
    device = own_device()
    if device.type == "cuda":
        torch.cuda.set_device(device)  # kernels are launched there
    else:
        log.warning("no GPU here: %d networks learn side by side on a processor, which takes long", len(members))
    trainer = StackedTrainer(members, device)
    done = trainer.run(state)
    best, rows = told_of(done)
    share = done.seconds / len(members)
    for member, row in zip(members, rows, strict=True):
        row |= {
            "name": member.name,
            "fingerprint": trainer.fingerprints[member.name],
            "told": done.told.get(member.name),
        }
    note = {"networks": rows, "device": device.type, "seconds": share}
    write_checkpoint(out, trainer.fingerprint, best, note)
    (state / CHECKPOINT).unlink(missing_ok=True)
    log.info("%d networks: done, %.0f s", len(members), done.seconds)


@dataclass(frozen=True)
class Lesson:
    """What one network has learned in a stack, on which kind of device, a hash of what it depends on, and why it ended.

    `told` says why it diverged, if it did.
    """

    progress: Progress
    device: str
    fingerprint: str
    told: str | None

    def checked(self, path: Path, fingerprint: str, chosen_by: str, *, may_diverge: bool) -> Progress:
        """Return how far the network has come.

        Raises:
            DataError: the file belongs to another training than this one, whose hash is `fingerprint`.
            TrainingError: it diverged, and may not.
        """
        if self.fingerprint != fingerprint:
            text = not_accepted("hash of configuration, data and code", self.fingerprint, [fingerprint])
            raise DataError(f"{path}: {text}; delete the file")
        if self.told and not may_diverge:
            raise TrainingError(self.told)
        self.progress.chosen_by = chosen_by
        return self.progress


def read_lesson(path: Path, name: str) -> Lesson:
    """Read what a network has learned from the file of its stack.

    Raises:
        DataError: the file is missing or damaged, or the network is not in it.
    """
    try:
        tensors, note = read_noted(path)
    except (SafetensorError, OSError) as error:
        raise DataError(f"{path}: cannot be read as networks that learned side by side: {error}") from None
    names = [row["name"] for row in note["networks"]]
    if name not in names:
        raise DataError(f"{path}: {not_accepted('network', name, names)}")
    place = names.index(name)
    row = note["networks"][place]
    epochs = [Epoch(**epoch) for epoch in row["epochs"]]
    # Copies, aligned as memory of torch's own is.
    best = {key: tensor.clone() for key, tensor in below(f"best.{place}.", tensors).items()}
    progress = Progress(epochs, row["errors"], best, note["seconds"], row["diverged"])
    return Lesson(progress, note["device"], row["fingerprint"], row["told"])
