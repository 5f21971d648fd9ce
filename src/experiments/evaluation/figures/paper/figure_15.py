"""Figure 15: the standard deviations that networks predict at three collisions, with their thresholds."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from experiments.evaluation.figures.drawing.curves import mark_flag
from experiments.evaluation.figures.style import beside, entitle, legend, looks, save_figure
from experiments.evaluation.number.rows import Field, read_detections
from experiments.plan.detection import Detections
from experiments.records.collisions import Collision
from experiments.settings.detection_tables import Figure15
from mobnet.core.columns import PUSH, STD, SWING, foot_of, named
from mobnet.core.detections import Threshold
from mobnet.core.joints import JointLayout
from mobnet.core.store import read_array
from mobnet.core.style import styled
from mobnet.settings.detection import Detection

COLUMNS = ("panel", "method", "time_s", "std_nm", "threshold_nm", "force_n", "swing")
HEIGHT_INCH = 2.3


@dataclass(frozen=True)
class CollisionCourse:
    """A collision over time (n,) [s] from its beginning: standard deviations (n,) and thresholds [N m] by method."""

    title: str
    time: np.ndarray
    stds: Mapping[str, np.ndarray]
    thresholds: Mapping[str, float]
    force: np.ndarray
    swing: np.ndarray


def figure_15(
    settings: Figure15,
    detection: Detection,
    layout: JointLayout,
    detections: Detections,
    recordings: Sequence[Path],
    estimates: Mapping[str, Sequence[Path]],
    figure_dir: Path,
) -> None:
    """Write Figure 15 as PDF, SVG, PNG and CSV: the first collision of each cell."""
    files = detections[settings.level]
    collisions: list[Collision] = read_detections(files["collisions"], "collisions")
    of_phase: list[Threshold] = read_detections(files["thresholds"], "thresholds")
    asked = settings.leg, f"{STD}.{settings.joint}", settings.kind, 1
    by_detector = {row.detector: row.value for row in of_phase if (row.leg, row.signal, row.kind, row.phase) == asked}
    thresholds = {method: by_detector[name] for method, name in settings.detectors.items()}
    courses = [
        _course(settings, detection, layout, collisions, cell, recordings, estimates, thresholds)
        for cell in settings.cells
    ]
    rows: list[tuple[Field, ...]] = []
    for course in courses:
        for method, std in course.stds.items():
            threshold = [course.thresholds[method]] * len(std)
            for numbers in zip(course.time, std, threshold, course.force, course.swing, strict=True):
                rows.append((course.title, method, *map(float, numbers)))
    save_figure(draw_courses(courses, settings.joint), figure_dir / "figure_15", COLUMNS, rows)


def _course(
    settings: Figure15,
    detection: Detection,
    layout: JointLayout,
    collisions: Sequence[Collision],
    cell: str,
    recordings: Sequence[Path],
    estimates: Mapping[str, Sequence[Path]],
    thresholds: Mapping[str, float],
) -> CollisionCourse:
    """Return the first collision of a cell over time."""
    hit = next(
        row
        for row in collisions
        if (row.scenario, row.leg) == (detection.collisions, settings.leg) and f"{row.link} {row.direction}" == cell
    )
    place = next(k for k, path in enumerate(recordings) if path.name == f"s{hit.seed}")
    names = [*named(PUSH, ("force_x", "force_y", "force_z")), f"{SWING}.{foot_of(layout, settings.joint)}"]
    array, meta = read_array(recordings[place], names)
    rate = float(meta["rate_hz"])
    start = round(hit.start_s * meta["rate_hz"])
    rows = slice(max(start - round(settings.before_s * rate), 0), start + round(settings.after_s * rate))
    stds = {
        method: read_array(estimates[method][place], [f"{STD}.{settings.joint}"])[0][rows, 0]
        for method in settings.detectors
    }
    time = (np.arange(len(array))[rows] - start) / rate
    return CollisionCourse(cell, time, stds, thresholds, np.linalg.norm(array[rows, :3], axis=1), array[rows, 3])


@styled
def draw_courses(courses: Sequence[CollisionCourse], joint: str) -> Figure:
    """Draw a panel for each collision: standard deviations, thresholds dotted, and the force behind them."""
    methods = list(courses[0].stds)
    styles = looks(methods)
    figure, axes = beside(len(courses), HEIGHT_INCH, sharey=True)
    for k, (axis, course) in enumerate(zip(axes, courses, strict=True)):
        for method in methods:
            axis.plot(course.time, course.stds[method], label=method, **styles[method].line)
            axis.axhline(
                course.thresholds[method],
                color=styles[method].colour,
                linestyle=":",
                linewidth=0.9,
                label=f"threshold of {method}",
            )
        mark_flag(axis, "swing", course.time, course.swing)
        behind = axis.twinx()
        behind.fill_between(course.time, course.force, color="0.75", linewidth=0.0, zorder=0, label="force")
        # The force takes the lower half of each panel, by one scale in all of them.
        behind.set_ylim(0.0, 2.0 * max(float(each.force.max()) for each in courses))
        behind.spines["right"].set_visible(True)
        behind.set_ylabel("force [N]" if axis is axes[-1] else "")
        behind.tick_params(labelright=axis is axes[-1])
        # An axis that is made later is drawn above: curves must lie before the force.
        axis.set_zorder(behind.get_zorder() + 1)
        axis.patch.set_visible(False)
        low, high = (float(course.time[end]) for end in (0, -1))
        axis.set(xlabel="time from the contact [s]", xlim=(low, high))
        entitle(axis, k, course.title)
    axes[0].set_ylabel(f"sigma of {joint} [N m]")
    axes[0].set_ylim(bottom=0.0)
    legend(figure, figure.axes)
    return figure
