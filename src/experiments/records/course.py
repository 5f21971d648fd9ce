"""The course of a walk with an estimator in its loop, as it is stored: what is sensed, estimated and touched."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import Any

from mobnet.core.arrays import Array
from mobnet.core.columns import STD, Column, recording_columns, torque_columns
from mobnet.core.joints import JointLayout
from mobnet.core.store import read_array

ESTIMATED = "estimated"  # external torque that is estimated, beside a true one
FORCE = ("obstacle.force", "N")
POINT = ("obstacle.point", "m")
BASE = ("true_base", "m")


def course_columns(layout: JointLayout, joints: Sequence[str]) -> list[Column]:
    """Return the columns of a course: the recording, estimates of joints, and what obstacles do to the robot."""
    recorded = chain.from_iterable(recording_columns(layout).values())
    return [*recorded, *torque_columns(layout, (ESTIMATED, STD), joints), *_in_world(FORCE, POINT, BASE)]


def _in_world(*signals: tuple[str, str]) -> list[Column]:
    """Return the three columns of each signal in world axes."""
    return [(f"{name}_{axis}", unit, "world") for name, unit in signals for axis in "xyz"]


@dataclass(frozen=True)
class StoredCourse:
    """The motion of a walk in which something pushes; T samples.

    Attributes:
        q: sensed position (T, nq) of which the base stands where it was, [m, -, rad].
        force: of obstacles and pushes on the robot (T, 3) [N], world axes.
        point: where obstacles act, the mean of the points of contact (T, 3) [m]; zero where none touches.
        swing: 1 where the plan has the left, right foot in the air (T, 2).
        note: rate_hz, case, level, seed, places of the obstacles by name [m], and times of the trial [s].
    """

    q: Array
    force: Array
    point: Array
    swing: Array
    note: Mapping[str, Any]

    def at(self, name: str) -> int | None:
        """Return the sample of a time of the trial, `contact_s` for one; None where it did not happen."""
        time_s = self.note[name]
        return None if time_s is None else min(round(time_s * self.note["rate_hz"]), len(self.q) - 1)


def read_course(stem: Path, layout: JointLayout) -> StoredCourse:
    """Read the motion of a stored course.

    Raises:
        DataError: the file is missing or damaged.
    """
    recorded = recording_columns(layout)
    signals = [recorded["q"], _in_world(FORCE), _in_world(POINT), recorded["swing"], _in_world(BASE)]
    names = [name for name, *_ in chain.from_iterable(signals)]
    array, note = read_array(stem, names)
    parts = list[Array]()
    at = 0
    for columns in signals:
        parts.append(array[:, at : at + len(columns)].astype("float64"))
        at += len(columns)
    q, force, point, swing, base = parts
    q[:, :3] = base  # the sensed base drifts
    return StoredCourse(q, force, point, swing, note)
