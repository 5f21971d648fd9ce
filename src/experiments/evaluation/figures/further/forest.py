"""All statements at a glance: the worst claim of each, our interval, the range where it is reproduced, and the verdict.

One figure has the statements with a number of the paper, ours over the original's on a log axis; another one those
without, how far ours lies on the claimed side of the bound.
"""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

from collections import Counter
from collections.abc import Mapping, Sequence
from math import ceil
from pathlib import Path
from typing import Any

import matplotlib as mpl
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from experiments.evaluation.figures.style import save_figure
from experiments.evaluation.measure.claims.places import (
    BEYOND_BOUND,
    OVER_PAPER,
    POSITION,
    statements_of,
)
from experiments.evaluation.measure.claims.verdicts import bounds_of, unit_text
from experiments.evaluation.number.frames import records_of, rows_of
from experiments.evaluation.number.laws import number_from
from experiments.evaluation.number.number import Number, is_missing
from experiments.intervals.bounds import range_text
from experiments.settings.table_columns import FOREST
from experiments.settings.verdicts import (
    DESCRIPTION,
    NETWORKS,
    NO_NUMBER,
    NOT_MEASURED,
    NOT_REPRODUCED,
    OBSERVER,
    OPEN,
    OURS,
    REPRODUCED,
    SIGN_AT_LEAST,
    SIGN_ONLY,
)
from mobnet.core.style import PAGE_INCH, STYLE

Row = Mapping[Any, Any]  # of a statement, as `statements_of` returns it
# Column of the CSV file -> that of a statement: where it stands on its axis.
FILED = dict(zip(("value", "low", "high", "from", "to"), POSITION, strict=True))
STEMS = {OVER_PAPER: "claims", BEYOND_BOUND: "claims_own"}  # of the two figures
ENDS: Mapping[str, tuple[float, float]] = {OVER_PAPER: (1 / 8, 8.0), BEYOND_BOUND: (-1.15, 1.15)}  # of the axes
EQUAL: Mapping[str, float] = {OVER_PAPER: 1.0, BEYOND_BOUND: 0.0}
TICKS: Mapping[str, Mapping[float, str]] = {
    OVER_PAPER: {0.125: "1/8", 0.25: "1/4", 0.5: "1/2", 1.0: "1", 2.0: "2", 4.0: "4", 8.0: "8"},
    BEYOND_BOUND: {-1.0: "against", 0.0: "bound", 1.0: "for"},
}
HEADS: Mapping[str, str] = {
    OBSERVER: "Statements of the original about the observer",
    NETWORKS: "Statements of the original about networks",
    NO_NUMBER: "Statements of the original without a number",
    OURS: "Our own statements",
}
# verdict -> colour, dark enough for text, marker, and sign before a text
LOOKS: Mapping[str, tuple[str, str, str]] = {
    NOT_REPRODUCED: ("#D55E00", "X", "\N{BALLOT X}"),
    SIGN_ONLY: ("#9A6700", "v", "\N{SOUTH EAST ARROW}"),
    OPEN: ("0.35", "s", "?"),
    DESCRIPTION: ("#6A4C93", "D", "="),
    SIGN_AT_LEAST: ("#0072B2", "^", "\N{NORTH EAST ARROW}"),
    REPRODUCED: ("#00795A", "o", "\N{CHECK MARK}"),
    NOT_MEASURED: ("0.45", "", "\N{EN DASH}"),
}
POINTS, ROW_INCH, HEAD_INCH = 7.0, 0.11, 0.17  # size of text; heights of a row and of a head
KEY_ROW_INCH, KEY_EDGE_INCH = 0.145, 0.06  # height of a row of the legend, and below all of them
KEY_COLUMNS = 3
AXIS_INCH = 0.3  # height below the last row, of an axis
TEXT_INCH, LEFT_INCH, WIDTH_INCH = 0.12, 3.86, 1.2  # where texts begin; where the axis does, and its width
COLUMN_INCH = {"ours": 5.14, "other": 6.97}  # where our number begins and the other column ends
STRIPE: Mapping[str, Any] = {"color": "0.96", "linewidth": 0.0, "clip_on": False, "zorder": 0}  # every other row


def forest(claims: pd.DataFrame, confidence: float, figure_dir: Path) -> None:
    """Write the figures of statements as PDF, PNG and CSV.

    The claims are judged; `confidence` is that of the intervals, a share [-].
    """
    statements = statements_of(claims)
    for axis, stem in STEMS.items():
        shown = rows_of(statements, axis=axis)
        filed = shown.assign(worst=shown["claim"], **{name: shown[column] for name, column in FILED.items()})
        save_figure(
            draw_forest(shown, axis, f"{confidence:.0%} interval"),
            figure_dir / stem,
            FOREST,
            records_of(filed, FOREST),
        )


def draw_forest(statements: pd.DataFrame, axis_name: str, interval: str) -> Figure:
    """Draw statements below one another, section by section, on one axis; the legend calls the interval so."""
    sections = [section.to_dict("records") for _, section in statements.groupby("score", sort=False)]
    rows = ROW_INCH * len(statements) + HEAD_INCH * max(1, len(sections))
    keys = _keys(statements, f"claimed range, for the {interval}")
    tall = KEY_ROW_INCH * ceil(len(keys) / KEY_COLUMNS) + KEY_EDGE_INCH + rows + AXIS_INCH
    with mpl.rc_context({**STYLE, "font.size": POINTS}):
        figure = Figure(figsize=(PAGE_INCH, tall))
        place = (LEFT_INCH / PAGE_INCH, AXIS_INCH / tall, WIDTH_INCH / PAGE_INCH, rows / tall)
        axis = figure.add_axes(place)
        _scale(axis, axis_name, rows)
        top = 0.0
        for section in sections:
            _head(axis, top, section, axis_name)
            top += HEAD_INCH
            for k, statement in enumerate(section):
                if k % 2:
                    _stripe(axis, top)
                _row(axis, top + ROW_INCH / 2.0, statement)
                top += ROW_INCH
        figure.legend(
            handles=keys,
            loc="upper center",
            bbox_to_anchor=(0.5, 1.0),
            ncols=KEY_COLUMNS,
            frameon=False,
            fontsize=POINTS,
            borderaxespad=0.3,
            handlelength=1.4,
            columnspacing=1.0,
            handletextpad=0.4,
        )
    return figure


def _scale(axis: Axes, name: str, rows: float) -> None:
    """Set the scales of an axis whose rows are so high together [inch]."""
    if name == OVER_PAPER:
        axis.set_xscale("log", base=2)
    axis.set_xticks(list(TICKS[name]), list(TICKS[name].values()))
    axis.minorticks_off()
    axis.set(xlim=ENDS[name], ylim=(rows, 0.0), xlabel=f"{name} [-]")
    axis.axvline(EQUAL[name], color="0.4", linewidth=0.5, zorder=1.5)
    axis.spines["left"].set_visible(False)
    axis.set_yticks([])
    axis.tick_params(length=2.0, pad=1.5, labelsize=POINTS, width=0.4)
    axis.xaxis.label.set_fontsize(POINTS)


def _text(axis: Axes, inch: float, row: float, text: str, **look: Any) -> None:
    """Write a text beside an axis, so far from the page's left side and from the first row's top [inch]."""
    x = (inch - LEFT_INCH) / WIDTH_INCH
    axis.text(x, row, text, transform=axis.get_yaxis_transform(), va="center", fontsize=POINTS, **look)


def _head(axis: Axes, top: float, section: Sequence[Row], name: str) -> None:
    """Write the head of a section at its top [inch]."""
    middle = top + HEAD_INCH / 2.0
    says = f"{HEADS[section[0]['score']]} ({len(section)})"
    _text(axis, TEXT_INCH, middle, says, weight="bold")
    _text(axis, COLUMN_INCH["ours"], middle, "ours, with interval", weight="bold")
    _text(
        axis, COLUMN_INCH["other"], middle, "original" if name == OVER_PAPER else "holds if", weight="bold", ha="right"
    )
    line = {"color": "0.5", "linewidth": 0.5, "clip_on": False, "transform": axis.get_yaxis_transform()}
    ends = [(inch - LEFT_INCH) / WIDTH_INCH for inch in (0.0, COLUMN_INCH["other"])]
    axis.plot(ends, [top + HEAD_INCH - 0.02] * 2, **line)


def _stripe(axis: Axes, top: float) -> None:
    """Draw the ground of a row at its top [inch] from side to side, which leads the eye."""
    left, right = ((inch - LEFT_INCH) / WIDTH_INCH for inch in (0.0, COLUMN_INCH["other"]))
    place = (left, top), right - left, ROW_INCH
    axis.add_patch(Rectangle(*place, transform=axis.get_yaxis_transform(), **STRIPE))


def _row(axis: Axes, row: float, statement: Row) -> None:
    """Draw a statement in its row [inch]: sign, text, interval and numbers."""
    colour, _, sign = LOOKS[statement["verdict"]]
    _text(axis, 0.01, row, sign, color=colour, weight="bold")
    _text(axis, TEXT_INCH, row, text_of(statement))
    number = number_from(statement)
    value, interval = number.texts()
    ours = "not measured" if number.value is None else f"{value} {interval}{unit_text(number.unit)}"
    _text(axis, COLUMN_INCH["ours"], row, ours, color=colour)
    printed = Number(number.published, unit=number.unit).texts()[0]
    other = range_text(bounds_of(statement)) if statement["axis"] == BEYOND_BOUND else printed
    _text(axis, COLUMN_INCH["other"], row, other, ha="right")
    _position(axis, row, statement)


def text_of(statement: Row) -> str:
    """Return what the worst claim of a statement says, with its joint, and of how many claims it is one."""
    count = f" (1 of {statement['claims']})" if statement["claims"] > 1 else ""
    return statement["says"].removesuffix(".") + count


def _position(axis: Axes, row: float, statement: Row) -> None:
    """Draw the range where a claim is reproduced, our number and its interval, arrows where they leave the axis."""
    first, last = ENDS[statement["axis"]]
    value, low, high, band_from, band_to = (
        None if is_missing(statement[name]) else statement[name] for name in POSITION
    )
    left = max(first if band_from is None else band_from, first)
    right = min(last if band_to is None else band_to, last)
    axis.barh(row, right - left, left=left, height=0.8 * ROW_INCH, color="0.88", linewidth=0)
    colour, marker, _ = LOOKS[statement["verdict"]]
    if value is None:
        return
    if low is not None and high is not None:
        ends = [min(max(end, first), last) for end in (low, high)]
        axis.plot(ends, [row, row], color=colour, linewidth=1.2, solid_capstyle="butt", zorder=3)
    look: dict[str, Any] = {"color": colour, "markeredgewidth": 0.0, "zorder": 4, "clip_on": False}
    if min(value, low or value) < first:
        axis.plot([first], [row], "<", markersize=4.0, **look)
    if max(value, high or value) > last:
        axis.plot([last], [row], ">", markersize=4.0, **look)
    if first <= value <= last:
        axis.plot([value], [row], marker, markersize=3.8, **look)


def _keys(statements: pd.DataFrame, band: str) -> list[Any]:
    """Return what colours, signs and markers mean, with how many statements have each verdict."""
    counts = Counter(statements["verdict"])
    handles: list[Any] = []
    for verdict, (colour, marker, sign) in LOOKS.items():
        if not counts[verdict]:
            continue
        width = 1.2 if marker else 0.0
        text = f"{sign} {verdict} ({counts[verdict]})"
        line = Line2D([], [], color=colour, marker=marker, markersize=4, linewidth=width, label=text)
        handles.append(line)
    return [*handles, Patch(color="0.88", label=band)]
