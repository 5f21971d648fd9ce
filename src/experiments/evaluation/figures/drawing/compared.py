"""Torque of a joint by method, below it the errors on a scale of their own, below them their RMSE. Drawing only."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from experiments.evaluation.compare.curves import Compared, Panel, TorqueCurve
from experiments.evaluation.figures.drawing.curves import FROM_LIFT_OFF, draw_panel, table_of
from experiments.evaluation.figures.drawing.named_bars import BAR_INCH, LINE, NamedBar, draw_named_bars
from experiments.evaluation.figures.style import NAME, entitle, legend, looks, save_figure, with_joint_name
from experiments.evaluation.number.frames import records_of
from experiments.evaluation.number.laws import numbers_by
from experiments.evaluation.number.number import Number, shown_name
from experiments.evaluation.number.rows import write_csv
from experiments.settings.table_columns import JOINT_ERRORS
from mobnet.core.style import COLUMN_INCH, PAGE_INCH, styled

TORQUE_INCH, ERROR_INCH, REST_INCH = 1.15, 0.85, 0.95  # height of rows, and of legend, titles and labels together
SHARE = 0.76  # of these heights that joints side by side have, which stand in the main text
SIDE_BY_SIDE, LEG_INCH = 3, 1.05  # joints of a leg in a row, and height of their torque
REACH = 1.25  # of the axis of errors, over the largest error of the last method, ours
ERROR_WIDTH = 0.75  # of the lines of errors, which are noisier, over those of the torque
SIGMAS = {1: 0.3, 2: 0.15}  # multiples of the standard deviation that are drawn, and how opaque
MARGIN = 0.2  # below and above the curves that the axis of torque holds [of their range]
ABOVE = 6.0  # zorder of the axis below numbers on grounds
CLEAR = {"facecolor": "white", "edgecolor": "none", "pad": 0.4}  # behind a number that lies on a line
KINDS = {"N m": "torque", "N": "force"}  # unit -> what has it
UNESTIMATED = "RMSE of no estimate"  # what the dashed line is
ZERO_LINE = {"color": "black", "linewidth": 0.5, "zorder": 1.0}


def near(panel: Panel, methods: Sequence[str]) -> list[TorqueCurve]:
    """Return the curves of methods whose errors are drawn, all where there is none of these."""
    return [curve for curve in panel.curves if curve.label in methods] or list(panel.curves)


def draw_torque(axis: Axes, pair: Compared, methods: Sequence[str]) -> None:
    """Draw truth and estimates; the axis holds the truth and the estimates of some methods, and cuts others."""
    truth, *estimates = (replace(curve, std=None) for curve in pair.torque.curves)
    draw_panel(axis, replace(pair.torque, curves=[truth, *estimates]))
    values = np.concatenate([truth.values, *(curve.values for curve in near(pair.torque, methods))])
    low = float(values.min())
    high = float(values.max())
    margin = MARGIN * (high - low) or 1.0
    axis.set(ylim=(low - margin, high + margin), xlim=(pair.torque.time[0], pair.torque.time[-1]))


def draw_error(axis: Axes, pair: Compared, methods: Sequence[str]) -> None:
    """Draw the errors of some methods, and around zero one and two standard deviations of one that predicts them."""
    curves = near(pair.error, methods)
    draw_panel(axis, replace(pair.error, curves=[replace(curve, std=None) for curve in curves]))
    for line in axis.lines:
        line.set_linewidth(ERROR_WIDTH * line.get_linewidth())
    for curve in curves:
        if curve.std is not None:
            draw_sigma(axis, curve.label, pair.error.time, curve.std)
    axis.axhline(0.0, **ZERO_LINE)
    reach = REACH * float(np.abs(curves[-1].values).max()) or 1.0
    beyond = [shown_name(curve.label) for curve in curves if np.median(np.abs(curve.values)) > reach]
    if beyond:
        at = {"xy": (1.0, 0.0), "xycoords": "axes fraction", "xytext": (-1.0, 5.0)}
        axis.annotate(f"beyond: {', '.join(beyond)}", ha="right", **at, **NAME)
    axis.set(ylim=(-reach, reach), xlim=(pair.error.time[0], pair.error.time[-1]))


def draw_sigma(axis: Axes, method: str, time: NDArray[Any], std: NDArray[Any]) -> None:
    """Draw bands of one and two standard deviations (T,) around zero."""
    for times, alpha in SIGMAS.items():
        label = f"\N{PLUS-MINUS SIGN} {times} std of {method}"
        look: dict[str, Any] = {"color": looks([method])[method].colour, "alpha": alpha, "linewidth": 0.0}
        axis.fill_between(time, -times * std, times * std, label=label, zorder=1.5, **look)


@styled
def draw_columns(
    pairs: Sequence[Compared],
    bars: Sequence[Sequence[NamedBar]],
    units: Sequence[str],
    methods: Sequence[str],
    x_label: str,
    source: str,
) -> Figure:
    """Draw joints side by side, as wide as a page: torque, errors, and the RMSE of each method [a unit each].

    The errors of some methods are drawn, those of others are far beyond them. The legend calls the paper's numbers
    `source`.
    """
    figure, grid = _columns(pairs, bars, units, methods, x_label)
    for axis, bars_of_joint, unit in zip(grid[-1], bars, units, strict=True):
        draw_named_bars(axis, bars_of_joint, unit, source=source)
    _finish(figure, grid)
    return figure


@styled
def draw_relative_columns(
    pairs: Sequence[Compared],
    bars: Sequence[Sequence[NamedBar]],
    units: Sequence[str],
    methods: Sequence[str],
    x_label: str,
    limbs: Sequence[str],
) -> Figure:
    """Draw joints side by side as `draw_columns` does, over errors of their limbs on one scale, as shares [-].

    The shares are those of the error that an estimate of no torque has, which is marked.
    """
    figure, grid = _columns(pairs, bars, units, methods, x_label)
    for axis, bars_of_joint, limb in zip(grid[-1], bars, limbs, strict=True):
        draw_named_bars(axis, bars_of_joint, "-")
        axis.axvline(1.0, label=UNESTIMATED, **LINE)
        for text in axis.texts:
            text.set_bbox(CLEAR)
        axis.spines["bottom"].set_zorder(ABOVE)
        axis.set_xlabel(f"relative RMSE of {limb} [-]")
    right = max(axis.get_xlim()[1] for axis in grid[-1])
    for axis in grid[-1]:
        axis.set_xlim(0.0, right)
    _finish(figure, grid)
    return figure


def _columns(
    pairs: Sequence[Compared],
    bars: Sequence[Sequence[NamedBar]],
    units: Sequence[str],
    methods: Sequence[str],
    x_label: str,
) -> tuple[Figure, NDArray[Any]]:
    """Return a figure and its panels (3, n), with torques and errors of joints (n,) and an empty row for bars."""
    rows = max(len(bars_of_joint) for bars_of_joint in bars)
    heights = (SHARE * TORQUE_INCH, SHARE * ERROR_INCH, BAR_INCH * (rows + 0.5))
    figure = Figure(figsize=(PAGE_INCH, sum(heights) + REST_INCH), layout="constrained")
    grid = figure.subplots(3, len(pairs), squeeze=False, height_ratios=heights)
    for k, pair in enumerate(pairs):
        torque, error, _ = grid[:, k].tolist()
        draw_torque(torque, pair, methods)
        entitle(torque, k, with_joint_name(pair.torque.title.removesuffix(f" [{units[k]}]")))
        torque.tick_params(labelbottom=False)
        draw_error(error, pair, methods)
        error.set_xlabel(x_label)
        # Joints of one unit share its labels.
        if k == 0 or len(set(units)) > 1:
            torque.set_ylabel(f"{KINDS[units[k]]} [{units[k]}]")
            error.set_ylabel(f"error [{units[k]}]")
    return figure, grid


def _finish(figure: Figure, grid: NDArray[Any]) -> None:
    """Name the bars at the left alone, and put the legend on top."""
    for axis in grid[-1, 1:]:
        axis.tick_params(labelleft=False)
    legend(figure, grid.ravel().tolist())


@styled
def draw_leg(pairs: Sequence[Compared]) -> Figure:
    """Draw the joints of a leg over a gait cycle, as wide as a page, in rows of three: torque, and below it errors."""
    rows = -(-len(pairs) // SIDE_BY_SIDE)
    heights = (LEG_INCH, LEG_INCH * ERROR_INCH / TORQUE_INCH) * rows
    figure = Figure(figsize=(PAGE_INCH, sum(heights) + REST_INCH), layout="constrained")
    grid = figure.subplots(2 * rows, SIDE_BY_SIDE, squeeze=False, height_ratios=heights)
    for k, pair in enumerate(pairs):
        row = 2 * (k // SIDE_BY_SIDE)
        column = k % SIDE_BY_SIDE
        torque, error = grid[row : row + 2, column].tolist()
        draw_torque(torque, pair, ())
        entitle(torque, k, with_joint_name(pair.torque.title))
        draw_error(error, pair, ())
        torque.tick_params(labelbottom=False)
        error.tick_params(labelbottom=k + SIDE_BY_SIDE >= len(pairs))
    for axis in grid[::2, 0]:
        axis.set_ylabel("torque [N m]")
    for axis in grid[1::2, 0]:
        axis.set_ylabel("error [N m]")
    for axis in grid[-1]:
        axis.set_xlabel(FROM_LIFT_OFF)
    legend(figure, grid.ravel().tolist())
    return figure


@styled
def draw_stack(
    pairs: Sequence[Compared], bars: Sequence[NamedBar], methods: Sequence[str], title: str, joint: str
) -> Figure:
    """Draw levels of a joint below one another, as wide as a column: torque [N m] and errors of each, RMSE of all.

    Time is that from the lift-off; `methods` are those whose errors are drawn.
    """
    inches = [*(TORQUE_INCH, ERROR_INCH) * len(pairs), BAR_INCH * len(bars)]
    figure = Figure(figsize=(COLUMN_INCH, sum(inches) + REST_INCH + 0.2 * len(pairs)), layout="constrained")
    *axes, below = figure.subplots(len(inches), 1, height_ratios=inches).tolist()
    for k, pair in enumerate(pairs):
        torque, error = axes[2 * k : 2 * k + 2]
        draw_torque(torque, pair, methods)
        entitle(torque, k, pair.torque.title)
        torque.tick_params(labelbottom=False)
        torque.set_ylabel(f"{joint} [N m]")
        draw_error(error, pair, methods)
        error.set_ylabel("error [N m]")
    axes[-1].set_xlabel(FROM_LIFT_OFF)
    draw_named_bars(below, bars, "N m")
    entitle(below, len(pairs), title)
    legend(figure, [*axes, below], 4)
    return figure


def with_drawn(errors: pd.DataFrame, drawn: Mapping[str, Mapping[str, float]]) -> pd.DataFrame:
    """Return errors by joint and method with the RMSE of the curve that is drawn, joint -> method -> it [N m]."""
    places = zip(errors["joint"], errors["method"], strict=True)
    shown = [drawn[joint].get(method) for joint, method in places]
    return errors.assign(rmse_drawn=pd.Series(shown, dtype=float))


def save_compared(figure: Figure, stem: Path, panels: Sequence[Panel], errors: pd.DataFrame) -> None:
    """Write a figure with the curves of panels, and beside it the errors of its bars, columns `JOINT_ERRORS`."""
    write_csv(stem.with_name(f"{stem.name}_bars.csv"), JOINT_ERRORS, records_of(errors, JOINT_ERRORS))
    save_figure(figure, stem, *table_of(panels))


def bars_by_joint(errors: pd.DataFrame, drawn: Mapping[str, Mapping[str, float]]) -> dict[str, list[NamedBar]]:
    """Return joint -> a bar for each method; `drawn` is joint -> method -> RMSE of the curve that is drawn [N m]."""
    groups = errors.groupby("joint", sort=False)
    return {
        str(joint): bars_of(numbers_by(of_joint, "method"), drawn.get(str(joint), {})) for joint, of_joint in groups
    }


def bars_of(numbers: Mapping[str, Number], rmse: Mapping[str, float]) -> list[NamedBar]:
    """Return a bar for each method, marked with the error of its curve where it has one."""
    return [NamedBar(name, name, number, [rmse[name]] if name in rmse else []) for name, number in numbers.items()]
