"""A log of a two-link arm on a fixed base that is pushed. A conftest imports the fixture."""

import mujoco
import numpy as np
import pytest

from mobnet.core.recording import Recording, Sensed, Truth
from mobnet.robot.plant import robot_spec

RATE_HZ, SUB_STEPS, SAMPLES = 1000.0, 2, 600
PUSH = np.array([0.0, 3.0])  # [N m]


@pytest.fixture(scope="session")
def pushed_arm(arm):
    """The simulated arm swings under its motors, and is pushed after a tenth of a second."""
    spec = robot_spec(arm)
    spec.option.timestep = 1 / (SUB_STEPS * RATE_HZ)
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_RK4  # links turn at 10 rad/s, too fast for Euler's method
    model = spec.compile()
    data, rows = mujoco.MjData(model), []
    data.qpos[:] = 0.5, -0.8
    for sample in range(SAMPLES):
        ticks = []
        for _ in range(SUB_STEPS):
            data.ctrl[:] = 12 * np.sin(9 * data.time) - 4 * data.qpos - data.qvel
            data.qfrc_applied[:] = PUSH if sample >= RATE_HZ / 10 else 0.0
            mujoco.mj_step(model, data)
            ticks.append([data.ctrl.copy(), data.qfrc_applied.copy()])
        rows.append([data.qpos.copy(), data.qvel.copy(), *np.mean(ticks, axis=0)])
    q, v, tau, external = np.array(rows).transpose(1, 0, 2)
    none = np.zeros((SAMPLES, 0))
    truth = Truth(external, none, none, none, np.zeros((SAMPLES, 1)), np.zeros_like(tau), np.zeros_like(external), none)
    return Recording(
        Sensed(q, v, none, tau, tau, none, none, none), ((0, SAMPLES),), RATE_HZ, {"level": "ideal"}, truth
    )
