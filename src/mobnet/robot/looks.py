"""A robot as pictures show it: dressed in the shells, hands and head of its table, which nothing else reads."""

from dataclasses import replace
from typing import TypeVar

from mobnet.robot.description import RobotDescription, with_mirrored
from mobnet.settings.parts import Looks

Robot = TypeVar("Robot", bound=RobotDescription)


def dressed(robot: Robot, looks: Looks | None) -> Robot:
    """Return a robot whose solids are those of its looks, both sides; as it is where its table has none.

    The solids of a description that is not dressed are those that touch obstacles and the robot itself.
    """
    if looks is None:
        return robot
    return replace(robot, shapes=with_mirrored(looks.shapes), tones={**robot.tones, **looks.tones})
