"""The robot that a user names by the file of its table. It reads a configuration, which no job of the workflow does."""

from pathlib import Path

from mobnet.robot.description import RobotDescription, describe
from mobnet.settings.lab import Lab, load_section
from mobnet.settings.robot import RobotTable


def given_table(path: Path | None, settings: Lab) -> RobotTable:
    """Return the table of a file, or that of the configuration where none is given.

    Raises:
        ConfigError: the file cannot be read, or is no table of a robot.
    """
    return load_section(path, RobotTable) if path else settings.robot


def given_robot(path: Path | None, settings: Lab) -> RobotDescription:
    """Return the robot of a table's file, or that of the configuration where none is given.

    Raises:
        ConfigError: the file cannot be read, or is no table of a robot.
    """
    return describe(given_table(path, settings))
