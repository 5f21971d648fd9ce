"""Films of walks into obstacles: the robot, and below it what it estimates, what is true, and what it says."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from experiments.evaluation.figures.drawing.robot import FORCE, draw_scene, projection
from experiments.records.course import ESTIMATED, StoredCourse, read_course
from experiments.settings.reaction_tables import Films
from mobnet.core.arrays import Array
from mobnet.core.columns import EXTERNAL, STD
from mobnet.core.store import read_array
from mobnet.core.style import styled
from mobnet.formats.parts import Looks
from mobnet.formats.robot import RobotTable
from mobnet.robot.description import RobotDescription, describe, dressed
from mobnet.settings.data import Obstacle
from mobnet.simulation.clip import save_clip
from mobnet.simulation.render import Pixels

SIZE_INCH = (4.8, 6.4)
DPI = 100
HEIGHTS = (3.2, 1.0, 1.0, 0.35)  # of the panels: robot, force, torque, what the robot says
ROOM_M = (-1.0, 1.0, -0.1, 1.85)  # right of the base, and above the ground


@dataclass(frozen=True)
class FilmCurves:
    """What scrolls below the robot: times from the first contact on [s], and signals over them (T,).

    Attributes:
        time_s: from the first contact on [s].
        force: size of the obstacle's force [N].
        estimated: external torque of the joint [N m].
        std: its standard deviation [N m].
        true: the true one [N m].
        reacted_s: when the robot reacts [s]; None if it does not.
    """

    time_s: Array
    force: Array
    estimated: Array
    std: Array
    true: Array
    reacted_s: float | None


def films(
    settings: Films,
    robot: RobotTable,
    looks: Looks | None,
    obstacles: Mapping[str, Obstacle],
    courses: Mapping[str, Path],
    outs: Mapping[str, Path],
) -> None:
    """Write a film of the first walk of each case; its ending says of which kind."""
    description = dressed(describe(robot), looks)
    for case, out in outs.items():
        course = read_course(courses[case], description.layout)
        curves = read_curves(courses[case], course, settings.joints[case])
        seen = frames(settings, description, obstacles, course, curves, case)
        save_clip(seen, settings.frames_hz, out)


def read_curves(stem: Path, course: StoredCourse, joint: str) -> FilmCurves:
    """Read what is shown of a joint in a course."""
    array, note = read_array(stem, [f"{signal}.{joint}" for signal in (ESTIMATED, STD, EXTERNAL)])
    first = course.at("contact_s") or 0
    rate_hz = note["rate_hz"]
    reacted = course.at("reacted_s")
    times = (np.arange(len(array)) - first) / rate_hz
    since = None if reacted is None else (reacted - first) / rate_hz
    estimated, std, true = array.T.astype(np.float64)
    return FilmCurves(times, np.linalg.norm(course.force, axis=1), estimated, std, true, since)


@styled
def frames(
    settings: Films,
    robot: RobotDescription,
    obstacles: Mapping[str, Obstacle],
    course: StoredCourse,
    curves: FilmCurves,
    case: str,
) -> Iterator[Pixels]:
    """Yield the frames of a film (height, width, 3)."""
    figure = Figure(figsize=SIZE_INCH, dpi=DPI)
    canvas = FigureCanvasAgg(figure)
    axes: list[Axes] = figure.subplots(len(HEIGHTS), 1, height_ratios=HEIGHTS).tolist()
    figure.subplots_adjust(left=0.17, right=0.97, top=0.99, bottom=0.07, hspace=0.25)
    view = projection(*settings.views_deg[case])
    step = 1.0 / (settings.frames_hz * settings.slower)
    for time_s in np.arange(*settings.shown_s, step):
        k = int(np.searchsorted(curves.time_s, time_s))
        # The course may end before the time that a film shows.
        if k >= len(course.q):
            return
        for axis in axes:
            axis.clear()
        # The picture goes along with the robot.
        centre = float((view @ course.q[k][:3])[0])
        draw_scene(axes[0], robot, obstacles, course, k, view)
        axes[0].set(xlim=(centre + ROOM_M[0], centre + ROOM_M[1]), ylim=ROOM_M[2:])
        draw_curves(axes[1:], curves, settings, case, k)
        canvas.draw()
        yield np.asarray(canvas.buffer_rgba())[..., :3].copy()


def draw_curves(axes: Sequence[Axes], curves: FilmCurves, settings: Films, case: str, k: int) -> None:
    """Draw the force, the torque of the joint, and contact and reaction, until sample k."""
    now = curves.time_s[k]
    shown = slice(max(0, int(np.searchsorted(curves.time_s, now - settings.history_s))), k + 1)
    times = curves.time_s[shown]
    force = axes[0]
    torque = axes[1]
    force.plot(times, curves.force[shown], color=FORCE)
    force.set(ylabel="force [N]", ylim=(0.0, 1.05 * max(curves.force.max(), 1.0)))
    estimated = curves.estimated[shown]
    std = curves.std[shown]
    torque.fill_between(times, estimated - std, estimated + std, color="#0072B2", alpha=0.25, linewidth=0)
    torque.plot(times, estimated, color="#0072B2", label="estimate, one sigma")
    torque.plot(times, curves.true[shown], color="black", linewidth=0.7, label="truth")
    # Scales are those of the whole walk: they must not jump while curves scroll.
    both = np.concatenate([curves.estimated, curves.true])
    torque.set(ylabel=f"{settings.joints[case]} [N m]", ylim=(both.min() - 1.0, both.max() + 1.0))
    torque.legend(loc="upper left", ncols=2, frameon=False)
    bars = {"touched": curves.force[shown] > 0.0}
    if curves.reacted_s is not None:
        bars["reacts"] = times >= curves.reacted_s
    for row, (name, on) in enumerate(bars.items()):
        axes[2].fill_between(
            times, row, row + 0.8, where=on, color=FORCE if name == "touched" else "#0072B2", linewidth=0
        )
    axes[2].set(yticks=[0.4, 1.4], yticklabels=["touched", "reacts"], ylim=(0.0, 1.8), xlabel="time from contact [s]")
    for axis in axes:
        axis.set_xlim(now - settings.history_s, now)
