"""Pushes on the robot: forces at named points and torques on joints, at set times or at random, in phases of a step.

The plant feels them like contacts; they are part of the external torque. Those on a sole are felt by its foot's sensor.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from mobnet.control.compiled import compiled
from mobnet.control.parameters import State
from mobnet.core.errors import ConfigError, not_accepted
from mobnet.core.joints import N_VIRTUAL
from mobnet.robot.description import RobotDescription

Array = NDArray[np.float64]
DIRECTIONS = ("any", "horizontal", "down", "backward")  # backward: against the x axis of the pushed body
ANY, HORIZONTAL, DOWN, BACKWARD = range(4)
SHAPES = ("step", "half_sine")
PHASES = ("always", "left_swing", "right_swing", "left_support", "right_support")
SHARE_WINDOW = 0.05  # [-] of a step: a push whose moment has passed by more waits for the next step

STATE = np.dtype([
    ("start", "f8"), ("end", "f8"), ("share", "f8"), ("active", "i8"), ("count", "i8"),
    ("size", "f8"), ("direction", "f8", 3),
])  # fmt: skip


class Pushes(NamedTuple):
    """Laws and state of the pushes of a scenario, one row each.

    Attributes:
        site: point that is pushed (n,), -1 for a torque on a joint.
        body: its body (n,).
        dof: joint that is turned (n,), in the generalized velocity; -1 for a force.
        phase: when it may come (n,), index of PHASES.
        share: bounds of the share of the step's duration at which it comes (n, 2) [-].
        pause: bounds of the time between two (n, 2) [s]; used where `times` is empty.
        times: earliest times of the episode (n, k) [s], padded with infinity.
        timed: 1 where `times` rules (n,).
        size: bounds of the peak (n, 2) [N] or [N m].
        duration: bounds (n, 2) [s].
        direction: index of DIRECTIONS (n,).
        shape: index of SHAPES (n,).
        state: running push of each row (n,), records of STATE.
    """

    site: NDArray[np.int64]
    body: NDArray[np.int64]
    dof: NDArray[np.int64]
    phase: NDArray[np.int64]
    share: Array
    pause: Array
    times: Array
    timed: NDArray[np.int64]
    size: Array
    duration: Array
    direction: NDArray[np.int64]
    shape: NDArray[np.int64]
    state: NDArray[Any]


def make_pushes(
    settings: Mapping[str, Any], names: Sequence[str], model: mujoco.MjModel, robot: RobotDescription
) -> Pushes:
    """Build the pushes of a scenario from rows of the `pushes` section.

    Raises:
        ConfigError: a push, its point or its joint is unknown.
    """
    for name in names:
        if name not in settings:
            raise ConfigError(not_accepted("push", name, settings))
    rows = [settings[name] for name in names]
    sites = [_site(model, name, row) for name, row in zip(names, rows, strict=True)]
    longest = max((len(row.get("at_s", ())) for row in rows), default=0)
    times = np.full((len(rows), longest + 1), np.inf)  # the last one never comes
    for k, row in enumerate(rows):
        times[k, : len(row.get("at_s", ()))] = row.get("at_s", ())
    return Pushes(
        site=_whole(sites),
        body=_whole(model.site_bodyid[site] if site >= 0 else -1 for site in sites),
        dof=_whole(_dof(robot, name, row) for name, row in zip(names, rows, strict=True)),
        phase=_whole(PHASES.index(row.get("during", PHASES[0])) for row in rows),
        share=_bounds(row.get("share", (0.0, 0.0)) for row in rows),
        pause=_bounds(row.get("pause_s", (0.0, 0.0)) for row in rows),
        times=times,
        timed=_whole("at_s" in row for row in rows),
        size=_bounds(row["torque_nm"] if "joint" in row else row["force_n"] for row in rows),
        duration=_bounds(row["duration_s"] for row in rows),
        direction=_whole(DIRECTIONS.index(row.get("direction", DIRECTIONS[0])) for row in rows),
        shape=_whole(SHAPES.index(row["shape"]) for row in rows),
        state=np.zeros(len(rows), dtype=STATE),
    )


def _whole(values: Any) -> NDArray[np.int64]:
    """Return whole numbers (n,)."""
    return np.array([int(value) for value in values], dtype=np.int64)


def _bounds(values: Any) -> Array:
    """Return lower and upper bounds (n, 2)."""
    return np.array([list(map(float, value)) for value in values], dtype=np.float64).reshape(-1, 2)


def _site(model: mujoco.MjModel, name: str, row: Mapping[str, Any]) -> int:
    """Return the index of a push's point, -1 if it turns a joint."""
    if "joint" in row:
        return -1
    sites = [model.site(i).name for i in range(model.nsite)]
    if row["point"] not in sites:
        raise ConfigError(not_accepted(f"pushes.{name}.point", row["point"], sites))
    return sites.index(row["point"])


def _dof(robot: RobotDescription, name: str, row: Mapping[str, Any]) -> int:
    """Return the place of a push's joint in the generalized velocity, -1 if it pushes a point."""
    if "joint" not in row:
        return -1
    if row["joint"] not in robot.layout.actuated:
        raise ConfigError(not_accepted(f"pushes.{name}.joint", row["joint"], robot.layout.actuated))
    return N_VIRTUAL + robot.layout.actuated.index(row["joint"])


def reset_pushes(pushes: Pushes, start_s: float, rng: np.random.Generator) -> None:
    """End all pushes and plan the first of each for an episode whose clock starts at start_s [s]."""
    pushes.state[:] = 0
    for k in range(len(pushes.state)):
        plan(pushes, k, start_s, rng)


@compiled
def plan(pushes: Pushes, k: int, now: float, rng: np.random.Generator) -> None:
    """Draw when push k comes next: at its next set time [s], or after a pause."""
    s = pushes.state[k]
    s.active = 0
    if pushes.timed[k] == 1:
        s.start = pushes.times[k, min(s.count, pushes.times.shape[1] - 1)]
    else:
        s.start = now + rng.uniform(pushes.pause[k, 0], pushes.pause[k, 1])
    s.share = rng.uniform(pushes.share[k, 0], pushes.share[k, 1])


@compiled
def in_phase(phase: int, share: float, s: State) -> bool:
    """Return whether the step of the walking state s is where a push may start: phase of PHASES, share [-] of it."""
    if phase == 0:
        return True
    if s.swinging == 0:
        return False
    swinging = 1 if s.side < 0.0 else 2  # index of left, right swing
    wanted = phase if phase < 3 else 5 - phase  # a leg supports alone while the other one swings
    return swinging == wanted and share <= s.t / s.total < share + SHARE_WINDOW


@compiled
def _begin(pushes: Pushes, k: int, now: float, xmat: Array, rng: np.random.Generator) -> None:
    """Draw size, duration and direction of push k and start it."""
    s = pushes.state[k]
    s.active = 1
    s.count += 1
    s.start = now
    s.end = now + rng.uniform(pushes.duration[k, 0], pushes.duration[k, 1])
    s.size = rng.uniform(pushes.size[k, 0], pushes.size[k, 1])
    yaw = rng.uniform(-np.pi, np.pi)
    up = rng.uniform(-1.0, 1.0) if pushes.direction[k] == ANY else 0.0
    flat = np.sqrt(1.0 - up * up)
    s.direction[0], s.direction[1], s.direction[2] = flat * np.cos(yaw), flat * np.sin(yaw), up
    if pushes.direction[k] == DOWN:
        s.direction[0], s.direction[1], s.direction[2] = 0.0, 0.0, -1.0
    elif pushes.direction[k] == BACKWARD:
        for i in range(3):
            s.direction[i] = -xmat[pushes.body[k], 3 * i]


@compiled
def push(
    pushes: Pushes, s: State, xfrc: Array, qfrc: Array, site_xpos: Array, xipos: Array, xmat: Array,
    rng: np.random.Generator, tau_joints: Array,
) -> None:  # fmt: skip
    """Apply what pushes now: forces into xfrc (nbody, 6) [N, N m], joint torques added to qfrc (nv,) [N m].

    Args:
        pushes: laws and state.
        s: state of the walking controller; its clock tells the time.
        xfrc: wrench on each body at its centre of mass, world axes; overwritten for pushed bodies.
        qfrc: applied generalized forces.
        site_xpos: points (nsite, 3) [m].
        xipos: centres of mass of the bodies (nbody, 3) [m].
        xmat: axes of the bodies (nbody, 9).
        rng: random numbers of the pushes.
        tau_joints: the joint torques alone are added to it (nv,) [N m]: unlike forces they leave no trace in MuJoCo.
    """
    for k in range(len(pushes.state)):
        if pushes.body[k] >= 0:
            for i in range(6):
                xfrc[pushes.body[k], i] = 0.0
    for k in range(len(pushes.state)):
        p = pushes.state[k]
        if p.active == 1 and s.clock >= p.end:
            plan(pushes, k, s.clock, rng)
        if p.active == 0 and s.clock >= p.start and in_phase(pushes.phase[k], p.share, s):
            _begin(pushes, k, s.clock, xmat, rng)
        if p.active == 0:
            continue
        size = p.size
        if pushes.shape[k] == 1:
            size *= np.sin(np.pi * (s.clock - p.start) / (p.end - p.start))
        if pushes.dof[k] >= 0:
            qfrc[pushes.dof[k]] += size
            tau_joints[pushes.dof[k]] += size
        else:
            _force_at(pushes, k, size, xfrc, site_xpos, xipos)


@compiled
def _force_at(pushes: Pushes, k: int, size: float, xfrc: Array, site_xpos: Array, xipos: Array) -> None:
    """Add a force [N] of that size at the point of push k, as a wrench at its body's centre of mass."""
    body, point, direction = pushes.body[k], site_xpos[pushes.site[k]], pushes.state[k].direction
    for i in range(3):
        j, n = (i + 1) % 3, (i + 2) % 3
        xfrc[body, i] += size * direction[i]
        arm_j, arm_n = point[j] - xipos[body, j], point[n] - xipos[body, n]
        xfrc[body, 3 + i] += size * (arm_j * direction[n] - arm_n * direction[j])
