"""Mistakes planted into an arm's log: what a wrong map can make of it, and the hint that names each.

An arm has a base that turns about the vertical, a shoulder, an elbow and a wrist.
"""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import NDArray

Array = NDArray[np.float64]
CURRENTS = (15.0, 13.0, 11.0, 10.5, 11.0, 11.5, 11.0)  # torques of a current [N m/A]
LATE_S = 0.03


@dataclass(frozen=True)
class Log:
    """Positions, velocities and torques (T, n) of an arm, and the numbers of base, shoulder and elbow."""

    q: Array
    v: Array
    torque: Array
    rate_hz: float
    base: int
    shoulder: int
    elbow: int

    def table(self, joints: Sequence[str]) -> pd.DataFrame:
        """Return it as a table with the columns of a recording."""
        columns = {"time": np.arange(len(self.q)) / self.rate_hz}
        for name, values in (("q", self.q), ("v", self.v), ("tau_motor", self.torque)):
            columns |= {f"{name}.{joint}": column for joint, column in zip(joints, values.T, strict=True)}
        return pd.DataFrame(columns)


class Planted(NamedTuple):
    """A mistake, the hint that names it, and the joints that no hint may go beyond; all where none is given."""

    spoil: Callable[[Log], Log]
    pattern: str
    joints: Callable[[Log], tuple[int, ...]] | None


def shoulder(log: Log) -> tuple[int, ...]:
    return (log.shoulder,)


def elbow(log: Log) -> tuple[int, ...]:
    return (log.elbow,)


def shoulder_and_elbow(log: Log) -> tuple[int, ...]:
    return log.shoulder, log.elbow


def base_and_shoulder(log: Log) -> tuple[int, ...]:
    return log.base, log.shoulder


def turned(log: Log, joint: int) -> Array:
    sign = np.ones(log.q.shape[1])
    sign[joint] = -1.0
    return sign


def exchanged(log: Log, pair: Sequence[int]) -> NDArray[np.intp]:
    order = np.arange(log.q.shape[1])
    order[list(pair)] = list(reversed(pair))
    return order


def with_torque(log: Log, torque: Array) -> Log:
    return replace(log, torque=torque)


def backwards(log: Log) -> Log:
    sign = turned(log, log.elbow)
    return replace(log, q=sign * log.q, v=sign * log.v, torque=sign * log.torque)


def from_another_zero(log: Log) -> Log:
    shift = np.zeros(log.q.shape[1])
    shift[log.shoulder] = np.pi / 2
    return replace(log, q=log.q - shift)


def with_motion_exchanged(log: Log) -> Log:
    order = exchanged(log, base_and_shoulder(log))
    return replace(log, q=log.q[:, order], v=log.v[:, order])


def late(log: Log) -> Log:
    t = np.arange(len(log.q)) / log.rate_hz
    return with_torque(log, np.stack([np.interp(t - LATE_S, t, column) for column in log.torque.T], axis=1))


def amperes(log: Log) -> Log:
    return with_torque(log, log.torque / np.array(CURRENTS[: log.torque.shape[1]]))


BEFORE = r"tau_motor is 1/[\d.]+( to [\d.]+)? of what the motion needs: before the gear, or a current in A\?"
PLANTED = {
    "nothing": Planted(lambda log: log, "", None),
    "all torques negative": Planted(
        lambda log: with_torque(log, -log.torque), "tau_motor is of the wrong sign", None
    ),
    "shoulder negative": Planted(
        lambda log: with_torque(log, turned(log, log.shoulder) * log.torque),
        "tau_motor is of the wrong sign",
        shoulder,
    ),
    "shoulder and elbow exchanged": Planted(
        lambda log: with_torque(log, log.torque[:, exchanged(log, shoulder_and_elbow(log))]),
        "tau_motor of the two is exchanged",
        shoulder_and_elbow,
    ),
    "base and shoulder exchanged": Planted(
        lambda log: with_torque(log, log.torque[:, exchanged(log, base_and_shoulder(log))]),
        "tau_motor of the two is exchanged",
        base_and_shoulder,
    ),
    "reversed order": Planted(
        lambda log: with_torque(log, log.torque[:, ::-1]), "tau_motor stands in the reverse order", None
    ),
    "mN m": Planted(lambda log: with_torque(log, 1e3 * log.torque), "tau_motor is .*in mN m", None),
    "before the gear": Planted(lambda log: with_torque(log, log.torque / 100), BEFORE, None),
    "amperes": Planted(amperes, BEFORE, None),
    "elbow counted backwards": Planted(backwards, "q, v and tau_motor have the wrong sign", elbow),
    "another zero of the shoulder": Planted(
        from_another_zero, r"q reads -1\.[4-6]\d rad \(-(8|9)\d degrees\) too much", shoulder
    ),
    "motion of base and shoulder exchanged": Planted(
        with_motion_exchanged, "q and v of the two are exchanged", base_and_shoulder
    ),
    "speeds negative": Planted(lambda log: replace(log, v=-log.v), "changes by -.* times the integral of v", None),
    "late torque": Planted(late, "tau_motor: [23][0-9.]* ms late against the motion", None),
    "rad said to be degrees": Planted(
        lambda log: replace(log, q=np.radians(log.q), v=np.radians(log.v)), "in rad, and taken for degrees", None
    ),
}  # fmt: skip


def fault_of(name: str, log: Log, joints: Sequence[str], hints: Sequence[str]) -> str:
    """Return what is wrong with the hints on a planted mistake: missing, another one, or another joint; "" if nothing.

    Values beyond the limits of the robot's table may be named beside it.
    """
    planted = PLANTED[name]
    told = [hint for hint in hints if "beyond the robot's table" not in hint]
    if not planted.pattern:
        return f"told of a clean log: {told}" if told else ""
    if len(told) != 1 or not re.search(planted.pattern, told[0]):
        return f"expected {planted.pattern!r} alone, told: {told}"
    own = planted.joints(log) if planted.joints else range(len(joints))
    others = [joint for k, joint in enumerate(joints) if k not in own and re.search(rf"\b{joint}\b", told[0])]
    return f"other joints are named: {told}" if others else ""
