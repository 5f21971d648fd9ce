"""Made-up walks into obstacles: contacts, alarms and falls as asked."""

from collections.abc import Sequence
from dataclasses import astuple, replace
from pathlib import Path

import numpy as np

from experiments.evaluation.number.rows import write_csv
from experiments.records.course import course_columns
from experiments.records.reactions import NONE, TRIALS, Trial
from mobnet.core.joints import JointLayout
from mobnet.core.store import write_array

HIT = Trial(
    case="foot", level="robot_1", seed=240, detector="MOB-Net-pushed-ratio", rule="reaction", wait_s=0.0,
    wrench="estimated", feed_forward=0.0, walked_s=4.0, velocity_rmse_m_s=0.003, tracking_rmse_rad=0.01, power_w=200.0,
    contact_s=4.0, in_swing=1, alarm_s=4.01, limb="LL", reacted_s=4.01, angle_deg=10.0, base_angle_deg=40.0,
    first_peak_n=200.0, first_impulse_ns=8.0, peak_n=220.0, impulse_ns=9.0, contacts=2, fell_s=None, stopped=1,
)  # fmt: skip
EARLY = replace(
    HIT, contact_s=None, in_swing=None, alarm_s=2.0, reacted_s=2.0, angle_deg=None, base_angle_deg=None,
    first_peak_n=None, first_impulse_ns=None, peak_n=None, impulse_ns=None, contacts=0,
)  # fmt: skip
LEANS = replace(
    HIT, detector=NONE, rule="", alarm_s=None, limb="", reacted_s=None, angle_deg=None, base_angle_deg=None,
    first_peak_n=900.0, impulse_ns=300.0, peak_n=1200.0, fell_s=6.5, stopped=0,
)  # fmt: skip
FREE = replace(
    EARLY, case="free", alarm_s=None, limb="", reacted_s=None, walked_s=60.0, stopped=0,
)  # fmt: skip
FORCE_N = 150.0


def write_trials(folder: Path, rows: Sequence[Trial]) -> dict[str, dict[str, Path]]:
    """Write trials into a file of each robot and case; return them as rules hand them on."""
    levels, cases = (dict.fromkeys(getattr(row, name) for row in rows) for name in ("level", "case"))
    found = {level: {case: folder / level / f"{case}.csv" for case in cases} for level in levels}
    for level, files in found.items():
        for case, path in files.items():
            own = [astuple(row) for row in rows if (row.level, row.case) == (level, case)]
            write_csv(path, TRIALS, own)
    return found


def write_made_course(stem: Path, layout: JointLayout, reacted_s: float | None, level: str = HIT.level) -> Path:
    """Write a course of a second, that of `HIT` with a robot.

    The block pushes from 0.5 to 0.6 s, and the left foot lands at 0.7 s.
    """
    columns = course_columns(layout, layout.names)
    names, array = [name for name, *_ in columns], np.zeros((1000, len(columns)), np.float32)
    array[500:600, names.index("obstacle.force_x")] = -FORCE_N
    array[500:600, names.index("obstacle.point_z")] = 0.1
    array[:, names.index("q.quat_w")], array[:, names.index("true_base_z")] = 1.0, 0.9
    array[:, [name.startswith("std.") for name in names]] = 1.0
    array[300:700, names.index("swing.left_foot")] = 1.0
    note = {"rate_hz": 1000.0, "contact_s": 0.5, "reacted_s": reacted_s, "obstacles": {"foot_block": [0.6, 0.0, 0.0]},
            "level": level, "seed": HIT.seed}  # fmt: skip
    write_array(stem, array, columns, note, [(0, len(array))])
    return stem
