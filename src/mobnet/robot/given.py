"""The robot that a user names by a file. It reads a configuration, which no job of the workflow does."""

from pathlib import Path

from mobnet.core.place import check_extra
from mobnet.robot.description import RobotDescription, describe
from mobnet.settings.lab import Lab, load_section
from mobnet.settings.robot import RobotTable

FILES = (".urdf", ".xml", ".mjcf")  # of robots that no table describes yet


def given_table(path: Path | None, settings: Lab) -> RobotTable:
    """Return the table of a file, or that of the configuration where none is given.

    Raises:
        ConfigError: the file cannot be read, or is no table of a robot.
    """
    return load_section(path, RobotTable) if path else settings.robot


def given_robot(path: Path | None, settings: Lab) -> RobotDescription:
    """Return the robot of a table's file, or that of the configuration where none is given.

    A URDF or MJCF file is read as `mobnet robot` makes a table of it without further words.

    Raises:
        ConfigError: the file cannot be read, or is no table of a robot.
        DataError: the file is no robot, or a table cannot hold it.
    """
    if path is not None and path.suffix in FILES:
        check_extra("simulate")
        from mobnet.robot.import_table import read_robot  # MuJoCo, which comes with an extra

        return read_robot(path)
    return describe(given_table(path, settings))
