"""The rule `train_stack`: networks of one shape that learn side by side on a GPU."""

import functools
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from experiments.jobs.train_gray import known_of
from experiments.jobs.trainings import data_of
from mobnet.core.files import MEMBERS, write_json
from mobnet.learning.dataset import LimbData
from mobnet.learning.job import TrainingJob
from mobnet.learning.stacked.train import train_stack as train_on
from mobnet.learning.stacked.trainer import Member

Given = Mapping[str, Any]  # what the rule `train`, or `train_gray`, gets for one network


def train_stack(members: Mapping[str, Given], state: Path, out: Path) -> None:
    """Train networks side by side; a training that was killed goes on from its last epoch.

    Args:
        members: what each network's own training would get, by its name in the stack.
        state: folder of the checkpoint, and of a list of the networks' own folders.
        out: file of what they learn.

    Raises:
        ConfigError: networks differ in what those of a stack have in common.
        DataError: a recording, a residual or a fit is damaged or too short.
    """
    found: list[Member] = []
    for name, given in members.items():
        job = TrainingJob(given["training"], given["seed"], given["root_seed"])
        found.append(Member(name, job, loader(given), given["state"], given.get("start")))
    write_json(state / MEMBERS, {"folders": [str(member.state) for member in found]})
    train_on(found, state, out)


def loader(given: Given) -> Callable[[], LimbData]:
    """Return a function that reads the data of a network."""
    known = known_of(given["layout"], given["observer"], given["fitted"]) if "fitted" in given else None
    names = ("layout", "training", "recordings", "residuals", "rate_hz", "margins")
    return functools.partial(data_of, **{name: given[name] for name in names if name in given}, known=known)
