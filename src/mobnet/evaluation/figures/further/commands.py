"""Histograms of the walking commands in the training data (Table 2)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from mobnet.core.columns import COMMAND, COMMANDS
from mobnet.core.joints import JointLayout
from mobnet.evaluation.figures.style import beside, legend, save_figure, styled
from mobnet.evaluation.measure.data.steps import UNITS, bin_edges, bin_of, read_steps
from mobnet.settings.data import Commands
from mobnet.settings.evaluation import CommandsFigure

BARS_INCH = 1.9  # height of the figure
MARGIN = 0.08  # beside the range of a command [share of it]
GIVEN, RANGE = "commanded steps", "range of Table 2"
COLOUR = "#0072B2"
RANGE_LOOK: Mapping[str, Any] = {"color": "0.9", "linewidth": 0.0, "zorder": 0}
LABELS = ("step x [m]", "step y [m]", "turn [deg]", "duration [s]", "foot height [m]")


@dataclass(frozen=True)
class Bars:
    """Histogram of a command: edges of bins over its range (n + 1,) [unit of the label], and the share of steps [%] (n,)."""

    label: str
    edges: NDArray[np.float64]
    shares: NDArray[np.float64]


def commands(
    settings: CommandsFigure, commands: Commands, layout: JointLayout, sets: Mapping[str, Sequence[Path]],
    figure_dir: Path,
) -> None:  # fmt: skip
    """Write the histograms of the commands given (Table 2) in each data set's recordings, as PDF, PNG and CSV.

    The figure has the first set, the CSV file has all.
    """
    found = {name: read_steps(stems, layout).commanded for name, stems in sets.items()}
    rows, panels = [], []
    for column, label in enumerate(LABELS):
        edges = bin_edges(commands, column, settings.bins)
        ends = list(zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True))
        counts = {
            name: np.bincount(bin_of(values[:, column], edges), minlength=len(ends)) for name, values in found.items()
        }
        own = next(iter(counts.values()))
        panels.append(Bars(label, edges, 100.0 * own / own.sum()))
        rows += [
            (name, COMMAND[column][0], *bounds, count, count / len(found[name]), UNITS[column])
            for name, own in counts.items() for bounds, count in zip(ends, own.tolist(), strict=True)
        ]  # fmt: skip
    save_figure(draw_bars(panels), figure_dir / "commands", COMMANDS, rows)


@styled
def draw_bars(panels: Sequence[Bars]) -> Figure:
    """Draw the share of steps [%] in each bin, a panel for each command; grey is the range of Table 2."""
    figure, axes = beside(len(panels), BARS_INCH, sharey=True)
    for axis, panel in zip(axes, panels, strict=True):
        first, last = panel.edges[[0, -1]]
        margin = MARGIN * (last - first)
        axis.axvspan(first, last, label=RANGE, **RANGE_LOOK)
        axis.stairs(panel.shares, panel.edges, fill=True, color=COLOUR, label=GIVEN)
        axis.set(xlabel=panel.label, xlim=(first - margin, last + margin))
        axis.set_xticks(ends_and_middle(first, last))
    axes[0].set_ylabel("share of steps [%]")
    legend(figure, [axes[0]])
    return figure


def ends_and_middle(first: float, last: float) -> list[float]:
    """Return where an axis is named: at the ends of a range, and at zero or in its middle [any unit]."""
    return [first, 0.0 if first < 0.0 < last else (first + last) / 2.0, last]
