"""The plant's loop, compiled: controller, motors, friction, MuJoCo's step, truth, sensors, log."""

from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from mobnet.control.geometry import clip
from mobnet.control.parameters import State
from mobnet.control.random_torque import Exploration, advance_random_torque
from mobnet.control.upper_body import UpperBody, follow
from mobnet.control.walker import Walker
from mobnet.control.walking import walk
from mobnet.core.arrays import Array
from mobnet.core.compilation import compiled
from mobnet.core.machine_code import HeldValue
from mobnet.robot.description import LEG_JOINTS
from mobnet.simulation.drives import Drives, drive
from mobnet.simulation.faults import Faults, perceive
from mobnet.simulation.friction import PlantFriction, friction_torque
from mobnet.simulation.native import Native, addresses_at, call_step, doubles_at, ints_at
from mobnet.simulation.pushes import Pushes, push
from mobnet.simulation.sensing import Sensors, read_sensors
from mobnet.simulation.world import World

FIRST_CONTACT_ROW = int(mujoco.mjtConstraint.mjCNSTR_CONTACT_FRICTIONLESS)  # after equalities, friction loss and limits
CONTACT_ROWS = 3  # of a contact: its normal and two directions of friction, in the order of MuJoCo's elliptic cone
CONTACT_FORCE_N = 1.0  # a foot that the ground pushes harder touches it


class LivePlant(NamedTuple):
    """Live arrays of MuJoCo's data and what the plant adds to them."""

    native: Native  # addresses
    qpos: Array  # generalized position (nq,)
    qvel: Array  # generalized velocity (nv,)
    ctrl: Array  # motor torques (nu,) [N m]
    qfrc_applied: Array  # generalized forces from outside MuJoCo (nv,) [N, N m]: friction and pushes on joints
    xfrc_applied: Array  # pushes on bodies, at their centres of mass (nbody, 6) [N, N m]
    site_xpos: Array  # points of the robot (nsite, 3) [m]
    xipos: Array  # centres of mass of the bodies (nbody, 3) [m]
    xmat: Array  # axes of the bodies (nbody, 9)
    qfrc_smooth: Array  # passive - bias + applied + actuator + mapped xfrc_applied (nv,)
    qfrc_bias: Array  # Coriolis, centrifugal and gravity (nv,)
    qfrc_passive: Array  # passive forces (nv,)
    qfrc_actuator: Array  # motor torques in the generalized velocity (nv,)
    sensordata: Array  # readings of the step just taken
    friction: PlantFriction  # numbers of (23)
    drives: Drives  # of a surrogate robot
    faults: Faults  # of its sensors
    gravity: float  # gravity [m/s^2]
    links: Array  # torques of drives on the links (nu,) [N m]
    limits: Array  # motor limits (nu,) [N m]
    period: float  # length after which the terrain repeats [m]
    edge: float  # distance from the origin in x or y beyond which the robot is put back by a period [m]
    fall_height: float  # height of the pelvis below which the robot has fallen [m]
    dt: float  # step [s]
    every: int  # steps in a sample


def make_plant(
    world: World,
    native: Native,
    friction: PlantFriction,
    drives: Drives,
    faults: Faults,
    limits: Array,
    fall_height: float,
    every: int,
) -> LivePlant:
    """Collect the live arrays of a world; the world must outlive the plant. limits (nu,) [N m], fall_height [m]."""
    data = world.data
    return LivePlant(
        native=native,
        qpos=data.qpos,
        qvel=data.qvel,
        ctrl=data.ctrl,
        qfrc_applied=data.qfrc_applied,
        xfrc_applied=data.xfrc_applied,
        site_xpos=data.site_xpos,
        xipos=data.xipos,
        xmat=data.xmat,
        qfrc_smooth=data.qfrc_smooth,
        qfrc_bias=data.qfrc_bias,
        qfrc_passive=data.qfrc_passive,
        qfrc_actuator=data.qfrc_actuator,
        sensordata=data.sensordata,
        friction=friction,
        drives=drives,
        faults=faults,
        gravity=-float(world.model.opt.gravity[2]),
        links=np.zeros(len(data.ctrl)),
        limits=np.array(limits, dtype=float),
        period=float(world.period),
        edge=world.edge,
        fall_height=float(fall_height),
        dt=float(world.model.opt.timestep),
        every=int(every),
    )


class Loop(NamedTuple):
    """What the loop works on, sample after sample."""

    plant: LivePlant
    walker: Walker
    sensors: Sensors
    s: State  # of the controller
    upper: UpperBody
    torque: Exploration
    pushes: Pushes
    rng_noise: np.random.Generator
    rng_torque: np.random.Generator
    rng_pushes: np.random.Generator


@compiled(allocating=True)
def run(held: HeldValue, commands: Array, log: NDArray[np.float32]) -> int:
    """Simulate len(log) samples into log (n, C), columns of `recording_columns`; return how many before a fall.

    A `Loop` is held. A call takes few arguments, so that a walk with an estimator in it can call for each sample.
    """
    plant, walker, sensors, s, upper, torque, pushes, rng_noise, rng_torque, rng_pushes = held.value
    nv = len(plant.qvel)
    nu = len(plant.ctrl)
    tau = np.zeros(nu)
    tau_des = np.zeros(nu)
    tau_motor = np.zeros(nu)
    tau_ext = np.zeros(nv)
    tau_random = np.zeros(nu)
    tau_push = np.zeros(nv)
    wrenches = np.zeros((2, 6))
    touch = np.zeros(2)
    push_record = np.zeros(4)
    for row in range(len(log)):
        pushed = 0
        tau_des[:] = 0.0
        tau_motor[:] = 0.0
        tau_ext[:] = 0.0
        tau_random[:] = 0.0
        tau_push[:] = 0.0
        wrenches[:] = 0.0
        touch[:] = 0.0
        push_record[:] = 0.0
        for _ in range(plant.every):
            follow(upper, s.clock, walker.posture, walker.posture_rate)
            loads = sensors.told if sensors.estimated == 1 else sensors.wrenches
            walk(walker, s, sensors.q, sensors.v, loads, commands, plant.dt, tau)
            _explore(walker, s, torque, rng_torque, plant.dt, tau, tau_random)
            _actuate(plant, tau, tau_des, tau_motor)
            push(
                pushes,
                s,
                plant.xfrc_applied,
                plant.qfrc_applied,
                plant.site_xpos,
                plant.xipos,
                plant.xmat,
                plant.dt,
                rng_pushes,
                tau_push,
                push_record,
            )
            active = pushes.state.active.sum()
            pushed += active
            s.clock += plant.dt
            call_step(plant.native.step, plant.native.model, plant.native.data)
            if active > 0:
                _add_pushes(plant, tau_push)
            _add_contacts(plant, walker, tau_ext, touch)
            _sense(plant, walker, sensors, rng_noise)
            wrenches += sensors.wrenches
            _wrap(plant, sensors, s)
        for i in range(nv):
            tau_ext[i] += tau_push[i]
        _write(
            log[row],
            sensors,
            s,
            tau_des,
            tau_motor,
            tau_ext,
            tau_random,
            tau_push,
            push_record,
            wrenches,
            touch,
            pushed,
            plant.every,
        )
        if not plant.qpos[2] > plant.fall_height:  # a state that is not finite is a fall too
            return row
    return len(log)


@compiled
def _explore(
    walker: Walker, s: State, torque: Exploration, rng: np.random.Generator, dt: float, tau: Array, added: Array
) -> None:
    """Add the random torque to the desired torques tau and to its sum `added` (nu,) [N m], but not to a loaded leg."""
    advance_random_torque(torque, rng, dt)
    swing = -1 if s.swinging == 0 else (1 if s.side > 0 else 0)
    for j in range(len(tau)):
        if j < walker.upper and (swing < 0 or not walker.first[swing] <= j < walker.first[swing] + 6):
            continue
        tau[j] += torque.value[j]
        added[j] += torque.value[j]


@compiled
def _actuate(plant: LivePlant, tau: Array, tau_des: Array, tau_motor: Array) -> None:
    """Clip the desired torques tau (nu,) and send them to the motors, and friction to the joints; add to both sums.

    The limits are applied before the torque is sent: no drive is ever asked for more than it can give.
    """
    for j in range(len(tau)):
        tau[j] = clip(tau[j], -plant.limits[j], plant.limits[j])
        tau_des[j] += tau[j]
    if plant.drives.hidden == 1:
        drive(plant.drives, tau, plant.qpos[7:], plant.qvel[6:], plant.dt, plant.links, tau_motor)
        for j in range(len(tau)):
            plant.qfrc_applied[6 + j] = plant.links[j]
        return
    for j in range(len(tau)):
        plant.ctrl[j] = tau[j]
        plant.qfrc_applied[6 + j] = friction_torque(plant.friction, j, plant.qvel[6 + j], tau[j])
        tau_motor[j] += plant.ctrl[j]


@compiled
def _sense(plant: LivePlant, walker: Walker, sensors: Sensors, rng: np.random.Generator) -> None:
    """Read the sensors after a step; those of a surrogate robot do not see the plant itself."""
    if plant.faults.hidden == 0 and plant.drives.hidden == 0:
        read_sensors(sensors, walker, plant.qpos, plant.qvel, plant.sensordata, rng, plant.dt)
        return
    seen = plant.faults
    perceive(seen, sensors, plant.drives, plant.qpos, plant.qvel, plant.sensordata, plant.xmat, plant.gravity)
    read_sensors(sensors, walker, seen.qpos, seen.qvel, seen.data, rng, plant.dt)


@compiled
def _add_pushes(plant: LivePlant, tau_push: Array) -> None:
    """Add J^T F of the pushes on bodies in the step just taken (nv,) [N, N m]: what MuJoCo mapped of xfrc_applied."""
    for i in range(len(tau_push)):
        smooth = plant.qfrc_passive[i] - plant.qfrc_bias[i] + plant.qfrc_applied[i] + plant.qfrc_actuator[i]
        tau_push[i] += plant.qfrc_smooth[i] - smooth


@compiled
def _add_contacts(plant: LivePlant, walker: Walker, tau_ext: Array, touch: Array) -> None:
    """Add J^T F of the solver's contact rows in the step just taken (nv,) [N, N m].

    Only the contact rows: the constraint forces as a whole also hold friction loss and joint limits. Of a contact's
    three rows the first is its normal; normal forces [N] are added to touch (2,) of the left, right foot.
    """
    data = plant.native.data
    rows = ints_at(data + plant.native.nefc)[0]
    if rows == 0:
        return
    kinds = ints_at(addresses_at(data + plant.native.efc_type)[0])
    forces = doubles_at(addresses_at(data + plant.native.efc_force)[0])
    entries = ints_at(addresses_at(data + plant.native.row_entries)[0])
    starts = ints_at(addresses_at(data + plant.native.row_start)[0])
    columns = ints_at(addresses_at(data + plant.native.entry_column)[0])
    values = doubles_at(addresses_at(data + plant.native.entry_value)[0])
    for r in range(rows - 1, -1, -1):  # contact rows come last
        if kinds[r] < FIRST_CONTACT_ROW:
            break
        if forces[r] == 0.0:
            continue
        for i in range(starts[r], starts[r] + entries[r]):
            tau_ext[columns[i]] += values[i] * forces[r]
        if (rows - r) % CONTACT_ROWS == 0:
            ankle = columns[starts[r] + entries[r] - 1] - 6  # the last joint that the contact loads
            for k in range(2):
                if walker.first[k] <= ankle < walker.first[k] + LEG_JOINTS:
                    touch[k] += forces[r]


@compiled
def _wrap(plant: LivePlant, sensors: Sensors, s: State) -> None:
    """Put a robot beyond the edge back by a period, and all world positions of the controller with it."""
    for i in range(2):
        if abs(plant.qpos[i]) <= plant.edge:
            continue
        shift = -plant.period if plant.qpos[i] > 0.0 else plant.period
        plant.qpos[i] += shift
        sensors.q[i] += shift
        s.old_ankle[i] += shift
        s.lift[i] += shift
        s.foot[i] += shift
        s.target[i] += shift


@compiled
def _write(
    row: NDArray[np.float32],
    sensors: Sensors,
    s: State,
    tau_des: Array,
    tau_motor: Array,
    tau_ext: Array,
    tau_random: Array,
    tau_push: Array,
    push_record: Array,
    wrenches: Array,
    touch: Array,
    pushed: int,
    every: int,
) -> None:
    """Write one sample in the order of `recording_columns`; sums over the sample's steps become means."""
    at = _put(row, 0, sensors.q, 1.0)
    at = _put(row, at, sensors.v, 1.0)
    at = _put(row, at, sensors.acc_base_in_base, 1.0)
    at = _put(row, at, tau_des, 1.0 / every)
    at = _put(row, at, tau_motor, 1.0 / every)
    row[at] = s.swinging if s.side < 0 else 0
    row[at + 1] = s.swinging if s.side > 0 else 0
    at = _put(row, at + 2, s.command, 1.0 - s.standing)
    for k in range(2):
        row[at + k] = max(s.total - s.t, 0.0) * row[at - len(s.command) - 2 + k]
    at = _put(row, at + 2, tau_ext, 1.0 / every)
    for k in range(2):
        at = _put(row, at, wrenches[k], 1.0 / every)
    for k in range(2):
        row[at + k] = touch[k] > every * CONTACT_FORCE_N
    row[at + 2] = pushed > 0
    at = _put(row, at + 3, tau_random, 1.0 / every)
    at = _put(row, at, tau_push, 1.0 / every)
    row[at] = push_record[0]
    _put(row, at + 1, push_record[1:], 1.0 / every)


@compiled
def _put(row: NDArray[np.float32], at: int, values: Array, scale: float) -> int:
    """Write scaled values from column `at` on; return the next column."""
    for i in range(len(values)):
        row[at + i] = values[i] * scale
    return at + len(values)
