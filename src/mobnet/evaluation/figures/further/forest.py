"""All claims at a glance: our interval beside the paper's number, the range where it is reproduced, and the verdict.

Of a claim with a number of the paper the axis has our number over the paper's, on a log scale; of a cut both are what
remains of the error. Without such a number it has how far ours lies on the claimed side of the claim's bound, as a
share of the farthest end of its interval.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import accumulate, groupby, pairwise
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from mobnet.core.columns import FOREST, SIGN_ONLY, VERDICTS
from mobnet.evaluation.figures.style import PAGE_INCH, STYLE, save_figure
from mobnet.evaluation.measure.claims.verdicts import Judged
from mobnet.settings.claims import Bounds

OVER_PAPER, BEYOND_BOUND = "ours over the paper's", "beyond the bound"  # what an axis has
ENDS: Mapping[str, tuple[float, float]] = {OVER_PAPER: (1 / 8, 8.0), BEYOND_BOUND: (-1.15, 1.15)}  # of the axes
EQUAL: Mapping[str, float] = {OVER_PAPER: 1.0, BEYOND_BOUND: 0.0}
MARKS = (("#D55E00", "X"), ("#E69F00", "s"), ("#0072B2", "^"), ("#009E73", "o"), ("0.5", ""))
# verdict -> colour, of Okabe and Ito's palette, and marker
LOOKS: Mapping[str, tuple[str, str]] = dict(zip(VERDICTS, MARKS, strict=True))
ROW_INCH, HEAD_INCH, POINTS = 0.108, 0.28, 4.8  # height of a row and of a panel's head and axis, size of letters
COLUMNS, LABEL_SHARE = 2, 0.62  # of the page, and the share of a column that labels take
JOINT_SHARE = 0.45  # height of a joint's row over that of a claim's


@dataclass(frozen=True)
class Place:
    """Where a claim stands on its axis [-]: our number with its interval, and the range where it is reproduced."""

    judged: Judged
    axis: str
    values: tuple[float | None, float | None, float | None]
    band: Bounds

    @property
    def record(self) -> tuple[str | float | None, ...]:
        """Return the row of claims.csv among the figures."""
        return (self.judged.score, self.judged.row.name, self.judged.verdict, self.axis, *self.values, *self.band)


Panel = Sequence[Place]


def forest(judged: Sequence[Judged], confidence: float, figure_dir: Path) -> None:
    """Write the figure of all claims as PDF, PNG and CSV; `confidence` is that of the intervals, a share [-]."""
    places = [beyond_bound(each) if each.score == SIGN_ONLY else over_paper(each) for each in judged]
    save_figure(
        draw_forest(columns_of(places), confidence), figure_dir / "claims", FOREST, [place.record for place in places]
    )


def over_paper(judged: Judged) -> Place:
    """Return where our number is over the paper's [-]; of a cut, where what remains of an error is."""
    published, is_cut = judged.row.claim.published or 1.0, judged.row.claim.quantity == "cut"

    def over(number: float | None) -> float | None:
        if number is None:
            return None
        return (1.0 - number) / (1.0 - published) if is_cut else number / published

    (value, low, high), (first, last) = map(over, judged.ours.with_ends), map(over, judged.ranges.reproduced)
    return Place(judged, OVER_PAPER, (value, *in_order(low, high, is_cut)), in_order(first, last, is_cut))


def in_order(low: float | None, high: float | None, turned: bool) -> tuple[float | None, float | None]:
    """Return two ends [-], the other way round where the axis is turned."""
    return (high, low) if turned else (low, high)


def beyond_bound(judged: Judged) -> Place:
    """Return how far our number lies on the claimed side of its bound, as a share of the farthest end [-]."""
    found = [None if number is None else margin(number, judged.ranges.reproduced) for number in judged.ours.with_ends]
    held = [each for each in found if each is not None]
    scale = max(map(abs, held), default=0.0) or 1.0
    value, low, high = (None if each is None else each / scale for each in found)
    if value is not None and low is not None and high is not None:  # in a two-sided range the middle lies farthest in
        low, high = min(low, high), max(low, high, value)
    return Place(judged, BEYOND_BOUND, (value, low, high), (0.0, None))


def margin(number: float, bounds: Bounds) -> float:
    """Return how far a number lies inside a range, below zero outside [its unit]."""
    low, high = bounds
    return min(number - low if low is not None else float("inf"), high - number if high is not None else float("inf"))


def columns_of(places: Sequence[Place]) -> list[list[Panel]]:
    """Return the columns of the page, each with panels of one score; statements are not cut."""
    statements = [list(own) for _, own in groupby(sorted_by_score(places), lambda place: place.judged.row.statement)]
    share, tall = height_of(places) / COLUMNS, 0.0
    columns: list[list[list[Place]]] = [[]]
    for own in statements:
        if tall >= share and len(columns) < COLUMNS:
            columns.append([])
            tall = 0.0
        if not columns[-1] or columns[-1][-1][-1].judged.score != own[0].judged.score:
            columns[-1].append([])
        columns[-1][-1] += own
        tall += height_of(own)
    return [list(column) for column in columns]


def rows_of(panel: Iterable[Place]) -> list[float]:
    """Return where the middle of each row is, from the top down [heights of a row]; those of joints are low."""
    heights = [height_of([place]) for place in panel]
    return [top + height / 2.0 for top, height in zip(accumulate(heights, initial=0.0), heights, strict=False)]


def height_of(panel: Iterable[Place]) -> float:
    """Return the height of rows [heights of a row]."""
    return sum(JOINT_SHARE if place.judged.row.joint else 1.0 for place in panel)


def sorted_by_score(places: Iterable[Place]) -> list[Place]:
    """Return places score by score, statement by statement, each in the order in which it comes first."""
    held = list(places)
    first = list(dict.fromkeys(place.judged.row.statement for place in held))
    scores = list(dict.fromkeys(place.judged.score for place in held))
    return sorted(held, key=lambda place: (scores.index(place.judged.score), first.index(place.judged.row.statement)))


def draw_forest(columns: Sequence[Sequence[Panel]], confidence: float) -> Figure:
    """Draw panels of claims in the columns of a page."""
    heights = [sum(HEAD_INCH + ROW_INCH * height_of(panel) for panel in column) for column in columns]
    tall, wide = max(heights) + HEAD_INCH, PAGE_INCH / len(columns)
    with mpl.rc_context({**STYLE, "font.size": POINTS}):
        figure = Figure(figsize=(PAGE_INCH, tall))
        for k, column in enumerate(columns):
            top = tall - HEAD_INCH
            for panel in column:
                high = ROW_INCH * height_of(panel)
                left, width = (k + LABEL_SHARE) * wide, (1.0 - LABEL_SHARE) * wide - 0.08
                axis = figure.add_axes((left / PAGE_INCH, (top - high) / tall, width / PAGE_INCH, high / tall))
                draw_panel(axis, panel)
                top -= high + HEAD_INCH
        key(figure, f"{confidence:.0%} interval")
    return figure


def draw_panel(axis: Axes, panel: Panel) -> None:
    """Draw the claims of one score, the first one on top."""
    name, rows = panel[0].axis, rows_of(panel)
    first, last = ENDS[name]
    for row, place in zip(rows, panel, strict=True):
        low, high = (edge if end is None else end for end, edge in zip(place.band, (first, last), strict=True))
        low, high, height = max(low, first), min(high, last), 0.9 * height_of([place])
        axis.barh(row, high - low, left=low, height=height, color="0.88", linewidth=0)
        draw_place(axis, row, place)
    axis.axvline(EQUAL[name], color="0.4", linewidth=0.4, zorder=1.5)
    for (row, before), (_, place) in pairwise(zip(rows, panel, strict=True)):
        if before.judged.row.statement != place.judged.row.statement:
            edge = row + height_of([before]) / 2.0
            axis.plot([-LABEL_SHARE / (1.0 - LABEL_SHARE) + 0.05, 1.0], [edge, edge], color="0.75", linewidth=0.3,
                      transform=axis.get_yaxis_transform(), clip_on=False, zorder=1.0)  # fmt: skip
    if name == OVER_PAPER:
        axis.set_xscale("log", base=2)
        axis.set_xticks([0.125, 0.25, 0.5, 1, 2, 4, 8], ["1/8", "1/4", "1/2", "1", "2", "4", "8"])
    else:
        axis.set_xticks([-1, 0, 1], ["against", "bound", "for"])
    axis.set(xlim=(first, last), ylim=(height_of(panel), 0.0))
    axis.set_yticks(*labels_of(panel, rows))
    axis.tick_params(length=1.5, pad=1.5, labelsize=POINTS, width=0.4)
    axis.tick_params(axis="y", length=0)
    axis.set_title(f"{panel[0].judged.score}: {name}", fontsize=POINTS + 1, pad=2, loc="right", weight="bold")


def labels_of(panel: Panel, rows: Sequence[float]) -> tuple[list[float], list[str]]:
    """Return places and texts beside the rows: what a claim says, and the first and the last of its joints."""
    places, texts = list[float](), list[str]()
    for is_joint, own in groupby(zip(rows, panel, strict=True), lambda each: bool(each[1].judged.row.joint)):
        held = list(own)
        if is_joint:
            places.append((held[0][0] + held[-1][0]) / 2.0)
            texts.append(f"{held[0][1].judged.row.joint} (top) to {held[-1][1].judged.row.joint}")
        else:
            places += [row for row, _ in held]
            texts += [place.judged.row.claim.says.removesuffix(".") for _, place in held]
    return places, texts


def draw_place(axis: Axes, row: float, place: Place) -> None:
    """Draw our number and its interval, an arrow where it lies beyond an end of the axis."""
    value, low, high = place.values
    colour, marker = LOOKS[place.judged.verdict]
    small = bool(place.judged.row.joint)
    first, last = ENDS[place.axis]
    if value is None:
        axis.text(EQUAL[place.axis], row, "not measured", fontsize=POINTS - 1, color=colour, ha="center", va="center")
        return
    if low is not None and high is not None:
        ends = [min(max(end, first), last) for end in (low, high)]
        axis.plot(ends, [row, row], color=colour, linewidth=0.6 if small else 1.0, solid_capstyle="butt", zorder=3)
    beyond = "<" if value < first else ">" if value > last else marker
    look: dict[str, Any] = {"markersize": 1.8 if small else 3.2, "markeredgewidth": 0.0, "zorder": 4, "clip_on": False}
    axis.plot([min(max(value, first), last)], [row], linestyle="", marker=beyond, color=colour, **look)


def key(figure: Figure, interval: str) -> None:
    """Put what colours and markers mean on top of a figure."""
    handles: list[Any] = [
        mpl.lines.Line2D([], [], color=colour, marker=marker or "_", markersize=4, linewidth=1.0, label=verdict)
        for verdict, (colour, marker) in LOOKS.items()
    ]
    handles.append(mpl.patches.Patch(color="0.9", label=f"reproduced if the {interval} lies here"))
    figure.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, 1.0), ncols=len(handles), frameon=False,
                  fontsize=POINTS + 1, borderaxespad=0.2)  # fmt: skip
