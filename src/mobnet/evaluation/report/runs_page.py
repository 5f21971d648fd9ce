"""The page of all trainings: one HTML file that needs no other, with a table that has curves in every row.

The address holds what is shown (order, filter, opened rows): `runs.html#sort=-rmse&filter=LSTM&open=LSTM-LL-s0`.
"""

import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mobnet.core.columns import Epoch
from mobnet.core.files import METRICS, RUN, read_json, write_text
from mobnet.evaluation.measure.learning.trainings import TrainedNetwork, read_training, training_seconds
from mobnet.evaluation.report.charts import Chart, line_chart
from mobnet.evaluation.report.html import rendered

SETTINGS = ("target", "settings", "fingerprint", "provenance")  # keys of run.json that say what was trained on what
SHOWN = ("name", "limb", "device", "precision")  # keys that are shown as they are
ENDED, DIVERGED = "done", "diverged"
MISSING = "–"


@dataclass(frozen=True)
class TrainingRun(TrainedNetwork):
    """One training.

    Attributes:
        name: method, limb and seed, such as `MOB-Net-LL-s0`.
        limb: row of the configuration's networks.
        device: `cpu` or `cuda`.
        precision: number format of the products.
        cell: kind of network.
        settings: what was trained on what, dotted name -> text.
        metrics: file that holds the curves.
        seconds: time of the training's epochs [s], of all starts; None where it is not known.
    """

    name: str
    limb: str
    device: str
    precision: str
    cell: str
    settings: Mapping[str, str]
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


def read_training_run(folder: Path) -> TrainingRun:
    """Read a network's folder, and what its training took from the folder of its checkpoint.

    Raises:
        DataError: a file is missing or damaged, or lacks a key or a column.
    """
    training, note = read_training(folder), read_json(folder / RUN)
    return TrainingRun(
        **vars(training),
        **{key: note[key] for key in SHOWN},
        cell=note["settings"]["network"]["cell"],
        settings=dict(pair for key in SETTINGS for pair in flattened(key, note[key])),
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
    RunColumn("method", "method"),
    RunColumn("limb", "limb"),
    RunColumn("seed", "seed", layout="d"),
    RunColumn("cell", "cell"),
    RunColumn("parameters", "parameters", layout=",d"),
    RunColumn("samples", "samples", layout=",d"),
    RunColumn("epoch_count", "epochs", layout="d"),
    RunColumn("best_epoch", "best epoch", layout="d"),
    RunColumn("loss", "best validation loss", layout=".3f"),
    RunColumn("rmse", "RMSE", "N m", ".2f"),
    RunColumn("seconds", "time", "s", ".1f"),
    RunColumn("device", "device"),
    RunColumn("precision", "precision"),
    RunColumn("state", "state"),
)


def runs_page(scale: str, folders: Sequence[Path], templates: Sequence[Path], out: Path) -> None:
    """Write the page of all trained networks; its links to the metrics are relative.

    `templates` has the page's HTML, then the files that it includes.
    """
    runs = sorted(map(read_training_run, folders), key=lambda run: (run.method, run.limb, run.seed))
    text = rendered(
        templates[0], scale=scale, columns=COLUMNS, runs=runs, diverged=DIVERGED,
        charts={run.name: charts(run) for run in runs},
        links={run.name: os.path.relpath(run.metrics, out.parent) for run in runs},
    )  # fmt: skip
    write_text(out, text)


def charts(run: TrainingRun) -> list[Chart]:
    """Return a training's curves over its epochs: loss (22) [-], RMSE [N m] and learning rate [-]; none without one."""
    if run.best is None:
        return []
    x, best = [row.epoch for row in run.epochs], run.best.epoch
    training, validation = ([getattr(row, name) for row in run.epochs] for name in ("train_loss", "validation_loss"))
    return [
        line_chart("loss", "loss [-]", x, {"training": training, "validation": validation}, best),
        line_chart("rmse", "RMSE [N m]", x, {"validation": [row.validation_rmse for row in run.epochs]}, best),
        line_chart("rate", "learning rate [-]", x, {"rate": [row.rate for row in run.epochs]}, best),
    ]
