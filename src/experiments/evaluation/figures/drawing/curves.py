"""Panels of curves over time, and the plotted numbers as CSV. Drawing only."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from experiments.evaluation.compare.curves import Panel
from experiments.evaluation.figures.style import looks
from experiments.evaluation.number.rows import Field

Mark = tuple[float, Mapping[str, Any]]  # of a flag: its lower edge [of the height], its look
FLAGS: Mapping[str, Mark] = {"swing": (0.0, {"color": "#009E73", "alpha": 0.15})}
PUSH: Mark = (0.95, {"color": "0.35"})  # of a push, whatever it is called
BAND_ALPHA = 0.35
FROM_LIFT_OFF = "time from lift-off [s]"


def draw_panel(axis: Axes, panel: Panel) -> None:
    """Draw the curves (T,) [N m] of one panel with their bands, and mark where its flags hold."""
    for name, flags in panel.flags.items():
        mark_flag(axis, name, panel.time, flags)
    styles = looks(curve.label for curve in panel.curves)
    for curve in panel.curves:
        look = styles[curve.label]
        axis.plot(panel.time, curve.values, label=curve.label, **look.line)
        if curve.std is not None:
            low = curve.values - curve.std
            high = curve.values + curve.std
            axis.fill_between(
                panel.time,
                low,
                high,
                color=look.colour,
                alpha=BAND_ALPHA,
                linewidth=0.0,
                zorder=1.5,
                label=f"\N{PLUS-MINUS SIGN} 1 std of {curve.label}",
            )


def mark_flag(axis: Axes, name: str, time: NDArray[Any], flags: NDArray[Any]) -> None:
    """Mark where a flag holds (T,) over time (T,) [s]: the swing over the whole height, a push as a bar on top."""
    bottom, mark = FLAGS.get(name, PUSH)
    if np.any(flags):
        bars = [(time[start], time[last] - time[start]) for start, last in held(flags)]
        across = axis.get_xaxis_transform()
        axis.broken_barh(bars, (bottom, 1.0 - bottom), transform=across, linewidth=0.0, label=name, **mark)


def held(flags: NDArray[Any]) -> list[tuple[int, int]]:
    """Return the first and the last sample of each time in which a flag (T,) holds."""
    edges = np.flatnonzero(np.diff(np.pad(flags.astype(np.int8), 1)))
    return [(int(start), int(end) - 1) for start, end in edges.reshape(-1, 2)]


def table_of(panels: Sequence[Panel]) -> tuple[list[str], list[tuple[Field, ...]]]:
    """Return columns and rows of the plotted numbers, a row for each panel and sample: time [s], flags, curves [N m].

    A curve that another panel has and this one has not leaves its field empty.
    """
    columns = [columns_of(panel) for panel in panels]
    names = list(dict.fromkeys(name for of_panel in columns for name in of_panel))
    rows: list[tuple[Field, ...]] = []
    for panel, of_panel in zip(panels, columns, strict=True):
        values = [of_panel[name].tolist() if name in of_panel else [None] * len(panel.time) for name in names]
        rows += [(panel.title, *row) for row in zip(*values, strict=True)]
    return ["panel", *names], rows


def columns_of(panel: Panel) -> dict[str, NDArray[Any]]:
    """Return name -> plotted numbers (T,): time [s], flags, curves and their deviations [N m], V1..V3 [N]."""
    columns = {"time_s": panel.time, **{name: flags.astype(np.int64) for name, flags in panel.flags.items()}}
    for curve in panel.curves:
        columns[curve.label] = curve.values
        if curve.std is not None:
            columns[f"{curve.label} std"] = curve.std
    return columns
