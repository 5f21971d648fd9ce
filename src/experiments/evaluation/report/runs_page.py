"""The page of all trainings: one HTML file that needs no other, with a table that has curves in every row.

The address holds what is shown (order, filter, opened and chosen rows, which curve of these):
`runs.html#sort=-rmse&filter=LSTM&open=LSTM-LL-s0&pick=GRU-LL-s0&curve=rmse`.
"""

import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from experiments.evaluation.measure.learning.trainings import (
    TrainedNetwork,
    error_in_test,
    read_test_errors,
    read_training,
    robot_of,
    training_seconds,
)
from experiments.evaluation.report.charts import Chart, line_chart
from experiments.evaluation.report.html import rendered
from mobnet.core.epochs import Epoch
from mobnet.core.files import METRICS, RUN, read_json, write_text

# keys of run.json that say what was trained on what
SETTINGS = ("target", "settings", "device", "precision", "fingerprint", "provenance")
SHOWN = ("name", "limb")  # keys that are shown as they are
ENDED = "done"
DIVERGED = "diverged"
MISSING = "–"


@dataclass(frozen=True)
class TrainingRun(TrainedNetwork):
    """One training.

    Attributes:
        name: method, limb and seed, such as `MOB-Net-LL-s0`.
        robot: folder of the plant or of the robot whose recordings it learned from.
        limb: row of the configuration's networks.
        cell: kind of network.
        settings: what was trained on what, dotted name -> text.
        test: test of its estimates, scenario and level; empty where it was in none.
        test_rmse: RMSE of the external torque in a test [N m; N of the base's forces], if there is one.
        metrics: file that holds the curves.
        seconds: time of the training's epochs [s], of all starts; None where it is not known.
    """

    name: str
    robot: str
    limb: str
    cell: str
    settings: Mapping[str, str]
    test: str
    test_rmse: float | None
    metrics: Path
    seconds: float | None

    @property
    def state(self) -> str:
        """How the training ended."""
        return DIVERGED if self.diverged else ENDED

    @property
    def epoch_count(self) -> int:
        """Number of finished epochs."""
        return len(self.epochs)

    @property
    def best(self) -> Epoch | None:
        """The epoch kept; None where the training diverged in its first."""
        return self.kept if self.epochs else None

    @property
    def best_epoch(self) -> int | None:
        """Number of the best epoch."""
        return self.best.epoch if self.best else None

    @property
    def loss(self) -> float | None:
        """Validation loss (22) at the best epoch [-]."""
        return self.best.validation_loss if self.best else None

    @property
    def rmse(self) -> float | None:
        """RMSE on the validation blocks at the best epoch [N m]."""
        return self.best.validation_rmse if self.best else None

    @property
    def best_joints(self) -> Mapping[str, float]:
        """Joint -> RMSE on the validation blocks at the best epoch [N m; V1 to V3 in N]."""
        return {name: errors[self.best.epoch - 1] for name, errors in self.joint_errors.items()} if self.best else {}


def read_training_run(folder: Path, tested: pd.DataFrame | None = None) -> TrainingRun:
    """Read a network's folder, and what its training took from the folder of its checkpoint.

    Raises:
        DataError: a file is missing or damaged, or lacks a key or a column.
    """
    training = read_training(folder)
    note = read_json(folder / RUN)
    settings: dict[str, str] = {}
    for name in SETTINGS:
        settings |= dict(flattened(name, note[name]))
    test, rmse = ("", None) if tested is None else error_in_test(tested, note)
    return TrainingRun(
        **vars(training),
        **{name: note[name] for name in SHOWN},
        robot=robot_of(folder),
        cell=note["settings"]["network"]["cell"],
        settings=settings,
        test=test,
        test_rmse=rmse,
        metrics=folder / METRICS,
        seconds=training_seconds(folder),
    )


def flattened(name: str, value: Any) -> Iterator[tuple[str, str]]:
    """Yield a nested value as pairs of a dotted name and text."""
    if isinstance(value, Mapping):
        for key, inner in value.items():
            yield from flattened(f"{name}.{key}", inner)
    elif isinstance(value, Sequence) and not isinstance(value, str):
        yield name, ", ".join(map(str, value))
    else:
        yield name, str(value)


@dataclass(frozen=True)
class RunColumn:
    """A column of the table.

    Attributes:
        key: attribute of a training, and the column's name in the page's address.
        title: head of the column.
        unit: unit of its numbers.
        layout: format of its numbers; empty for text.
    """

    key: str
    title: str
    unit: str = ""
    layout: str = ""

    def text(self, run: TrainingRun) -> str:
        """Return a training's value as the table shows it."""
        value = getattr(run, self.key)
        return MISSING if value is None else format(value, self.layout)


COLUMNS = (
    RunColumn("name", "name"),
    RunColumn("robot", "robot"),
    RunColumn("method", "method"),
    RunColumn("limb", "limb"),
    RunColumn("seed", "seed", layout="d"),
    RunColumn("cell", "cell"),
    RunColumn("parameters", "parameters", layout=",d"),
    RunColumn("samples", "samples", layout=",d"),
    RunColumn("epoch_count", "epochs", layout="d"),
    RunColumn("best_epoch", "best epoch", layout="d"),
    RunColumn("loss", "best validation loss", layout=".3f"),
    RunColumn("rmse", "validation RMSE", "N m", ".2f"),
    RunColumn("test_rmse", "test RMSE", "N m", ".2f"),
    RunColumn("seconds", "time", "s", ".1f"),
    RunColumn("state", "state"),
)


def runs_page(
    scale: str, folders: Sequence[Path], scores: Sequence[Path], templates: Sequence[Path], out: Path
) -> None:
    """Write the page of all trained networks; its links to the metrics are relative.

    Of the `scores`, the first file that has a network gives its error in a test. `templates` has the page's HTML, then
    the files that it includes.

    Raises:
        DataError: a file is missing or damaged.
    """
    tested = read_test_errors(scores)
    runs = [read_training_run(folder, tested) for folder in folders]
    runs.sort(key=lambda run: (run.method, run.limb, run.seed))
    text = rendered(
        templates[0],
        scale=scale,
        columns=COLUMNS,
        runs=runs,
        diverged=DIVERGED,
        shared=shared_settings(runs),
        charts={run.name: charts(run) for run in runs},
        links={run.name: os.path.relpath(run.metrics, out.parent) for run in runs},
    )
    write_text(out, text)


def shared_settings(runs: Sequence[TrainingRun]) -> dict[str, str]:
    """Return the settings that all of several trainings have alike, which the page shows once."""
    if len(runs) < 2:
        return {}
    first, *others = (run.settings for run in runs)
    shared: dict[str, str] = {}
    for name, text in first.items():
        if all(other.get(name) == text for other in others):
            shared[name] = text
    return shared


def charts(run: TrainingRun) -> list[Chart]:
    """Return a training's curves over its epochs: loss (22) [-], RMSE [N m] and learning rate [-]; none without one."""
    if run.best is None:
        return []
    x = [row.epoch for row in run.epochs]
    best = run.best.epoch
    training = [row.train_loss for row in run.epochs]
    validation = [row.validation_loss for row in run.epochs]
    return [
        line_chart("loss", "loss [-]", x, {"training": training, "validation": validation}, best),
        line_chart("rmse", "RMSE [N m]", x, {"validation": [row.validation_rmse for row in run.epochs]}, best),
        line_chart("rate", "learning rate [-]", x, {"rate": [row.rate for row in run.epochs]}, best),
    ]
