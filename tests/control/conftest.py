"""The controller of the true robot, its state, and random poses."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from mobnet.control.kinematics import update
from mobnet.control.parameters import State, WalkingParameters, empty_state, walking_parameters
from mobnet.control.walker import Walker, make_walker
from mobnet.robot.description import RobotDescription

Array = NDArray[np.float64]
GRAVITY = 9.81
COMMAND = np.array([0.12, 0.05, 0.15, 0.8, 0.05])  # step x, y [m], turn [rad], duration [s], foot height [m]


@pytest.fixture(scope="session")
def par(full_config: dict[str, Any]) -> WalkingParameters:
    return walking_parameters(full_config["walking"])


@pytest.fixture
def walker(robot: RobotDescription, par: WalkingParameters) -> Walker:
    return make_walker(robot, par, 1.0, GRAVITY)


@pytest.fixture
def stepping() -> State:
    """Amid a step of the right foot: left foot at (0.2, 0.1), turned by 0.3 rad, right foot behind it."""
    s = empty_state()
    s.side, s.command, s.omega = 1.0, COMMAND, 3.4
    s.commanded = s.total = COMMAND[3]
    s.old_ankle, s.old_yaw, s.stance_yaw = (0.1, -0.1, 0.15), 0.2, 0.3
    return s


@pytest.fixture
def random_pose(walker: Walker, robot: RobotDescription) -> Callable[[int], tuple[Array, Array]]:
    """A function seed -> position (nq,), velocity (nv,), with the walker's pose updated to them."""

    def draw(seed: int) -> tuple[Array, Array]:
        rng = np.random.default_rng(seed)
        q, v = rng.normal(size=robot.layout.nq), rng.normal(size=robot.layout.nv)
        q[3:7] /= np.linalg.norm(q[3:7])
        update(walker.tree, q, v, GRAVITY, walker.pose)
        return q, v

    return draw
