"""The controller of the true robot, its state, and random poses."""

import numpy as np
import pytest

from mobnet.control.kinematics import update
from mobnet.control.parameters import empty_state, walking_parameters
from mobnet.control.walker import make_walker

GRAVITY = 9.81
COMMAND = np.array([0.12, 0.05, 0.15, 0.8, 0.05])  # step x, y [m], turn [rad], duration [s], foot height [m]


@pytest.fixture(scope="session")
def par(settings):
    return walking_parameters(settings.walking)


@pytest.fixture
def make(robot, settings):
    return lambda: make_walker(robot, settings.walking, 1.0, GRAVITY)


@pytest.fixture
def walker(make):
    return make()


@pytest.fixture
def stepping():
    """Amid a step of the right foot: left foot at (0.2, 0.1), turned by 0.3 rad, right foot behind it."""
    s = empty_state()
    s.side, s.command, s.omega = 1.0, COMMAND, 3.4
    s.commanded = s.total = COMMAND[3]
    s.old_ankle, s.old_yaw, s.stance_yaw = (0.1, -0.1, 0.15), 0.2, 0.3
    return s


@pytest.fixture
def random_pose(walker, robot):
    """A function seed -> position (nq,), velocity (nv,), with the walker's pose updated to them."""

    def draw(seed):
        rng = np.random.default_rng(seed)
        q, v = rng.normal(size=robot.layout.nq), rng.normal(size=robot.layout.nv)
        q[3:7] /= np.linalg.norm(q[3:7])
        update(walker.tree, q, v, GRAVITY, walker.pose)
        return q, v

    return draw
