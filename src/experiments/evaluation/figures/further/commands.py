"""Histograms of the walking commands in the training data (Table 2)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from experiments.evaluation.figures.style import beside, legend, save_figure
from experiments.evaluation.measure.data.steps import CHOICES, KEYS, UNITS, bin_edges, bin_of, read_steps
from experiments.settings.figures import CommandsFigure
from experiments.settings.table_columns import COMMANDS
from mobnet.core.columns import COMMAND
from mobnet.core.joints import JointLayout
from mobnet.core.style import styled
from mobnet.settings.data import Commands

BARS_INCH = 1.9  # height of the figure
BAR_SHARE = 0.85  # of a bin
MARGIN = 0.08  # beside the range of a command [share of it]
GIVEN = "commanded steps"
RANGE = "range of Table 2"
COLOUR = "#0072B2"
RANGE_LOOK: Mapping[str, Any] = {"color": "0.93", "linewidth": 0.0, "zorder": 0}
LABELS = ("step x [m]", "step y [m]", "turn [deg]", "duration [s]", "foot height [m]")


@dataclass(frozen=True)
class Bars:
    """Histogram of a command: edges of bins (n + 1,) [unit of the label], and the share of steps [%] in each (n,).

    `named` are the values at which the axis is named [unit of the label].
    """

    label: str
    edges: NDArray[np.float64]
    shares: NDArray[np.float64]
    named: Sequence[float]


def commands(
    settings: CommandsFigure,
    commands: Commands,
    layout: JointLayout,
    sets: Mapping[str, Sequence[Path]],
    figure_dir: Path,
) -> None:
    """Write the histograms of the commands given (Table 2) in each data set's recordings, as PDF, PNG and CSV.

    The figure has the first set, the CSV file has all.
    """
    commanded = {name: read_steps(stems, layout).commanded for name, stems in sets.items()}
    rows = []
    panels = []
    for column, label in enumerate(LABELS):
        edges = bin_edges(commands, column, settings.bins)
        ends = list(zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True))
        counts = {
            name: np.bincount(bin_of(values[:, column], edges), minlength=len(ends))
            for name, values in commanded.items()
        }
        # Percent of the steps, as sets have different numbers of them.
        first = next(iter(counts.values()))
        panels.append(Bars(label, edges, 100.0 * first / first.sum(), named_values(commands, column)))
        for name, of_set in counts.items():
            for bounds, count in zip(ends, of_set.tolist(), strict=True):
                share = count / len(commanded[name])
                rows.append((name, COMMAND[column][0], *bounds, count, share, UNITS[column]))
    save_figure(draw_bars(panels), figure_dir / "commands", COMMANDS, rows)


def named_values(commands: Commands, column: int) -> list[float]:
    """Return the ends of a command's range and zero in it, or the first and last of its choices [m], [deg], [s]."""
    values = getattr(commands, KEYS[column])
    return sorted({*values, 0.0}) if column < CHOICES else [values[0], values[-1]]


@styled
def draw_bars(panels: Sequence[Bars]) -> Figure:
    """Draw the share of steps [%] in each bin, a panel for each command; grey is the range of Table 2."""
    figure, axes = beside(len(panels), BARS_INCH, sharey=True)
    for axis, panel in zip(axes, panels, strict=True):
        first, last = panel.edges[[0, -1]]
        margin = MARGIN * (last - first)
        axis.axvspan(first, last, label=RANGE, **RANGE_LOOK)
        middles = (panel.edges[1:] + panel.edges[:-1]) / 2.0
        widths = BAR_SHARE * np.diff(panel.edges)
        axis.bar(middles, panel.shares, widths, color=COLOUR, label=GIVEN)
        axis.set(xlabel=panel.label, xlim=(first - margin, last + margin))
        axis.set_xticks(panel.named, [f"{value:g}" for value in panel.named])
    axes[0].set_ylabel("share of steps [%]")
    legend(figure, [axes[0]])
    return figure
