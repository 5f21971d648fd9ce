"""Groups of bars, one for each method, with intervals, the paper's numbers and short notes. Drawing only."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from mobnet.evaluation.figures.style import looks
from mobnet.evaluation.number.number import Number

BAR_SHARE = 0.8  # of the distance between two groups of bars
NOTE_POINTS = 6.0  # size of a note
NOTE_ROOM = {0: 0.15, 90: 1.0}  # angle of notes [deg] -> room for them above the highest bar, as a share of it
PAPER = {"marker": "D", "markersize": 3.5, "color": "white", "markeredgecolor": "black", "markeredgewidth": 0.8}


@dataclass(frozen=True)
class BarPanel:
    """One panel of Figures 6, 10 and 18, of n groups of bars.

    A method has in each group its number [N m] with its interval and perhaps the paper's, which the legend calls
    `source`, and perhaps a note above its bar (n,).
    """

    title: str
    groups: Sequence[str]
    bars: Mapping[str, Sequence[Number]]
    source: str = "paper"
    notes: Mapping[str, Sequence[str]] = field(default_factory=dict)


def draw_bar_panel(axis: Axes, panel: BarPanel, note_deg: int = 0) -> None:
    """Draw a panel's bars [N m] side by side in their groups; `note_deg` is the angle of its notes [deg]."""
    places, width = np.arange(len(panel.groups)), BAR_SHARE / max(1, len(panel.bars))
    styles = looks(panel.bars)
    for k, (method, numbers) in enumerate(panel.bars.items()):
        x = places + (k - (len(panel.bars) - 1) / 2) * width
        heights, low, high, published = columns_of(numbers)
        axis.bar(
            x, heights, width, label=method, hatch=styles[method].hatch, edgecolor="black", linewidth=0.4,
            color=styles[method].colour, yerr=[heights - low, high - heights],
            error_kw={"linewidth": 0.8, "capsize": 2.0},
        )  # fmt: skip
        if np.isfinite(published).any():
            axis.plot(x + width / 4, published, linestyle="", label=panel.source, zorder=4, **PAPER)
        if method in panel.notes:
            _notes(axis, x, panel, method, note_deg)
    axis.set_xticks(places, panel.groups)
    axis.tick_params(axis="x", length=0.0)


def columns_of(numbers: Sequence[Number]) -> NDArray[np.float64]:
    """Return value, lower and upper end and the paper's number (4, n) [N m], nan where it prints none.

    Where there is no interval, its ends are the value.
    """
    rows = [(*number.range, number.published) for number in numbers]
    return np.array(rows, dtype=np.float64).reshape(-1, 4).T


def _notes(axis: Axes, x: NDArray[Any], panel: BarPanel, method: str, angle_deg: int) -> None:
    """Write a method's notes at places (n,): above its bars, or, at an angle [deg], above all bars of the group."""
    below = [columns_of(numbers)[2:] for name, numbers in panel.bars.items() if angle_deg or name == method]
    tops = np.nanmax(np.concatenate(below), axis=0)
    for place, top, note in zip(x, tops, panel.notes[method], strict=True):
        axis.annotate(
            note, (place, top), (0.0, 4.0), textcoords="offset points", fontsize=NOTE_POINTS, rotation=angle_deg,
            ha="center", va="bottom",
        )  # fmt: skip
    axis.set_ylim(0.0, max(axis.get_ylim()[1], tops.max() * (1 + NOTE_ROOM[angle_deg])))
