"""Sensor readings of the plant: noise of Table 3 and of our own, and the base state that the robot estimates."""

import math
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from mobnet.control.base_state import update_base
from mobnet.control.walker import Walker
from mobnet.core.arrays import Array
from mobnet.core.compilation import compiled, vector3
from mobnet.robot.description import SIDES
from mobnet.settings.plant import Noise, Plant
from mobnet.settings.surrogate import Level, SensorErrors


class Sensors(NamedTuple):
    """The robot's sensors, as the compiled loop takes them: their noise, places in MuJoCo's data, and readings."""

    q_std: float  # noise of joint positions, a standard deviation [rad]
    v_std: float  # noise of joint velocities [rad/s]
    acc_std: float  # noise of the base's acceleration [m/s^2]
    omega_std: float  # noise of the base's angular velocity [rad/s]
    encoder_step: float  # joint positions are multiples of it [rad]; 0 for exact ones
    turn_std: float  # noise of the base's orientation about each axis [rad]
    offset_std: float  # its error that stays for an episode [rad]
    force_std: float  # noise of the feet's forces [N]
    moment_std: float  # noise of the feet's moments [N m]
    sensed_base: int  # 1 if base position and velocity come from proprioception, 0 if they are the plant's
    gyro: int  # first entry of the gyroscope in sensordata
    acc: int  # first entry of the accelerometer
    force: NDArray[np.int64]  # first entries of the left, right foot's force (2,)
    torque: NDArray[np.int64]  # first entries of their torque (2,)
    offset: Array  # error of the base's orientation in this episode, a rotation vector in base axes (3,) [rad]
    q: Array  # generalized position (nq,), as `Sensed.q`
    v: Array  # generalized velocity (nv,), as `Sensed.v`
    acc_base_in_base: Array  # specific force (3,) [m/s^2]
    wrenches: Array  # ground's wrench on the feet about their sensors, foot axes (2, 6) [N, N m]
    estimated: int  # 1 if the controller is told `told` in place of these wrenches
    told: Array  # estimated wrenches, as `wrenches` (2, 6) [N, N m]; written by who runs the loop


def make_sensors(
    plant: Plant, level: Level, model: mujoco.MjModel, estimated: bool = False, errors: SensorErrors | None = None
) -> Sensors:
    """Build the sensors of a plant at an uncertainty level (section 5.1), with the errors of a surrogate robot.

    Without errors, all noise is that of Table 3; see `Sensors.estimated`.
    """
    q_std, v_std, acc_std, omega_std = read_table_03(plant.noise, level)
    if errors is not None:
        acc_std = errors.acceleration_noise_m_s2
        omega_std = errors.angular_velocity_noise_rad_s
    noise = plant.own_noise
    noisy = level.noise != "none"
    return Sensors(
        q_std=q_std,
        v_std=v_std,
        acc_std=acc_std,
        omega_std=omega_std,
        encoder_step=noisy * noise.encoder_step_rad,
        turn_std=noisy * noise.orientation_rad,
        offset_std=noisy * noise.orientation_offset_rad,
        force_std=noisy * noise.foot_force_n,
        moment_std=noisy * noise.foot_moment_nm,
        sensed_base=int(level.base_state == "sensed"),
        gyro=int(model.sensor("imu_gyro").adr[0]),
        acc=int(model.sensor("imu_acc").adr[0]),
        force=np.array([model.sensor(f"{side}_foot_force").adr[0] for side in SIDES], dtype=np.int64),
        torque=np.array([model.sensor(f"{side}_foot_torque").adr[0] for side in SIDES], dtype=np.int64),
        offset=np.zeros(3),
        q=np.zeros(model.nq),
        v=np.zeros(model.nv),
        acc_base_in_base=np.zeros(3),
        wrenches=np.zeros((len(SIDES), 6)),
        estimated=int(estimated),
        told=np.zeros((len(SIDES), 6)),
    )


def read_table_03(noise: Noise, level: Level) -> tuple[float, ...]:
    """Return standard deviations of joint position [rad], joint velocity [rad/s], acceleration [m/s^2], gyro [rad/s].

    The level says how the numbers of Table 3 are read: as standard deviations (`std`), so with those of acceleration
    and angular velocity exchanged (`swapped`), or as variances (`variance`), as the table calls them.
    """
    q = noise.joint_position_rad
    v = noise.joint_velocity_rad_s
    acc = noise.base_acceleration_m_s2
    omega = noise.base_angular_velocity_rad_s
    readings = {
        "none": (0.0, 0.0, 0.0, 0.0),
        "std": (q, v, acc, omega),
        "swapped": (q, v, omega, acc),
        "variance": (math.sqrt(q), math.sqrt(v), math.sqrt(acc), math.sqrt(omega)),
    }
    return readings[level.noise]


def reset_sensors(sensors: Sensors, q: Array, v: Array, rng: np.random.Generator) -> None:
    """Begin an episode at a known q (nq,), v (nv,) without load on the feet; the orientation's error is drawn."""
    sensors.q[:] = q
    sensors.v[:] = v
    sensors.wrenches[:] = 0.0
    sensors.offset[:] = sensors.offset_std * rng.standard_normal(3)


@compiled
def read_sensors(
    sensors: Sensors, walker: Walker, qpos: Array, qvel: Array, sensordata: Array, rng: np.random.Generator, dt: float
) -> None:
    """Fill the readings from the plant after a step of dt [s]: qpos (nq,), qvel (nv,), sensordata of that step."""
    _read_feet(sensors, sensordata, rng)
    for i in range(3):
        sensors.acc_base_in_base[i] = sensordata[sensors.acc + i] + sensors.acc_std * rng.standard_normal()
    if sensors.sensed_base == 1:
        update_base(walker, sensors.acc_base_in_base, dt, sensors.q, sensors.v)
    else:
        for i in range(3):
            sensors.q[i] = qpos[i]
            sensors.v[i] = qvel[i]
    _read_orientation(sensors, qpos, rng)
    for i in range(3, 6):
        sensors.v[i] = qvel[i] + sensors.omega_std * rng.standard_normal()
    for i in range(7, len(qpos)):
        q = qpos[i] + sensors.q_std * rng.standard_normal()
        step = sensors.encoder_step
        sensors.q[i] = q if step == 0.0 else step * np.rint(q / step)
    for i in range(6, len(qvel)):
        sensors.v[i] = qvel[i] + sensors.v_std * rng.standard_normal()


@compiled
def _read_feet(sensors: Sensors, sensordata: Array, rng: np.random.Generator) -> None:
    """Fill the wrenches of the ground on the feet; MuJoCo gives those of the feet on the soles."""
    for k in range(2):
        for i in range(3):
            sensors.wrenches[k, i] = -sensordata[sensors.force[k] + i] + sensors.force_std * rng.standard_normal()
            sensors.wrenches[k, 3 + i] = -sensordata[sensors.torque[k] + i] + sensors.moment_std * rng.standard_normal()


@compiled
def _read_orientation(sensors: Sensors, qpos: Array, rng: np.random.Generator) -> None:
    """Fill the base's orientation: the true one, turned in base axes by the episode's error and by noise."""
    half = vector3()
    w = qpos[3]
    x = qpos[4]
    y = qpos[5]
    z = qpos[6]
    for i in range(3):
        half[i] = 0.5 * (sensors.offset[i] + sensors.turn_std * rng.standard_normal())
    # The product of the quaternion w x y z with 1 + half, which turns by the small rotation vector 2 half.
    norm = np.sqrt(1.0 + half[0] ** 2 + half[1] ** 2 + half[2] ** 2)
    sensors.q[3] = (w - x * half[0] - y * half[1] - z * half[2]) / norm
    sensors.q[4] = (x + w * half[0] + y * half[2] - z * half[1]) / norm
    sensors.q[5] = (y + w * half[1] + z * half[0] - x * half[2]) / norm
    sensors.q[6] = (z + w * half[2] + x * half[1] - y * half[0]) / norm
