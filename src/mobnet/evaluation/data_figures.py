"""Figures of the data: what was commanded, and which velocities and torques it covers. Drawing only."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from mobnet.evaluation.figures import STYLE

PAGE_INCH = 7.1  # width of both columns of the paper
CLOUD_INCH, BARS_INCH = 2.0, 1.9  # heights of a row
COLOURS = ("#E69F00", "#56B4E9", "#009E73")  # Okabe and Ito
TEST_COLOUR = "black"
DOT, MARKER = 1.6, 4.0  # size of a dot [points^2]; how much larger it stands in the legend


@dataclass(frozen=True)
class Cloud:
    """One panel of Figure 19.

    Attributes:
        joint: name of the joint; chooses the column.
        training: name of the training set; chooses the row and the colour.
        dots: joint velocity [rad/s] and desired torque [N m] in training (n, 2).
        test: the same in the tests (m, 2), drawn over it.
    """

    joint: str
    training: str
    dots: NDArray[Any]
    test: NDArray[Any]


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


def draw_clouds(clouds: Sequence[Cloud], test: str) -> Figure:
    """Draw desired torque [N m] over joint velocity [rad/s], a column a joint and a row a training set (Figure 19).

    Args:
        clouds: the panels, velocity in [rad/s] and torque in [N m].
        test: name of the test data in the legend.
    """
    joints, sets = (list(dict.fromkeys(getattr(cloud, key) for cloud in clouds)) for key in ("joint", "training"))
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(PAGE_INCH, CLOUD_INCH * len(sets)), layout="constrained")
        axes = figure.subplots(len(sets), len(joints), sharex="col", sharey="col", squeeze=False)
        for cloud in clouds:
            row, column = sets.index(cloud.training), joints.index(cloud.joint)
            _scatter(axes[row, column], cloud.dots, COLOURS[row], f"training {cloud.training}")
            _scatter(axes[row, column], cloud.test, TEST_COLOUR, test)
        for letter, joint, axis in zip("abcdefgh", joints, axes[0], strict=False):
            axis.set_title(f"({letter}) {joint}", loc="left", pad=3)
        for axis in axes[-1]:
            axis.set_xlabel("velocity [rad/s]")
        for axis in axes[:, 0]:
            axis.set_ylabel("desired torque [N m]")
        legend(figure, axes[:, 0].tolist(), last=test)
    return figure


def _scatter(axis: Axes, dots: NDArray[Any], colour: str, label: str) -> None:
    """Draw dots (n, 2) as pixels: thousands of vector dots would make a slow page."""
    axis.scatter(dots[:, 0], dots[:, 1], s=DOT, c=colour, linewidths=0, label=label, rasterized=True)


def draw_bars(panels: Sequence[Bars]) -> Figure:
    """Draw the share of steps [%] in each bin, a panel a command, the sets side by side."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(PAGE_INCH, BARS_INCH), layout="constrained")
        axes = figure.subplots(1, len(panels), squeeze=False)[0]
        for axis, panel in zip(axes, panels, strict=True):
            width = np.diff(panel.edges) / (len(panel.shares) + 1)
            for k, (colour, (name, shares)) in enumerate(zip(COLOURS, panel.shares.items(), strict=False)):
                axis.bar(
                    panel.edges[:-1] + (k + 0.5) * width, 100 * shares, width, align="edge", color=colour, label=name
                )
            axis.set_xlabel(panel.label)
        axes[0].set_ylabel("share of steps [%]")
        legend(figure, [axes[0]])
    return figure


def legend(figure: Figure, axes: Sequence[Axes], last: str = "") -> None:
    """Put one legend of everything drawn above the panels, one name at its end."""
    found: dict[str, Any] = {}
    for axis in axes:
        handles, labels = axis.get_legend_handles_labels()
        found.update(zip(labels, handles, strict=True))
    names = sorted(found, key=lambda name: name == last)
    figure.legend([found[name] for name in names], names, loc="outside upper center", ncols=len(names), frameon=False,
                  markerscale=MARKER, handletextpad=0.4)  # fmt: skip
