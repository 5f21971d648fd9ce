"""Figure 13: three collisions of a leg as pictures, with the force as an arrow."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from experiments.evaluation.figures.drawing.robot import draw_arrow, draw_robot, lowest, point_at, projection
from experiments.evaluation.figures.style import beside, entitle, save_figure
from experiments.evaluation.number.rows import read_detections
from experiments.plan.detection import Detections
from experiments.records.collisions import Collision
from experiments.settings.detection_tables import Figure13
from mobnet.core.columns import PUSH, named
from mobnet.core.errors import DataError, not_accepted
from mobnet.core.recording_file import read_sensed
from mobnet.core.store import read_array
from mobnet.core.style import styled
from mobnet.formats.parts import Looks
from mobnet.formats.robot import RobotTable
from mobnet.robot.description import RobotDescription, describe, dressed
from mobnet.settings.detection import Detection

COLUMNS = (
    "panel",
    "seed",
    "number",
    "time_s",
    "force_n",
    *(f"point_{a}_m" for a in "xyz"),
    *(f"force_{a}_n" for a in "xyz"),
)
HEIGHT_INCH = 2.2
VIEW = 55.0, 10.0  # azimuth and elevation of the eye [deg], from ahead and the robot's left
ARROW_M_N = 0.0035  # length of an arrow for each newton
ROOM_M = (-0.7, 0.7, -0.15, 0.95)  # of a panel, which shows the legs: right of the robot's base, above the ground
GROUND_M = 0.6  # from the robot's base to each edge of the ground that is drawn


@styled
def figure_13(
    settings: Figure13,
    detection: Detection,
    robot: RobotTable,
    looks: Looks | None,
    detections: Detections,
    recordings: Sequence[Path],
    figure_dir: Path,
) -> None:
    """Write Figure 13 as PDF, SVG, PNG and CSV: the first collision of each cell, when its force is largest."""
    description = dressed(describe(robot), looks)
    rows = []
    collisions = read_detections(detections[settings.level]["collisions"], "collisions")
    figure, axes = beside(len(settings.cells), HEIGHT_INCH)
    for k, (axis, cell) in enumerate(zip(axes, settings.cells, strict=True)):
        hit = first_of(collisions, detection.collisions, settings.leg, cell)
        rows.append((cell, hit.seed, hit.number, *_draw(axis, description, hit, recordings)))
        entitle(axis, k, f"{cell}, {hit.force_n:.0f} N")
    save_figure(figure, figure_dir / "figure_13", COLUMNS, rows)


def first_of(collisions: Sequence[Collision], scenario: str, leg: str, cell: str) -> Collision:
    """Return the first collision of a cell, `<link> <direction>`; a DataError says that there is none."""
    of_leg = [row for row in collisions if (row.scenario, row.leg) == (scenario, leg)]
    for row in of_leg:
        if f"{row.link} {row.direction}" == cell:
            return row
    cells = {f"{row.link} {row.direction}" for row in of_leg}
    raise DataError(not_accepted(f"collision of {leg} in {scenario}", cell, sorted(cells)))


def _draw(axis: Axes, robot: RobotDescription, hit: Collision, recordings: Sequence[Path]) -> tuple[float, ...]:
    """Draw a collision; return when [s] and how hard [N] it is shown, where it acts [m] and its force [N]."""
    stem = next(path for path in recordings if path.name == f"s{hit.seed}")
    forces, meta = read_array(stem, named(PUSH, ("force_x", "force_y", "force_z")))
    rate = float(meta["rate_hz"])
    rows = slice(round(hit.start_s * rate), round(hit.end_s * rate))
    row = rows.start + int(np.argmax(np.linalg.norm(forces[rows], axis=1)))
    q = read_sensed(stem, robot.layout).sensed.q[row].astype(np.float64)
    force = forces[row].astype(np.float64)
    q[:3] = 0.0
    q[2] = -lowest(robot, q)  # the sensed height drifts, and the supporting foot stands on the ground
    side = next(side for side, limb in robot.layout.legs.items() if limb == hit.leg)
    point = point_at(robot, q, f"{side}_{hit.link}_{hit.direction}")
    heading = np.rad2deg(np.arctan2(2 * (q[3] * q[6] + q[4] * q[5]), 1 - 2 * (q[5] ** 2 + q[6] ** 2)))
    view = projection(heading + VIEW[0], VIEW[1])
    draw_robot(axis, robot, q, view)
    (x, y, _), (from_x, from_y, _) = ((view @ place).tolist() for place in (point, point - ARROW_M_N * force))
    draw_arrow(axis, (from_x, from_y), (x, y))
    corners = GROUND_M * np.array([(-1.0, -1.0, 0.0), (-1.0, 1.0, 0.0), (1.0, 1.0, 0.0), (1.0, -1.0, 0.0)])
    axis.fill(*(corners @ view.T)[:, :2].T, color="0.9", linewidth=0.0, zorder=0)
    axis.set(xlim=ROOM_M[:2], ylim=ROOM_M[2:])
    return (row / rate, float(np.linalg.norm(force)), *point.tolist(), *force.tolist())
