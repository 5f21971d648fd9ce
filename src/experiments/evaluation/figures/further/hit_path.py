"""By which inputs a hit enters a network's prediction, and so leaves the estimate."""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from experiments.evaluation.figures.style import LOOKS, NAME, legend, save_figure
from experiments.evaluation.measure.learning.explained import ALL, PATH, read_why
from experiments.evaluation.number.frames import records_of, rows_of
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
    brought = rows_of(read_why(kept), measure=PATH)
    brought = brought[brought["method"].isin(settings.methods)]
    save_figure(draw_paths(settings, brought), figure_dir / "hit_path", WHY, records_of(brought, WHY))


@styled
def draw_paths(settings: HitPath, brought: pd.DataFrame) -> Figure:
    """Draw bars of each method, side by side for each kind of inputs, with the numbers of the robots."""
    figure = Figure(figsize=(COLUMN_INCH, HEIGHT_INCH), layout="constrained")
    axis: Axes = figure.subplots()
    groups = list(brought["inputs"].unique())
    width = BARS / len(settings.methods)
    offsets: dict[str, float] = {}  # of the bars of a method, from the middle of a group
    for k, method in enumerate(settings.methods):
        offsets[method] = (k - (len(settings.methods) - 1) / 2.0) * width
    brought = brought.assign(x=brought["inputs"].map(groups.index) + brought["method"].map(offsets))
    for k, method in enumerate(settings.methods):
        look = LOOKS[max((known for known in LOOKS if method.startswith(known)), key=len)]
        bars = rows_of(brought, robot=ALL, method=method)
        face: dict[str, Any] = {"facecolor": look.colour if k == 0 else "white", "edgecolor": look.colour}
        axis.bar(bars["x"], bars["value"], width, label=settings.methods[method], linewidth=0.9, **face)
    robots = brought[brought["robot"] != ALL]
    values = [0.0, *brought["value"]]
    room = ROOM * (max(values) - min(values))
    axis.set_ylim(min(values) - room, max(values) + room)
    axis.plot(robots["x"], robots["value"], label=ROBOT_LABEL, **ROBOT)
    axis.axhline(0.0, color="black", linewidth=0.6)
    axis.set_xticks(range(len(groups)), [group.replace(" ", "\n") for group in groups], fontsize=NAME["fontsize"])
    axis.tick_params(axis="x", length=0.0)
    axis.set_ylabel("share of a hit that\nthe prediction takes [-]")
    legend(figure, [axis], last=ROBOT_LABEL)
    return figure
