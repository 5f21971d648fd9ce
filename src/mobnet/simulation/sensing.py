"""Sensor readings of the plant: noise of Table 3, and the base state that the robot estimates."""

import math
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from mobnet.control.base_state import update_base
from mobnet.control.compiled import compiled
from mobnet.control.walker import Walker, vertical_force
from mobnet.core.arrays import Array
from mobnet.robot.description import SIDES
from mobnet.settings.plant import Level, NoiseStd

NOISE = {"none": lambda _: 0.0, "std": float, "variance": math.sqrt}  # how the numbers of Table 3 are read


class Sensors(NamedTuple):
    """Noise, addresses and readings."""

    q_std: float  # noise of joint positions, a standard deviation [rad]
    v_std: float  # noise of joint velocities [rad/s]
    acc_std: float  # noise of the base's acceleration [m/s^2]
    omega_std: float  # noise of the base's angular velocity [rad/s]
    sensed_base: int  # 1 if base position and velocity come from proprioception, 0 if they are the plant's
    gyro: int  # first entry of the gyroscope in sensordata
    acc: int  # first entry of the accelerometer
    force: NDArray[np.int64]  # first entries of the left, right foot's force (2,)
    torque: NDArray[np.int64]  # first entries of their torque (2,)
    q: Array  # generalized position (nq,), as `Sensed.q`
    v: Array  # generalized velocity (nv,), as `Sensed.v`
    acc_base_in_base: Array  # specific force (3,) [m/s^2]
    wrenches: Array  # ground's wrench on the feet about their sensors, foot axes (2, 6) [N, N m]
    loads: Array  # vertical force on the feet (2,) [N]


def make_sensors(noise: NoiseStd, level: Level, model: mujoco.MjModel) -> Sensors:
    """Build the sensors of a plant at an uncertainty level (section 5.1) from the numbers of Table 3."""
    std = NOISE[level.noise]
    return Sensors(
        q_std=std(noise.joint_position_rad),
        v_std=std(noise.joint_velocity_rad_s),
        acc_std=std(noise.base_acceleration_m_s2),
        omega_std=std(noise.base_angular_velocity_rad_s),
        sensed_base=int(level.base_state == "sensed"),
        gyro=int(model.sensor("imu_gyro").adr[0]),
        acc=int(model.sensor("imu_acc").adr[0]),
        force=np.array([model.sensor(f"{side}_foot_force").adr[0] for side in SIDES], dtype=np.int64),
        torque=np.array([model.sensor(f"{side}_foot_torque").adr[0] for side in SIDES], dtype=np.int64),
        q=np.zeros(model.nq),
        v=np.zeros(model.nv),
        acc_base_in_base=np.zeros(3),
        wrenches=np.zeros((len(SIDES), 6)),
        loads=np.zeros(len(SIDES)),
    )


@compiled
def read_sensors(
    sensors: Sensors, walker: Walker, qpos: Array, qvel: Array, sensordata: Array, rng: np.random.Generator, dt: float
) -> None:
    """Fill the readings from the plant after a step of dt [s]: qpos (nq,), qvel (nv,), sensordata of that step."""
    for k in range(2):
        for i in range(3):  # MuJoCo gives the wrench of the foot on the sole
            sensors.wrenches[k, i] = -sensordata[sensors.force[k] + i]
            sensors.wrenches[k, 3 + i] = -sensordata[sensors.torque[k] + i]
        sensors.loads[k] = vertical_force(walker, k)
    for i in range(3):
        sensors.acc_base_in_base[i] = sensordata[sensors.acc + i] + sensors.acc_std * rng.standard_normal()
    if sensors.sensed_base == 1:
        update_base(walker, sensors.loads, sensors.acc_base_in_base, dt, sensors.q, sensors.v)
    else:
        for i in range(3):
            sensors.q[i] = qpos[i]
            sensors.v[i] = qvel[i]
    for i in range(3, 7):
        sensors.q[i] = qpos[i]
    for i in range(3, 6):
        sensors.v[i] = qvel[i] + sensors.omega_std * rng.standard_normal()
    for i in range(7, len(qpos)):
        sensors.q[i] = qpos[i] + sensors.q_std * rng.standard_normal()
    for i in range(6, len(qvel)):
        sensors.v[i] = qvel[i] + sensors.v_std * rng.standard_normal()
