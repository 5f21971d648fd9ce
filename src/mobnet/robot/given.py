"""The robot that a user names by a file. It reads a configuration, which no job of the workflow does."""

from pathlib import Path

from mobnet.core.files import descriptor_of
from mobnet.core.place import check_extra
from mobnet.formats.loading import load_section
from mobnet.formats.robot import RobotTable
from mobnet.robot.description import RobotDescription, describe
from mobnet.settings.lab import Lab

FILES = (".urdf", ".xml", ".mjcf")  # of robots that no table describes yet; gzip may have packed them


def given_table(path: Path | None, settings: Lab) -> RobotTable:
    """Return the table of a file, or that of the configuration where none is given.

    A URDF or MJCF file is read as `mobnet robot` makes a table of it without further words.

    Raises:
        ConfigError: the file cannot be read, or is no table of a robot.
        DataError: the file is no robot, or a table cannot hold it.
    """
    if path is None:
        return settings.robot
    if not is_robot_file(path):
        return load_section(path, RobotTable)
    check_extra("simulate")
    from mobnet.robot.import_table import read_table  # MuJoCo, which comes with an extra

    table, _ = read_table(path)
    return table


def given_robot(path: Path | None, settings: Lab) -> RobotDescription:
    """Return the robot of a file as `given_table` does its table, with notes of what the file does not say."""
    if path is None or not is_robot_file(path):
        return describe(given_table(path, settings))
    check_extra("simulate")
    from mobnet.robot.import_table import read_robot

    return read_robot(path)


def is_robot_file(path: Path) -> bool:
    """Return whether a path is that of a URDF or MJCF file; standard input and pipes hold one."""
    return descriptor_of(path) is not None or path.name.lower().removesuffix(".gz").endswith(FILES)
