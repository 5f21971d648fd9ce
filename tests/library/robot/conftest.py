"""The robot, its two models and random states."""

import mujoco
import numpy as np
import pytest

from mobnet.robot.plant import SOLE_TYPE, TERRAIN_TYPE, robot_spec

TIME_STEP_S = 0.0005
STIFFNESS, DAMPING = 12.0, 0.25  # per N m of torque limit, 1/rad and s/rad
PUSH = np.array([10.0, 5.0, 3.0])  # on the left sole [N]


@pytest.fixture(scope="session")
def plant(robot):
    return robot_spec(robot).compile()


@pytest.fixture
def random_state(robot):
    """A function seed -> position (nq,), velocity (nv,)."""

    def draw(seed):
        rng = np.random.default_rng(seed)
        q = rng.normal(size=robot.layout.nq)
        q[3:7] /= np.linalg.norm(q[3:7])
        return q, rng.normal(size=robot.layout.nv)

    return draw


@pytest.fixture
def standing(robot):
    """A function steps -> iterator over model, data and the position (nq,) before the step, of a robot held upright."""
    spec = robot_spec(robot)
    plane = mujoco.mjtGeom.mjGEOM_PLANE
    spec.worldbody.add_geom(type=plane, size=[5, 5, 1], contype=TERRAIN_TYPE, conaffinity=SOLE_TYPE)
    spec.option.timestep = TIME_STEP_S
    model = spec.compile()

    def simulate(steps):
        data = mujoco.MjData(model)
        data.qpos[2] = robot.leg.link_length * 2 - robot.leg.hip_pos[2] - robot.sole.height
        for _ in range(steps):
            before = data.qpos.copy()
            data.ctrl[:] = -robot.torque_limits * (STIFFNESS * data.qpos[7:] + DAMPING * data.qvel[6:])
            data.body("left_sole").xfrc_applied[:3] = PUSH
            mujoco.mj_step(model, data)
            yield model, data, before

    return simulate
