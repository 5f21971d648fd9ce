"""What a training writes at each epoch: `metrics.csv`, and a checkpoint from which it goes on to the same result.

One safetensors file holds tensors and, as its note, the numbers: a file is either whole or absent. Every random draw of
an epoch comes from a generator seeded by seed and epoch, so there is no generator state to keep.
"""

import csv
import io
import json
import logging
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from operator import attrgetter
from pathlib import Path
from typing import Any

from safetensors import SafetensorError, safe_open
from safetensors.torch import save as to_bytes
from torch import Tensor, nn

from mobnet.core.epochs import EPOCHS, JOINT_ERROR, Epoch
from mobnet.core.errors import DataError
from mobnet.core.files import atomic_path, parse_json, write_text
from mobnet.learning.soap import Optimizer

log = logging.getLogger(__name__)


@dataclass
class Progress:
    """How far a training has come: finished epochs, weights of the best one, processor time of all starts [s].

    The best epoch has the smallest number in the column `chosen_by`, of those at the finest time. The `errors` of an
    epoch are the RMSE of its validation joint by joint [N, N m]. A training whose loss ran away stopped there: it has
    `diverged`, and is never resumed.
    """

    epochs: list[Epoch] = field(default_factory=list)
    errors: list[list[float]] = field(default_factory=list)
    best: dict[str, Tensor] = field(default_factory=dict)
    seconds: float = 0.0
    diverged: bool = False
    chosen_by: str = "validation_loss"

    def best_epoch(self) -> Epoch:
        """Return the epoch whose weights are kept, the first of equals."""
        return min(self.epochs, key=attrgetter("stride", self.chosen_by))


def copy_weights(network: nn.Module) -> dict[str, Tensor]:
    """Return a copy of a network's weights, on the CPU."""
    return {name: tensor.detach().cpu().clone() for name, tensor in network.state_dict().items()}


def save(path: Path, fingerprint: str, network: nn.Module, optimizer: Optimizer, done: Progress) -> None:
    """Write a checkpoint atomically; the fingerprint is a hash of all that the result depends on."""
    tensors = {f"last.{name}": tensor for name, tensor in copy_weights(network).items()}
    tensors |= {f"best.{name}": tensor for name, tensor in done.best.items()}
    for index, state in optimizer.state_dict()["state"].items():
        tensors |= {f"optimizer.{index}.{key}": value.detach().cpu().clone() for key, value in state.items()}
    epochs = [asdict(epoch) for epoch in done.epochs]
    write_checkpoint(path, fingerprint, tensors, {"epochs": epochs, "errors": done.errors, "seconds": done.seconds})


def resume(path: Path, fingerprint: str, network: nn.Module, optimizer: Optimizer) -> Progress:
    """Load a checkpoint of the same run into network and optimizer; log why if it cannot be used.

    Return how far the training has come; nothing is done yet if there is no checkpoint of this fingerprint.
    """
    checkpoint = read_checkpoint(path, fingerprint)
    if checkpoint is None:
        return Progress()
    tensors, note = checkpoint
    # The last weights go on learning, with Adam's moments; the best ones only wait to be written.
    network.load_state_dict(below("last.", tensors))
    state: dict[int, dict[str, Tensor]] = {}
    for name, tensor in below("optimizer.", tensors).items():
        index, key = name.split(".")
        # A copy, aligned as memory of torch's own is: products round otherwise where it is not, as in a file's bytes.
        state.setdefault(int(index), {})[key] = tensor.clone()
    optimizer.load_state_dict({**optimizer.state_dict(), "state": state})
    epochs = [Epoch(**row) for row in note["epochs"]]
    done = Progress(epochs, note["errors"], below("best.", tensors), note["seconds"])
    log.info("%s: resuming after epoch %d", path, len(done.epochs))
    return done


def write_checkpoint(path: Path, fingerprint: str, tensors: Mapping[str, Tensor], note: Mapping[str, Any]) -> None:
    """Write tensors and a note atomically; the fingerprint is a hash of all that the result depends on."""
    text = json.dumps({"fingerprint": fingerprint, **note})
    with atomic_path(path) as temporary:
        temporary.write_bytes(to_bytes(dict(tensors), {"note": text}))


def read_checkpoint(path: Path, fingerprint: str) -> tuple[dict[str, Tensor], dict[str, Any]] | None:
    """Return the tensors and the note of a checkpoint of this fingerprint; None without one, and log why."""
    if not path.exists():
        return None
    try:
        tensors, note = read_noted(path)
    except (SafetensorError, OSError, ValueError, DataError) as error:
        log.warning("%s: damaged (%s); starting afresh", path, error)
        return None
    if note.get("fingerprint") != fingerprint:
        log.warning(
            "%s: belongs to another configuration, data or code (%s, here %s); starting afresh",
            path,
            note.get("fingerprint"),
            fingerprint,
        )
        return None
    return tensors, note


def read_noted(path: Path) -> tuple[dict[str, Tensor], dict[str, Any]]:
    """Return the tensors of a file and its note.

    Raises:
        DataError: the note is no JSON.
        SafetensorError, OSError, ValueError: the file is missing or damaged.
    """
    with safe_open(path, framework="pt") as file:
        note = parse_json((file.metadata() or {}).get("note", "{}"), str(path))
        tensors = {name: file.get_tensor(name) for name in file.keys()}  # noqa: SIM118, not a dict
    return tensors, note


def write_metrics(path: Path, done: Progress, joints: Sequence[str]) -> None:
    """Write one line for each epoch, its errors of the n joints after its own columns; atomic."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow((*EPOCHS, *map(JOINT_ERROR.format, joints)))
    writer.writerows((*asdict(epoch).values(), *errors) for epoch, errors in zip(done.epochs, done.errors, strict=True))
    write_text(path, text.getvalue())


def below(prefix: str, tensors: Mapping[str, Tensor]) -> dict[str, Tensor]:
    """Return the tensors whose names begin with a prefix, by the rest of their names."""
    return {name.removeprefix(prefix): tensor for name, tensor in tensors.items() if name.startswith(prefix)}
