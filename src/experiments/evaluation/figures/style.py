"""What all figures share: the look of each method, sizes, the legend, and a saver whose files never change."""

import hashlib
import logging
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import ceil
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Text

from experiments.evaluation.number.number import shown_name
from experiments.evaluation.number.rows import Field, write_csv
from mobnet.core.files import atomic_path
from mobnet.core.style import COLUMN_INCH, PAGE_INCH, STYLE, settle

log = logging.getLogger(__name__)

LETTERS = "abcdefghijkl"
# Of a name at a line, beside its place.
NAME: Mapping[str, Any] = {"textcoords": "offset points", "va": "center_baseline", "fontsize": 7.0}
# Code of a joint without its side -> its name, of the joints that figures show.
JOINTS = {
    "L1": "hip yaw", "L2": "hip roll", "L3": "hip pitch", "L4": "knee", "L5": "ankle pitch", "L6": "ankle roll",
    "A2": "shoulder", "W1": "waist yaw", "W2": "waist pitch", "W3": "waist roll", "V3": "base, vertical",
}  # fmt: skip
JOINT = re.compile(r"^(?P<code>[LR]?(?P<place>[LAWV]\d))\b")
CLIP = re.compile(r"(?:(?<=id=\")|(?<=url\(#))p[0-9a-f]{10}\b")  # name of an area that a drawing is cut to
PATHS = re.compile(r' d="[^"]*"')
DIGITS = re.compile(r"(\.\d\d)\d+")
UNDATED: Mapping[str, dict[str, Any]] = {  # ending of a picture -> what would make equal pictures differ
    ".pdf": {"CreationDate": None, "Producer": None},
    ".svg": {"Date": None, "Creator": None},
    ".png": {"Software": None},
}


@dataclass(frozen=True)
class Look:
    """How a method is drawn, such that methods differ for colour-blind readers and in print without colour.

    Attributes:
        colour: of lines, bars and dots; Okabe and Ito's palette, and grey.
        dash: of lines, in Matplotlib's terms.
        hatch: of bars.
        marker: of places on a line.
        width: of lines [points]; None for the usual one.
        order: Matplotlib's zorder; higher ones are drawn on top.
    """

    colour: str
    dash: Any = "-"
    hatch: str = ""
    marker: str = "o"
    width: float | None = None
    order: float = 2.0

    @property
    def line(self) -> dict[str, Any]:
        """How Matplotlib calls the look of a line."""
        width = {} if self.width is None else {"linewidth": self.width}
        return {"color": self.colour, "linestyle": self.dash, "zorder": self.order, **width}


PALETTE = (
    Look("#D55E00", "-", "////", "D"),
    Look("#0072B2", (0, (2, 1)), "", "o"),
    Look("#009E73", (0, (5, 1.5)), "xxxx", "^"),
    Look("#CC79A7", (0, (6, 1, 1.5, 1)), "++++", "P"),
    Look("#E69F00", (0, (3, 1, 1, 1, 1, 1)), "\\\\\\\\", "v"),
    Look("#56B4E9", (0, (8, 2)), "....", "s"),
    Look("black", (0, (1, 1)), "----", "X"),
    Look("0.45", (0, (4, 1, 1, 1)), "||||", "p"),
    Look("#F0E442", (0, (3, 2)), "oooo", "*"),
)
KINDS = ("GRU", "LSTM", "RNN", "TCN", "MLP", "MLP-500")  # of networks; never in a figure with the methods below
# The fitted friction model that is shown beside networks: one of the two in a figure, the better one on its plant.
FORMULA = Look("#8A6100", "-", "\\\\", "h", 0.7, 2.2)
# Solid are our networks, the formula and the truth; dashes, and lighter or thinner lines, are for other baselines.
LOOKS: Mapping[str, Look] = {
    **dict(zip(KINDS, PALETTE, strict=False)),
    "MOB-Net": Look("#D55E00", "-", "////", "D", 1.2, 2.6),
    "MOB-Net-pushed": Look("#D55E00", (0, (7, 1)), "\\\\\\\\", "d", 1.2, 2.6),
    "MOB-Net-Single": Look("#009E73", "-", "xxxx", "^", 1.1, 2.4),
    "MOB-Net-Single-2X": Look("#F0E442", (0, (3, 2)), "oooo", "*"),
    "MOB-Net-gray": Look("#009E73", (0, (5, 1.5)), "xxxx", "^", 1.1, 2.4),
    "FTS-e2e": Look("#CC79A7", (0, (6, 1, 1.5, 1)), "++++", "P", 1.1, 2.7),
    "FTS-e2e-pushed": Look("#CC79A7", (0, (3, 1)), "++++", "p", 1.1, 2.7),
    "MOB": Look("#0072B2", (0, (4, 1)), "", "o", 0.6, 2.0),
    "MOB-fric": Look("#7CC7F0", (0, (8, 1.5)), "....", "s", 1.2, 1.9),
    "MOB-fric-BPF": Look("#E69F00", (0, (3, 1, 1, 1, 1, 1)), "||||", "v"),
    "MOB-fric-load": FORMULA,
    "MOB-fric-dahl": FORMULA,
    "MOB-Kalman": Look("0.45", (0, (4, 1, 1, 1)), "----", "p"),
    "zero": Look("0.8", (0, (1, 1)), "*", "X"),
    "truth": Look("black", "-", width=0.8, order=3.0),  # on top of all
    "target": Look("0.6", "-", width=2.2, order=1.0),
}


def looks(labels: Iterable[str]) -> dict[str, Look]:
    """Return the look of everything in a figure: a method's own, or the next of those that no method in it has."""
    names = list(dict.fromkeys(labels))
    taken = {LOOKS[name].colour for name in names if name in LOOKS}
    free = [look for look in PALETTE if look.colour not in taken]
    others = [name for name in names if name not in LOOKS]
    return {name: LOOKS[name] if name in LOOKS else free[others.index(name) % len(free)] for name in names}


def stacked(units: Sequence[str], panel_inch: float, legend_inch: float, columns: int = 1) -> tuple[Figure, list[Axes]]:
    """Return a figure of one column's width with panels below one another, those of a unit on one scale; in [inch].

    With several `columns` of panels it has the width of the page.
    """
    rows = ceil(len(units) / columns)
    width = COLUMN_INCH if columns == 1 else PAGE_INCH
    figure = Figure(figsize=(width, panel_inch * rows + legend_inch), layout="constrained")
    axes: list[Axes] = figure.subplots(rows, columns, squeeze=False).ravel().tolist()
    for axis, unit in zip(axes, units, strict=True):
        if axis is not (first := axes[units.index(unit)]):
            axis.sharey(first)
    return figure, axes


def beside(count: int, height_inch: float, **shared: Any) -> tuple[Figure, list[Axes]]:
    """Return a figure of two columns' width with panels side by side, so high [inch]; what they share is `shared`."""
    figure = Figure(figsize=(PAGE_INCH, height_inch), layout="constrained")
    return figure, figure.subplots(1, count, squeeze=False, **shared)[0].tolist()


def entitle(axis: Axes, k: int, title: str) -> None:
    """Put the k-th letter and a title above a panel."""
    axis.set_title(f"({LETTERS[k]}) {title}", loc="left", pad=3)


def with_joint_name(text: str, between: str = " ") -> str:
    """Return a text that begins with the code of a joint with its name before it: `hip pitch (LL3)`."""
    joint = JOINT.match(text)
    if joint is None or joint["place"] not in JOINTS:
        return text
    return f"{JOINTS[joint['place']]}{between}({joint['code']}){text[joint.end() :]}"


def legend(figure: Figure, axes: Sequence[Axes], columns: int | None = None, last: str = "", **look: float) -> None:
    """Put one legend of everything drawn above the panels, each label as it is drawn first and `last` at the end.

    A row has so many columns at most, or all entries, and fewer where it would be wider than the figure; `look` has
    other lengths of Matplotlib's legend [font size].
    """
    handles: dict[str, Any] = {}
    for axis in axes:
        for handle, label in zip(*axis.get_legend_handles_labels(), strict=True):
            handles.setdefault(shown_name(label), handle)
    if last in handles:
        handles[last] = handles.pop(last)
    look = {"handlelength": 1.8, "columnspacing": 0.9, "handletextpad": 0.4, "borderpad": 0.0, **look}
    most = max(1, min(columns or len(handles), len(handles)))
    fewer = (ceil(len(handles) / rows) for rows in range(ceil(len(handles) / most) + 1, len(handles) + 1))
    for n in (most, *fewer):  # the width is known once it is laid out
        key = figure.legend(
            handles.values(), handles.keys(), loc="outside upper center", ncols=n, frameon=False, **look
        )
        if n == 1 or key.get_window_extent().width <= figure.bbox.width:
            return
        key.remove()


def apart(places: Sequence[float], gap: float, top: float) -> list[float]:
    """Return places (n,) on an axis for names of lines that end at these places: none nearer than a gap, none above."""
    order = sorted(range(len(places)), key=lambda k: places[k])
    moved = list(places)
    for below, k in pairwise(order):
        moved[k] = max(moved[k], moved[below] + gap)
    for k in reversed(order):
        moved[k] = min(moved[k], top)
        top = moved[k] - gap
    return moved


def save_figure(figure: Figure, stem: Path, columns: Sequence[str], rows: Iterable[Sequence[Field]]) -> None:
    """Write the plotted numbers as `stem.csv`, and `stem.pdf` (fonts embedded), `.svg` and `.png` without dates.

    So equal numbers give equal files.

    Raises:
        ValueError: letters of a text would be drawn as outlines, so that nobody could read their size from the PDF.
    """
    outlined = [text.get_text() for text in figure.findobj(Text) if text.get_path_effects() and text.get_text()]
    if outlined:
        raise ValueError(f"{stem}: text with path effects: {outlined[0]!r}; give it a box as background instead")
    write_csv(stem.with_suffix(".csv"), columns, rows)
    save_picture(figure, stem)
    log.info("%s.pdf: %d panels", stem, len(figure.axes))


def save_picture(figure: Figure, stem: Path, endings: Iterable[str] = UNDATED) -> None:
    """Write a figure in the formats of some endings, by default as PDF, SVG and PNG, without dates."""
    with mpl.rc_context(STYLE):
        settle(figure)
        for suffix in endings:
            with atomic_path(stem.with_suffix(suffix)) as temporary:
                figure.savefig(temporary, format=suffix[1:], metadata=UNDATED[suffix])
                if suffix == ".svg":
                    svg = temporary.read_text(encoding="utf-8")
                    temporary.write_text(with_stable_names(shortened(svg)), encoding="utf-8")


def shortened(svg: str) -> str:
    """Return a drawing whose paths have two digits behind the point, a hundredth of 1/72 inch: half as many bytes."""
    return PATHS.sub(lambda path: DIGITS.sub(r"\1", path[0]), svg)


def with_stable_names(svg: str) -> str:
    """Return a drawing whose clip paths are named by what is drawn and by their order.

    Matplotlib names them by their corners, to the last digit. A page may hold several drawings, so that their names
    differ.
    """
    order = {name: k for k, name in enumerate(dict.fromkeys(CLIP.findall(svg)))}
    numbered = CLIP.sub(lambda match: str(order[match[0]]), svg)
    digest = hashlib.sha256(numbered.encode()).hexdigest()[:8]
    return CLIP.sub(lambda match: f"clip-{digest}-{order[match[0]]}", svg)
