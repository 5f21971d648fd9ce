"""A leg in a made-up walk: swings of a third of a second, an upright robot, and torques as asked."""

import functools

import pytest
from made_swings import RATE_HZ, swinging

from mobnet.detection.detector import LegGate
from mobnet.formats.plain import as_plain
from mobnet.kernel.detecting import GateNumbers


@pytest.fixture(scope="session")
def gate(settings, robot):
    return LegGate.of(as_plain(settings.detection.gate, GateNumbers), robot, "LL", RATE_HZ)


@pytest.fixture(scope="session")
def walk(layout):
    """A function of a number of swings -> what a robot senses that hangs still in the air, first with its foot down."""
    return functools.partial(swinging, layout)
