"""A recording of any robot that moves without walking: plan, plant, control, sensors, truth (docs/robots.md)."""

import logging
import time
import zlib
from collections.abc import Sequence
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
log = logging.getLogger(__name__)


class Numbers(NamedTuple):
    """What a run takes of the configuration."""

    motion: FreeMotion
    plant: Plant
    rates: Rates


def record_motion(
    robot: RobotDescription, numbers: Numbers, seconds: float, seed: int, ideal: bool, pushed: bool
) -> Recording:
    """Simulate a robot that moves for so long [s]; all recordings are of the same robot, whatever the seed.

    `tau_motor` are samples at the ticks: the mean of what a motor gave just before and just after one. `tau_ext` are
    means over the samples, as in every recording: pushes, and what holds a floating base. In the ideal case the plant
    is the table's robot without friction, and sensors are exact.

    Raises:
        SimulationError: no motion is found that meets the limits of the robot.
    """
    own = zlib.crc32(robot.name.encode())
    rng = {**streams(STREAMS, [own, seed]), **streams(HIDDEN, [own])}
    settings = numbers.motion
    gravity = numbers.plant.gravity_m_s2
    motion = plan_motion(robot, settings, seconds, gravity, rng["motion"])
    built = robot if ideal else hidden_links(robot, settings.body, rng["body"])
    model = held_model(built, settings, numbers.rates.plant_hz, gravity)
    off = 0.0 if ideal else settings.joints.constant_share
    constants = 1 + off * rng["motors"].uniform(-1, 1, robot.layout.nu)
    drawn = draw_pushes(model, settings.pushes, seconds, rng["pushes"]) if pushed else ()
    run = FreeRun(robot, numbers, model, motion, constants, ideal)
    run.through(round(seconds * numbers.rates.data_hz), PushSequence(drawn, robot.torque_limits, settings.pushes))
    if not ideal:
        add_noise(run, robot, numbers, rng["noise"])
    meta = {"scenario": "motion", "level": "ideal" if ideal else "hidden", "seed": seed}
    return recording_of(run, robot.layout, numbers.rates.data_hz, meta)


def streams(names: Sequence[str], entropy: Sequence[int]) -> dict[str, np.random.Generator]:
    """Return generators of random numbers by their names."""
    seeds = np.random.SeedSequence(entropy).spawn(len(names))
    return {name: np.random.default_rng(seed) for name, seed in zip(names, seeds, strict=True)}


class FreeRun:
    """A plant in motion, and its samples: q (T, nq), v (T, nv), acc (T, 3), tau (T, nu), ext (T, nv), pushed (T, 1)."""

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

    def through(self, samples: int, pushes: PushSequence) -> None:
        """Simulate so many samples."""
        model = self.model
        data = self.data
        nu = self.robot.layout.nu
        rate_hz = self.numbers.rates.data_hz
        self.q = np.zeros((samples, model.nq))
        self.v = np.zeros((samples, model.nv))
        self.tau = np.zeros((samples, nu))
        self.ext = np.zeros((samples, model.nv))
        self.push = np.zeros((samples, model.nv))
        self.pushed = np.zeros((samples, 1))
        self.acc = np.zeros((samples, 3))
        before = self.control(*(self.motion(0.0, order) for order in range(3)))
        told = time.monotonic()
        for start in range(0, samples, CHUNK):
            if time.monotonic() - told > TOLD_S:
                told = time.monotonic()
                log.info("%.0f of %.0f s simulated", start / rate_hz, samples / rate_hz)
            times = np.arange(start, min(start + CHUNK, samples)) / rate_hz
            for k, *wanted in zip(
                range(start, samples), *(self.motion(times, order) for order in range(3)), strict=False
            ):
                self.q[k] = data.qpos
                self.v[k] = data.qvel
                self.acc[k] = 0.0 if self.imu is None else data.sensordata[self.imu]
                torque = self.control(*wanted)
                self.tau[k] = (before + torque) / 2
                before = torque
                held, pushed = self.step(torque, pushes)
                if k + 1 < samples:
                    self.ext[k + 1] = held + pushed
                    self.push[k + 1] = pushed
                    self.pushed[k + 1] = pushed.any()

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
        held = np.zeros(model.nv)
        pushed = np.zeros(model.nv)
        every = round(rates.plant_hz / rates.data_hz)
        data.ctrl[:] = self.constants * torque
        for _ in range(every):
            data.qfrc_applied[:] = pushes.torque(model, data)
            if self.friction is not None:
                model.dof_damping[-len(torque) :] = damping_of(self.friction, data.qvel[-len(torque) :], data.ctrl)
            mujoco.mj_step(model, data)
            held += data.qfrc_constraint / every
            pushed += data.qfrc_applied / every
        return held, pushed


def add_noise(run: FreeRun, robot: RobotDescription, numbers: Numbers, rng: np.random.Generator) -> None:
    """Add errors of sensors to the samples: steps of encoders, noise of speeds, base and torques (Table 3, our own)."""
    noise = numbers.plant.noise
    own = numbers.plant.own_noise
    nu = robot.layout.nu
    rows = len(run.q)
    run.q[:, -nu:] = own.encoder_step_rad * np.rint(run.q[:, -nu:] / own.encoder_step_rad)
    run.v[:, -nu:] += noise.joint_velocity_rad_s * rng.normal(size=(rows, nu))
    run.tau += numbers.motion.joints.torque_noise_share * robot.torque_limits * rng.normal(size=(rows, nu))
    if robot.floating:
        half = own.orientation_offset_rad * rng.normal(size=3) + own.orientation_rad * rng.normal(size=(rows, 3))
        run.q[:, 3:NQ_BASE] = slightly_turned(run.q[:, 3:NQ_BASE], half / 2)
        run.v[:, 3:N_VIRTUAL] += noise.base_angular_velocity_rad_s * rng.normal(size=(rows, 3))
    if run.imu is not None:
        run.acc += noise.base_acceleration_m_s2 * rng.normal(size=(rows, 3))


def slightly_turned(quaternion: Array, half: Array) -> Array:
    """Return quaternions w x y z (T, 4), turned by small rotation vectors 2 `half`, (T, 3) [rad] in base axes."""
    w = quaternion[:, :1]
    u = quaternion[:, 1:]
    turned = np.hstack([w - (u * half).sum(axis=1, keepdims=True), u + w * half + np.cross(u, half)])
    return turned / np.linalg.norm(turned, axis=1, keepdims=True)


def recording_of(run: FreeRun, layout: JointLayout, rate_hz: float, meta: dict[str, Any]) -> Recording:
    """Return the samples of a run as a recording; what does not exist, and feet that touch nothing, are zero."""
    rows = len(run.q)
    values = {name: np.zeros((rows, len(columns))) for name, columns in recording_columns(layout).items()}
    values |= {"q": run.q, "v": run.v, "tau_des": run.tau, "tau_motor": run.tau}
    values |= {"tau_ext": run.ext, "pushed": run.pushed, "tau_push": run.push}
    if layout.virtual:
        values["acc_base_in_base"] = run.acc
    sensed = {field.name: values[field.name] for field in fields(Sensed)}
    truth = {field.name: values[field.name] for field in fields(Truth)}
    return Recording(Sensed(**sensed), ((0, rows),), rate_hz, meta, Truth(**truth))
