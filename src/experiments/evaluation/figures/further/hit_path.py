"""By which inputs a hit enters a network's prediction, and so leaves the estimate."""

from collections.abc import Mapping, Sequence
from dataclasses import astuple
from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from experiments.evaluation.figures.style import LOOKS, NAME, legend, save_figure
from experiments.evaluation.measure.learning.explained import ALL, PATH, HitNumber, read_why
from experiments.settings.figures import HitPath
from experiments.settings.table_columns import WHY
from mobnet.core.style import COLUMN_INCH, styled

HEIGHT_INCH = 2.1
BARS = 0.8  # of a group, share of what it takes
ROOM = 0.15  # above and below all bars and robots [share of their range]
EDGE: Mapping[str, Any] = {"markeredgecolor": "black", "markeredgewidth": 0.5}
ROBOT: Mapping[str, Any] = {"marker": "o", "markersize": 2.6, "color": "white", "linestyle": "", "zorder": 4.0, **EDGE}
ROBOT_LABEL = "each robot"


def hit_path(settings: HitPath, kept: Path, figure_dir: Path) -> None:
    """Write the figure as PDF, PNG and CSV: shares of a hit that predictions take [-], by inputs.

    `kept` is the table that `./reproduce why` made.
    """
    rows = [row for row in read_why(kept) if row.measure == PATH and row.method in settings.methods]
    save_figure(draw_paths(settings, rows), figure_dir / "hit_path", WHY, [astuple(row) for row in rows])


@styled
def draw_paths(settings: HitPath, rows: Sequence[HitNumber]) -> Figure:
    """Draw bars of each method, side by side for each kind of inputs, with the numbers of the robots."""
    figure = Figure(figsize=(COLUMN_INCH, HEIGHT_INCH), layout="constrained")
    axis: Axes = figure.subplots()
    means = [row for row in rows if row.robot == ALL]
    robots = [row for row in rows if row.robot != ALL]
    groups = list(dict.fromkeys(row.inputs for row in rows))
    width = BARS / len(settings.methods)
    places: dict[tuple[str, str], float] = {}
    for k, method in enumerate(settings.methods):
        for group in groups:
            places[method, group] = groups.index(group) + (k - (len(settings.methods) - 1) / 2.0) * width
        look = LOOKS[max((known for known in LOOKS if method.startswith(known)), key=len)]
        own = [row for row in means if row.method == method]
        x = [places[method, row.inputs] for row in own]
        face: dict[str, Any] = {"facecolor": look.colour if k == 0 else "white", "edgecolor": look.colour}
        axis.bar(x, [row.value for row in own], width, label=settings.methods[method], linewidth=0.9, **face)
    values = [0.0, *(row.value for row in rows)]
    room = ROOM * (max(values) - min(values))
    axis.set_ylim(min(values) - room, max(values) + room)
    x = [places[row.method, row.inputs] for row in robots]
    axis.plot(x, [row.value for row in robots], label=ROBOT_LABEL, **ROBOT)
    axis.axhline(0.0, color="black", linewidth=0.6)
    axis.set_xticks(range(len(groups)), [group.replace(" ", "\n") for group in groups], fontsize=NAME["fontsize"])
    axis.tick_params(axis="x", length=0.0)
    axis.set_ylabel("share of a hit that\nthe prediction takes [-]")
    legend(figure, [axis], last=ROBOT_LABEL)
    return figure
