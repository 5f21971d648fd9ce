"""Figure 22: walks into a tool cart and into the frame of a door as pictures, from the contact to the stop."""

from collections.abc import Mapping
from pathlib import Path

from matplotlib.figure import Figure

from experiments.evaluation.figures.drawing.robot import draw_scene, projection
from experiments.evaluation.figures.style import entitle, save_figure
from experiments.evaluation.number.rows import Field
from experiments.settings.reaction_tables import Figure22
from mobnet.core.course import StoredCourse, read_course
from mobnet.core.style import PAGE_INCH, styled
from mobnet.robot.description import describe, dressed
from mobnet.settings.data import Obstacle
from mobnet.settings.parts import Looks
from mobnet.settings.robot import RobotTable

COLUMNS = (
    "case",
    "moment",
    "time_s",
    *(f"base_{a}_m" for a in "xyz"),
    *(f"point_{a}_m" for a in "xyz"),
    *(f"force_{a}_n" for a in "xyz"),
)
ROW_INCH = 2.1
ROOM_M = (-0.75, 0.75, -0.1, 1.9)  # of a panel: right of the base's first place, and above the ground


@styled
def figure_22(
    settings: Figure22,
    robot: RobotTable,
    looks: Looks | None,
    obstacles: Mapping[str, Obstacle],
    courses: Mapping[str, Path],
    figure_dir: Path,
) -> None:
    """Write Figure 22 as PDF, SVG, PNG and CSV: the first walk of each case before, at and after the contact."""
    description = dressed(describe(robot), looks)
    rows = list[list[Field]]()
    walks = {case: read_course(courses[case], description.layout) for case in settings.cases}
    figure = Figure(figsize=(PAGE_INCH, ROW_INCH * len(walks)), layout="constrained")
    grid = figure.subplots(len(walks), len(settings.moments_s) + 1, squeeze=False)
    for row, (case, course) in enumerate(walks.items()):
        first = course.at("contact_s") or 0
        view = projection(*settings.views_deg[case])
        start = view @ course.q[first][:3]
        for column, (axis, (moment, k)) in enumerate(zip(grid[row], moments_of(course, settings).items(), strict=True)):
            draw_scene(axis, description, obstacles, course, k, view)
            axis.set(xlim=(start[0] + ROOM_M[0], start[0] + ROOM_M[1]), ylim=ROOM_M[2:])
            entitle(axis, row * grid.shape[1] + column, f"{case}, {moment}")
            time_s = (k - first) / course.note["rate_hz"]
            rows.append([case, moment, time_s, *course.q[k][:3], *course.point[k], *course.force[k]])
    save_figure(figure, figure_dir / "figure_22", COLUMNS, rows)


def moments_of(course: StoredCourse, settings: Figure22) -> dict[str, int]:
    """Return what is shown of a walk -> its sample: moments from the first contact on, and the end."""
    first = course.at("contact_s") or 0
    last = len(course.q) - 1
    rate_hz = course.note["rate_hz"]
    shown = {f"{time_s:g} s": min(max(0, first + round(time_s * rate_hz)), last) for time_s in settings.moments_s}
    return {**shown, "end": last}
