"""Motions of the upper body against their places, the configuration and the robot."""

from collections.abc import Iterator
from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import ConfigDict, Field

from mobnet.agreement.arrays import NAMES
from mobnet.agreement.said import differences
from mobnet.core.columns import named
from mobnet.core.errors import not_accepted
from mobnet.core.files import read_json
from mobnet.core.notes import Index, Note, NotNegative, Text, checked
from mobnet.core.store import ARRAY, NOTE, read_array
from mobnet.plan.runs import Files
from mobnet.settings.data import Motion

TARGET = "q_ref"
AT_ONCE = 1.5  # times a joint's velocity limit, between two knots
SAME_RAD = 1e-3


class MotionNote(Note):
    """What the note of a motion says besides that of every array."""

    model_config = ConfigDict(extra="allow")

    motion: Text
    seed: Index
    part: Index
    variant: Index
    clearance_m: Annotated[NotNegative, Field(le=5)]
    hand_speed_mean_m_s: NotNegative
    hand_speed_max_m_s: Annotated[NotNegative, Field(le=20)]


def motion_faults(path: Path, place: tuple[str, ...], files: Files) -> Iterator[str]:
    """Yield in what a motion is not the one of its place, or none that the robot can make."""
    found, rows = NAMES.fullmatch(place[-1]), files.settings.motions
    if not found or path.suffix != NOTE or len(place) != 3 or place[1] not in rows:
        return
    row, note = rows[place[1]], read_json(path)
    checked(path, note, MotionNote)
    yield from differences(note, {"motion": place[1], "seed": int(found[1]), "rate_hz": row.knot_hz})
    if note["variant"] >= len(row.variants):
        yield not_accepted("variant", note["variant"], [f"0 to {len(row.variants) - 1}"])
    if note["clearance_m"] < row.clearance_least_m:
        yield not_accepted("clearance_m", note["clearance_m"], [f"{row.clearance_least_m} or more"])
    if note["hand_speed_mean_m_s"] > note["hand_speed_max_m_s"]:
        accepted = [f"at most hand_speed_max_m_s, {note['hand_speed_max_m_s']}"]
        yield not_accepted("hand_speed_mean_m_s", note["hand_speed_mean_m_s"], accepted)


def knot_faults(path: Path, place: tuple[str, ...], files: Files) -> Iterator[str]:
    """Yield columns, ranges, speeds, a beginning and a length that are not those of a motion."""
    found, rows = NAMES.fullmatch(place[-1]), files.settings.motions
    if found and path.suffix == ARRAY and len(place) == 3 and place[1] in rows:
        yield from _knot_faults(path, rows[place[1]], place[1], int(found[1]), files)


def _knot_faults(path: Path, motion: Motion, name: str, seed: int, files: Files) -> Iterator[str]:
    """Yield in what the knots of a motion, its row of the configuration being given, are not those of its seed."""
    settings, layout = files.settings, files.settings.layout
    array, note = read_array(path.with_suffix(""), None, layout)
    held = [column["name"] for column in note["columns"]]
    if held != named(TARGET, layout.above_legs):
        yield not_accepted("columns", held, [f"{TARGET} of {', '.join(layout.above_legs)}"])
        return
    posture = settings.robot.posture_rad
    speeds = np.abs(np.diff(array, axis=0)).max(axis=0, initial=0.0) * motion.knot_hz
    for k, joint in enumerate(layout.above_legs):
        limit = layout.limits[joint]
        low, high = float(array[:, k].min()), float(array[:, k].max())
        if low < limit.low or high > limit.high:
            yield not_accepted(f"{TARGET}.{joint}", [low, high], [f"{limit.low} to {limit.high}, the joint's range"])
        if speeds[k] > AT_ONCE * limit.speed:
            accepted = [f"at most {AT_ONCE * limit.speed:g} rad/s from knot to knot"]
            yield not_accepted(f"{TARGET}.{joint}: speed", float(speeds[k]), accepted)
        if low == high:
            yield not_accepted(f"{TARGET}.{joint}: every knot", low, ["angles that change"])
        if abs(array[0, k] - posture[joint]) > SAME_RAD:
            yield not_accepted(f"{TARGET}.{joint}, row 0", float(array[0, k]), [f"{posture[joint]}, the posture"])
    moved = [scenario for scenario, row in settings.scenarios.items() if row.motion == name]
    if any(scenario in moved and seed == other for scenario, _, other in files.recorded()):
        rows = round(files.duration_s(moved, seed) * motion.knot_hz) + 1
        if note["rows"] != rows:
            yield not_accepted("rows", note["rows"], [f"{rows}, of its duration"])
