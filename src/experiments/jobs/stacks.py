"""The rule `train_stack`: networks of one shape that learn side by side on a GPU."""

import functools
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from experiments.jobs.fitting import known_of
from experiments.jobs.trainings import data_of
from mobnet.core.files import MEMBERS, write_json
from mobnet.learning.dataset import LimbData
from mobnet.learning.job import TrainingJob
from mobnet.learning.stacked.train import train_stack as train_on
from mobnet.learning.stacked.trainer import Member

Given = Mapping[str, Any]  # what the rule `train` gets for one network, and its files


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
    in_stack: list[Member] = []
    last: dict[str, LimbData] = {}
    for name, given in members.items():
        job = TrainingJob(given["training"], given["seed"], given["root_seed"])
        in_stack.append(Member(name, job, functools.partial(read, given, last), given["state"], given.get("start")))
    write_json(state / MEMBERS, {"folders": [str(member.state) for member in in_stack]})
    train_on(in_stack, state, out)


def read(given: Given, last: dict[str, LimbData]) -> LimbData:
    """Return the data of a network: those that were read `last`, if they are the same, as of another seed."""
    names = ("layout", "training", "recordings", "residuals", "rate_hz", "margins")
    arguments = {name: given[name] for name in names if name in given}
    training = given["training"]
    of_data = training.target, training.network, training.held_out, training.learning.data_s
    key = repr((of_data, arguments["recordings"], given.get("fitted"), given.get("margins")))
    if key not in last:
        last.clear()
        known = known_of(given["layout"], given["observer"], given["fitted"]) if "fitted" in given else None
        last[key] = data_of(**arguments, known=known)
    return last[key]
