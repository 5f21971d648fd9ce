"""Figure 21: where and when each foot is on the ground in a walk into an obstacle, and after the reaction."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from experiments.evaluation.figures.drawing.robot import solid_of
from experiments.evaluation.figures.drawing.solids import outline_of
from experiments.evaluation.figures.style import entitle, legend, save_figure
from experiments.records.course import StoredCourse, read_course
from experiments.settings.reaction_tables import Figure21
from mobnet.control.kinematics import empty_pose, tree_of, update
from mobnet.core.arrays import Array
from mobnet.core.joints import N_VIRTUAL
from mobnet.core.style import COLUMN_INCH, styled
from mobnet.formats.robot import RobotTable
from mobnet.robot.description import SIDES, RobotDescription, describe
from mobnet.settings.data import Obstacle

COLUMNS = ("foot", "step", "reacting", "time_s", "x_m", "y_m", "yaw_rad", "until_s")
HEIGHT_INCH = 2.9
IN_THE_AIR = 0.5  # of a flag
COLOURS = {"left": "#0072B2", "right": "#009E73"}
OBSTACLE: Mapping[str, Any] = {"color": "#D55E00", "linewidth": 1.4, "label": "front of the obstacle"}
PELVIS: Mapping[str, Any] = {"color": "0.5", "linewidth": 0.9, "label": "pelvis"}
MOMENTS: Mapping[str, Mapping[str, Any]] = {  # times of the trial -> how they are drawn
    "contact_s": {"color": "#D55E00", "linewidth": 0.8, "linestyle": (0, (1, 1)), "label": "first contact"},
    "reacted_s": {"color": "black", "linewidth": 0.8, "linestyle": (0, (3, 2)), "label": "reaction"},
}
SOLES: Mapping[bool, Mapping[str, Any]] = {  # whether they landed after the reaction
    False: {"facecolor": "white", "alpha": 1.0, "label": "sole on the ground"},
    True: {"label": "after the reaction"},
}
FROM_ABOVE = np.eye(3)  # the axes of the picture
MARGIN = 0.04  # of the axis of x, above and below all that is drawn [share of it]


@dataclass(frozen=True)
class DrawnStance:
    """A foot on the ground.

    Attributes:
        side: of the foot.
        start: sample at which it has landed, or the first one.
        end: sample at which it leaves the ground, or the last one.
        place: x, y and yaw of the foot at the start (3,) [m, m, rad].
        outline: corners of its sole, from above (4, 2) [m].
        number: from 1 on of those that begin after the reaction, 0 of others.
    """

    side: str
    start: int
    end: int
    place: Array
    outline: Array
    number: int


@styled
def figure_21(
    settings: Figure21,
    robot: RobotTable,
    obstacles: Mapping[str, Obstacle],
    courses: Mapping[str, Path],
    figure_dir: Path,
) -> None:
    """Write Figure 21 as PDF, SVG, PNG and CSV: where and when each foot is on the ground in a case's first walk."""
    description = describe(robot)
    course = read_course(courses[settings.case], description.layout)
    rate_hz = course.note["rate_hz"]
    stances = list(stances_of(description, course))
    rows = [
        (stance.side, k, int(stance.number > 0), stance.start / rate_hz, *stance.place.tolist(), stance.end / rate_hz)
        for k, stance in enumerate(stances)
    ]
    figure = draw_strips(course, stances, obstacles)
    save_figure(figure, figure_dir / "figure_21", COLUMNS, rows)


def stances_of(robot: RobotDescription, course: StoredCourse) -> Iterator[DrawnStance]:
    """Yield each time that a foot is on the ground, in the order in which they begin, the left one first."""
    tree = tree_of(robot, 1.0)
    pose = empty_pose(tree)
    names = [body.name for body in robot.bodies]
    still = np.zeros(N_VIRTUAL + len(tree.body_of_joint))
    reacted = course.at("reacted_s")
    last = len(course.q) - 1
    contacts: list[tuple[int, int, int]] = []
    for k in range(len(SIDES)):
        in_air = course.swing[:, k] >= IN_THE_AIR
        landed = [0, *(np.flatnonzero(in_air[:-1] & ~in_air[1:]) + 1).tolist()]
        for start in landed:
            lifted = np.flatnonzero(in_air[start:])
            contacts.append((start, k, start + int(lifted[0]) if lifted.size else last))
    count = 0
    for start, k, end in sorted(contacts):
        update(tree, course.q[start], still, 0.0, pose)
        body = names.index(robot.feet[SIDES[k]].body)
        rotation = pose.rotation[body]
        yaw = np.arctan2(rotation[1, 0], rotation[0, 0])
        place = np.array([*pose.position[body][:2], yaw])
        count += reacted is not None and start > reacted
        yield DrawnStance(SIDES[k], start, end, place, outline_at(robot, place), count)


def sole_corners(robot: RobotDescription) -> Array:
    """Return the corners of a sole (4, 2) [m], from above, in the foot's axes."""
    assert robot.sole is not None  # it walks
    (x, y, _) = robot.sole.box_centre
    (length, width, _) = robot.sole.box_half
    signs = np.array([(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)])
    return np.array([x, y]) + signs * (length, width)


def outline_at(robot: RobotDescription, place: Array) -> Array:
    """Return the corners of a sole (4, 2) [m] of a foot at x, y and yaw (3,) [m, m, rad]."""
    c = np.cos(place[2])
    n = np.sin(place[2])
    return sole_corners(robot) @ np.array([[c, n], [-n, c]]) + place[:2]


def obstacle_outlines(course: StoredCourse, obstacles: Mapping[str, Obstacle]) -> list[Array]:
    """Return the outline of each part of the obstacles of a walk, from above (n, 2) [m]."""
    outlines: list[Array] = []
    for name, at in course.note["obstacles"].items():
        outlines += [outline_of(solid_of(part, at), FROM_ABOVE) for part in obstacles[name].parts]
    return outlines


@styled
def draw_strips(course: StoredCourse, stances: Sequence[DrawnStance], obstacles: Mapping[str, Obstacle]) -> Figure:
    """Draw a strip for each foot: x [m] of its sole while it is on the ground, over time [s].

    An obstacle is a line where it is in the way of the foot, and the base is a line, too.
    """
    figure = Figure(figsize=(COLUMN_INCH, HEIGHT_INCH), layout="constrained")
    axes: list[Axes] = figure.subplots(len(SIDES), 1, sharex=True, sharey=True).tolist()
    rate_hz = course.note["rate_hz"]
    times = np.arange(len(course.q)) / rate_hz
    outlines = obstacle_outlines(course, obstacles)
    for k, (axis, side) in enumerate(zip(axes, SIDES, strict=True)):
        steps = [stance for stance in stances if stance.side == side]
        for stance in steps:
            _sole(axis, stance, rate_hz)
        for outline in outlines:
            if any(is_beside(outline, stance.outline) for stance in steps):
                axis.axhline(outline[:, 0].min(), **OBSTACLE)
        axis.plot(times, course.q[:, 0], **PELVIS)
        for name, look in MOMENTS.items():
            if (at := course.at(name)) is not None:
                axis.axvline(at / rate_hz, **look)
        entitle(axis, k, f"{side} foot")
        axis.set_ylabel("x [m]")
    axes[-1].set(xlabel="time [s]", xlim=(0.0, times[-1]))
    axes[0].margins(y=MARGIN)
    legend(figure, axes, 3)
    return figure


def is_beside(outline: Array, other: Array) -> bool:
    """Return whether two outlines (n, 2) [m] lie side by side across the way, so that one is in the other's way."""
    return bool(outline[:, 1].min() < other[:, 1].max() and other[:, 1].min() < outline[:, 1].max())


def _sole(axis: Axes, stance: DrawnStance, rate_hz: float) -> None:
    """Draw from heel to toe [m] and over its time [s] a sole on the ground, with its number after the reaction."""
    heel = stance.outline[:, 0].min()
    toe = stance.outline[:, 0].max()
    start = stance.start / rate_hz
    lasting = (stance.end - stance.start) / rate_hz
    colour = COLOURS[stance.side]
    look = {"facecolor": colour, "alpha": 0.5, **SOLES[stance.number > 0]}
    axis.add_patch(Rectangle((start, heel), lasting, toe - heel, edgecolor=colour, linewidth=0.8, **look))
    if stance.number:
        at = (start + lasting / 2, toe)
        axis.annotate(
            str(stance.number), at, (0.0, -2.0), textcoords="offset points", ha="center", va="top", fontsize=7
        )
