"""Pushes on the robot: forces at named points and torques on joints, at set times or at random, in phases of a step.

The plant feels them like contacts; they are part of the external torque. Those on a sole are felt by its foot's sensor.
"""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from mobnet.control.parameters import State
from mobnet.core.arrays import Array
from mobnet.core.compilation import compiled
from mobnet.core.joints import N_VIRTUAL
from mobnet.robot.description import RobotDescription
from mobnet.settings.data import Direction, Phase, Push, Sines

# the last three: against the body's x axis, along its y axis and against it
DIRECTIONS: tuple[Direction, ...] = ("any", "horizontal", "down", "backward", "leftward", "rightward")
ANY, HORIZONTAL, DOWN, BACKWARD, LEFTWARD, RIGHTWARD = range(6)
SHAPES = ("step", "half_sine", "sines", "impactor")
_, HALF_SINE, SINES, IMPACTOR = range(4)
PHASES: tuple[Phase, ...] = ("always", "left_swing", "right_swing", "left_support", "right_support")
SHARE_WINDOW = 0.05  # [-] of a step: a push whose moment has passed by more waits for the next step

LAW = np.dtype(
    [
        ("site", "i8"),
        ("body", "i8"),
        ("dof", "i8"),
        ("phase", "i8"),
        ("direction", "i8"),
        ("shape", "i8"),
        ("timed", "i8"),
        ("log", "i8"),
        ("share", "f8", 2),
        ("pause", "f8", 2),
        ("size", "f8", 2),
        ("moment", "f8", 2),
        ("duration", "f8", 2),
        ("mass", "f8"),
    ]
)
STATE = np.dtype(
    [
        ("start", "f8"),
        ("end", "f8"),
        ("share", "f8"),
        ("active", "i8"),
        ("count", "i8"),
        ("size", "f8"),
        ("direction", "f8", 3),
        ("moment", "f8", 3),
        ("stiffness", "f8"),
        ("speed", "f8"),
        ("travel", "f8"),
        ("anchor", "f8"),
        ("place", "f8", 3),
    ]
)


class Pushes(NamedTuple):
    """Laws and state of the pushes of a scenario, one row each."""

    # records of LAW (n,): `site`, the point that is pushed, and its `body`, both -1 for a torque on a joint; `dof`,
    # the joint's place in the generalized velocity, -1 for a force; `phase`, `direction` and `shape`, indices of
    # PHASES, DIRECTIONS and SHAPES; `timed`, 1 where `times` rules; `log`, 1 where sizes are drawn on a log scale;
    # bounds of the `share` [-] of the step at which it comes, of the `pause` [s] between two, of the `size` [N] or
    # [N m] of the peak, of the peak of the `moment` [N m] that comes with a force, zero without one, and of the
    # `duration` [s]; `mass` [kg] of an impactor
    law: NDArray[Any]
    times: Array  # earliest times of the episode (n, k) [s], padded with infinity
    sines: Array  # lines (n, m, 3) of shape `sines`: angular frequency [rad/s], phase [rad], share of the size [-]
    # running push of each row (n,), records of STATE: `moment`, that at the peak (3,) [N m]; of an impactor the
    # `stiffness` [N/m], `speed` [m/s] and `travel` [m] along the push, where the point was at its start (`anchor`) and
    # in the last step (`place`) [m]
    state: NDArray[Any]


def make_pushes(settings: Mapping[str, Push], model: mujoco.MjModel, robot: RobotDescription) -> Pushes:
    """Build the pushes of a scenario, in the order of their rows."""
    rows = settings.values()
    times = [row.at_s or () for row in rows]
    padded = np.full((len(rows), 1 + max(map(len, times), default=0)), np.inf)  # the last one never comes
    for k, row in enumerate(times):
        padded[k, : len(row)] = row
    laws = np.array([_law(row, model, robot) for row in rows], dtype=LAW)
    return Pushes(laws, padded, _sines([row.sines for row in rows]), np.zeros(len(rows), dtype=STATE))


def _sines(rows: Sequence[Sines | None]) -> Array:
    """Return the lines of pushes (n, m, 3), as in `Pushes.sines`; those that a push lacks have a share of zero."""
    lines_of = np.zeros((len(rows), max((len(row.share) for row in rows if row), default=0), 3))
    for lines, row in zip(lines_of, rows, strict=True):
        if row:
            columns = 2.0 * np.pi * np.array(row.frequency_hz), np.deg2rad(row.phase_deg), row.share
            lines[: len(row.share)] = np.stack(columns, axis=1)
    return lines_of


def _law(row: Push, model: mujoco.MjModel, robot: RobotDescription) -> tuple[Any, ...]:
    target = -1, -1, N_VIRTUAL + robot.layout.actuated.index(row.joint) if row.joint else -1
    if row.point:
        target = model.site(row.point).id, int(model.site(row.point).bodyid[0]), -1
    return (
        *target,
        PHASES.index(row.during),
        DIRECTIONS.index(row.direction),
        SHAPES.index(row.shape),
        row.at_s is not None,
        row.sizes == "log",
        row.share,
        row.pause_s or (0.0, 0.0),
        row.force_n or row.torque_nm,
        row.moment_nm or (0.0, 0.0),
        row.duration_s,
        row.impactor_kg or 0.0,
    )


def reset_pushes(pushes: Pushes, start_s: float, rng: np.random.Generator) -> None:
    """End all pushes and plan the first of each for an episode whose clock starts at start_s [s]."""
    pushes.state[:] = 0
    for k in range(len(pushes.state)):
        plan(pushes, k, start_s, rng)


@compiled
def plan(pushes: Pushes, k: int, now: float, rng: np.random.Generator) -> None:
    """Draw when push k comes next: at its next set time [s], or after a pause from now [s] on."""
    law = pushes.law[k]
    p = pushes.state[k]
    p.active = 0
    if law.timed == 1:
        p.start = pushes.times[k, min(p.count, pushes.times.shape[1] - 1)]
    else:
        p.start = now + rng.uniform(law.pause[0], law.pause[1])
    p.share = rng.uniform(law.share[0], law.share[1])


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
def _begin(law: Any, p: Any, now: float, axes: Array, rng: np.random.Generator) -> None:
    """Draw size, duration and direction of a push and start it now [s]; axes (9,) are those of the pushed body."""
    p.active = 1
    p.count += 1
    p.start = now
    p.end = now + rng.uniform(law.duration[0], law.duration[1])
    if law.log == 1:
        p.size = np.exp(rng.uniform(np.log(law.size[0]), np.log(law.size[1])))
    else:
        p.size = rng.uniform(law.size[0], law.size[1])
    _draw_direction(p.direction, law.direction == ANY, rng)
    if law.moment[1] > 0.0:
        _draw_direction(p.moment, True, rng)
        p.moment *= rng.uniform(law.moment[0], law.moment[1])
    if law.direction == DOWN:
        p.direction[0] = 0.0
        p.direction[1] = 0.0
        p.direction[2] = -1.0
    elif law.direction >= BACKWARD:
        axis, sign = (0, -1.0) if law.direction == BACKWARD else (1, 1.0 if law.direction == LEFTWARD else -1.0)
        for i in range(3):
            p.direction[i] = sign * axes[3 * i + axis]


@compiled
def _draw_direction(vector: Array, anywhere: bool, rng: np.random.Generator) -> None:
    """Set a vector (3,) to a unit vector that may point anywhere, or to a horizontal one."""
    yaw = rng.uniform(-np.pi, np.pi)
    up = rng.uniform(-1.0, 1.0) if anywhere else 0.0
    flat = np.sqrt(1.0 - up * up)
    vector[0] = flat * np.cos(yaw)
    vector[1] = flat * np.sin(yaw)
    vector[2] = up


@compiled
def meet(p: Any, mass: float, place: Array, dt: float) -> None:
    """Set an impactor of a mass [kg] on its way that meets a point at place (3,) [m] now; the last step took dt [s].

    A mass m that meets a wall at the speed F T / (pi m) on a spring of stiffness m (pi / T)^2 touches it for T and
    pushes with F at most; the point's own speed along the push is added.
    """
    length = p.end - p.start
    p.stiffness = mass * (np.pi / length) ** 2
    p.speed = p.size * length / (np.pi * mass)
    p.anchor = p.travel = 0.0
    for i in range(3):
        p.anchor += p.direction[i] * place[i]
        p.speed += p.direction[i] * (place[i] - p.place[i]) / dt


@compiled
def hit(p: Any, mass: float, place: Array, dt: float) -> float:
    """Advance an impactor by dt [s] against a point at place (3,) [m]; return its force [N], below 0 once they part."""
    depth = p.travel + p.anchor
    for i in range(3):
        depth -= p.direction[i] * place[i]
    force = p.stiffness * depth
    p.speed -= max(force, 0.0) / mass * dt
    p.travel += p.speed * dt
    return force


@compiled
def _advance(
    pushes: Pushes, k: int, s: State, xmat: Array, site_xpos: Array, dt: float, rng: np.random.Generator
) -> float:
    """End or begin push k if it is time to; return how hard it pushes now [N] or [N m], zero between two pushes."""
    law = pushes.law[k]
    p = pushes.state[k]
    if p.active == 1 and law.shape != IMPACTOR and s.clock >= p.end:
        plan(pushes, k, s.clock, rng)
    if p.active == 0 and s.clock >= p.start and in_phase(law.phase, p.share, s):
        _begin(law, p, s.clock, xmat[law.body], rng)
        if law.shape == IMPACTOR:
            meet(p, law.mass, site_xpos[law.site], dt)
    if law.shape == IMPACTOR:
        return advance_impactor(pushes, k, s.clock, site_xpos[law.site], dt, rng)
    if p.active == 0:
        return 0.0
    if law.shape == HALF_SINE:
        return p.size * np.sin(np.pi * (s.clock - p.start) / (p.end - p.start))
    if law.shape == SINES:
        return p.size * sum_of_sines(pushes.sines[k], s.clock - p.start)
    return p.size


@compiled
def advance_impactor(pushes: Pushes, k: int, clock: float, place: Array, dt: float, rng: np.random.Generator) -> float:
    """Return the force of an impactor [N] on a point at place (3,) [m], and plan the next one once it has parted."""
    law = pushes.law[k]
    p = pushes.state[k]
    force = 0.0
    if p.active == 1:
        force = max(hit(p, law.mass, place, dt), 0.0)
        if force == 0.0 and clock > p.start:  # at the start they just touch
            plan(pushes, k, clock, rng)
    for i in range(3):
        p.place[i] = place[i]
    return force


@compiled
def sum_of_sines(sines: Array, time_s: float) -> float:
    """Return the sum of the lines (m, 3) of a push [-], as in `Pushes.sines`, at a time [s] from its start."""
    total = 0.0
    for i in range(len(sines)):
        total += sines[i, 2] * np.sin(sines[i, 0] * time_s + sines[i, 1])
    return total


@compiled
def push(
    pushes: Pushes,
    s: State,
    xfrc: Array,
    qfrc: Array,
    site_xpos: Array,
    xipos: Array,
    xmat: Array,
    dt: float,
    rng: np.random.Generator,
    tau_joints: Array,
    push_record: Array,
) -> None:
    """Apply what pushes in a step of dt [s]: forces into xfrc (nbody, 6) [N, N m], joint torques to qfrc (nv,) [N m].

    xfrc holds wrenches at the bodies' centres of mass, world axes, and is overwritten for pushed bodies. The joint
    torques alone are added to tau_joints (nv,) [N m]: unlike forces they leave no trace in MuJoCo. `push_record` (4,)
    has of forces the row that pushes, counted from 1, and the sum [N], to which this step's is added. Points (nsite,
    3), centres of mass (nbody, 3) [m] and axes (nbody, 9) are MuJoCo's; the clock of the walking state s tells time.
    """
    for k in range(len(pushes.law)):
        if pushes.law[k].dof < 0:
            xfrc[pushes.law[k].body] = 0.0
    for k in range(len(pushes.law)):
        law = pushes.law[k]
        size = _advance(pushes, k, s, xmat, site_xpos, dt, rng)
        if law.dof >= 0:
            qfrc[law.dof] += size
            tau_joints[law.dof] += size
        elif size != 0.0:
            p = pushes.state[k]
            _force_at(site_xpos[law.site], xipos[law.body], size, p.direction, xfrc[law.body])
            push_record[0] = k + 1
            for i in range(3):
                xfrc[law.body, 3 + i] += size / p.size * p.moment[i]
                push_record[1 + i] += size * p.direction[i]


@compiled
def _force_at(point: Array, centre: Array, size: float, direction: Array, wrench: Array) -> None:
    """Add a force [N] in a direction (3,) at a point (3,) [m] to the wrench (6,) [N, N m] about a centre (3,) [m]."""
    for i in range(3):
        j = (i + 1) % 3
        n = (i + 2) % 3
        wrench[i] += size * direction[i]
        wrench[3 + i] += size * ((point[j] - centre[j]) * direction[n] - (point[n] - centre[n]) * direction[j])
