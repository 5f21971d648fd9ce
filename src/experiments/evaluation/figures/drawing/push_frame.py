"""One frame of the film of a push: the robot on the left, the torque of a joint on the right. Drawing only."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle
from numpy.typing import NDArray

from experiments.evaluation.compare.curves import TorqueCurve
from experiments.evaluation.figures.drawing.pushed import PUSH, draw_pushed
from experiments.evaluation.figures.style import LOOKS
from mobnet.core.arrays import Array
from mobnet.robot.description import RobotDescription
from mobnet.simulation.render import Pixels

SIZE_INCH = (9.6, 5.4)
DPI = 100
STYLE: dict[Any, Any] = {"font.size": 11.5, "font.family": "DejaVu Sans", "axes.linewidth": 0.8}
ROBOT, TORQUE = (0.0, 0.0, 0.4, 1.0), (0.475, 0.34, 0.505, 0.475)  # places of the panels, shares of the picture
ROOM_M = (-0.76, 0.76, -0.22, 1.92)  # of the robot's panel: right of it, and above the ground
TEXT_X, TITLE_Y, LEGEND_Y, LINE_Y, LINE_STEP = 0.425, 0.93, 0.845, 0.178, 0.05  # of texts, shares of the picture
COLUMN_X = (0.425, 0.725, 0.855, 0.985)  # left end of the names, right ends of the numbers
INK, PALE, BACKGROUND, SWING = "#1B1F24", "#5B6470", "#F6F8FA", "#E6F3EE"
WIDER = 1.5  # of lines, beside those of figures
BAND_ALPHA = 0.35


@dataclass(frozen=True)
class Moment:
    """What a frame shows.

    Attributes:
        q: position of the robot on the ground (nq,) [m, -, rad].
        centre: of the floor and of the picture (3,) [m].
        point: name of the point that is pushed.
        force: that of the push (3,) [N], world axes.
        felt: point of the link that the detector names; empty before it does.
        said: what it says; empty before it does.
        now_s: time [s].
        ends_s: ends of the torque's time axis [s].
        speed: text on how fast time runs.
    """

    q: Array
    centre: Array
    point: str
    force: Array
    felt: str
    said: str
    now_s: float
    ends_s: tuple[float, float]
    speed: str


@dataclass(frozen=True)
class TorquePlot:
    """The torque of a joint: time (T,) [s], curves (T,) [N m], swing or not (T,), texts, and the axis' ends [N m]."""

    time_s: Array
    curves: Sequence[TorqueCurve]
    swing: NDArray[np.bool_]
    title: str
    labels: Mapping[str, str]
    ends_nm: tuple[float, float]


def draw_frame(
    robot: RobotDescription,
    view: Array,
    moment: Moment,
    course: TorquePlot,
    drawn_s: float,
    lines: Sequence[str | Sequence[str]],
) -> Pixels:
    """Draw a frame (height, width, 3): the torque until `drawn_s` [s], and what stands below it.

    That is text, a line each, or a table: heads of columns, then lines with a method and texts.
    """
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=SIZE_INCH, dpi=DPI, facecolor="white")
        canvas = FigureCanvasAgg(figure)
        scene, torque = (figure.add_axes(place) for place in (ROBOT, TORQUE))
        figure.add_artist(Rectangle((0, 0), ROBOT[2], 1, facecolor=BACKGROUND, zorder=-1))
        _draw_scene(scene, robot, view, moment)
        _draw_torque(torque, moment, course, drawn_s)
        figure.text(TEXT_X, TITLE_Y, course.title, fontsize=13, fontweight="bold", color=INK)
        _draw_legend(figure, course)
        _draw_lines(figure, course, lines)
        canvas.draw()
    return np.asarray(canvas.buffer_rgba())[..., :3].copy()


def _draw_legend(figure: Figure, course: TorquePlot) -> None:
    """Draw what the lines and the shade mean, in one row."""
    handles: list[Any] = [
        Line2D([], [], **_line(curve.label), label=course.labels[curve.label]) for curve in course.curves
    ]
    handles.append(Patch(color=SWING, label=course.labels["swing"]))
    figure.legend(
        handles=handles,
        loc="lower left",
        bbox_to_anchor=(TEXT_X - 0.008, LEGEND_Y),
        ncols=len(handles),
        fontsize=10.5,
        frameon=False,
        handlelength=1.1,
        columnspacing=0.9,
        handletextpad=0.4,
        borderpad=0.0,
        labelcolor=INK,
    )


def _draw_lines(figure: Figure, course: TorquePlot, lines: Sequence[str | Sequence[str]]) -> None:
    """Write lines of text, or a table whose lines but the first have the colours of their methods."""
    for row, line in enumerate(lines):
        y = LINE_Y - row * LINE_STEP
        if isinstance(line, str):
            figure.text(TEXT_X, y, line, color=INK)
            continue
        method, *texts = line
        look: dict[str, Any] = {"color": PALE, "fontsize": 10.5}
        if row:
            look = {"color": LOOKS[method].colour, "fontweight": "bold"}
        for column, text in enumerate([course.labels.get(method, method), *texts]):
            figure.text(COLUMN_X[column], y, text, ha="right" if column else "left", **look)


def _draw_scene(axis: Axes, robot: RobotDescription, view: Array, moment: Moment) -> None:
    """Draw the robot with what pushes it, the speed of time, and what the detector says."""
    draw_pushed(axis, robot, moment.q, moment.centre, view, point=moment.point, force=moment.force, felt=moment.felt)
    x, y = view[:2] @ moment.centre
    axis.set(xlim=(x + ROOM_M[0], x + ROOM_M[1]), ylim=(y + ROOM_M[2], y + ROOM_M[3]))
    axis.text(0.05, 0.035, f"{moment.now_s:+.2f} s".replace("-", "\N{MINUS SIGN}"), color=INK, transform=axis.transAxes)
    axis.text(0.95, 0.035, moment.speed, color=PALE, ha="right", transform=axis.transAxes)
    if moment.said:
        box = {"boxstyle": "round,pad=0.45", "facecolor": PUSH, "edgecolor": "none"}
        axis.text(
            0.5,
            0.94,
            moment.said,
            color="white",
            fontweight="bold",
            ha="center",
            va="center",
            transform=axis.transAxes,
            bbox=box,
            zorder=9,
        )


def _draw_torque(axis: Axes, moment: Moment, course: TorquePlot, drawn_s: float) -> None:
    """Draw the torque until a time, with swing shaded and a mark at the present."""
    first, last = np.searchsorted(course.time_s, (moment.ends_s[0], drawn_s))
    rows = slice(max(int(first) - 1, 0), int(last) + 1)
    time_s = course.time_s[rows]
    swing = course.swing.tolist()
    across = axis.get_xaxis_transform()
    axis.fill_between(course.time_s, 0, 1, where=swing, color=SWING, linewidth=0, transform=across, zorder=0)
    axis.axhline(0.0, color="0.75", linewidth=0.8, zorder=0.5)
    for curve in course.curves:
        if curve.std is not None:
            low = curve.values[rows] - curve.std[rows]
            high = curve.values[rows] + curve.std[rows]
            axis.fill_between(time_s, low, high, color=LOOKS[curve.label].colour, alpha=BAND_ALPHA, linewidth=0)
        axis.plot(time_s, curve.values[rows], **_line(curve.label))
    axis.axvline(moment.now_s, color=PALE, linewidth=0.9, zorder=1)
    axis.set(xlim=moment.ends_s, ylim=course.ends_nm, xlabel="time from contact [s]")
    axis.spines[["top", "right"]].set_visible(False)
    axis.tick_params(colors=INK, length=3)
    axis.xaxis.label.set_color(INK)
    axis.xaxis.set_major_formatter("{x:.1f}")
    axis.xaxis.set_major_locator(mpl.ticker.MultipleLocator(0.1 if moment.ends_s[1] - moment.ends_s[0] < 0.9 else 0.5))


def _line(label: str) -> dict[str, Any]:
    """Return how a curve looks: as in figures, wider, and without dashes, which would flicker as they move."""
    look = LOOKS[label]
    width = (look.width or 1.0) * WIDER
    return {"color": look.colour, "linewidth": width, "zorder": look.order}
