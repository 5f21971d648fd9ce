"""A simulated arm of a table: it follows sines in MuJoCo, with friction that its model lacks, and may be pushed."""

from collections.abc import Sequence

import mujoco
import numpy as np
import pandas as pd
from numpy.typing import NDArray

from mobnet.robot.description import RobotDescription
from mobnet.robot.dynamics import bias
from mobnet.robot.nominal import NominalModel
from mobnet.robot.plant import robot_spec

STEPS = 2  # of the simulation in a sample
WAVES, RATES_HZ, SIZES_RAD = 12, (0.05, 0.8), (0.05, 0.2)  # sines of each joint
STIFFNESS, DAMPING = 150.0, 15.0  # of its control [N m/rad], [N m s/rad]
DRY, VISCOUS, STEADY = 1.5, 1.0, 0.05  # friction [N m], [N m s/rad], and the speed at which it turns [rad/s]
NOISE = {"q": 1e-5, "v": 2e-3, "tau_motor": 0.02}
Push = tuple[float, float, Sequence[float]]  # start, duration [s], torque of each joint [N m]


def arm_log(
    robot: RobotDescription, seconds: float, rate_hz: float, seed: int = 0, pushes: Sequence[Push] = ()
) -> pd.DataFrame:
    """Return a log with `time` [s] and columns as in a recording."""
    rng, joints = np.random.default_rng(seed), robot.layout.nu
    model = robot_spec(robot).compile()
    model.opt.timestep = 1.0 / rate_hz / STEPS
    data, nominal = mujoco.MjData(model), NominalModel(robot)
    rate, size = 2 * np.pi * rng.uniform(*RATES_HZ, (WAVES, joints)), rng.uniform(*SIZES_RAD, (WAVES, joints))
    phase, rows = rng.uniform(0, 2 * np.pi, (WAVES, joints)), np.zeros((round(seconds * rate_hz), 3 * joints))
    data.qpos[:] = (size * np.sin(phase)).sum(axis=0)
    for row in rows:
        angle = rate * data.time + phase
        wanted, speed = (size * np.sin(angle)).sum(axis=0), (size * rate * np.cos(angle)).sum(axis=0)
        torque = bias(nominal, data.qpos, np.zeros(joints)) + STIFFNESS * (wanted - data.qpos)
        torque += DAMPING * (speed - data.qvel)
        row[:] = np.concatenate([data.qpos, data.qvel, torque])
        for _ in range(STEPS):
            friction = DRY * np.tanh(data.qvel / STEADY) + VISCOUS * data.qvel
            data.qfrc_applied[:] = _pushed(pushes, data.time, joints) - friction
            data.ctrl[:] = torque
            mujoco.mj_step(model, data)
    names = [f"{name}.{joint}" for name in NOISE for joint in robot.layout.actuated]
    rows += rng.normal(size=rows.shape) * np.repeat(list(NOISE.values()), joints)
    return pd.DataFrame({"time": np.arange(len(rows)) / rate_hz, **dict(zip(names, rows.T, strict=True))})


def _pushed(pushes: Sequence[Push], time_s: float, joints: int) -> NDArray[np.float64]:
    """Return the torque of half-sines that act at a time (joints,) [N m]."""
    found = np.zeros(joints)
    for start, duration, torque in pushes:
        if start <= time_s < start + duration:
            found += np.sin(np.pi * (time_s - start) / duration) * np.asarray(torque)
    return found
