"""What is accepted of the numbers of an array, by the names of its columns; every reader of arrays asks here.

Bounds are physical and wide, so that the log of a real robot passes and a wrong unit does not. Those of a joint's
position, velocity and torque come from the robot's table. `docs/log_formats.md` describes them.
"""

import functools
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.core.columns import COMMAND, EXTERNAL, EXTERNAL_LP, FEET, LABEL_LP, PUSH_TORQUE, RESIDUAL, STD
from mobnet.core.errors import not_accepted
from mobnet.core.joints import JointLayout

FINITE = float(np.finfo(np.float32).max)
NORM = 0.01  # a quaternion's norm may differ from 1 by this: rounding and noise do, and another unit does not
BEYOND_RAD = 0.1  # of a joint's range: its stop gives way, and its zero is known to some degrees
BEYOND_SPEED, BEYOND_TORQUE = 3.0, 3.0  # of a joint's limits: a hit, a motor stronger than its table says
QUATERNION = tuple(f"q.quat_{axis}" for axis in "wxyz")
# signals in N for V1..V3 of a floating base, in N m for all others
TORQUES = (RESIDUAL, EXTERNAL_LP, LABEL_LP, EXTERNAL, PUSH_TORQUE, STD)


class Rule(NamedTuple):
    """What is accepted of a column: its unit and frame, one of these pairs, and its numbers, 0 or 1 of a flag."""

    places: tuple[tuple[str, str], ...]
    low: float = -FINITE
    high: float = FINITE
    flag: bool = False


def _within(size: float, *place: str) -> Rule:
    """Return the rule of a column with one unit and frame, whose numbers are at most this large."""
    return Rule(((place[0], place[1]),), -size, size)


def _command(name: str, unit: str) -> Rule:
    """Return the rule of a number of a step's command."""
    return _within(LARGEST[name], unit, "stance foot")._replace(low=-LARGEST[name] if name in SIGNED else 0.0)


FORCE = ("N", "world")
TORQUE = ("N m", "joint")
LARGEST = {"step_x": 2.0, "step_y": 2.0, "turn": np.pi, "duration": 60.0, "foot_height": 1.0}  # of a step's command
PUSHES = 1000.0  # of a scenario, at most
SIGNED = ("step_x", "step_y", "turn")  # the other numbers of a command are not below zero
RULES: Mapping[str, Rule] = {  # pattern of names -> what is accepted; the first that fits counts
    r"q\.base_[xy]": _within(1e4, "m", "world"),
    r"q\.base_z": _within(100.0, "m", "world"),
    r"q\.quat_[wxyz]": _within(1.0 + NORM, "-", "world"),
    r"(q|q_ref)\..+": _within(4 * np.pi, "rad", "joint"),
    r"v\.base_[xyz]": _within(20.0, "m/s", "world"),
    r"v\.omega_[xyz]": _within(50.0, "rad/s", "base"),
    r"v\..+": _within(100.0, "rad/s", "joint"),
    r"acc\.[xyz]": _within(1e3, "m/s^2", "base"),
    r"(tau_des|tau_motor|tau_random)\..+": _within(1e4, "N m", "joint"),
    r"swing\..+": Rule((("-", "plan"),), 0.0, 1.0, flag=True),
    r"contact\..+": Rule((("-", "ground"),), 0.0, 1.0, flag=True),
    r"pushed": Rule((("-", "scenario"),), 0.0, 1.0, flag=True),
    r"landing\..+": Rule((("s", "plan"),), 0.0, LARGEST["duration"]),
    r"push\.row": Rule((("-", "scenario"),), 0.0, PUSHES),
    r"push\.force_[xyz]": _within(1e5, "N", "world"),
    **{rf"command\.{name}": _command(name, unit) for name, unit in COMMAND},
    **{rf"wrench_{foot}\.force_[xyz]": _within(1e5, "N", foot) for foot in FEET},
    **{rf"wrench_{foot}\.moment_[xyz]": _within(1e4, "N m", foot) for foot in FEET},
    rf"{STD}\..+": Rule((FORCE, TORQUE), 0.0, 1e6),
    rf"({'|'.join(TORQUES)})\..+": Rule((FORCE, TORQUE), -1e6, 1e6),
}


@functools.cache
def _general_rule(name: str) -> Rule:
    """Return what is accepted of a column of any robot."""
    return next((rule for pattern, rule in RULES.items() if re.fullmatch(pattern, name)), Rule(()))


def rule_of(name: str, layout: JointLayout | None = None) -> Rule:
    """Return what is accepted of a column; anything finite of one that this project does not know."""
    rule = _general_rule(name)
    signal, _, joint = name.partition(".")
    if layout is None or joint not in layout.names:
        return rule
    if signal in TORQUES:
        return rule._replace(places=(FORCE if layout.unit(joint) == "N" else TORQUE,))
    limits = layout.limits.get(joint)
    if limits is None:
        return rule
    sizes = {"v": BEYOND_SPEED * limits.speed, "tau_motor": BEYOND_TORQUE * limits.torque}
    if signal in sizes:
        return rule._replace(low=-sizes[signal], high=sizes[signal])
    return rule._replace(low=limits.low - BEYOND_RAD, high=limits.high + BEYOND_RAD) if signal == "q" else rule


def column_faults(columns: Sequence[Mapping[str, Any]], layout: JointLayout | None = None) -> Iterator[str]:
    """Yield columns (name, unit, frame) whose unit or frame is another than this project's, or of an unknown joint."""
    for column in columns:
        signal, _, joint = column["name"].partition(".")
        if layout is not None and signal in TORQUES and joint not in layout.names:
            yield not_accepted("columns", column["name"], [f"{signal}.{name}" for name in layout.names])
        places = rule_of(column["name"], layout).places
        if places and (column["unit"], column["frame"]) not in places:
            given = f"columns: {column['name']!r}: unit {column['unit']!r}, frame {column['frame']!r}"
            accepted = " or ".join(f"unit {unit!r}, frame {frame!r}" for unit, frame in places)
            yield f"{given} is not accepted; accepted: {accepted}"


class Values:
    """Looks at the numbers of an array, piece by piece, and keeps the first fault of each column."""

    def __init__(self, names: Sequence[str], layout: JointLayout | None = None, everywhere: bool = False) -> None:
        """Look at columns of these names; `everywhere` says that all rows are in segments, so that each std counts."""
        self._names = names
        self._rules = [rule_of(name, layout) for name in names]
        self._low = np.array([rule.low for rule in self._rules], dtype=np.float32)
        self._high = np.array([rule.high for rule in self._rules], dtype=np.float32)
        if everywhere:
            self._low[[name.startswith(f"{STD}.") for name in names]] = np.finfo(np.float32).tiny
        self._flags = np.flatnonzero([rule.flag for rule in self._rules])
        self._turned = [names.index(name) for name in QUATERNION] if set(QUATERNION) <= set(names) else []
        self._found: dict[int | str, str] = {}

    def look(self, first: int, columns: NDArray[np.float32]) -> None:
        """Look at samples, (C, n), each column contiguous, of which `first` is the number of the first."""
        if not columns.shape[1]:
            return
        fits = (columns.min(axis=1) >= self._low) & (columns.max(axis=1) <= self._high)  # NaN does not fit
        for k in np.flatnonzero(~fits).tolist():
            self._note(k, first, columns[k], (columns[k] >= self._low[k]) & (columns[k] <= self._high[k]))
        for k in self._flags.tolist():
            self._note(k, first, columns[k], (columns[k] == 0.0) | (columns[k] == 1.0))
        if self._turned:
            norm = np.sqrt(np.square(columns[self._turned]).sum(axis=0))
            good = np.abs(norm - 1.0) <= NORM
            if not good.all() and "norm" not in self._found:
                row = int(np.argmin(good))
                where = f"columns {QUATERNION[0]!r} to {QUATERNION[-1]!r}, row {first + row}: norm"
                self._found["norm"] = not_accepted(where, float(norm[row]), [f"1 within {NORM}"])

    def _note(self, k: int, first: int, column: NDArray[np.float32], good: NDArray[np.bool_]) -> None:
        """Keep the first fault of a column, if it is its first."""
        if k in self._found or good.all():
            return
        row = int(np.argmin(good))
        rule = self._rules[k]
        accepted = "finite numbers"
        if np.isfinite(column[row]) and abs(rule.high) < FINITE:
            unit = rule.places[0][0] if len(rule.places) == 1 else "N or N m"
            accepted = "0 or 1" if rule.flag else f"{rule.low:.6g} to {rule.high:.6g} {unit}".removesuffix(" -")
            accepted = f"above {accepted}" if rule.low == 0.0 == column[row] else accepted
        where = f"column {self._names[k]!r}, row {first + row}"
        self._found[k] = not_accepted(where, float(column[row]), [accepted])

    def faults(self) -> list[str]:
        """Return a line for each column with a fault."""
        return list(self._found.values())
