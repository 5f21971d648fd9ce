"""Histograms of the walking commands that the data hold (Table 2)."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from mobnet.core.recording import COMMAND
from mobnet.evaluation.figures.style import PAGE_INCH, SET_COLOURS, STYLE, legend, save_figure
from mobnet.evaluation.measure.steps import (
    KEYS,
    UNITS,
    Sets,
    Steps,
    bin_edges,
    bin_of,
    read_sets,
)
from mobnet.evaluation.number.rows import write_rows

log = logging.getLogger(__name__)

BARS_INCH = 1.9  # height
LABELS = ("step x [m]", "step y [m]", "turn [deg]", "duration [s]", "foot height [m]")


@dataclass(frozen=True)
class Bar:
    """How often a command was given: a row of commands.csv.

    Attributes:
        set: data set.
        command: quantity of Table 2.
        bin_from: lower end of the bin [unit].
        bin_to: upper end of the bin [unit].
        count: steps.
        share: of the set's steps [-].
        unit: unit of the bin.
    """

    set: str
    command: str
    bin_from: float
    bin_to: float
    count: int
    share: float
    unit: str


def commands(config: Mapping[str, Any], sets: Sets, out_dir: Path) -> None:
    """Write the histograms of the commands given as PDF, PNG and CSV (Table 2).

    Args:
        config: resolved configuration: `robot`, `walking`, `commands`, `evaluation.commands.bins`.
        sets: name -> stems of the recordings.
        out_dir: gets commands.pdf, .png and .csv.

    Raises:
        DataError: a file is missing, or a set holds no step.
    """
    steps = read_sets(config, sets)
    rows = [bar for column in range(len(KEYS)) for name in steps for bar in bars(config, name, steps[name], column)]
    write_rows(out_dir / "commands.csv", Bar, rows)
    save_figure(draw_bars([panel(rows, column) for column in range(len(KEYS))]), out_dir / "commands")
    log.info("%s: %s steps", out_dir / "commands.pdf", {name: len(found) for name, found in steps.items()})


def bars(config: Mapping[str, Any], name: str, steps: Steps, column: int) -> list[Bar]:
    """Return the histogram of one command in one set."""
    edges = bin_edges(config, column, config["evaluation"]["commands"]["bins"])
    counts = np.bincount(bin_of(steps.commanded[:, column], edges), minlength=len(edges) - 1)
    return [
        Bar(name, COMMAND[column][0], float(low), float(high), int(count), float(count / len(steps)), UNITS[column])
        for low, high, count in zip(edges[:-1], edges[1:], counts, strict=True)
    ]


def panel(rows: Sequence[Bar], column: int) -> Bars:
    """Return what one panel of the figure shows."""
    own = [row for row in rows if row.command == COMMAND[column][0]]
    names = dict.fromkeys(row.set for row in own)
    shares = {name: np.array([row.share for row in own if row.set == name]) for name in names}
    first = [row for row in own if row.set == own[0].set]
    return Bars(LABELS[column], np.array([first[0].bin_from, *(row.bin_to for row in first)]), shares)


@dataclass(frozen=True)
class Bars:
    """Histograms of one command.

    Attributes:
        label: name and unit for the axis.
        edges: of the bins (n + 1,) [unit of the label].
        shares: name of a data set -> share of its steps in each bin (n,) [-].
    """

    label: str
    edges: NDArray[Any]
    shares: Mapping[str, NDArray[Any]]


def draw_bars(panels: Sequence[Bars]) -> Figure:
    """Draw the share of steps [%] in each bin, a panel a command, the sets side by side."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(PAGE_INCH, BARS_INCH), layout="constrained")
        axes = figure.subplots(1, len(panels), squeeze=False)[0]
        for axis, panel in zip(axes, panels, strict=True):
            width = np.diff(panel.edges) / (len(panel.shares) + 1)
            for k, (colour, (name, shares)) in enumerate(zip(SET_COLOURS, panel.shares.items(), strict=False)):
                axis.bar(
                    panel.edges[:-1] + (k + 0.5) * width, 100 * shares, width, align="edge", color=colour, label=name
                )
            axis.set_xlabel(panel.label)
        axes[0].set_ylabel("share of steps [%]")
        legend(figure, [axes[0]])
    return figure
