"""Rows of bodies and joints as a table has them, with limits and names that it takes."""

from collections.abc import Collection, Iterator, Sequence
from typing import Any

import numpy as np
import pinocchio as pin

from mobnet.core.arrays import Array
from mobnet.formats.base import MOST_M, MOST_RAD
from mobnet.formats.parts import SPEED_RAD_S, TORQUE_NM
from mobnet.robot.import_base import RobotSelection
from mobnet.robot.import_inertia import Mass, six
from mobnet.robot.import_names import renamed, words_of
from mobnet.robot.import_tree import Joint, RigidBody


def body_rows(
    parts: Sequence[RigidBody], masses: Sequence[Mass], robot: RobotSelection, notes: list[str]
) -> list[dict[str, Any]]:
    """Return the rows of bodies, and note names that differ from those of the file."""
    names = [body.name for body in parts]
    if not robot.floating:
        names[0] = "base"
    words = words_of(names, "body", {"world"})
    first = 0 if robot.floating else 1
    notes += renamed(names[first:], words[first:], "bodies")
    shift = _shift(parts, robot, notes)
    rows = []
    for k, (body, mass) in enumerate(zip(parts, masses, strict=True)):
        parent = "world" if k == 0 else words[body.parent]
        pos = body.pos - shift if k and body.parent == 0 else body.pos
        rows.append(_row(words[k], parent, pos, body.turn, mass))
    return rows


def _shift(parts: Sequence[RigidBody], robot: RobotSelection, notes: list[str]) -> Array:
    """Return the place from which a base that stands still counts [m], and note it where it is not the world's."""
    places = [body.pos for body in parts[1:] if body.parent == 0]
    if robot.floating or np.abs(places).max() <= MOST_M:
        return np.zeros(3)
    numbers = ", ".join(f"{value:g}" for value in places[0])
    notes.append(f"the robot stands at [{numbers}] m in the file; the table counts places from there")
    return places[0]


def _listed(values: Array) -> list[float]:
    """Return numbers as a list, without -0.0."""
    return [float(x) + 0.0 for x in values]


def _row(name: str, parent: str, pos: Array, turn: Array, mass: Mass) -> dict[str, Any]:
    """Return the row of a body, in SI units."""
    quat = pin.Quaternion(turn).normalized().coeffs()[[3, 0, 1, 2]]
    lists = {"pos": pos, "quat": quat, "com": mass.com, "inertia": six(mass.inertia)}
    listed = {key: _listed(value) for key, value in lists.items()}
    return {"name": name, "parent": parent, **listed, "mass": float(mass.mass)}


def joint_rows(
    hinges: Sequence[Joint],
    bodies: Sequence[str],
    taken: Collection[str],
    limits: tuple[float, float],
    notes: list[str],
) -> Iterator[dict[str, Any]]:
    """Yield the rows of hinges, and note of which the file says no limit that a table takes.

    Args:
        hinges: in their order.
        bodies: names of the bodies that they move.
        taken: names that no joint may have.
        limits: of a joint without them: torque [N m] and speed [rad/s].
        notes: get what is noted.
    """
    names = [joint.name for joint in hinges]
    words = words_of(names, "joint", taken)
    notes += renamed(names, words, "joints")
    torque_limit, speed_limit = limits
    turned = list[str]()
    unlimited: dict[str, list[str]] = {"range": [], "torque": [], "speed": []}
    for joint, word, body in zip(hinges, words, bodies, strict=True):
        low, high = _range(joint)
        torque = _within(joint.torque, TORQUE_NM)
        speed = _within(joint.speed, SPEED_RAD_S)
        turned += [word] if joint.range and joint.range[0] > joint.range[1] else []
        unlimited["range"] += [word] if joint.range is None or (low, high) != _ends(joint.range) else []
        unlimited["torque"] += [] if torque else [word]
        unlimited["speed"] += [] if speed else [word]
        yield {
            "id": word,
            **({"name": joint.name} if joint.name else {}),
            "body": body,
            "axis": [float(x) + 0.0 for x in joint.axis],
            "range": [low, high],
            "torque_limit": torque or torque_limit,
            "armature": joint.armature,
            "velocity_limit": speed or speed_limit,
        }
    if turned:
        notes.append(f"range of {', '.join(turned)}: the lower end is above the upper one; they change places")
    defaults = {"range": f"{MOST_RAD} rad", "torque": f"{torque_limit:g} N m", "speed": f"{speed_limit:g} rad/s"}
    for kind, without in unlimited.items():
        if without:
            beyond = _beyond(kind, hinges)
            notes.append(f"{kind} of {', '.join(without)}: not in the file{beyond}, {defaults[kind]} is taken")


def _range(joint: Joint) -> tuple[float, float]:
    """Return the range of a joint [rad] as a table takes it, two turns to each side where there is none."""
    if joint.range is None:
        return -MOST_RAD, MOST_RAD
    low, high = _ends(joint.range)
    low = max(low, -MOST_RAD)
    high = min(high, MOST_RAD)
    return (low, high) if low < high else (-MOST_RAD, MOST_RAD)


def _ends(ends: tuple[float, float]) -> tuple[float, float]:
    """Return the ends of a range, the lower one first."""
    return min(ends), max(ends)


def _within(value: float | None, bounds: tuple[float, float]) -> float | None:
    """Return a limit, or None for one that means that there is none."""
    return value if value is not None and bounds[0] <= value <= bounds[1] else None


def _beyond(kind: str, joints: Sequence[Joint]) -> str:
    """Return what is said where some joint has a limit, but none that a table takes."""
    if kind == "range":
        beyond = [joint for joint in joints if joint.range and _ends(joint.range) != _range(joint)]
        return f" or wider than {MOST_RAD} rad" if beyond else ""
    values = [joint.torque if kind == "torque" else joint.speed for joint in joints]
    low, high = TORQUE_NM if kind == "torque" else SPEED_RAD_S
    return f" or not within {low} to {high}" if any(value and not low <= value <= high for value in values) else ""
