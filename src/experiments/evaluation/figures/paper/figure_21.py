"""Figure 21: footsteps of compliant stepping, from above, in a walk into an obstacle at the foot."""

from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from experiments.evaluation.figures.drawing.robot import PAD, draw_arrow, solid_of
from experiments.evaluation.figures.drawing.solids import outline_of
from experiments.evaluation.figures.style import legend, save_figure
from experiments.settings.reaction_tables import Figure21
from mobnet.control.kinematics import empty_pose, tree_of, update
from mobnet.core.arrays import Array
from mobnet.core.course import StoredCourse, read_course
from mobnet.core.joints import N_VIRTUAL
from mobnet.core.style import COLUMN_INCH, styled
from mobnet.robot.description import SIDES, RobotDescription, describe
from mobnet.settings.data import Obstacle
from mobnet.settings.robot import RobotTable

COLUMNS = ("foot", "step", "reacting", "time_s", "x_m", "y_m", "yaw_rad")
HEIGHT_INCH = 2.9
IN_THE_AIR = 0.5  # of a flag
COLOURS = {"left": "#0072B2", "right": "#009E73"}
Step = tuple[str, int, Array]  # side, sample at which the foot stands, its place x, y and yaw (3,) [m, m, rad]
ARROW_M = 0.25
FROM_ABOVE = np.eye(3)  # the axes of the picture
PLACES = 6  # of numbers along a sole


@styled
def figure_21(
    settings: Figure21,
    robot: RobotTable,
    obstacles: Mapping[str, Obstacle],
    courses: Mapping[str, Path],
    figure_dir: Path,
) -> None:
    """Write Figure 21 as PDF, SVG, PNG and CSV: where the feet stood in the first walk of a case, before and after."""
    description = describe(robot)
    course = read_course(courses[settings.case], description.layout)
    reacted = course.at("reacted_s")
    rate_hz = course.note["rate_hz"]
    steps = list(steps_of(description, course))
    rows = [
        (side, number, int(reacted is not None and k > reacted), k / rate_hz, *place.tolist())
        for number, (side, k, place) in enumerate(steps)
    ]
    save_figure(_draw(description, obstacles, course, steps), figure_dir / "figure_21", COLUMNS, rows)


def steps_of(robot: RobotDescription, course: StoredCourse) -> Iterator[Step]:
    """Yield where the feet stand at the beginning, and each foot again after it has landed."""
    tree = tree_of(robot, 1.0)
    pose = empty_pose(tree)
    names = [body.name for body in robot.bodies]
    still = np.zeros(N_VIRTUAL + len(tree.body_of_joint))
    in_air = course.swing >= IN_THE_AIR
    landed = [(0, k) for k in range(len(SIDES))]
    for k in range(len(SIDES)):
        last_in_air = np.flatnonzero(in_air[:-1, k] & ~in_air[1:, k])
        landed += [(int(at) + 1, k) for at in last_in_air]
    for at, k in sorted(landed):
        update(tree, course.q[at], still, 0.0, pose)
        body = names.index(robot.feet[SIDES[k]].body)
        rotation = pose.rotation[body]
        place = pose.position[body]
        yield SIDES[k], at, np.array([place[0], place[1], np.arctan2(rotation[1, 0], rotation[0, 0])])


def sole_corners(robot: RobotDescription) -> Array:
    """Return the corners of a sole (4, 2) [m], from above, in the foot's axes."""
    assert robot.sole is not None  # it walks
    (x, y, _) = robot.sole.box_centre
    (length, width, _) = robot.sole.box_half
    signs = np.array([(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)])
    return np.array([x, y]) + signs * (length, width)


@styled
def _draw(
    robot: RobotDescription, obstacles: Mapping[str, Obstacle], course: StoredCourse, steps: list[Step]
) -> Figure:
    """Draw soles, obstacles, the way of the base, and the force until the reaction."""
    figure = Figure(figsize=(COLUMN_INCH, HEIGHT_INCH), layout="constrained")
    axis: Axes = figure.subplots()
    reacted = course.at("reacted_s")
    first = course.at("contact_s")
    corners = sole_corners(robot)
    count = 0
    for side, k, place in steps:
        c = np.cos(place[2])
        n = np.sin(place[2])
        outline = corners @ np.array([[c, n], [-n, c]]) + place[:2]
        is_reacting = reacted is not None and k > reacted
        count += is_reacting
        sole = Polygon(
            outline,
            closed=True,
            edgecolor=COLOURS[side],
            facecolor=COLOURS[side] if is_reacting else "none",
            alpha=0.45 if is_reacting else 1.0,
            linewidth=0.8,
            label=f"{side} sole",
        )
        axis.add_patch(sole)
        if is_reacting:
            heel = outline[[1, 2]].mean(axis=0)
            toe = outline[[0, 3]].mean(axis=0)
            # Soles that lie on one another have their numbers beside each other.
            along = (count % PLACES + 0.5) / PLACES
            axis.annotate(str(count), heel + along * (toe - heel), ha="center", va="center", fontsize=7)
    for name, at in course.note["obstacles"].items():
        for part in obstacles[name].parts:
            outline = outline_of(solid_of(part, at), FROM_ABOVE)
            axis.add_patch(Polygon(outline, closed=True, facecolor=PAD, edgecolor="0.25", linewidth=0.6, zorder=0))
    end = len(course.q) if reacted is None else reacted
    axis.plot(*course.q[:end, :2].T, color="0.5", linewidth=0.8, label="pelvis until the reaction")
    axis.plot(*course.q[end:, :2].T, color="0.5", linewidth=0.8, linestyle="--", label="pelvis after it")
    if first is not None and reacted is not None and reacted > first:
        push = course.force[first : reacted + 1, :2].sum(axis=0)
        start = course.q[reacted, :2]
        way = ARROW_M * push / np.linalg.norm(push)
        draw_arrow(axis, tuple(start.tolist()), tuple((start + way).tolist()))
    axis.set_aspect("equal")
    axis.autoscale_view()
    axis.set(xlabel="x [m]", ylabel="y [m]")
    legend(figure, [axis])
    return figure
