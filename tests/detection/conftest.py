"""A leg in a made-up walk: swings of a third of a second, an upright robot, and torques as asked."""

import functools
from collections.abc import Callable

import pytest
from made_swings import RATE_HZ, swinging

from mobnet.core.joints import JointLayout
from mobnet.core.recording import Sensed
from mobnet.detection.detector import LegGate
from mobnet.robot.description import WalkingRobot
from mobnet.settings.settings import Settings


@pytest.fixture(scope="session")
def gate(settings: Settings, robot: WalkingRobot) -> LegGate:
    """The gate of the left leg."""
    return LegGate.of(settings.detection.gate, robot, "LL", RATE_HZ)


@pytest.fixture(scope="session")
def walk(layout: JointLayout) -> Callable[[int], Sensed]:
    """A function of a number of swings -> what a robot senses that hangs still in the air, first with its foot down."""
    return functools.partial(swinging, layout)
