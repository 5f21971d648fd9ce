"""What the sensors of the surrogate robot see: rotors instead of links, late and biased inertia, feet that weigh."""

from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.compilation import compiled
from mobnet.robot.description import SIDES, WalkingRobot
from mobnet.robot.plant import sole_name
from mobnet.settings.surrogate import SensorErrors
from mobnet.simulation.drives import Drives
from mobnet.simulation.sensing import Sensors

INERTIAL = 10  # numbers of an inertial reading: quaternion w x y z, angular velocity, acceleration


class Faults(NamedTuple):
    """Errors that last, of one surrogate robot, and what its sensors see with them.

    Attributes:
        hidden: 1 if there are such errors, 0 where sensors see the plant itself.
        zero: error of the encoders' zeros (nu,) [rad].
        acc: constant error of the acceleration, base axes (3,) [m/s^2].
        omega: constant error of the angular velocity, base axes (3,) [rad/s].
        mounting: rotation vector by which the inertial sensor is mounted askew, base axes (3,) [rad].
        late: delay of the inertial sensor in steps.
        gain: gain of the left, right foot's wrench (2, 6).
        offset: its constant error (2, 6) [N, N m].
        plate: mass below each foot's sensor, and the mass that is taken off the readings (2,) [kg].
        arm: centre of that mass from the sensor, foot axes (3,) [m].
        foot_acc: first entries of the left, right foot's accelerometer in sensordata (2,).
        soles: bodies of the left, right sole (2,).
        past: inertial readings of the last steps (late + 1, 10).
        steps: number of steps so far (1,).
        qpos: generalized position as seen (nq,).
        qvel: generalized velocity as seen (nv,).
        data: sensordata as seen.
    """

    hidden: int
    zero: Array
    acc: Array
    omega: Array
    mounting: Array
    late: int
    gain: Array
    offset: Array
    plate: Array
    arm: Array
    foot_acc: NDArray[np.int64]
    soles: NDArray[np.int64]
    past: Array
    steps: NDArray[np.int64]
    qpos: Array
    qvel: Array
    data: Array


def draw_faults(
    errors: SensorErrors, robot: WalkingRobot, model: mujoco.MjModel, rate_hz: float, rng: np.random.Generator
) -> Faults:
    """Draw the errors of a surrogate robot's sensors, a plant stepped at a rate [1/s]."""
    late = round(rng.uniform(*errors.imu_late_s) * rate_hz)
    sizes = [errors.foot_force_n, errors.foot_moment_nm]
    known = robot.sole.plate_kg
    plate = known * (1.0 + errors.plate_share * rng.standard_normal())
    return no_faults(model)._replace(
        hidden=1,
        zero=errors.encoder_zero_rad * rng.standard_normal(robot.layout.nu),
        acc=errors.acceleration_m_s2 * rng.standard_normal(3),
        omega=errors.angular_velocity_rad_s * rng.standard_normal(3),
        mounting=errors.mounting_rad * rng.standard_normal(3),
        late=late,
        gain=1.0 + errors.foot_gain_share * rng.standard_normal((len(SIDES), 6)),
        offset=np.repeat(sizes, 3) * rng.standard_normal((len(SIDES), 6)),
        plate=np.array([plate, known]),
        arm=np.subtract(robot.sole.plate_com, robot.sole.sensor_pos),
        past=np.zeros((late + 1, INERTIAL)),
    )


def no_faults(model: mujoco.MjModel) -> Faults:
    """Return what stands in the place of errors on the plant of section 5.1."""
    nu = model.nu
    return Faults(
        hidden=0,
        zero=np.zeros(nu),
        acc=np.zeros(3),
        omega=np.zeros(3),
        mounting=np.zeros(3),
        late=0,
        gain=np.ones((len(SIDES), 6)),
        offset=np.zeros((len(SIDES), 6)),
        plate=np.zeros(2),
        arm=np.zeros(3),
        foot_acc=np.array([model.sensor(f"{side}_foot_acc").adr[0] for side in SIDES], dtype=np.int64),
        soles=np.array([model.body(sole_name(side)).id for side in SIDES], dtype=np.int64),
        past=np.zeros((1, INERTIAL)),
        steps=np.zeros(1, dtype=np.int64),
        qpos=np.zeros(model.nq),
        qvel=np.zeros(model.nv),
        data=np.zeros(model.nsensordata),
    )


def reset_faults(faults: Faults, sensors: Sensors) -> None:
    """Begin an episode: nothing has been read yet; the error of the mounting joins that of the orientation."""
    faults.steps[0] = 0
    sensors.offset[:] += faults.mounting


@compiled
def perceive(
    faults: Faults, sensors: Sensors, drives: Drives, qpos: Array, qvel: Array, data: Array, xmat: Array, gravity: float
) -> None:
    """Fill what the sensors see from the plant after a step: qpos (nq,), qvel (nv,), sensordata, body axes (n, 9)."""
    _copy(qpos, faults.qpos)
    _copy(qvel, faults.qvel)
    _copy(data[: len(faults.data)], faults.data)  # those of obstacles come behind the robot's own
    for j in range(len(faults.zero)):
        if drives.hidden == 1:
            faults.qpos[7 + j] = drives.state[j].angle
            faults.qvel[6 + j] = drives.state[j].rate
        faults.qpos[7 + j] += faults.zero[j]
    if faults.hidden == 0:
        return
    _see_inertia(faults, sensors, qpos, data)
    for k in range(2):
        _weigh_foot(faults, sensors, k, xmat[faults.soles[k]], gravity)


@compiled
def _copy(values: Array, out: Array) -> None:
    """Write values (n,) into out (n,)."""
    for i in range(len(values)):
        out[i] = values[i]


@compiled
def _see_inertia(faults: Faults, sensors: Sensors, qpos: Array, data: Array) -> None:
    """Fill the orientation, angular velocity and acceleration of some steps ago, with constant errors."""
    size = len(faults.past)
    now = faults.past[faults.steps[0] % size]
    for i in range(4):
        now[i] = qpos[3 + i]
    for i in range(3):
        now[4 + i] = data[sensors.gyro + i]
        now[7 + i] = data[sensors.acc + i]
    seen = faults.past[max(faults.steps[0] - faults.late, 0) % size]
    for i in range(4):
        faults.qpos[3 + i] = seen[i]
    for i in range(3):
        faults.qvel[3 + i] = seen[4 + i] + faults.omega[i]
        faults.data[sensors.acc + i] = seen[7 + i] + faults.acc[i]
    faults.steps[0] += 1


@compiled
def _weigh_foot(faults: Faults, sensors: Sensors, k: int, axes: Array, gravity: float) -> None:
    """Fill the wrench of foot k that is read: the ground's, less what the mass below the sensor weighs and resists.

    The weight of a mass that was calibrated is added again, so that a foot at rest in the air reads zero but for the
    error of that mass. MuJoCo's readings are minus the ground's wrench.
    """
    force, torque, acc = sensors.force[k], sensors.torque[k], faults.foot_acc[k]
    for i in range(3):
        j = (i + 1) % 3
        n = (i + 2) % 3
        # Specific force: acceleration less gravity, foot axes; the world's vertical is the third row of the axes.
        lost = faults.plate[0] * faults.data[acc + i] - faults.plate[1] * gravity * axes[6 + i]
        lost_j = faults.plate[0] * faults.data[acc + j] - faults.plate[1] * gravity * axes[6 + j]
        lost_n = faults.plate[0] * faults.data[acc + n] - faults.plate[1] * gravity * axes[6 + n]
        read = -faults.data[force + i] - lost
        moment = -faults.data[torque + i] - (faults.arm[j] * lost_n - faults.arm[n] * lost_j)
        faults.data[force + i] = -(faults.gain[k, i] * read + faults.offset[k, i])
        faults.data[torque + i] = -(faults.gain[k, 3 + i] * moment + faults.offset[k, 3 + i])
