"""A leg in a made-up walk: swings of a third of a second, an upright robot, and torques as asked."""

from collections.abc import Callable

import numpy as np
import pytest

from mobnet.core.columns import COMMAND, FEET
from mobnet.core.recording import Sensed
from mobnet.detection.detector import LegGate
from mobnet.robot.description import WalkingRobot
from mobnet.settings.settings import Settings

RATE_HZ = 1000.0
AIR, GROUND = 350, 1050  # samples of a swing, and of a step in which the foot stands


@pytest.fixture(scope="session")
def gate(settings: Settings, robot: WalkingRobot) -> LegGate:
    """The gate of the left leg."""
    return LegGate.of(settings.detection.gate, robot, "LL", RATE_HZ)


@pytest.fixture(scope="session")
def walk(robot: WalkingRobot) -> Callable[[int], Sensed]:
    """A function of a number of swings -> what a robot senses that hangs still in the air, first with its foot down."""

    def make(swings: int) -> Sensed:
        layout, rows = robot.layout, swings * (AIR + GROUND) + GROUND
        phase = np.arange(rows) % (AIR + GROUND) - GROUND
        air = phase >= 0
        q = np.zeros((rows, layout.nq))
        q[:, 3], q[:, 2] = 1.0, 1.0
        bend = dict(zip(layout.limb("LL"), (0.0, 0.0, -0.4, 0.9, -0.5, 0.0), strict=True))
        for joint, angle in bend.items():
            q[:, 7 + layout.actuated.index(joint)] = angle
        landing = np.where(air, (AIR - phase) / RATE_HZ, 0.0)
        flags, none = np.zeros((rows, len(FEET))), np.zeros((rows, layout.nu))
        swing, until = flags.copy(), flags.copy()
        swing[:, 0], until[:, 0] = air, landing
        command = np.zeros((rows, len(COMMAND)))
        acc = np.tile([0.0, 0.0, 9.81], (rows, 1))
        return Sensed(q, np.zeros((rows, layout.nv)), acc, none, none, swing, command, until)

    return make
