"""Histograms of the walking commands in the training data (Table 2)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from mobnet.core.columns import COMMAND, COMMANDS
from mobnet.core.joints import JointLayout
from mobnet.evaluation.figures.style import beside, legend, looks, save_figure, styled
from mobnet.evaluation.measure.data.steps import UNITS, bin_edges, bin_of, read_steps
from mobnet.settings.data import Commands
from mobnet.settings.evaluation import CommandsFigure

BARS_INCH = 2.1  # height, with two rows of the legend
LABELS = ("step x [m]", "step y [m]", "turn [deg]", "duration [s]", "foot height [m]")


@dataclass(frozen=True)
class Bars:
    """Histograms of a command: edges of bins (n + 1,) [unit of the label], and data set -> steps in each bin (n,)."""

    label: str
    edges: NDArray[np.float64]
    counts: Mapping[str, NDArray[np.intp]]


def commands(
    settings: CommandsFigure, commands: Commands, layout: JointLayout, sets: Mapping[str, Sequence[Path]],
    figure_dir: Path,
) -> None:  # fmt: skip
    """Write the histograms of the commands given (Table 2) in each data set's recordings, as PDF, PNG and CSV."""
    found = {name: read_steps(stems, layout).commanded for name, stems in sets.items()}
    rows, panels = [], []
    for column, label in enumerate(LABELS):
        edges = bin_edges(commands, column, settings.bins)
        ends = list(zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True))
        counts = {
            name: np.bincount(bin_of(values[:, column], edges), minlength=len(ends)) for name, values in found.items()
        }
        panels.append(Bars(label, edges, counts))
        rows += [
            (name, COMMAND[column][0], *bounds, count, count / len(found[name]), UNITS[column])
            for name, own in counts.items() for bounds, count in zip(ends, own.tolist(), strict=True)
        ]  # fmt: skip
    save_figure(draw_bars(panels), figure_dir / "commands", COMMANDS, rows)


@styled
def draw_bars(panels: Sequence[Bars]) -> Figure:
    """Draw the share of steps [%] in each bin, a panel for each command, the sets side by side."""
    figure, axes = beside(len(panels), BARS_INCH)
    for axis, panel in zip(axes, panels, strict=True):
        width, styles = np.diff(panel.edges) / (len(panel.counts) + 1), looks(panel.counts)
        for k, (name, counts) in enumerate(panel.counts.items()):
            left, shares = panel.edges[:-1] + (k + 0.5) * width, 100 * counts / counts.sum()
            axis.bar(left, shares, width, align="edge", color=styles[name].colour, label=name)
        axis.set_xlabel(panel.label)
    axes[0].set_ylabel("share of steps [%]")
    legend(figure, [axes[0]])
    return figure
