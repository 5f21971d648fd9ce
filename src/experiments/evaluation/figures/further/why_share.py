"""Why a hit is hidden: what networks show of a hit over their error in walking, by inputs, robot and learning."""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from experiments.evaluation.figures.style import LOOKS, NAME, apart, beside, entitle, legend, save_figure
from experiments.evaluation.measure.learning.explained import FEW, Learned, by_robot, over_shown_robots, read_why
from experiments.evaluation.measure.learning.taught import SHARE_OF_HIT, WALKING
from experiments.evaluation.number.frames import records_of, rows_of
from experiments.evaluation.number.number import is_missing
from experiments.settings.figures import ExplainedPanel, WhyShare
from experiments.settings.runs import Statistics
from mobnet.core.style import styled

ERROR = ("error_ratio", "error_ratio_low", "error_ratio_high")
SHARE = ("share", "share_low", "share_high")
COLUMNS = ("panel", "network", "data", "method", "way", "robots", "ends", *ERROR, *SHARE)
INTERVAL, ROBOTS = "interval", "robots"  # what the ends of a number are
HEIGHT_INCH = 2.5
MARK: Mapping[str, Any] = {"markersize": 4.5, "markeredgewidth": 0.9, "markerfacecoloralt": "white", "zorder": 3.0}
FILLS = ("full", "left", "none")  # of the first, second and third network of a kind
LINE: Mapping[str, Any] = {"linewidth": 0.8, "zorder": 2.0}
TO_NAME: Mapping[str, Any] = {"linewidth": 0.4, "zorder": 1.0}
SMALL: Mapping[str, Any] = {"markersize": 3.0, "markeredgewidth": 0.6}  # of a mark beside a text
WHOLE: Mapping[str, Any] = {"color": "0.6", "linewidth": 0.6, "linestyle": (0, (2, 2)), "zorder": 0.5}
ROOM, TO_NAMES, NAMES = 0.06, 0.12, 0.85  # beside all that is drawn; to texts; for these [share of its range]
AXIS_INCH, NAME_INCH = 1.5, 0.1  # height of a panel; least distance between two texts


def why_share(settings: WhyShare, statistics: Statistics, kept: Path, figure_dir: Path) -> None:
    """Write the figure as PDF, PNG and CSV: share of a hit [-] over the error in walking, a ratio [-].

    `kept` is the table that `./reproduce why` made.
    """
    rows = read_why(kept)
    errors = by_robot(rows, WALKING)
    shares = by_robot(rows, SHARE_OF_HIT)
    panels = [dots_of(settings, statistics, *panel, errors, shares) for panel in settings.panels.items()]
    dots = pd.concat(panels, ignore_index=True)
    save_figure(draw_why(settings.networks, dots), figure_dir / "why_share", COLUMNS, records_of(dots, COLUMNS))


def dots_of(
    settings: WhyShare,
    statistics: Statistics,
    title: str,
    panel: ExplainedPanel,
    errors: Mapping[Learned, Mapping[str, float]],
    shares: Mapping[Learned, Mapping[str, float]],
) -> pd.DataFrame:
    """Return the dots of a panel, from errors in walking [N m] and shares of a hit [-] of each robot: `COLUMNS`.

    A row is of networks that differ in their seed and robot alone; `text` says what is special about their robots and
    their learning. Networks that the trial does not have are left out.
    """
    shown = [(name, cell) for name, cell in cells_of(settings, panel) if cell in errors]
    common = set[str].intersection(*(set(errors[cell]) for _, cell in shown)) if shown else set[str]()
    robots = sorted(common)
    ends = INTERVAL if len(robots) > FEW else ROBOTS
    dots: list[dict[str, object]] = []
    for name, cell in shown:
        data, method, way = cell
        learned_from = settings.sets[data]
        over = (learned_from.over, settings.over.method, settings.over.ways[0])
        error = over_shown_robots([errors[each] for each in (cell, over)], robots, statistics)
        share = over_shown_robots([shares[cell]], robots, statistics)
        text = ", ".join(each for each in (learned_from.says, settings.ways.get(way, "")) if each)
        place = {"panel": title, "network": name, "text": text, "data": data, "method": method, "way": way}
        numbers = dict(zip((*ERROR, *SHARE), (*error.with_ends, *share.with_ends), strict=True))
        dots.append({**place, "robots": len(robots), "ends": ends, **numbers})
    return pd.DataFrame(dots, columns=[*COLUMNS, "text"]).astype(dict.fromkeys((*ERROR, *SHARE), float))


def cells_of(settings: WhyShare, panel: ExplainedPanel) -> Iterator[tuple[str, Learned]]:
    """Yield what a panel shows, each with the name of its network."""
    for name in panel.networks:
        network = settings.networks[name]
        for data in panel.sets:
            for way in panel.ways:
                if way in network.ways:
                    yield name, (data, network.method, way)


def marks_of(networks: Iterable[str]) -> dict[str, dict[str, Any]]:
    """Return the mark of each network, as Matplotlib calls it: that of the method whose name its own begins with.

    Of each further network of a method less of the mark is filled.
    """
    marks: dict[str, dict[str, Any]] = {}
    seen = Counter[str]()
    for name in networks:
        method = max((known for known in LOOKS if name.startswith(known)), key=len)
        look = LOOKS[method]
        fill = FILLS[seen[method] % len(FILLS)]
        marks[name] = {"marker": look.marker, "color": look.colour, "fillstyle": fill, **MARK}
        seen[method] += 1
    return marks


@styled
def draw_why(networks: Iterable[str], dots: pd.DataFrame) -> Figure:
    """Draw the panels side by side with one scale of shares; each dot has its text right of all that is drawn."""
    titles = dots["panel"].unique()
    figure, axes = beside(len(titles), HEIGHT_INCH, sharey=True)
    marks = marks_of(networks)
    for k, (axis, title) in enumerate(zip(axes, titles, strict=True)):
        shown = rows_of(dots, panel=title)
        for dot in shown.to_dict("records"):
            _draw(axis, dot, marks[dot["network"]])
        axis.set_xlabel("error in walking, over MOB-Net's [-]")
        entitle(axis, k, f"{title}, {shown['robots'].iloc[0]} robots")
    axes[0].set_ylabel("share of a hit that is shown [-]")
    # The scale of shares is known once all panels have their dots.
    for axis, title in zip(axes, titles, strict=True):
        _name(axis, rows_of(dots, panel=title), marks)
    legend(figure, axes)
    return figure


def range_of(dot: Mapping[Any, Any], names: Sequence[str]) -> list[float]:
    """Return a number and the ends of its interval, or itself where it has none, from columns of these names."""
    value, *ends = (dot[name] for name in names)
    return [value, *(value if is_missing(end) else end for end in ends)]


def _draw(axis: Axes, dot: Mapping[Any, Any], mark: Mapping[str, Any]) -> None:
    """Draw networks as a mark, with lines from end to end of both numbers."""
    x, left, right = range_of(dot, ERROR)
    y, low, high = range_of(dot, SHARE)
    axis.hlines(y, left, right, color=mark["color"], **LINE)
    axis.vlines(x, low, high, color=mark["color"], **LINE)
    axis.plot(x, y, label=dot["network"], linestyle="", **mark)


def _name(axis: Axes, dots: pd.DataFrame, marks: Mapping[str, Mapping[str, Any]]) -> None:
    """Write the texts of dots right of all that is drawn, apart from one another, each with a line to its dot."""
    rows = dots.to_dict("records")
    drawn = np.array([range_of(dot, ERROR) for dot in rows], dtype=np.float64)
    width = float(drawn.max() - drawn.min())
    first, last = float(drawn.min()) - ROOM * width, float(drawn.max()) + ROOM * width
    place = last + TO_NAMES * width
    ticks = [tick for tick in axis.get_xticks() if first <= tick <= last]
    axis.set_xlim(first, place + NAMES * width)
    axis.set_xticks(ticks)
    axis.spines["bottom"].set_bounds(first, last)
    axis.hlines([0.0, 1.0], first, last, **WHOLE)
    low, high = axis.get_ylim()
    gap = NAME_INCH / AXIS_INCH * (high - low)
    named = [dot for dot in rows if dot["text"]]
    shares = [dot["share"] for dot in named]
    for dot, share, height in zip(named, shares, apart(shares, gap, high), strict=True):
        mark = {**marks[dot["network"]], **SMALL}
        axis.plot([dot["error_ratio"], place], [share, height], color=mark["color"], **TO_NAME)
        axis.plot(place, height, linestyle="", **mark)
        axis.annotate(dot["text"], (place, height), (3.5, 0.0), ha="left", **NAME)
