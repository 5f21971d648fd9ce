"""The page of all trainings: one HTML file that needs no other, with a table that has curves in every row.

The address holds what is shown (order, filter, opened rows): `runs.html#sort=-rmse&filter=LSTM&open=LSTM-LL-s0`.
"""

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from mobnet.core.files import write_text
from mobnet.evaluation.report.charts import Chart, line_chart
from mobnet.evaluation.report.html import rendered
from mobnet.evaluation.report.training_runs import DIVERGED, TrainingRun, read_training_run

MISSING = "–"


@dataclass(frozen=True)
class Column:
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
    Column("name", "name"),
    Column("method", "method"),
    Column("limb", "limb"),
    Column("seed", "seed", layout="d"),
    Column("cell", "cell"),
    Column("parameters", "parameters", layout=",d"),
    Column("samples", "samples", layout=",d"),
    Column("epoch_count", "epochs", layout="d"),
    Column("best_epoch", "best epoch", layout="d"),
    Column("loss", "best validation loss", layout=".3f"),
    Column("rmse", "RMSE", "N m", ".2f"),
    Column("seconds", "time", "s", ".1f"),
    Column("device", "device"),
    Column("precision", "precision"),
    Column("state", "state"),
)


def runs_page(scale: str, folders: Sequence[Path], templates: Sequence[Path], out: Path) -> None:
    """Write the page of all trainings.

    Args:
        scale: name of the scale, for the title.
        folders: folder of each trained network, with its `run.json` and `metrics.csv`.
        templates: the page's HTML, then the files that it includes.
        out: HTML file; its links to the metrics are relative.

    Raises:
        DataError: a file is missing or damaged.
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
