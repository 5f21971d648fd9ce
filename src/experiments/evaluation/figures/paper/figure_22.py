"""Figure 22: walks into a tool cart and into the frame of a door as pictures, one that ends well and one that falls."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from experiments.evaluation.figures.drawing.robot import draw_scene, projection, solids_of
from experiments.evaluation.figures.drawing.solids import outline_of
from experiments.evaluation.figures.style import entitle, save_figure
from experiments.evaluation.measure.reaction.results import trials_of
from experiments.evaluation.number.frames import read_trials, rows_of
from experiments.evaluation.number.rows import Field
from experiments.plan.reactions import Reactions
from experiments.records.course import StoredCourse, read_course
from experiments.settings.reaction_tables import Figure22
from mobnet.core.arrays import Array
from mobnet.core.joints import JointLayout
from mobnet.core.style import PAGE_INCH, styled
from mobnet.formats.parts import Looks
from mobnet.formats.robot import RobotTable
from mobnet.robot.description import RobotDescription, describe, dressed
from mobnet.settings.data import Obstacle
from mobnet.settings.reaction import Reaction

COLUMNS = (
    "case",
    "moment",
    "time_s",
    *(f"base_{a}_m" for a in "xyz"),
    *(f"point_{a}_m" for a in "xyz"),
    *(f"force_{a}_n" for a in "xyz"),
    "robot",
    "fell",
)
LARGEST, END = "largest force", "end"  # moments that every walk has
PICTURE_INCH, TITLE_INCH, TEXT_INCH = 1.72, 0.22, 0.17  # height of a picture, of a row's title, and of the text below
ROOM_M = (-0.88, 0.88, -0.05, 1.75)  # of a panel: right of the base's first place, and above the ground
GHOST = {"facecolors": "0.88", "edgecolors": "none", "zorder": 1.0}  # of the robot at the first contact


@dataclass(frozen=True)
class ShownWalk:
    """A walk of a case with a robot: what is said of all of its kind, whether it ends in a fall, and its course."""

    title: str
    case: str
    level: str
    fell: bool
    course: StoredCourse

    @property
    def first(self) -> int:
        """The sample of the first contact, or the first one where nothing was touched."""
        return self.course.at("contact_s") or 0


@styled
def figure_22(
    settings: Figure22,
    robot: RobotTable,
    looks: Looks | None,
    obstacles: Mapping[str, Obstacle],
    reaction: Reaction,
    reactions: Reactions,
    courses: Reactions,
    figure_dir: Path,
) -> None:
    """Write Figure 22 as PDF, SVG, PNG and CSV: of each case a walk that ends without a fall, and one that falls.

    They are the first of their kind among the robots' first walks, whose courses there are; there may be none.
    """
    description = dressed(describe(robot), looks)
    trials = read_trials(reactions, settings.cases)
    shown: list[ShownWalk] = []
    for case in settings.cases:
        reacted = trials_of(trials, case, reaction.ours)
        shown += walks_of(case, reacted, [of[case] for of in courses.values()], description.layout)
    rows = list[list[Field]]()
    figure, grid = rows_of_pictures(len(shown), len(settings.moments_s) + 2)
    for k, (axes, walk) in enumerate(zip(grid, shown, strict=True)):
        case = walk.case
        view = projection(*settings.views_deg[case])
        moments = moments_of(walk.course, settings)
        for axis, (moment, at) in zip(axes, moments.items(), strict=True):
            draw_moment(axis, description, obstacles, walk, at, view)
            time_s = (at - walk.first) / walk.course.note["rate_hz"]
            axis.text(0.0, 0.0, said_of(walk, moment, at, time_s), transform=axis.transAxes, va="top")
            places = (walk.course.q[at][:3], walk.course.point[at], walk.course.force[at])
            rows.append([case, moment, time_s, *np.concatenate(places).tolist(), walk.level, int(walk.fell)])
        entitle(axes[0], k, walk.title)
    save_figure(figure, figure_dir / "figure_22", COLUMNS, rows)


def rows_of_pictures(rows: int, columns: int) -> tuple[Figure, Sequence[Sequence[Axes]]]:
    """Return a figure as wide as a page with rows of pictures, each with room for a title above and a text below."""
    row_inch = PICTURE_INCH + TITLE_INCH + TEXT_INCH
    high = rows * row_inch
    # Matplotlib's own layout would give a long title room in the first column alone.
    edges = {
        "left": 0.0,
        "right": 1.0,
        "top": 1.0 - TITLE_INCH / high,
        "bottom": TEXT_INCH / high,
        "hspace": (TITLE_INCH + TEXT_INCH) / PICTURE_INCH,
        "wspace": 0.0,
    }
    figure = Figure(figsize=(PAGE_INCH, high))
    return figure, figure.subplots(rows, columns, squeeze=False, gridspec_kw=edges).tolist()


def walks_of(case: str, trials: pd.DataFrame, stems: Sequence[Path], layout: JointLayout) -> Iterator[ShownWalk]:
    """Yield the first stored walk of a case that ends without a fall and the first that falls, where there are such.

    The trials are all of the case, of which each stored course is one.
    """
    fallen = int(trials["fell_s"].notna().sum())
    counts = {
        False: f"{len(trials) - fallen} of {len(trials)} walks end without a fall",
        True: f"{fallen} of {len(trials)} walks end in a fall",
    }
    courses = [read_course(stem, layout) for stem in stems]
    for fell, count in counts.items():
        ended = [course for course in courses if has_fallen(course, trials) == fell]
        for course in ended[:1]:
            level = course.note["level"]
            robot = level.replace("_", " ")
            yield ShownWalk(f"{case}: {count}; this one is that of {robot}", case, level, fell, course)


def has_fallen(course: StoredCourse, trials: pd.DataFrame) -> bool:
    """Return whether a stored walk ends in a fall."""
    trial = rows_of(trials, level=course.note["level"], seed=course.note["seed"])
    return bool(trial["fell_s"].notna().iloc[0])


def moments_of(course: StoredCourse, settings: Figure22) -> dict[str, int]:
    """Return what is shown of a walk -> its sample: the largest force and moments from the contact on, then the end."""
    first = course.at("contact_s") or 0
    last = len(course.q) - 1
    rate_hz = course.note["rate_hz"]
    shown = {f"{time_s:g} s": min(max(0, first + round(time_s * rate_hz)), last) for time_s in settings.moments_s}
    shown[LARGEST] = int(np.linalg.norm(course.force, axis=1).argmax())
    return {**dict(sorted(shown.items(), key=lambda item: item[1])), END: last}


def said_of(walk: ShownWalk, moment: str, at: int, time_s: float) -> str:
    """Return what is written below a picture: its time [s], the force that acts [N], and whether it is the end."""
    text = f"{time_s:.2f} s"
    if walk.course.point[at].any():
        text += f", {np.linalg.norm(walk.course.force[at]):.0f} N"
    return f"{text}, end" if moment == END else text


def draw_moment(
    axis: Axes,
    robot: RobotDescription,
    obstacles: Mapping[str, Obstacle],
    walk: ShownWalk,
    at: int,
    view: Array,
) -> None:
    """Draw a sample of a walk, and behind it the robot as it was at the first contact."""
    start = view @ walk.course.q[walk.first][:3]
    ghost = [outline_of(solid, view) for solid in solids_of(robot, walk.course.q[walk.first])]
    axis.add_collection(PolyCollection(ghost, **GHOST), autolim=False)
    draw_scene(axis, robot, obstacles, walk.course, at, view)
    # Hundreds of polygons of each robot make a file of megabytes: they are one picture in it.
    for drawn in axis.collections:
        drawn.set_rasterized(True)
    axis.set(xlim=(start[0] + ROOM_M[0], start[0] + ROOM_M[1]), ylim=ROOM_M[2:])
