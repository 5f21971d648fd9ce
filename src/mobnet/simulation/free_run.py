"""A recording of any robot that moves without walking: plan, plant, control, sensors, truth (docs/logs.md)."""

import logging
import time
import zlib
from collections.abc import Iterator, Sequence
from copy import deepcopy
from dataclasses import fields
from typing import Any, NamedTuple

import mujoco
import numpy as np
from scipy.interpolate import BSpline

from mobnet.core.arrays import Array
from mobnet.core.columns import recording_columns
from mobnet.core.joints import N_VIRTUAL, NQ_BASE, JointLayout
from mobnet.core.recording import Recording, Sensed, Truth
from mobnet.robot.description import RobotDescription
from mobnet.settings.free_motion import FreeMotion
from mobnet.settings.plant import Plant, Rates
from mobnet.simulation.free_motion import TableModel, plan_motion, whole_state
from mobnet.simulation.free_plant import (
    PushSequence,
    damping_of,
    draw_pushes,
    held_model,
    hidden_links,
    joint_friction,
)

STREAMS = ("motion", "pushes", "noise")  # of random numbers of a seed, in the order spawned
HIDDEN = ("body", "motors")  # those of the robot itself, whatever the seed
TOLD_S = 5.0  # between two lines of progress
CHUNK = 10_000  # samples for which the motion is computed at once
PIECE = 60_000  # samples that are held at once, a minute at 1 kHz
log = logging.getLogger(__name__)


class Numbers(NamedTuple):
    """What a run takes of the configuration."""

    motion: FreeMotion
    plant: Plant
    rates: Rates


class RunPiece(NamedTuple):
    """Successive samples of a run: q (n, nq), v (n, nv), acc (n, 3), tau (n, nu), ext, push (n, nv), pushed (n, 1)."""

    q: Array
    v: Array
    acc: Array
    tau: Array
    ext: Array
    push: Array
    pushed: Array


def record_motion(
    robot: RobotDescription, numbers: Numbers, seconds: float, seed: int, ideal: bool, pushed: bool
) -> Recording:
    """Simulate a robot that moves for so long [s], as `motion_pieces` does, and return it as one recording."""
    parts = list(motion_pieces(robot, numbers, seconds, seed, ideal, pushed))
    sensed = [np.concatenate([getattr(piece.sensed, field.name) for piece in parts]) for field in fields(Sensed)]
    truth = [np.concatenate([getattr(piece.truth, field.name) for piece in parts]) for field in fields(Truth)]
    whole = ((0, sum(len(piece.sensed) for piece in parts)),)
    return Recording(Sensed(*sensed), whole, parts[0].rate_hz, parts[0].meta, Truth(*truth))


def motion_pieces(
    robot: RobotDescription, numbers: Numbers, seconds: float, seed: int, ideal: bool, pushed: bool
) -> Iterator[Recording]:
    """Simulate a robot that moves for so long [s], and yield a minute after the other; an hour does not fit in memory.

    All recordings are of the same robot, whatever the seed. `tau_motor` are samples at the ticks: the mean of what a
    motor gave just before and just after one. `tau_ext` are means over the samples, as in every recording: pushes, and
    what holds a floating base. In the ideal case the plant is the table's robot without friction, and sensors are
    exact.

    Raises:
        SimulationError: no motion is found that meets the limits of the robot.
    """
    robot_seed = zlib.crc32(robot.name.encode())
    rng = {**streams(STREAMS, [robot_seed, seed]), **streams(HIDDEN, [robot_seed])}
    settings = numbers.motion
    gravity = numbers.plant.gravity_m_s2
    motion = plan_motion(robot, settings, seconds, gravity, rng["motion"])
    built = robot if ideal else hidden_links(robot, settings.body, rng["body"])
    model = held_model(built, settings, numbers.rates.plant_hz, gravity)
    off = 0.0 if ideal else settings.joints.constant_share
    constants = 1 + off * rng["motors"].uniform(-1, 1, robot.layout.nu)
    drawn = draw_pushes(model, settings.pushes, seconds, rng["pushes"]) if pushed else ()
    run = FreeRun(robot, numbers, model, motion, constants, ideal)
    rate_hz = numbers.rates.data_hz
    rows = round(seconds * rate_hz)
    noise = None if ideal else SensorNoise(robot, numbers, rows, rng["noise"])
    meta = {"scenario": "motion", "level": "ideal" if ideal else "hidden", "seed": seed}
    for samples in run.pieces(rows, PushSequence(drawn, robot.torque_limits, settings.pushes)):
        yield recording_of(noise.added(samples) if noise else samples, robot.layout, rate_hz, meta)


def streams(names: Sequence[str], entropy: Sequence[int]) -> dict[str, np.random.Generator]:
    """Return generators of random numbers by their names."""
    seeds = np.random.SeedSequence(entropy).spawn(len(names))
    return {name: np.random.default_rng(seed) for name, seed in zip(names, seeds, strict=True)}


class FreeRun:
    """A plant in motion."""

    def __init__(
        self,
        robot: RobotDescription,
        numbers: Numbers,
        model: mujoco.MjModel,
        motion: BSpline,
        constants: Array,
        ideal: bool,
    ) -> None:
        """Put a robot at the start of a motion; `constants` (nu,) are true torques over reported ones."""
        self.robot = robot
        self.numbers = numbers
        self.model = model
        self.motion = motion
        self.constants = constants
        self.data = mujoco.MjData(model)
        self.data.qpos[:], self.data.qvel[:] = whole_state(robot, motion(0.0))
        mujoco.mj_forward(model, self.data)
        self.table = TableModel(robot, numbers.plant.gravity_m_s2)
        self.friction = None if ideal else joint_friction(robot, numbers.motion)
        self.gains = numbers.motion.tracking_rad_s**2, 2 * numbers.motion.tracking_rad_s
        self.imu = slice(model.sensor("imu_acc").adr[0], model.sensor("imu_acc").adr[0] + 3) if robot.imu else None

    def pieces(self, rows: int, pushes: PushSequence) -> Iterator[RunPiece]:
        """Simulate so many samples, and yield a minute of them after the other."""
        rate_hz = self.numbers.rates.data_hz
        nv = self.model.nv
        self.before = self.control(*(self.motion(0.0, order) for order in range(3)))
        self.held, self.pushed = np.zeros(nv), np.zeros(nv)  # over the sample that ends at the next tick
        last_told_s = time.monotonic()
        for start in range(0, rows, PIECE):
            count = min(PIECE, rows - start)
            widths = (self.model.nq, nv, 3, self.robot.layout.nu, nv, nv, 1)
            samples = RunPiece(*(np.zeros((count, width)) for width in widths))
            for first in range(0, count, CHUNK):
                if time.monotonic() - last_told_s > TOLD_S:
                    last_told_s = time.monotonic()
                    log.info("%.0f of %.0f s simulated", (start + first) / rate_hz, rows / rate_hz)
                chunk = RunPiece(*(values[first : first + CHUNK] for values in samples))
                self._through(chunk, (start + first + np.arange(len(chunk.q))) / rate_hz, pushes)
            yield samples

    def _through(self, samples: RunPiece, times: Array, pushes: PushSequence) -> None:
        """Simulate the samples at successive times (n,) [s]."""
        data = self.data
        for k, wanted in enumerate(zip(*(self.motion(times, order) for order in range(3)), strict=True)):
            samples.q[k] = data.qpos
            samples.v[k] = data.qvel
            samples.acc[k] = 0.0 if self.imu is None else data.sensordata[self.imu]
            samples.ext[k] = self.held + self.pushed
            samples.push[k] = self.pushed
            samples.pushed[k] = self.pushed.any()
            torque = self.control(*wanted)
            samples.tau[k] = (self.before + torque) / 2
            self.before = torque
            self.held, self.pushed = self.step(torque, pushes)

    def control(self, q: Array, v: Array, acceleration: Array) -> Array:
        """Return the motors' torques (nu,) [N m] that follow a motion (nu,) by the model of the table."""
        data = self.data
        nu = self.robot.layout.nu
        (stiff, damp) = self.gains
        wanted = acceleration + stiff * (q - data.qpos[-nu:]) + damp * (v - data.qvel[-nu:])
        limits = self.robot.torque_limits
        return np.clip(self.table.torque(data.qpos, data.qvel, wanted), -limits, limits)

    def step(self, torque: Array, pushes: PushSequence) -> tuple[Array, Array]:
        """Advance by a sample; return its mean torques of what holds the base, and of pushes, (nv,) [N], [N m] each."""
        model = self.model
        data = self.data
        rates = self.numbers.rates
        holding = np.zeros(model.nv)
        pushed = np.zeros(model.nv)
        every = round(rates.plant_hz / rates.data_hz)
        data.ctrl[:] = self.constants * torque
        for _ in range(every):
            data.qfrc_applied[:] = pushes.torque(model, data)
            if self.friction is not None:
                model.dof_damping[-len(torque) :] = damping_of(self.friction, data.qvel[-len(torque) :], data.ctrl)
            mujoco.mj_step(model, data)
            holding += data.qfrc_constraint / every
            pushed += data.qfrc_applied / every
        return holding, pushed


class SensorNoise:
    """Errors of sensors: steps of encoders, noise of speeds, base and torques (Table 3, our own)."""

    def __init__(self, robot: RobotDescription, numbers: Numbers, rows: int, rng: np.random.Generator) -> None:
        """Take the random numbers of a run of so many samples.

        Each signal has those of all of its samples behind those of the signal before it, so that each gets a generator
        of its own, which begins there: noise does not depend on the pieces in which it is added.
        """
        self._robot = robot
        self._numbers = numbers
        nu = robot.layout.nu
        self._v, self._tau = _apart(rng, rows, nu), _apart(rng, rows, nu)
        if robot.floating:
            self._offset = numbers.plant.own_noise.orientation_offset_rad * rng.normal(size=3)
            self._quaternion, self._omega = _apart(rng, rows, 3), _apart(rng, rows, 3)
        self._acc = _apart(rng, rows, 3)

    def added(self, samples: RunPiece) -> RunPiece:
        """Return the samples that follow the last ones, with noise; what they hold is overwritten."""
        robot = self._robot
        noise = self._numbers.plant.noise
        noise_numbers = self._numbers.plant.own_noise
        share = self._numbers.motion.joints.torque_noise_share
        (rows, nu) = samples.tau.shape
        samples.q[:, -nu:] = noise_numbers.encoder_step_rad * np.rint(
            samples.q[:, -nu:] / noise_numbers.encoder_step_rad
        )
        samples.v[:, -nu:] += noise.joint_velocity_rad_s * self._v.normal(size=(rows, nu))
        samples.tau[:] += share * robot.torque_limits * self._tau.normal(size=(rows, nu))
        if robot.floating:
            half = self._offset + noise_numbers.orientation_rad * self._quaternion.normal(size=(rows, 3))
            samples.q[:, 3:NQ_BASE] = slightly_turned(samples.q[:, 3:NQ_BASE], half / 2)
            samples.v[:, 3:N_VIRTUAL] += noise.base_angular_velocity_rad_s * self._omega.normal(size=(rows, 3))
        if robot.imu:
            samples.acc[:] += noise.base_acceleration_m_s2 * self._acc.normal(size=(rows, 3))
        return samples


def _apart(rng: np.random.Generator, rows: int, width: int) -> np.random.Generator:
    """Return a generator of the next normal numbers (rows, width); the given one goes on behind them."""
    copied = deepcopy(rng)
    for start in range(0, rows, CHUNK):
        rng.normal(size=(min(CHUNK, rows - start), width))
    return copied


def slightly_turned(quaternion: Array, half: Array) -> Array:
    """Return quaternions w x y z (T, 4), turned by small rotation vectors 2 `half`, (T, 3) [rad] in base axes."""
    w = quaternion[:, :1]
    u = quaternion[:, 1:]
    turned = np.hstack([w - (u * half).sum(axis=1, keepdims=True), u + w * half + np.cross(u, half)])
    return turned / np.linalg.norm(turned, axis=1, keepdims=True)


def recording_of(run: RunPiece, layout: JointLayout, rate_hz: float, meta: dict[str, Any]) -> Recording:
    """Return samples of a run as a recording; what does not exist, and feet that touch nothing, are zero."""
    rows = len(run.q)
    values = {name: np.zeros((rows, len(columns))) for name, columns in recording_columns(layout).items()}
    values |= {"q": run.q, "v": run.v, "tau_des": run.tau, "tau_motor": run.tau}
    values |= {"tau_ext": run.ext, "pushed": run.pushed, "tau_push": run.push}
    if layout.virtual:
        values["acc_base_in_base"] = run.acc
    sensed = {field.name: values[field.name] for field in fields(Sensed)}
    truth = {field.name: values[field.name] for field in fields(Truth)}
    return Recording(Sensed(**sensed), ((0, rows),), rate_hz, meta, Truth(**truth))
