"""Drives of the surrogate robot: a current loop, a rotor with friction that no fit has the form of, a gear that gives.

Rotor and link are coupled by the spring of the gear, so an encoder on the motor reads the rotor. Friction acts on the
rotor; it follows a reversal over a presliding angle (Dahl), grows with the torque that the gear transmits, differs
between directions, varies along a turn and falls while the gear warms up (docs/notes/surrogate.md).
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.compilation import compiled
from mobnet.robot.description import RobotDescription
from mobnet.settings.surrogate import Surrogate

LAW = np.dtype(
    [
        ("constant", "f8"),
        ("lag", "f8"),
        ("delay", "i8"),
        ("rotor", "f8"),
        ("stiffness", "f8"),
        ("damping", "f8"),
        ("coulomb", "f8"),
        ("viscous", "f8"),
        ("load", "f8"),
        ("back", "f8"),
        ("direction", "f8"),
        ("static", "f8"),
        ("stribeck", "f8"),
        ("presliding", "f8"),
        ("ripple", "f8"),
        ("ripple_waves", "f8"),
        ("ripple_phase", "f8"),
        ("cogging", "f8"),
        ("cogging_waves", "f8"),
        ("cogging_phase", "f8"),
        ("cable", "f8"),
        ("cable_phase", "f8"),
        ("warm", "f8"),
        ("warm_s", "f8"),
    ]
)
STATE = np.dtype([("angle", "f8"), ("rate", "f8"), ("current", "f8"), ("bend", "f8")])
CABLE_WAVES = 2.0  # periods of a cable's torque in a turn of the joint


class Drives(NamedTuple):
    """Drives of all joints (nu,).

    Attributes:
        hidden: 1 if they move the joints, 0 where motors give what is desired and friction is (23).
        law: records of LAW. Torques in N m at the joint: `constant` is the true torque for a reported one, `lag` the
            time constant of the current loop [s], `delay` its dead time in steps of the plant; `rotor` is its inertia
            [kg m^2], `stiffness` [N m/rad] and `damping` [N m s/rad] are those of the gear's spring; `load` is friction
            for each transmitted torque where the motor drives, `back` what it is multiplied by where the load drives.
        state: records of STATE: angle [rad] and rate [rad/s] of the rotor at the joint, `current` as a torque [N m]
            and `bend` of the friction from -1 to 1.
        wanted: what was desired in the last steps (nu, steps) [N m], as many as the longest delay takes.
        clock: time for which the gears have been running [s], and the number of steps so far (2,).
    """

    hidden: int
    law: NDArray[Any]
    state: NDArray[Any]
    wanted: Array
    clock: Array


def no_drives(nu: int) -> Drives:
    """Return what stands in the place of drives on the plant of section 5.1."""
    return Drives(0, np.zeros(nu, LAW), np.zeros(nu, STATE), np.zeros((nu, 1)), np.zeros(2))


def draw_drives(
    surrogate: Surrogate, robot: RobotDescription, link: Array, rate_hz: float, rng: np.random.Generator
) -> Drives:
    """Draw the drives of a surrogate robot, a plant stepped at a rate [1/s].

    What a gear's spring turns on the side of the link has the inertia `link` (nu,) [kg m^2].
    """
    drive = surrogate.drive
    drives = no_drives(robot.layout.nu)
    law = drives.law
    typical = dict[str, dict[str, float]]()
    for limb, row in surrogate.limbs.items():
        for i, joint in enumerate(robot.layout.limb(limb)):
            typical[joint] = {name: values[i] for name, values in row}
    for k, joint in enumerate(robot.layout.actuated):
        row = {name: value * rng.uniform(1 - drive.spread, 1 + drive.spread) for name, value in typical[joint].items()}
        rotor = max(robot.joints[k].armature, drive.rotor_min_kg_m2)
        either = rng.choice([-1.0, 1.0])
        shared = rotor * link[k] / (rotor + link[k])
        drawn = {
            "constant": rng.uniform(*drive.torque_constant),
            "lag": rng.uniform(*drive.lag_s),
            "delay": round(rng.uniform(*drive.delay_s) * rate_hz),
            "rotor": rotor,
            "stiffness": row["stiffness_nm_rad"],
            "damping": 2 * drive.damping_ratio * np.sqrt(row["stiffness_nm_rad"] * shared),
            "coulomb": drive.dry_scale * row["coulomb_nm"],
            "viscous": row["viscous_nms"],
            "load": row["load_share"],
            "back": rng.uniform(*drive.back_ratio),
            "direction": either * rng.uniform(*drive.direction_share),
            "static": rng.uniform(*drive.static_share),
            "stribeck": rng.uniform(*drive.stribeck_rad_s),
            "presliding": rng.uniform(*drive.presliding_rad),
            "ripple": rng.uniform(*drive.ripple_share),
            "ripple_waves": drive.ripple_waves,
            "cogging": row["cogging_nm"],
            "cogging_waves": drive.cogging_waves,
            "cable": row["cable_nm"],
            "warm": rng.uniform(*drive.warm_share),
            "warm_s": rng.uniform(*drive.warm_s),
        }
        for name, value in drawn.items():
            law[name][k] = value
        for name in ("ripple_phase", "cogging_phase", "cable_phase"):
            law[name][k] = rng.uniform(-np.pi, np.pi)
    return drives._replace(hidden=1, wanted=np.zeros((len(law), law["delay"].max() + 1)))


def reset_drives(drives: Drives, q: Array, v: Array, running_s: float) -> None:
    """Begin an episode with the rotors at the joints, q (nu,) [rad], v (nu,) [rad/s], after running so long [s]."""
    drives.state[:] = 0
    drives.state["angle"] = q
    drives.state["rate"] = v
    drives.clock[:] = running_s, 0.0


@compiled
def drive(drives: Drives, tau: Array, q: Array, v: Array, dt: float, link: Array, reported: Array) -> None:
    """Advance the drives by a step of dt [s], given desired torques tau (nu,) [N m].

    Joints are at q (nu,) [rad], v (nu,) [rad/s]. Written are the torques on the links (nu,) [N m], and added what the
    drives report of their motors (nu,) [N m].
    """
    step = int(drives.clock[1])
    size = drives.wanted.shape[1]
    for j in range(len(tau)):
        law = drives.law[j]
        s = drives.state[j]
        drives.wanted[j, step % size] = tau[j]
        past = drives.wanted[j, max(step - law.delay, 0) % size]
        s.current += (past - s.current) * (1.0 - np.exp(-dt / law.lag))
        reported[j] += s.current
        spring = law.stiffness * (s.angle - q[j]) + law.damping * (s.rate - v[j])
        cold = 1.0 - law.warm * (1.0 - np.exp(-drives.clock[0] / law.warm_s))
        friction = _friction(law, s, spring, cold, dt)
        cogging = law.cogging * np.sin(law.cogging_waves * s.angle + law.cogging_phase)
        push = law.constant * s.current + cogging - friction - spring
        # Viscous friction is taken at the end of the step, which is stable for any inertia.
        s.rate = (s.rate + dt / law.rotor * push) / (1.0 + dt * law.viscous * cold / law.rotor)
        s.angle += dt * s.rate
        link[j] = spring + law.cable * np.sin(CABLE_WAVES * q[j] + law.cable_phase)
    drives.clock[0] += dt
    drives.clock[1] += 1.0


@compiled
def _friction(law: Any, s: Any, spring: float, cold: float, dt: float) -> float:
    """Return the dry friction [N m] against a rotor's motion, whose presliding goes on by dt [s].

    Which side drives, and the direction, are told by the bend itself: it changes over an angle and not at once.
    """
    sign = 1.0 if s.rate > 0.0 else -1.0
    s.bend = sign + (s.bend - sign) * np.exp(-abs(s.rate) * dt / law.presliding)
    drives_load = 0.5 * (1.0 + s.bend * (1.0 if spring > 0.0 else -1.0))
    share = law.load * (drives_load + (1.0 - drives_load) * law.back)
    size = cold * law.coulomb * (1.0 + law.direction * s.bend) + share * abs(spring)
    size *= 1.0 + law.static * np.exp(-abs(s.rate) / law.stribeck)
    return size * (1.0 + law.ripple * np.sin(law.ripple_waves * s.angle + law.ripple_phase)) * s.bend
