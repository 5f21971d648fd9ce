"""Figure 20: validation loss by size of the network and of the training data."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from mobnet.evaluation.figures.drawing.lines import Line, LinePanel, draw_lines
from mobnet.evaluation.figures.style import save_figure
from mobnet.evaluation.measure.trainings import Training, read_trainings, sound
from mobnet.evaluation.number.rows import write_rows

log = logging.getLogger(__name__)

TITLES = {"parameters": "size of the network", "samples": "size of the training data"}
X_LABELS = {"parameters": "parameters [thousand]", "samples": "samples learned from [thousand]"}
LOSSES = ("loss", "loss_low", "loss_high")
THOUSAND = 1e3


@dataclass(frozen=True)
class Size:
    """One place of Figure 20: a row of figure_20.csv.

    Attributes:
        panel: what varies, `parameters` or `samples`.
        base: estimator whose network is varied.
        method: the variation, a row of the configuration's methods.
        parameters: of the network.
        samples: that it learned from.
        runs: trainings behind the means, those that diverged left out.
        loss: mean validation loss (22) of the epoch kept [-].
        loss_low: lowest run [-].
        loss_high: highest run [-].
        rmse_nm: mean over joints of the root-mean-square error on the data held out [N m], unlike the loss not in
            units of each target's spread.
        rmse_low_nm: lowest run [N m].
        rmse_high_nm: highest run [N m].
    """

    panel: str
    base: str
    method: str
    parameters: int
    samples: int
    runs: int
    loss: float
    loss_low: float
    loss_high: float
    rmse_nm: float
    rmse_low_nm: float
    rmse_high_nm: float


def figure_20(entries: Sequence[Mapping[str, Any]], out_dir: Path) -> None:
    """Write Figure 20, validation loss [-] over parameters (a) and training samples (b), as PDF, PNG and CSV.

    Args:
        entries: one mapping a variation: `panel` (a name of `TITLES`), `base`, the estimator, and `folders` of its
            trained networks.
        out_dir: gets figure_20.pdf, .png and .csv.

    Raises:
        DataError: a file is missing or damaged.
    """
    sizes = [size for entry in entries for size in sizes_of(entry)]
    sizes.sort(key=lambda size: getattr(size, size.panel))
    panels = []
    for panel, title in TITLES.items():
        rows = [size for size in sizes if size.panel == panel]
        bases = dict.fromkeys(entry["base"] for entry in entries if entry["panel"] == panel)
        lines = [growth_line(own, base) for base in bases if (own := [row for row in rows if row.base == base])]
        panels.append(LinePanel(title, X_LABELS[panel], "validation loss [-]", lines, sizes=True))
    write_rows(out_dir / "figure_20.csv", Size, sizes)
    save_figure(draw_lines(panels), out_dir / "figure_20")
    log.info("%s: %d sizes", out_dir / "figure_20.pdf", len(sizes))


def sizes_of(entry: Mapping[str, Any]) -> list[Size]:
    """Return the place of a variation in its panel; none where all its trainings diverged.

    Raises:
        DataError: a file is missing or damaged.
    """
    return [
        size_of(entry["panel"], entry["base"], kept)
        for trainings in read_trainings(entry["folders"]).values()
        for kept in [sound(trainings)]
        if kept
    ]


def size_of(panel: str, base: str, trainings: Sequence[Training]) -> Size:
    """Return one place of the figure, loss [-] and RMSE [N m], from its runs."""
    first = trainings[0]
    numbers = []
    for field in ("validation_loss", "validation_rmse"):
        values = np.array([getattr(training.kept, field) for training in trainings])
        numbers += [float(values.mean()), float(values.min()), float(values.max())]
    return Size(panel, base, first.method, first.parameters, first.samples, len(trainings), *numbers)


def growth_line(own: Sequence[Size], base: str) -> Line:
    """Return the losses (n,) [-] of an estimator's variations over the size that their panel varies."""
    sizes = np.array([getattr(row, row.panel) for row in own]) / THOUSAND
    return Line(base, sizes, *(np.array([getattr(row, name) for row in own]) for name in LOSSES))
