"""The pictures that explain: drawings of the method and of the robot, and the film of a push with its still."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from experiments.evaluation.figures.drawing.method_and_robot import draw_all
from experiments.evaluation.figures.drawing.push_film import push_film
from experiments.plan.detection import Detections
from experiments.plan.runs import Run
from experiments.settings.measures import Peaks
from experiments.settings.pages import Drawings, PushFilm, Story
from mobnet.core.joints import JointLayout
from mobnet.formats.parts import Looks
from mobnet.formats.robot import RobotTable
from mobnet.settings.data import Push


def pictures(
    drawings: Drawings,
    film: PushFilm,
    story: Story,
    pushes: Mapping[str, Push],
    peaks: Peaks,
    robot: RobotTable,
    looks: Looks | None,
    layout: JointLayout,
    runs: Sequence[Run],
    detections: Detections,
    figure_dir: Path,
) -> None:
    """Write `method` and `robot` as PDF, SVG, PNG and CSV, and `push` as WebP, GIF, PNG and CSV, into a folder.

    Without runs of the story there is no film.
    """
    draw_all(drawings, pushes[story.push], robot, looks, layout, figure_dir)
    if runs:
        push_film(film, story, peaks, robot, looks, layout, runs, detections, figure_dir / "push.webp")
