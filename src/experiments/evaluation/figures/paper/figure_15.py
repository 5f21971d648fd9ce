"""Figure 15: the standard deviations that networks predict at three collisions, with their thresholds."""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from experiments.evaluation.figures.drawing.curves import mark_flag
from experiments.evaluation.figures.style import beside, entitle, legend, looks, save_figure
from experiments.evaluation.number.frames import records_of, rows_of
from experiments.evaluation.number.rows import read_detections
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
    courses: list[pd.DataFrame] = []
    for cell in settings.cells:
        courses.append(_course(settings, detection, layout, collisions, cell, recordings, estimates, thresholds))
    rows = pd.concat(courses, ignore_index=True)
    save_figure(draw_courses(rows, settings.joint), figure_dir / "figure_15", COLUMNS, records_of(rows, COLUMNS))


def _course(
    settings: Figure15,
    detection: Detection,
    layout: JointLayout,
    collisions: Sequence[Collision],
    cell: str,
    recordings: Sequence[Path],
    estimates: Mapping[str, Sequence[Path]],
    thresholds: Mapping[str, float],
) -> pd.DataFrame:
    """Return the first collision of a cell over time, method by method: `COLUMNS`."""
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
    shown = array[rows].astype(np.float64)
    course = pd.DataFrame(
        {
            "panel": cell,
            "time_s": (np.arange(len(array))[rows] - start) / rate,
            "force_n": np.linalg.norm(array[rows, :3], axis=1).astype(np.float64),
            "swing": shown[:, 3],
        }
    )
    parts: list[pd.DataFrame] = []
    for method in settings.detectors:
        std = read_array(estimates[method][place], [f"{STD}.{settings.joint}"])[0][rows, 0]
        parts.append(course.assign(method=method, std_nm=std.astype(np.float64), threshold_nm=thresholds[method]))
    return pd.concat(parts)


@styled
def draw_courses(rows: pd.DataFrame, joint: str) -> Figure:
    """Draw a panel for each collision: standard deviations, thresholds dotted, and the force behind them.

    The rows have columns `COLUMNS`.
    """
    titles = rows["panel"].unique()
    styles = looks(rows["method"].unique())
    figure, axes = beside(len(titles), HEIGHT_INCH, sharey=True)
    for k, (axis, title) in enumerate(zip(axes, titles, strict=True)):
        for method, course in rows_of(rows, panel=title).groupby("method", sort=False):
            look = styles[str(method)]
            axis.plot(course["time_s"], course["std_nm"], label=str(method), **look.line)
            threshold_nm = float(course["threshold_nm"].iloc[0])
            label = f"threshold of {method}"
            axis.axhline(threshold_nm, color=look.colour, linestyle=":", linewidth=0.9, label=label)
        # Time, force and swing are those of the collision, whatever the method.
        collision = rows_of(rows, panel=title, method=rows["method"].iloc[0])
        time_s = collision["time_s"].to_numpy()
        mark_flag(axis, "swing", time_s, collision["swing"].to_numpy())
        behind = axis.twinx()
        behind.fill_between(
            time_s, collision["force_n"].to_numpy(), color="0.75", linewidth=0.0, zorder=0, label="force"
        )
        # The force takes the lower half of each panel, by one scale in all of them.
        behind.set_ylim(0.0, 2.0 * float(rows["force_n"].max()))
        behind.spines["right"].set_visible(True)
        behind.set_ylabel("force [N]" if axis is axes[-1] else "")
        behind.tick_params(labelright=axis is axes[-1])
        # An axis that is made later is drawn above: curves must lie before the force.
        axis.set_zorder(behind.get_zorder() + 1)
        axis.patch.set_visible(False)
        low, high = (float(time_s[end]) for end in (0, -1))
        axis.set(xlabel="time from the contact [s]", xlim=(low, high))
        entitle(axis, k, str(title))
    axes[0].set_ylabel(f"sigma of {joint} [N m]")
    axes[0].set_ylim(bottom=0.0)
    legend(figure, figure.axes)
    return figure
